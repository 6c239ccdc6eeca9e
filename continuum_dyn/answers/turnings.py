"""Turning points of a signal, and the monotonic branches between them."""

from itertools import pairwise

import numpy as np

CONSTANT = 1e-9
"""Largest change of a signal that counts as none, in parts of its range."""


def turnings(values: np.ndarray, least: float) -> np.ndarray:
    """Indices of the samples from which a signal turns back by more than ``least``, in its own unit."""
    found: list[int] = []
    direction, best = 0, 0
    for sample in _extremes(values):
        if direction * (values[sample] - values[best]) > 0.0:
            best = sample
        elif abs(values[sample] - values[best]) > least:
            if direction:
                found.append(best)
            direction, best = int(np.sign(values[sample] - values[best])), sample
    return np.array(found, dtype=int)


def _extremes(values: np.ndarray) -> list[int]:
    """Samples that no neighbour on either side goes beyond in the same direction, and the last one."""
    moves = np.flatnonzero(np.diff(values))
    turns = np.sign(np.diff(values))[moves]
    return [*(moves[:-1][turns[1:] != turns[:-1]] + 1).tolist(), len(values) - 1]


def monotonic_branches(values: np.ndarray, least: float) -> list[slice]:
    """Branches from one turning point to the next, without the parts where the signal is constant.

    Each changes by more than ``least``, and includes both of its ends.
    """
    edges = [0, *turnings(values, least).tolist(), len(values) - 1]
    branches = [_moving(values, start, end) for start, end in pairwise(edges)]
    return [branch for branch in branches if abs(values[branch.stop - 1] - values[branch.start]) > least]


def _moving(values: np.ndarray, start: int, end: int) -> slice:
    """The part of a branch from its first change to its last one."""
    part = values[start : end + 1]
    near = CONSTANT * np.ptp(part)
    leaves = np.flatnonzero(np.abs(part - part[0]) > near)
    comes = np.flatnonzero(np.abs(part - part[-1]) > near)
    if not leaves.size:
        return slice(start, start + 1)
    return slice(start + int(leaves[0]) - 1, start + int(comes[-1]) + 2)
