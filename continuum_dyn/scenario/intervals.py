"""Intervals of time between the corners of profiles, within which every input is one piece."""

import dataclasses
from bisect import bisect_right
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from continuum_dyn.scenario.profiles import Piecewise

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


def cut_into_intervals(profiles: Sequence[Piecewise], duration: float) -> list[Interval]:
    """Cut the time from 0 to ``duration`` (s) at every corner of any profile."""
    pieces = [profile.pieces() for profile in profiles]
    corners = {piece[0] for rows in pieces for piece in rows if 0 < piece[0] < duration}
    edges = [0.0, *sorted(corners), duration]
    starts = [np.array([row[0] for row in rows]) for rows in pieces]
    result = []
    for start, end in pairwise(edges):
        active = [
            rows[max(int(np.searchsorted(begin, start, side="right")) - 1, 0)]
            for rows, begin in zip(pieces, starts, strict=True)
        ]
        result.append(Interval(start, end, np.array(active).reshape(len(profiles), 6)))
    return result


def intervals_after(intervals: Sequence[Interval], time: float) -> list[Interval]:
    """The intervals after a time (s), the first of them cut there."""
    left = [interval for interval in intervals if interval.end > time]
    return [dataclasses.replace(interval, start=max(interval.start, time)) for interval in left]


def join_intervals(intervals: Sequence[Interval]) -> list[list[Interval]]:
    """Group consecutive intervals between which no input jumps and no wave sets in."""
    groups = [[intervals[0]]]
    for before, interval in pairwise(intervals):
        if _continues(before, interval):
            groups[-1].append(interval)
        else:
            groups.append([interval])
    return groups


def _continues(before: Interval, interval: Interval) -> bool:
    """Whether no input jumps, and no wave sets in, from one interval to the next."""
    last, first = (each.inputs(np.array([interval.start]))[0] for each in (before, interval))
    sets_in = (interval.pieces[:, 3] != 0.0) & (interval.pieces != before.pieces).any(axis=1)
    near = np.abs(first - last) <= ROUNDING * (np.abs(last) + np.abs(first))
    return not sets_in.any() and bool(near.all())


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
