"""What an equilibrium costs: from a straight arm to 2 N, in compiled code, over the number of segments.

Absolute figures are reported; asserted are ratios within the run: the time grows linearly with the number
of segments, and one Newton iteration stays below a multiple of a loop of as many multiply-adds.
"""

import statistics
import time

import numpy as np

from statics import (
    RONE2012_HOLE_OFFSET,
    Arm,
    Bending,
    Cable,
    Cables,
    Extension,
    Gravity,
    Scene,
    StaticSolver,
)
from statics.kernels.compiled import compiled
from statics.passes.newton import find_stable
from statics.passes.rest_passes import RestPasses
from statics.passes.search import clear

DISKS = (4, 16, 64, 256, 1024)
REPEATS = 9
WORK = 200_000
"""Segments times solutions in one repeat."""
LINEAR_WITHIN = 1.5
"""Largest allowed ratio of the time per segment and iteration at 1024 segments to that at 64."""
MULTIPLY_ADDS = 100
"""Multiply-adds per segment and iteration that one iteration is held against."""
ITERATION_WITHIN = 1.0
"""Largest allowed ratio of one iteration to so many multiply-adds, each waiting for the one before."""


def scene(disks: int) -> Scene:
    """The paper's arm, its length and mass cut into that many segments."""
    arm = Arm.preset(
        "rone2012",
        disks=disks,
        disk_spacing=0.08 / disks,
        disk_mass=4 * 7.782e-4 / disks,
        cables=(Cable("upper", RONE2012_HOLE_OFFSET),),
    )
    return Scene(arm, (Bending(), Extension(), Gravity(), Cables()))


@compiled
def chained_multiply_adds(count: int, factor: float) -> float:
    """A fixed amount of arithmetic, to measure the machine by."""
    total = 1.0
    for _ in range(count):
        total = total * factor + 1.0
    return total


@compiled
def repeat_solution(
    times: int,
    passes: RestPasses,
    q: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    unit: float,
) -> int:
    """Solve from straight so many times; the Newton iterations of the last."""
    iterations = 0
    for _ in range(times):
        clear(q)
        iterations = find_stable(passes, q, inputs, segments, disks, unit, 200)[1]
    return iterations


def seconds_per_solution(disks: int) -> tuple[float, int]:
    """Median time of a solution from straight at 2 N, and its Newton iterations."""
    solver = StaticSolver(scene(disks))
    tables = np.array([2.0]), solver.segments, solver.disks, solver.scene.arm.rest_length
    q, count = np.zeros((disks, 2)), max(1, WORK // disks)
    iterations = repeat_solution(1, solver.kernel.passes, q, *tables)
    times = []
    for _ in range(REPEATS):
        started = time.perf_counter()
        repeat_solution(count, solver.kernel.passes, q, *tables)
        times.append((time.perf_counter() - started) / count)
    return statistics.median(times), iterations


def main() -> None:
    """Print the table and check the ratios."""
    chained_multiply_adds(1, 0.5)
    started = time.perf_counter()
    chained_multiply_adds(50_000_000, 0.5)
    per_multiply_add = (time.perf_counter() - started) / 50_000_000
    print(f"one chained multiply-add: {per_multiply_add * 1e9:.2f} ns")
    print("segments  iterations  time per solution  per segment and iteration")
    per_segment = {}
    for disks in DISKS:
        seconds, iterations = seconds_per_solution(disks)
        per_segment[disks] = seconds / disks / iterations
        print(f"{disks:8d}  {iterations:10d}  {seconds * 1e6:14.2f} us  {per_segment[disks] * 1e9:22.1f} ns")
    growth = per_segment[1024] / per_segment[64]
    against = per_segment[64] / (MULTIPLY_ADDS * per_multiply_add)
    print(f"1024 against 64 segments, per segment: {growth:.2f} (allowed: {LINEAR_WITHIN})")
    print(f"one iteration against {MULTIPLY_ADDS} multiply-adds: {against:.2f} (allowed: {ITERATION_WITHIN})")
    assert growth < LINEAR_WITHIN
    assert against < ITERATION_WITHIN


if __name__ == "__main__":
    main()
