"""Whether a motion has come to rest where the statics say that it must."""

from math import hypot


def tip_gap(tip: tuple[float, float, float], rest: tuple[float, float, float]) -> float:
    """Distance (m) between two tip poses (x, y, theta)."""
    return hypot(tip[0] - rest[0], tip[1] - rest[1])


def settled(gap: float, speed: float, within: float) -> bool:
    """Whether the tip is within that distance (m) of its equilibrium, and slower than that per second."""
    return gap < within and speed < within
