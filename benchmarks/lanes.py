"""What passes gain in lanes: Newton iterations of 4 or 8 arms at a time against one arm at a time.

Throughput at 1024 segments of the paper's arm, of the whole iteration and pass by pass; asserted: the whole.
"""

from iterations import Iteration
from scaling import SCENARIO, cut

from continuum_dyn import load_scenario
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation import Motion

SEGMENTS, CALLS = 1024, 100
LANES = (4, 8)
AT_LEAST = 2.5
"""Least gain of an iteration."""


def main() -> None:
    """Print the gains and check them."""
    scenario = load_scenario(SCENARIO)
    for extension in (True, False):
        motion = Motion(cut(scenario, SEGMENTS, extension))
        motion.warm_up(Solver("chain"))
        alone = Iteration(motion).spent(CALLS)
        print(f"{'with' if extension else 'without'} extension: {sum(alone.values()):.1f} ns a segment alone")
        for lanes in LANES:
            together = Iteration(motion, lanes).spent(CALLS)
            parts = ", ".join(f"{name} {spent / together[name]:.1f}" for name, spent in alone.items())
            gain = sum(alone.values()) / sum(together.values())
            print(f"  {lanes} lanes: {gain:.2f} times as many (at least {AT_LEAST}); {parts}")
            assert gain >= AT_LEAST


if __name__ == "__main__":
    main()
