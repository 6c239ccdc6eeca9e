"""Branches of a ramp's equilibria: stable or not, with the drive rising or falling."""

from collections.abc import Mapping
from itertools import groupby, pairwise
from typing import NamedTuple

import numpy as np


class Branch(NamedTuple):
    """Neighbouring equilibria, from row ``start`` to ``end``: all steady or none, all falling or none."""

    start: int
    end: int
    steady: bool
    falling: bool


def found_stable(points: Mapping[str, np.ndarray]) -> np.ndarray:
    """Rows that are not known to be unstable, booleans: a log may not say which are stable."""
    return points["stable"].astype(bool) if "stable" in points else np.ones(len(points["point"]), dtype=bool)


def directions(values: np.ndarray) -> np.ndarray:
    """Direction in which each value was reached: 1 rising, -1 falling; in a pause, as before it."""
    steps = np.sign(np.diff(values))
    moving = np.flatnonzero(steps)
    if moving.size == 0:
        return np.ones(len(values))
    last = np.maximum.accumulate(np.where(steps != 0.0, np.arange(steps.size), moving[0]))
    return np.concatenate([steps[moving[:1]], steps[last]])


def branches(points: Mapping[str, np.ndarray], drive: np.ndarray) -> list[Branch]:
    """Branches of equilibria along a ramp, with nothing across a jump.

    Unstable ones are not said to fall, as a path turns back by itself there.
    """
    stable, falls = found_stable(points), directions(drive) < 0.0
    kept = stable | (points["critical"] > 0)

    def kind(pair: tuple[int, int]) -> tuple[bool, bool, bool]:
        steady = bool(kept[list(pair)].all() and stable[list(pair)].any())
        return bool(points["jumped"][pair[1]]), steady, steady and bool(falls[pair[1]])

    found = []
    for (jumped, steady, falling), pairs in groupby(pairwise(range(len(drive))), kind):
        rows = [row for pair in pairs for row in pair]
        if not jumped:
            found.append(Branch(rows[0], rows[-1], steady, falling))
    return found


def rows_falling(points: Mapping[str, np.ndarray], drive: np.ndarray) -> np.ndarray:
    """Rows of stable equilibria that a falling drive led to."""
    found = [np.arange(each.start + 1, each.end + 1) for each in branches(points, drive) if each.falling]
    return np.concatenate([np.empty(0, dtype=int), *found])
