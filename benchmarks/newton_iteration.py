"""What one Newton iteration of an implicit stage costs: residual, matrix, solve.

Per segment, at 64 segments of the paper's arm, beside a fixed loop of as many multiply-adds: eight sums that
wait for nothing but themselves. Reported pass by pass; asserted: the whole, as a ratio to that loop.
"""

import ast
import time
from collections.abc import Callable

import numpy as np
from numba import njit
from scaling import SCENARIO, cut

from continuum_dyn import load_scenario
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation import Motion
from statics.kernels.calling import run
from statics.kernels.loading import Kernel
from statics.kernels.slots import DAMPING_WEIGHT, SCALARS, STIFFNESS_WEIGHT

SEGMENTS = 64
CALLS, REPEATS = 4000, 15
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


def operations(kernel: Kernel) -> dict[str, int]:
    """Arithmetic operations of every step of a kernel."""
    return {
        node.name.removesuffix("_step"): sum(isinstance(part, ast.BinOp) for part in ast.walk(node))
        for node in kernel.tree.body
        if isinstance(node, ast.FunctionDef) and node.name.endswith(("_step", "_1", "_2"))
    }


@njit
def motions(address, n, scalars, q, u, w, inputs, segments, disks, chain):
    """Repeat the outward pass."""
    for _ in range(CALLS):
        run(address, n, scalars, q, u, w, inputs, segments, disks, chain)


@njit
def residuals(address, n, scalars, disks, chain, residual):
    """Repeat the residual pass."""
    for _ in range(CALLS):
        run(address, n, scalars, disks, chain, residual)


@njit
def eliminations(address, n, scalars, segments, disks, chain, residual, descent):
    """Repeat the elimination."""
    for _ in range(CALLS):
        run(address, n, scalars, segments, disks, chain, residual, descent, descent)


@njit
def substitutions(address, n, scalars, chain, descent, change):
    """Repeat the substitution."""
    for _ in range(CALLS):
        run(address, n, scalars, chain, descent, change)


def passes_of(motion: Motion) -> dict[str, Callable[[], None]]:
    """The passes of one iteration, each called many times from compiled code."""
    kernel, segments, disks = motion.dynamics.motion
    shape = (SEGMENTS, motion.dynamics.dofs)
    q = motion.start[: motion.dynamics.size].reshape(shape).copy()
    q[:, 0] += 1.0 / SEGMENTS
    u, w = np.full(shape, 0.1), np.zeros(shape)
    chain, tension = np.empty((SEGMENTS, kernel.widths["chain"])), np.array([1.0])
    residual, descent, change = np.empty(shape), np.empty(shape), np.empty(shape)
    scalars, passes = np.zeros(SCALARS), kernel.passes
    scalars[DAMPING_WEIGHT], scalars[STIFFNESS_WEIGHT] = 1e-3, 1e-6
    common = (SEGMENTS, scalars)
    return {
        "motion": lambda: motions(passes.motion, *common, q, u, w, tension, segments, disks, chain),
        "residual": lambda: residuals(passes.residual, *common, disks, chain, residual),
        "eliminate": lambda: eliminations(
            passes.eliminate, *common, segments, disks, chain, residual, descent
        ),
        "substitute": lambda: substitutions(passes.substitute, *common, chain, descent, change),
    }


def main() -> None:
    """Print the table with and without extension, and check the ratio."""
    scenario = load_scenario(SCENARIO)
    for extension in (True, False):
        motion = Motion(cut(scenario, SEGMENTS, extension))
        motion.warm_up(Solver("chain"))
        counted = operations(motion.dynamics.motion[0])
        ladder = max(count for name, count in counted.items() if name.startswith("sigma_ladder"))
        print(f"{'with' if extension else 'without'} extension, per segment")
        whole, all_operations = 0.0, 0
        for name, work in passes_of(motion).items():
            spent = nanoseconds(work) / CALLS / SEGMENTS
            done = counted[name] + (ladder if name == "motion" else 0)
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
