"""The hysteresis loop between the two branches of a drive that goes up and down."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np


class Loop(NamedTuple):
    """Two branches over the same range of a drive, at the same values ``drive`` of it, ascending.

    ``there`` and ``back`` are their rows, in the order of time; ``rises`` says whether the drive grows on
    the first branch.
    """

    drive: np.ndarray
    there: slice
    back: slice
    rises: bool


def widest_loop(drive: np.ndarray, branches: list[slice]) -> Loop | None:
    """The loop of two successive branches that covers most of the drive's range; the later of equals."""
    loops = [_loop(drive, *pair) for pair in pairwise(branches)]
    shared = [loop for loop in loops if loop.drive.size > 1]
    return max(reversed(shared), key=lambda loop: np.ptp(loop.drive), default=None)


def _loop(drive: np.ndarray, there: slice, back: slice) -> Loop:
    parts = [np.sort(drive[branch]) for branch in (there, back)]
    least, most = max(part[0] for part in parts), min(part[-1] for part in parts)
    values = np.unique(np.concatenate([*parts, [least, most]]))
    shared = values[(values >= least) & (values <= most)]
    return Loop(shared, there, back, bool(drive[there.stop - 1] > drive[there.start]))


def on_both_branches(loop: Loop, drive: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A column, shape (rows,), at the loop's values of the drive, on its first and second branch."""
    return _on(loop.there, loop, drive, column), _on(loop.back, loop, drive, column)


def _on(branch: slice, loop: Loop, drive: np.ndarray, column: np.ndarray) -> np.ndarray:
    at, values = drive[branch], column[branch]
    if at[-1] < at[0]:
        at, values = at[::-1], values[::-1]
    return np.interp(loop.drive, np.maximum.accumulate(at), values)


def work_around(loop: Loop, drive: np.ndarray, force: np.ndarray, displacement: np.ndarray) -> float:
    """Work (J) of a force (N) along its displacement (m) once around the loop, closed at both ends.

    Both have shape (rows,). Positive if more is put in than comes back.
    """
    around = [_around(loop, *on_both_branches(loop, drive, column)) for column in (force, displacement)]
    pulls, draws = around
    return float(np.sum(0.5 * (pulls[1:] + pulls[:-1]) * np.diff(draws)))


def _around(loop: Loop, there: np.ndarray, back: np.ndarray) -> np.ndarray:
    """The two branches in the order of time, and back to the start."""
    ordered = [there, back[::-1]] if loop.rises else [there[::-1], back]
    closed = np.concatenate(ordered)
    return np.append(closed, closed[0])


def widest_gap(loop: Loop, drive: np.ndarray, path: np.ndarray) -> float:
    """Largest distance (m) of the two branches of a path, shape (rows, 2), at the same value of the drive."""
    apart = [np.subtract(*on_both_branches(loop, drive, column)) for column in path.T]
    return float(np.hypot(*apart).max())
