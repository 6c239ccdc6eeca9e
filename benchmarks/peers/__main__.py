"""The tools that people would pick instead, on the same arm in the same run: tables of error and time.

Run from the top of the repository: ``python -m benchmarks.peers``, or with the names of some peers after it;
``--disks 16`` cuts the same arm finer. Peers that are not installed, or that would take far more than minutes
at so many disks, are named and left out. This program is timed right after each setting of a
peer, at a tolerance at which its error is no larger than the peer's.
"""

import argparse
import platform
import subprocess
import sys
from collections.abc import Iterable
from importlib import import_module
from importlib.metadata import version
from itertools import groupby

from .case import PAPER_DISKS, Answer, Case

PEERS = {"kane": 12, "mujoco_hinges": 64, "soromox_pcs": 16, "pyelastica": 16}
"""The peers, and up to how many disks each is measured without being named: minutes, not hours."""
HEADER = (
    "| settings | tip error | left when refined | time | ours at that error | ratio |\n"
    "|---|---|---|---|---|---|"
)


def main() -> None:
    """Print the tables of one peer, or of each in a process of its own: one's threads can slow another."""
    asked = arguments()
    if len(asked.peers) == 1:
        print_peer(asked.peers[0], Case(asked.disks, asked.duration))
        return
    print(f"Python {platform.python_version()}, continuum-dyn {version('continuum-dyn')}", flush=True)
    settings = ["--disks", str(asked.disks), "--duration", str(asked.duration)]
    for name, most in PEERS.items():
        if name in asked.peers or (not asked.peers and asked.disks <= most):
            subprocess.run([sys.executable, "-m", str(__package__), *settings, name], check=True)
        elif not asked.peers:
            print(f"\n{name}: left out, not a matter of minutes above {most} disks", flush=True)


def arguments() -> argparse.Namespace:
    """What the command line asks for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.peers", description=__doc__)
    parser.add_argument("peers", nargs="*", metavar="peer", help=f"{', '.join(PEERS)}; all if none is named")
    parser.add_argument("--disks", type=int, default=PAPER_DISKS, help="segments that the arm is cut into")
    parser.add_argument("--duration", type=float, default=1.0, help="of the motion, s")
    asked = parser.parse_args()
    unknown = set(asked.peers) - set(PEERS)
    if unknown:
        parser.error(f"no peer {', '.join(sorted(unknown))}. Allowed: {', '.join(PEERS)}.")
    return asked


def print_peer(name: str, case: Case) -> None:
    """A peer's versions and the tables of its models; or that it is not installed."""
    try:
        peer = import_module(f".{name}", __package__)
    except ModuleNotFoundError as missing:
        print(f"\n{name}: left out, {missing.name} is not installed")
        return
    print(f"\n{', '.join(f'{package} {version(package)}' for package in peer.PACKAGES)}; {case.disks} disks")
    for model, answers in groupby(peer.answers(case), key=lambda answer: answer.model):
        print_model(case, model, answers)


def print_model(case: Case, model: str, answers: Iterable[Answer]) -> None:
    """One model's rows. The last is the most refined: the model's part of the error is what that leaves."""
    rows, lacks, error = [], "", 0.0
    for answer in answers:
        lacks, error = answer.lacks, case.error(answer.tip)
        rtol, _own_error, own_seconds = case.own_time(error)
        rows.append((answer, error, rtol, own_seconds))
    print(f"\n{model}\n\n{HEADER}")
    for answer, its_error, rtol, own_seconds in rows:
        ours, ratio = f"{own_seconds * 1e3:.2f} ms, rtol {rtol:.0e}", answer.seconds / own_seconds
        print(
            f"| {answer.settings} | {length(its_error)} | {length(error)} "
            f"| {answer.seconds * 1e3:.4g} ms | {ours} | {ratio:.{0 if ratio >= 10 else 1}f} |"
        )
    print(f"\nIt lacks {lacks}.", flush=True)


def length(metres: float) -> str:
    """A length in micrometres or millimetres, two digits of it."""
    return f"{metres * 1e6:.2g} um" if metres < 9.5e-5 else f"{metres * 1e3:.2g} mm"


if __name__ == "__main__":
    main()
