"""What ``continuum-dyn run`` of the step response costs as a whole process, from no kernels to all of them.

Processor seconds, children included, the least of some rounds from an empty folder: others share the machine.
Each figure is held against a bar; the exit status is 1 where one is above it.
"""

import sys
import tempfile
from pathlib import Path

from processes import CHECKOUT, RUN, SCENARIOS, succeeded

SCENARIO = SCENARIOS / "step_response.toml"
OTHERS = {
    "one more effect": (
        "rotary_inertia = {}",
        "rotary_inertia = {}\nmass_damping = { mass_damping_rate = 20.0 }",
    ),
    "a cable that rubs": ("hole_offset = 0.008", "hole_offset = 0.008\nfriction = 0.2"),
}
"""Other structures of equations, by what is put in place of what."""
FIRST, OTHER, WARM = 9.0, 3.0, 1.4
"""Most seconds: without any kernels, for another structure after that, and with all kernels at hand."""
ROUNDS = 3


def seconds(scenario: Path, folder: Path) -> float:
    """Processor seconds of a run into a folder, whose kernels it keeps."""
    return succeeded(*RUN, scenario, "--out", folder, checkout=CHECKOUT, kernels=folder / "kernels").processor


def changed(name: str, folder: Path) -> Path:
    """The scenario with that structure instead."""
    text, (part, other) = SCENARIO.read_text(encoding="utf-8"), OTHERS[name]
    assert text.count(part) == 1
    path = folder / f"{name.replace(' ', '_')}.toml"
    path.write_text(text.replace(part, other), encoding="utf-8")
    return path


def measured(folder: Path) -> dict[str, tuple[float, float]]:
    """Every situation in turn: its seconds, and its bar."""
    found = {"the first scenario ever": (seconds(SCENARIO, folder), FIRST)}
    for name in OTHERS:
        found[f"then {name}"] = (seconds(changed(name, folder), folder), OTHER)
    return found | {"warm": (seconds(SCENARIO, folder), WARM)}


def main() -> int:
    """Print the table; the exit status."""
    rounds = []
    for _ in range(ROUNDS):
        with tempfile.TemporaryDirectory() as folder:
            rounds.append(measured(Path(folder)))
    least = {name: (min(found[name][0] for found in rounds), bar) for name, (_, bar) in rounds[0].items()}
    print(f"run of the step response   processor time  at most   (least of {ROUNDS})")
    for name, (spent, bar) in least.items():
        print(f"{name:25s}  {spent:12.2f} s  {bar:5.1f} s{'' if spent <= bar else '  OVER'}")
    return int(any(spent > bar for spent, bar in least.values()))


if __name__ == "__main__":
    sys.exit(main())
