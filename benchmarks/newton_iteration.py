"""What one Newton iteration of an implicit stage costs: residual, matrix, solve.

Per segment, at 64 segments of the paper's arm, beside a fixed loop of as many multiply-adds: eight sums that
wait for nothing but themselves. Reported pass by pass; asserted: the whole, as a ratio to that loop.
"""

import ast

import numpy as np
from iterations import Iteration, nanoseconds
from scaling import SCENARIO, cut

from continuum_dyn import load_scenario
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation import Motion
from statics.kernels.compiled import compiled
from statics.kernels.loading import Kernel

SEGMENTS = 64
CALLS = 4000
AT_MOST = 2.5
"""Times the loop of multiply-adds: what a wait for angles, pivots and memory may cost."""


@compiled
def multiply_adds(count: int, x: np.ndarray) -> None:
    """``count`` times eight multiply-adds."""
    a, b, c, d, e, f, g, h = x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7]
    for _ in range(count):
        a, b, c, d = a * 0.9 + 1.0, b * 0.9 + 1.0, c * 0.9 + 1.0, d * 0.9 + 1.0
        e, f, g, h = e * 0.9 + 1.0, f * 0.9 + 1.0, g * 0.9 + 1.0, h * 0.9 + 1.0
    x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7] = a, b, c, d, e, f, g, h


def operations(kernel: Kernel) -> dict[str, int]:
    """Arithmetic operations of every step of a kernel."""
    return {
        node.name.removesuffix("_step"): sum(isinstance(part, ast.BinOp) for part in ast.walk(node))
        for node in kernel.tree.body
        if isinstance(node, ast.FunctionDef) and node.name.endswith(("_step", "_1", "_2"))
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
        for name, spent in Iteration(motion).spent(CALLS).items():
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
