"""A motion as accurate as asked, in metres, and checked.

The tolerance is found by trial: each run is held against one at a tenth of its tolerance, and their largest
tip distance over the samples is the estimate of the looser one's error. It is an estimate of the
integration's error; the error of the mesh is not in it.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.trajectory import Trajectory

LOOSEST, TIGHTEST = 1e-2, 1e-13
"""Relative tolerances between which is searched."""
AIM = 0.3
"""Part of what is asked that the search aims at."""
ENOUGH = (1 / 15, 0.6)
"""Parts of what is asked between which an estimate is taken."""
MOST_TRIALS = 8
SLOPE = 0.85
"""Error goes with about this power of the tolerance."""


@dataclass(frozen=True)
class Accurate:
    """A motion with the settings that were found for it and the estimate (m) of its largest tip error.

    ``reached`` is False where no tolerance was tight enough; ``trials`` holds the tolerances tried and
    their estimates.
    """

    trajectory: Trajectory
    solver: Solver
    estimate: float
    reached: bool
    trials: tuple[tuple[float, float], ...]


def tip_distance(first: Trajectory, second: Trajectory) -> float:
    """Largest distance (m) of the tips over the samples that both have."""
    count = min(first.time.size, second.time.size)
    x, y = (
        getattr(first, name)[:count, -1] - getattr(second, name)[:count, -1] for name in ("disk_x", "disk_y")
    )
    return float(np.hypot(x, y).max())


def to_accuracy(
    run: Callable[[Solver], Trajectory | None], solver: Solver, tip: float, scale: float
) -> Accurate | None:
    """The loosest motion found whose tip error is estimated below ``tip`` (m); ``scale`` is the arm's length.

    ``run`` integrates with the given settings, and returns None where it was stopped; then so does this,
    unless some pair of runs was done by then: the best of them is returned as not reached.
    """
    rtol = float(np.clip(tip / scale / 10.0, TIGHTEST, LOOSEST))
    tried: dict[float, Trajectory] = {}
    trials: list[tuple[float, float]] = []
    best: Accurate | None = None
    for _ in range(MOST_TRIALS):
        for tolerance in (rtol, 0.1 * rtol):
            if tolerance not in tried:
                trajectory = run(replace(solver, rtol=tolerance, atol=1e-3 * tolerance))
                if trajectory is None:
                    return best and replace(best, reached=False, trials=tuple(trials))
                tried[tolerance] = trajectory
        estimate = tip_distance(tried[rtol], tried[0.1 * rtol])
        trials.append((rtol, estimate))
        reached = estimate <= ENOUGH[1] * tip
        if best is None or (reached, rtol if reached else -estimate) > (best.reached, _rank(best)):
            settings = replace(solver, rtol=rtol, atol=1e-3 * rtol)
            best = Accurate(tried[rtol], settings, estimate, reached, ())
        further = rtol * (AIM * tip / max(estimate, 1e-3 * tip)) ** (1.0 / SLOPE)
        further = float(np.clip(further, TIGHTEST, LOOSEST))
        if (reached and estimate >= ENOUGH[0] * tip) or further == rtol:
            break
        rtol = further
    assert best is not None
    return replace(best, trials=tuple(trials))


def _rank(best: Accurate) -> float:
    return best.solver.rtol if best.reached else -best.estimate
