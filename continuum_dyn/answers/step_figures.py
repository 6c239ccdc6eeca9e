"""What control engineers read off a step response: rise time, overshoot, settling times.

The signal is the part of its travel that a motion has done: 0 where it starts, 1 where it is to rest. Between
samples it is the cubic spline through them, so that these times are finer than the samples.
"""

from collections.abc import Callable

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

RISES_FROM, RISES_TO = 0.1, 0.9
"""Parts of the travel between which the rise time is taken."""


def rise_time(part: CubicSpline, begin: float) -> float | None:
    """Time (s) from first being at 10 % of the travel to first being at 90 %; None if it never is."""
    starts, ends = (_first_at(part, level, begin) for level in (RISES_FROM, RISES_TO))
    return None if starts is None or ends is None else ends - starts


def overshoot(part: CubicSpline, begin: float) -> float:
    """How far it goes beyond its rest at most, over the travel; 0 if it does not."""
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
    comes = _between(lambda t: abs(float(part(t)) - 1.0) - band, nodes, outside[-1])
    return None if nodes[-1] - comes < stays else comes - begin


def _nodes(part: CubicSpline, begin: float) -> np.ndarray:
    """``begin``, the samples after it and the turning points between them, s; monotonic in between."""
    turns = part.derivative().roots(extrapolate=False)
    times = np.concatenate([part.x, turns[np.isfinite(turns)]])
    return np.append(begin, np.unique(times[times > begin]))


def _first_at(part: CubicSpline, level: float, begin: float) -> float | None:
    """Time (s) at which it first comes to that level, from ``begin`` on."""
    nodes = _nodes(part, begin)
    there = np.flatnonzero(part(nodes) >= level)
    if not there.size:
        return None
    return begin if there[0] == 0 else _between(lambda t: float(part(t)) - level, nodes, there[0] - 1)


def _between(function: Callable[[float], float], nodes: np.ndarray, number: int) -> float:
    """Where it is zero between that node and the next one."""
    return float(brentq(function, nodes[number], nodes[number + 1]))
