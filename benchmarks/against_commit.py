"""How fast this checkout is against another commit: ``python benchmarks/against_commit.py REVISION``.

Both are measured by ``speeds.py`` in processes that take turns, with warm kernels; of every speed the best
counts. Asserted: none is slower than the other commit's by more than a tenth.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from processes import CHECKOUT, succeeded

SPEEDS = Path(__file__).with_name("speeds.py")
ROUNDS = 5
WITHIN = 1.1
"""Largest allowed ratio of a time of this checkout to that of the other."""


def git(*arguments: str | Path) -> None:
    """Run git here."""
    subprocess.run(["git", "-C", CHECKOUT, *arguments], check=True, stdout=subprocess.DEVNULL)


@contextmanager
def checked_out(revision: str, folder: Path) -> Iterator[Path]:
    """A worktree of the revision, for as long as it is needed."""
    git("worktree", "add", "--quiet", "--detach", folder, revision)
    try:
        yield folder
    finally:
        git("worktree", "remove", "--force", folder)


def speeds(checkout: Path, kernels: Path) -> dict[str, float]:
    """Seconds by what they are of."""
    return json.loads(succeeded(SPEEDS, checkout=checkout, kernels=kernels).output)


def best(revision: str, rounds: int) -> tuple[dict[str, float], dict[str, float]]:
    """Speeds of this checkout and of the revision, each the best of the rounds; the first is not counted."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with checked_out(revision, folder / "other") as other:
            sides = (CHECKOUT, folder / "kernels"), (other, folder / "kernels_of_other")
            measured = [tuple(speeds(*side) for side in sides) for _ in range(rounds + 1)][1:]
    new, old = zip(*measured, strict=True)
    return least(new), least(old)


def least(found: tuple[dict[str, float], ...]) -> dict[str, float]:
    """The least of every speed."""
    return {name: min(speeds[name] for speeds in found) for name in found[0]}


def main() -> int:
    """Print the table; the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("revision", help="the other commit")
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="processes of each checkout")
    asked = parser.parse_args()
    new, old = best(asked.revision, asked.rounds)
    print(f"{'':42s}  {asked.revision[:12]:>12s}          here  ratio (at most {WITHIN})")
    for name in old:
        ratio = new[name] / old[name]
        mark = "" if ratio <= WITHIN else "  SLOWER"
        print(f"{name:42s}  {old[name] * 1e6:9.3f} us  {new[name] * 1e6:9.3f} us  {ratio:.2f}{mark}")
    return int(any(new[name] > WITHIN * old[name] for name in old))


if __name__ == "__main__":
    sys.exit(main())
