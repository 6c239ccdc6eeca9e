"""The loop between the way there and the way back of what is driven to and fro."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np


class Loop(NamedTuple):
    """Two ways over the same part of a drive, at the same values ``drive`` of it, ascending.

    ``there`` and ``back`` are their rows, in the order of time; ``rises`` says whether the drive grows on the
    way there.
    """

    drive: np.ndarray
    there: slice
    back: slice
    rises: bool


def widest_loop(drive: np.ndarray, ways: list[slice]) -> Loop | None:
    """The one of two successive monotonic ways that share most of the drive's range; the later of equals."""
    loops = [_loop(drive, *pair) for pair in pairwise(ways)]
    shared = [loop for loop in loops if loop.drive.size > 1]
    return max(reversed(shared), key=lambda loop: np.ptp(loop.drive), default=None)


def _loop(drive: np.ndarray, there: slice, back: slice) -> Loop:
    parts = [np.sort(drive[way]) for way in (there, back)]
    least, most = max(part[0] for part in parts), min(part[-1] for part in parts)
    values = np.unique(np.concatenate([*parts, [least, most]]))
    shared = values[(values >= least) & (values <= most)]
    return Loop(shared, there, back, bool(drive[there.stop - 1] > drive[there.start]))


def on_both_ways(loop: Loop, drive: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A column, shape (rows,), at the loop's values of the drive: on the way there, and on the way back."""
    return _on(loop.there, loop, drive, column), _on(loop.back, loop, drive, column)


def _on(way: slice, loop: Loop, drive: np.ndarray, column: np.ndarray) -> np.ndarray:
    at, values = drive[way], column[way]
    if at[-1] < at[0]:
        at, values = at[::-1], values[::-1]
    return np.interp(loop.drive, np.maximum.accumulate(at), values)


def work_around(loop: Loop, drive: np.ndarray, force: np.ndarray, displacement: np.ndarray) -> float:
    """Work (J) of a force (N) along its displacement (m) once around the loop, closed at both ends.

    Both have shape (rows,). Positive where more is put in than comes back.
    """
    around = [_around(loop, *on_both_ways(loop, drive, column)) for column in (force, displacement)]
    pulls, draws = around
    return float(np.sum(0.5 * (pulls[1:] + pulls[:-1]) * np.diff(draws)))


def _around(loop: Loop, there: np.ndarray, back: np.ndarray) -> np.ndarray:
    """The two ways in the order of time, and back to the start."""
    path = [there, back[::-1]] if loop.rises else [there[::-1], back]
    closed = np.concatenate(path)
    return np.append(closed, closed[0])


def widest_gap(loop: Loop, drive: np.ndarray, places: np.ndarray) -> float:
    """Largest distance (m) of places, shape (rows, 2), there and back at the same value of the drive."""
    apart = [np.subtract(*on_both_ways(loop, drive, column)) for column in places.T]
    return float(np.hypot(*apart).max())
