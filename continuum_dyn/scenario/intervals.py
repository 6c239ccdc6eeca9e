"""Intervals of time between the corners of profiles, within which every input is one piece."""

import dataclasses
from bisect import bisect_right
from collections.abc import Sequence
from itertools import pairwise
from typing import overload

import numpy as np

from continuum_dyn.scenario.profiles import Piecewise
from continuum_dyn.scenario.rates import piece_array

BLOCK = 1 << 16
"""Number of intervals that are compared at a time."""
ROUNDING = 1e-12
"""Largest gap between two pieces where they meet that counts as none, in parts of their values."""


@dataclasses.dataclass(frozen=True)
class Interval:
    """The time from ``start`` to ``end`` (s) without corners; each profile's piece, shape (profiles, 6)."""

    start: float
    end: float
    pieces: np.ndarray

    def inputs(self, time: np.ndarray) -> np.ndarray:
        """Values at the given times of this interval, shape (times, profiles); N for tensions."""
        start, value, slope, amplitude, frequency, phase = self.pieces.T
        since = np.asarray(time)[:, None] - start
        return value + slope * since + amplitude * np.sin(frequency * since + phase)


class Intervals(Sequence[Interval]):
    """Consecutive intervals between ``edges`` (s), each made when it is used: there may be a million.

    ``pieces`` are each profile's, shape (its pieces, 6); ``active`` their numbers in each interval, shape
    (profiles, intervals).
    """

    def __init__(self, edges: np.ndarray, pieces: Sequence[np.ndarray], active: np.ndarray) -> None:
        self.edges, self.pieces, self.active = edges, pieces, active

    def __len__(self) -> int:
        return len(self.edges) - 1

    @overload
    def __getitem__(self, index: int) -> Interval: ...
    @overload
    def __getitem__(self, index: slice) -> "Intervals": ...
    def __getitem__(self, index: int | slice) -> "Interval | Intervals":
        if isinstance(index, slice):
            first, last, _ = index.indices(len(self))
            return Intervals(self.edges[first : last + 1], self.pieces, self.active[:, first:last])
        number = range(len(self))[index]
        rows = [pieces[row] for pieces, row in zip(self.pieces, self.active[:, number], strict=True)]
        start, end = (float(edge) for edge in self.edges[number : number + 2])
        return Interval(start, end, np.array(rows).reshape(len(self.pieces), 6))

    @classmethod
    def of(cls, interval: Interval) -> "Intervals":
        """A single interval."""
        active = np.zeros((len(interval.pieces), 1), dtype=int)
        return cls(np.array([interval.start, interval.end]), list(interval.pieces[:, None]), active)

    def after(self, time: float) -> "Intervals":
        """The intervals after a time (s), the first of them cut there."""
        left = self[int(np.searchsorted(self.edges[1:], time, side="right")) :]
        if not left:
            return left
        start = max(float(left.edges[0]), time)
        return Intervals(np.concatenate([[start], left.edges[1:]]), left.pieces, left.active)

    def breaks(self) -> np.ndarray:
        """Numbers of the intervals at whose start an input jumps, or a wave sets in."""
        numbers = np.arange(1, len(self))
        blocks = np.split(numbers, range(BLOCK, len(numbers), BLOCK))
        return np.concatenate([block[self._breaks_at(block)] for block in blocks])

    def _breaks_at(self, numbers: np.ndarray) -> np.ndarray:
        found = np.zeros(len(numbers), dtype=bool)
        time = self.edges[numbers]
        for pieces, active in zip(self.pieces, self.active, strict=True):
            before, after = pieces[active[numbers - 1]], pieces[active[numbers]]
            last, first = _values(before, time), _values(after, time)
            near = np.abs(first - last) <= ROUNDING * (np.abs(last) + np.abs(first))
            found |= ~near | ((before != after).any(axis=1) & (after[:, 3] != 0.0))
        return found


def _values(pieces: np.ndarray, time: np.ndarray) -> np.ndarray:
    """Value of each piece at its time."""
    start, value, slope, amplitude, frequency, phase = pieces.T
    since = time - start
    return value + slope * since + amplitude * np.sin(frequency * since + phase)


def cut_into_intervals(profiles: Sequence[Piecewise], duration: float) -> Intervals:
    """Cut the time from 0 to ``duration`` (s) at every corner of any profile."""
    pieces = [piece_array(profile) for profile in profiles]
    starts = [rows[:, 0] for rows in pieces]
    corners = np.unique(np.concatenate([np.empty(0), *starts]))
    edges = np.concatenate([[0.0], corners[(corners > 0.0) & (corners < duration)], [duration]])
    active = [np.maximum(np.searchsorted(begin, edges[:-1], side="right") - 1, 0) for begin in starts]
    return Intervals(edges, pieces, np.array(active, dtype=int).reshape(len(profiles), len(edges) - 1))


def intervals_after(intervals: Intervals, time: float) -> Intervals:
    """The intervals after a time (s), the first of them cut there."""
    return intervals.after(time)


def join_intervals(intervals: Intervals) -> list[Intervals]:
    """Group consecutive intervals between which no input jumps and no wave sets in."""
    edges = [0, *intervals.breaks().tolist(), len(intervals)]
    return [intervals[first:last] for first, last in pairwise(edges)]


def inputs_at(intervals: Sequence[Interval], time: np.ndarray) -> np.ndarray:
    """Inputs at increasing times within consecutive intervals, shape (times, profiles).

    Where two intervals meet the later one counts.
    """
    if not time.size:
        return intervals[0].inputs(time)
    ends = (time[0], time[-1])
    first, last = (bisect_right(intervals, float(t), key=lambda interval: interval.start) for t in ends)
    known = intervals[max(first - 1, 0) : max(last, 1)]
    edges = np.searchsorted(time, [interval.start for interval in known[1:]])
    parts = np.split(time, edges)
    return np.concatenate([interval.inputs(part) for interval, part in zip(known, parts, strict=True)])
