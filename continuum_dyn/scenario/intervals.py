"""Intervals of time between the corners of profiles, within which every input is one piece."""

import dataclasses
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import overload

import numpy as np

from continuum_dyn.scenario.profiles import Piece, Piecewise
from continuum_dyn.scenario.rates import pieces_from

BLOCK = 1 << 16
"""Largest number of a profile's pieces that are at hand at a time."""
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

    def breaks(self) -> np.ndarray:
        """Numbers of the intervals at whose start an input jumps, or a wave sets in."""
        numbers = np.arange(1, len(self))
        return numbers[self._breaks_at(numbers)]

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


@dataclasses.dataclass(frozen=True)
class _Fixed:
    """The profile of a single piece."""

    piece: np.ndarray

    @property
    def initial(self) -> float:
        """Value at the start of the piece."""
        return float(_values(self.piece[None], self.piece[:1])[0])

    def pieces(self) -> list[Piece]:
        """The piece."""
        return [tuple(self.piece.tolist())]


@dataclasses.dataclass(frozen=True)
class Timeline(Iterable[Interval]):
    """The intervals from ``start`` to ``end`` (s), made in blocks: a table may have a million."""

    profiles: tuple[Piecewise, ...]
    start: float
    end: float

    def __iter__(self) -> Iterator[Interval]:
        for block in self.blocks():
            yield from block

    @classmethod
    def of(cls, interval: Interval) -> "Timeline":
        """The timeline of one interval."""
        return cls(tuple(map(_Fixed, interval.pieces)), interval.start, interval.end)

    @property
    def first(self) -> Interval:
        """The first interval."""
        return next(self.blocks())[0]

    @property
    def last(self) -> Interval:
        """Rest of the last interval just before the end."""
        return self.after(float(np.nextafter(self.end, self.start))).first

    def after(self, time: float) -> "Timeline":
        """The intervals after a time (s), the first of them cut there."""
        return dataclasses.replace(self, start=max(self.start, time))

    def inputs(self, time: np.ndarray) -> np.ndarray:
        """Inputs at increasing times, shape (times, profiles); where two intervals meet, the later's."""
        parts, done = [], 0
        for block in self.blocks():
            end = float(block.edges[-1])
            until = int(np.searchsorted(time, end, side="right" if end == self.end else "left"))
            parts.append(inputs_at(block, time[done:until]))
            done = until
            if done == time.size:
                break
        return np.concatenate(parts)

    def blocks(self) -> Iterator[Intervals]:
        """Consecutive intervals, together with at most ``BLOCK`` pieces of each profile."""
        start = self.start
        while start < self.end:
            block = self._block(start)
            yield block
            start = float(block.edges[-1])

    def _block(self, start: float) -> Intervals:
        pieces = [pieces_from(profile, start, BLOCK + 1) for profile in self.profiles]
        starts = [rows[:, 0] for rows in pieces]
        known = min((begin[-1] for begin in starts if len(begin) > BLOCK), default=self.end)
        end = min(self.end, max(known, float(np.nextafter(start, self.end))))
        corners = np.unique(np.concatenate([np.empty(0), *starts]))
        edges = np.concatenate([[start], corners[(corners > start) & (corners < end)], [end]])
        active = [np.maximum(np.searchsorted(begin, edges[:-1], side="right") - 1, 0) for begin in starts]
        return Intervals(edges, pieces, np.array(active, dtype=int).reshape(len(pieces), len(edges) - 1))


def cut_into_intervals(profiles: Iterable[Piecewise], duration: float) -> Timeline:
    """Cut the time from 0 to ``duration`` (s) at every corner of any profile."""
    return Timeline(tuple(profiles), 0.0, duration)


def join_intervals(block: Intervals) -> Iterator[Intervals]:
    """Group consecutive intervals between which no input jumps and no wave sets in."""
    edges = [0, *block.breaks().tolist(), len(block)]
    return (block[first:last] for first, last in pairwise(edges))


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
