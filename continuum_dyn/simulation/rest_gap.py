"""The place where a motion's tip should rest, and its distance from there."""

from collections.abc import Sequence
from itertools import pairwise
from math import hypot

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
