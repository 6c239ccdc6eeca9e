"""Rise time, overshoot and settling times of a step response.

The signal is the part of its travel that a motion has done: 0 at its start, 1 at its last equilibrium.
Between samples it is the cubic spline through them, so that these times are finer than the samples.
"""

from collections.abc import Callable

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

RISES_FROM, RISES_TO = 0.1, 0.9
"""Levels between which the rise time is taken, in parts of the travel."""


def rise_time(part: CubicSpline, begin: float) -> float | None:
    """Time (s) from first being at 10 % of the travel to first being at 90 %; None if it never is."""
    starts, ends = (_first_at(part, level, begin) for level in (RISES_FROM, RISES_TO))
    return None if starts is None or ends is None else ends - starts


def overshoot(part: CubicSpline, begin: float) -> float:
    """Largest excursion beyond the last equilibrium, over the travel; 0 if there is none."""
    return max(0.0, float(part(_nodes(part, begin)).max()) - 1.0)


def settling_time(part: CubicSpline, band: float, begin: float, stays: float = 0.0) -> float | None:
    """Time (s) from ``begin`` on, after which it stays within that part of the travel from its rest.

    None if it ends outside, or has not been inside for the time ``stays`` (s) when it ends.
    """
    nodes = _nodes(part, begin)
    outside = np.flatnonzero(np.abs(part(nodes) - 1.0) > band)
    if not outside.size:
        return 0.0
    if outside[-1] + 1 == nodes.size:
        return None
    comes = _root_between(lambda t: abs(float(part(t)) - 1.0) - band, nodes, outside[-1])
    return None if nodes[-1] - comes < stays else comes - begin


def _nodes(part: CubicSpline, begin: float) -> np.ndarray:
    """``begin``, the samples after it and the turning points between them, s; monotonic in between."""
    turns = part.derivative().roots(extrapolate=False)
    times = np.concatenate([part.x, turns[np.isfinite(turns)]])
    return np.append(begin, np.unique(times[times > begin]))


def _first_at(part: CubicSpline, level: float, begin: float) -> float | None:
    """Time (s) at which the signal first reaches that level, from ``begin`` on."""
    nodes = _nodes(part, begin)
    there = np.flatnonzero(part(nodes) >= level)
    if not there.size:
        return None
    return begin if there[0] == 0 else _root_between(lambda t: float(part(t)) - level, nodes, there[0] - 1)


def _root_between(function: Callable[[float], float], nodes: np.ndarray, number: int) -> float:
    """The root of a function between that node and the next one."""
    return float(brentq(function, nodes[number], nodes[number + 1]))
