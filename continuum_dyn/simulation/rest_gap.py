"""Distance of a motion's end from the equilibria that it may settle to."""

from collections.abc import Sequence
from itertools import pairwise
from math import hypot

TipPose = tuple[float, float, float]
"""x, y (m) and theta (rad)."""


def tip_gap(tip: TipPose, rests: Sequence[TipPose]) -> float:
    """Distance (m) of the tip from a pose at rest, or from the lines that join several.

    With friction an arm may rest anywhere between the two branches of its equilibria.
    """
    lines = pairwise(rests) if len(rests) > 1 else [(rests[0], rests[0])]
    return min(_from_line(tip, start, end) for start, end in lines)


def _from_line(tip: TipPose, start: TipPose, end: TipPose) -> float:
    along_x, along_y = end[0] - start[0], end[1] - start[1]
    away_x, away_y = tip[0] - start[0], tip[1] - start[1]
    squared = along_x**2 + along_y**2
    part = 0.0 if squared == 0.0 else min(1.0, max(0.0, (away_x * along_x + away_y * along_y) / squared))
    return hypot(away_x - part * along_x, away_y - part * along_y)


def has_settled(gap: float, speed: float, within: float) -> bool:
    """Whether the tip is within that distance (m) of its equilibrium, and slower than that per second."""
    return gap < within and speed < within
