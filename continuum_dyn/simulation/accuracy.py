"""Search for the tolerance at which a motion is as accurate as requested, in metres.

The search is by trial: each run is compared with one at a tenth of its tolerance, and their largest tip
distance over the samples is the estimate of the looser one's error. It is an estimate of the integration's
error; the error of the mesh is not in it.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.trajectory import Trajectory

LOOSEST, TIGHTEST = 1e-2, 1e-13
"""Bounds of the relative tolerance."""
AIM = 0.3
"""Error that the search aims at, over the requested accuracy."""
ENOUGH = (1 / 15, 0.6)
"""Smallest and largest estimate that ends the search, over the requested accuracy."""
MOST_TRIALS = 8
SLOPE = 0.85
"""Power of the tolerance that the error is about proportional to."""


@dataclass(frozen=True)
class Accurate:
    """A motion with the settings that were found for it and the estimate (m) of its largest tip error.

    ``reached`` is False if no tolerance was tight enough; ``trials`` holds the tolerances tried and their
    estimates.
    """

    trajectory: Trajectory
    solver: Solver
    estimate: float
    reached: bool
    trials: tuple[tuple[float, float], ...] = ()

    @property
    def rank(self) -> tuple[bool, float]:
        """Larger for the better one: loosest of those that reached the accuracy, else closest to it."""
        return self.reached, self.solver.rtol if self.reached else -self.estimate


def tip_distance(first: Trajectory, second: Trajectory) -> float:
    """Largest distance (m) of the tips over the samples that both have."""
    count = min(first.time.size, second.time.size)
    x, y = (
        getattr(first, name)[:count, -1] - getattr(second, name)[:count, -1] for name in ("disk_x", "disk_y")
    )
    return float(np.hypot(x, y).max())


def search_tolerance(
    run: Callable[[Solver], Trajectory | None], solver: Solver, tip: float, length: float
) -> Accurate | None:
    """The loosest motion found whose tip error is estimated below ``tip`` (m), in an arm of that length (m).

    ``run`` integrates with the given settings, and returns None if it was stopped. Then the search returns
    the best motion so far as not reached, or None if no pair of runs was complete.
    """
    rtol = float(np.clip(tip / length / 10.0, TIGHTEST, LOOSEST))
    tried: dict[float, Trajectory] = {}
    trials: list[tuple[float, float]] = []
    best: Accurate | None = None
    while True:
        for tolerance in (rtol, 0.1 * rtol):
            if tolerance not in tried:
                trajectory = run(solver.with_rtol(tolerance))
                if trajectory is None:
                    return best and replace(best, reached=False, trials=tuple(trials))
                tried[tolerance] = trajectory
        estimate = tip_distance(tried[rtol], tried[0.1 * rtol])
        trials.append((rtol, estimate))
        found = Accurate(tried[rtol], solver.with_rtol(rtol), estimate, estimate <= ENOUGH[1] * tip)
        best = found if best is None else max(best, found, key=lambda each: each.rank)
        further = rtol * (AIM * tip / max(estimate, 1e-3 * tip)) ** (1.0 / SLOPE)
        further = float(np.clip(further, TIGHTEST, LOOSEST))
        is_enough = found.reached and estimate >= ENOUGH[0] * tip
        if is_enough or further == rtol or len(trials) == MOST_TRIALS:
            return replace(best, trials=tuple(trials))
        rtol = further
