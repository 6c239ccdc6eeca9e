"""Rest position of a motion's tip, and the distance of its last sample from there."""

from collections.abc import Sequence
from itertools import pairwise
from math import hypot, log

import numpy as np

TipPose = tuple[float, float, float]
"""x, y (m) and theta (rad)."""
Place = tuple[float, float]
"""x, y (m)."""


def place_of_rest(tip: TipPose, rests: Sequence[TipPose]) -> Place:
    """The place of a pose at rest, or the one next to the tip on the lines that join several.

    With friction an arm may rest anywhere between the two branches of its equilibria.
    """
    lines = pairwise(rests) if len(rests) > 1 else [(rests[0], rests[0])]
    return min((_on_line(tip, start, end) for start, end in lines), key=lambda place: _distance(tip, place))


def tip_gap(tip: TipPose, rests: Sequence[TipPose]) -> float:
    """Distance (m) of the tip from its place of rest."""
    return _distance(tip, place_of_rest(tip, rests))


def _distance(tip: TipPose, place: Place) -> float:
    return hypot(tip[0] - place[0], tip[1] - place[1])


def _on_line(tip: TipPose, start: TipPose, end: TipPose) -> Place:
    along_x, along_y = end[0] - start[0], end[1] - start[1]
    away_x, away_y = tip[0] - start[0], tip[1] - start[1]
    squared = along_x**2 + along_y**2
    part = 0.0 if squared == 0.0 else min(1.0, max(0.0, (away_x * along_x + away_y * along_y) / squared))
    return start[0] + part * along_x, start[1] + part * along_y


def has_settled(gap: float, speed: float, within: float) -> bool:
    """Whether the tip is within that distance (m) of its equilibrium, and slower than that per second."""
    return gap < within and speed < within


def unsettled_message(
    time: np.ndarray, gaps: np.ndarray, speeds: np.ndarray, within: float, slip_speed: float
) -> str:
    """Message about a tip that has not settled: by how much, and when it would at the decay so far.

    ``gaps`` (m) are its distances from the final equilibrium at the times (s), ``speeds`` (m/s) its speeds;
    ``slip_speed`` (m/s) is the least of the cables that rub, infinite without such.
    """
    limit, gap, speed = 1e3 * within, 1e3 * gaps[-1], 1e3 * speeds[-1]
    away = f"{gap:.3g} mm from the final equilibrium (limit {limit:.3g} mm)"
    moves = f"moves at {speed:.3g} mm/s (limit {limit:.3g} mm/s)"
    if gap < limit:
        text = f"the tip is {away}, but still {moves}"
    else:
        text = f"the tip is {away}, and {moves}" if speed >= limit else f"the tip {moves}, but is {away}"
    creeps = ""
    if gap < limit and np.isfinite(slip_speed):
        creeps = f"; sticking cables creep, and less with a slip_speed below {slip_speed:g} m/s"
    return f"{text}; {_settles_at(time, np.maximum(gaps, speeds), within)}{creeps}"


def _settles_at(time: np.ndarray, sizes: np.ndarray, within: float) -> str:
    """The time at which what decays from the second third of a motion to the last would be small enough."""
    third = sizes.size // 3
    if third == 0:
        return "increase samples to estimate when it settles"
    before, after = float(sizes[third : 2 * third].max()), float(sizes[-third:].max())
    if not after < 0.9 * before:
        return "the motion does not decay"
    rate = log(before / after) / float(time[-third] - time[third])
    settled = max(time[-1], time[-third] + log(max(after / within, 1.0)) / rate)
    return f"at the decay rate so far it settles after about {settled:.2g} s"
