"""What one Newton iteration of an implicit stage costs: residual, matrix, solve.

Per segment, at 64 segments of the paper's arm, beside a fixed loop of as many multiply-adds: eight sums that
wait for nothing but themselves. Reported sweep by sweep; asserted: the whole, as a ratio to that loop.
"""

import ast
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numba import njit
from scaling import SCENARIO, cut

from continuum_dyn import load_scenario
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation import Motion

SEGMENTS = 64
CALLS, REPEATS = 4000, 15
SWEEPS = {
    "motion": ("motion_step",),
    "residual": ("residual_step",),
    "eliminate": ("eliminate_step",),
    "substitute": ("substitute_step",),
}
AT_MOST = 2.5
"""Times the loop of multiply-adds: what a wait for angles, pivots and memory may cost."""


@njit
def multiply_adds(count: int, x: np.ndarray) -> None:
    """``count`` times eight multiply-adds."""
    a, b, c, d, e, f, g, h = x
    for _ in range(count):
        a, b, c, d = a * 0.9 + 1.0, b * 0.9 + 1.0, c * 0.9 + 1.0, d * 0.9 + 1.0
        e, f, g, h = e * 0.9 + 1.0, f * 0.9 + 1.0, g * 0.9 + 1.0, h * 0.9 + 1.0
    x[:] = a, b, c, d, e, f, g, h


def nanoseconds(work: Callable[[], None]) -> float:
    """Shortest time of some repeats."""
    times = []
    work()
    for _ in range(REPEATS):
        started = time.perf_counter()
        work()
        times.append(time.perf_counter() - started)
    return 1e9 * min(times)


def operations(kernel: Any) -> dict[str, int]:
    """Arithmetic operations of every function of a generated kernel."""
    tree = ast.parse(Path(kernel.__file__).read_text(encoding="utf-8"))
    return {
        node.name: sum(isinstance(part, ast.BinOp) for part in ast.walk(node))
        for node in tree.body
        if isinstance(node, ast.FunctionDef)
    }


def sweeps_of(motion: Motion) -> dict[str, Callable[[], None]]:
    """The sweeps of one iteration, each called many times from compiled code."""
    kernel, segments, disks = motion.dynamics.implicit
    shape = (SEGMENTS, motion.dynamics.dofs)
    q = motion.start[: motion.dynamics.size].reshape(shape).copy()
    q[:, 0] += 1.0 / SEGMENTS
    u, w = np.full(shape, 0.1), np.zeros(shape)
    chain, tension = np.empty((SEGMENTS, kernel.CHAIN_COLUMNS)), np.array([1.0])
    residual, descent, change = np.empty(shape), np.empty(shape), np.empty(shape)
    start = (1e-3, 1e-6, *kernel.ELIMINATE_START[2:])
    outward, inward = kernel.motion_sweep, kernel.residual_sweep
    eliminate, substitute = kernel.eliminate_sweep, kernel.substitute_sweep

    @njit
    def motions(q, u, w, tension, segments, disks, chain):
        for _ in range(CALLS):
            outward(q, u, w, tension, segments, disks, chain)

    @njit
    def residuals(disks, chain, residual):
        for _ in range(CALLS):
            inward(disks, chain, residual)

    @njit
    def eliminations(start, segments, disks, chain, residual, descent):
        for _ in range(CALLS):
            eliminate(start, segments, disks, chain, residual, descent, descent)

    @njit
    def substitutions(chain, descent, change):
        for _ in range(CALLS):
            substitute(chain, descent, change)

    return {
        "motion": lambda: motions(q, u, w, tension, segments, disks, chain),
        "residual": lambda: residuals(disks, chain, residual),
        "eliminate": lambda: eliminations(start, segments, disks, chain, residual, descent),
        "substitute": lambda: substitutions(chain, descent, change),
    }


def main() -> None:
    """Print the table with and without extension, and check the ratio."""
    scenario = load_scenario(SCENARIO)
    for extension in (True, False):
        motion = Motion(cut(scenario, SEGMENTS, extension))
        motion.warm_up(Solver("chain"))
        counted = operations(motion.dynamics.implicit[0])
        ladder = max(count for name, count in counted.items() if name.startswith("sigma_ladder"))
        print(f"{'with' if extension else 'without'} extension, per segment")
        whole, all_operations = 0.0, 0
        for name, work in sweeps_of(motion).items():
            spent = nanoseconds(work) / CALLS / SEGMENTS
            done = sum(counted[step] for step in SWEEPS[name]) + (ladder if name == "motion" else 0)
            whole, all_operations = whole + spent, all_operations + done
            print(f"  {name:11s} {spent:5.1f} ns  {done:4d} operations")
        x = np.ones(8)
        count = all_operations * SEGMENTS * CALLS // 16
        loop = nanoseconds(lambda x=x, count=count: multiply_adds(count, x)) / CALLS / SEGMENTS
        print(f"  one iteration {whole:.1f} ns, {all_operations} operations")
        print(
            f"  as many multiply-adds in a loop: {loop:.1f} ns; {whole / loop:.1f} times (at most {AT_MOST})"
        )
        assert whole < AT_MOST * loop


if __name__ == "__main__":
    main()
