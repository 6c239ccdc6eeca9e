"""Where a signal turns back, and the monotonic ways between."""

from itertools import pairwise

import numpy as np

SAME = 1e-9
"""Part of a signal's range within which it stays where it is."""


def turnings(values: np.ndarray, least: float) -> np.ndarray:
    """Numbers of the samples from which a signal turns back by more than ``least``, in its own unit."""
    found: list[int] = []
    way, best = 0, 0
    for sample in _extremes(values):
        if way * (values[sample] - values[best]) > 0.0:
            best = sample
        elif abs(values[sample] - values[best]) > least:
            if way:
                found.append(best)
            way, best = int(np.sign(values[sample] - values[best])), sample
    return np.array(found, dtype=int)


def _extremes(values: np.ndarray) -> list[int]:
    """Samples that no neighbour on either side goes beyond in the same direction, and the last one."""
    moves = np.flatnonzero(np.diff(values))
    turns = np.sign(np.diff(values))[moves]
    return [*(moves[:-1][turns[1:] != turns[:-1]] + 1).tolist(), len(values) - 1]


def monotonic_ways(values: np.ndarray, least: float) -> list[slice]:
    """The stretches from one turning to the next, without those where the signal stays as it is.

    Each goes through more than ``least``; both of its ends are in it.
    """
    edges = [0, *turnings(values, least).tolist(), len(values) - 1]
    ways = [_moving(values, start, end) for start, end in pairwise(edges)]
    return [way for way in ways if abs(values[way.stop - 1] - values[way.start]) > least]


def _moving(values: np.ndarray, start: int, end: int) -> slice:
    """From where it leaves its first value to where it comes to its last one."""
    part = values[start : end + 1]
    near = SAME * np.ptp(part)
    leaves = np.flatnonzero(np.abs(part - part[0]) > near)
    comes = np.flatnonzero(np.abs(part - part[-1]) > near)
    if not leaves.size:
        return slice(start, start + 1)
    return slice(start + int(leaves[0]) - 1, start + int(comes[-1]) + 2)
