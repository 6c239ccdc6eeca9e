"""What logging costs of a run that computes 1000 samples a second: ``python benchmarks/log_cost.py``.

Arms are driven without rest for some seconds of computing. Each run is timed with its log, written as it
goes and finished, and without one, in turn and in one process. Reading the log back and making a recording
are no part of it. Times are the processor's, the system's on its behalf included: others share the machine.
"""

import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from continuum_dyn import Run, Scenario, load_scenario, simulate
from continuum_dyn.record import StreamedLog
from continuum_dyn.scenario.profiles import Sine
from continuum_dyn.scenario.studies import MotionStudy
from statics import Scene

SCENARIOS = Path(__file__).parents[1] / "scenarios"
RATE = 1000
"""Samples for each second of computing."""
CASES = ((4, 1500.0), (16, 500.0))
"""Disks of the arm, and duration of its motion (s)."""
REPEATS = 3
BOUND = 0.05
"""Part of the run that logging may take."""


def driven(disks: int, duration: float, samples: int) -> Scenario:
    """The arm of the step response with more disks, pulled up and down 20 times a second."""
    given = load_scenario(SCENARIOS / "step_response.toml")
    arm = replace(given.scene.arm, disks=disks, disk_spacing=0.08 / disks, disk_mass=3.1128e-3 / disks)
    return replace(
        given,
        scene=Scene(arm, given.scene.effects),
        drives=(Sine(1.0, 0.9, 20.0),),
        study=MotionStudy(duration, samples=samples),
    )


def logged(scenario: Scenario, path: Path) -> Run:
    """The run, and its log on disk."""
    with StreamedLog(path) as log:
        run = simulate(scenario, sink=log)
        log.finish(run)
    return run


def seconds(work: Callable[[], Run]) -> float:
    """Time of the processor, s."""
    started = time.process_time()
    work()
    return time.process_time() - started


def part_of_run(disks: int, duration: float, path: Path) -> float:
    """Time that logging adds, as a part of the run without it."""
    simulate(driven(disks, 0.1, 11))
    takes = seconds(lambda: simulate(driven(disks, duration, 11)))
    scenario = driven(disks, duration, round(RATE * takes))
    pairs = [
        (seconds(lambda: simulate(scenario)), seconds(lambda: logged(scenario, path))) for _ in range(REPEATS)
    ]
    bare, whole = (statistics.median(column) for column in zip(*pairs, strict=True))
    size, samples = path.stat().st_size / 1e6, round(RATE * takes)
    print(f"{disks:3} disks, {samples} samples in {bare:.2f} s, {size:.1f} MB:", end=" ")
    print(f"logging {1e6 * (whole - bare) / samples:.1f} us a sample, {(whole - bare) / bare:.1%} of the run")
    return (whole - bare) / bare


def main() -> int:
    """Exit status: 1 where logging costs more than ``BOUND`` of a run."""
    with tempfile.TemporaryDirectory() as folder:
        parts = [part_of_run(*case, Path(folder) / "log.h5") for case in CASES]
    return int(max(parts) > BOUND)


if __name__ == "__main__":
    sys.exit(main())
