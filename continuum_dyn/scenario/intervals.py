"""Intervals of time between the corners of profiles, within which every input is one piece."""

import dataclasses
from bisect import bisect_right
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from continuum_dyn.scenario.profiles import InPieces

SAME = 1e-12
"""Part of a value by which rounding may part the two pieces that meet in it."""


@dataclasses.dataclass(frozen=True)
class Span:
    """A stretch of time without corners, and each profile's piece over it, shape (profiles, 6)."""

    start: float
    end: float
    pieces: np.ndarray

    def inputs(self, time: np.ndarray) -> np.ndarray:
        """Values at the given times of this span, shape (times, profiles); N for tensions."""
        start, value, slope, amplitude, frequency, phase = self.pieces.T
        since = np.asarray(time)[:, None] - start
        return value + slope * since + amplitude * np.sin(frequency * since + phase)


def spans(profiles: Sequence[InPieces], duration: float) -> list[Span]:
    """The time from 0 to ``duration`` cut at every corner of any profile."""
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
        result.append(Span(start, end, np.array(active).reshape(len(profiles), 6)))
    return result


def spans_from(stretches: Sequence[Span], time: float) -> list[Span]:
    """What of the spans comes after a time (s)."""
    left = [span for span in stretches if span.end > time]
    return [dataclasses.replace(span, start=max(span.start, time)) for span in left]


def joined_spans(stretches: Sequence[Span]) -> list[list[Span]]:
    """The spans in groups within which no input jumps and no wave sets in."""
    groups = [[stretches[0]]]
    for before, span in pairwise(stretches):
        if _goes_on(before, span):
            groups[-1].append(span)
        else:
            groups.append([span])
    return groups


def _goes_on(before: Span, span: Span) -> bool:
    """Whether all inputs go on where one span ends and the next begins."""
    first, last = (stretch.inputs(np.array([span.start]))[0] for stretch in (before, span))
    sets_in = (span.pieces[:, 3] != 0.0) & (span.pieces != before.pieces).any(axis=1)
    return not sets_in.any() and bool(np.all(np.abs(last - first) <= SAME * (np.abs(first) + np.abs(last))))


def inputs_of(joined: Sequence[Span], time: np.ndarray) -> np.ndarray:
    """Values at increasing times within consecutive spans, shape (times, profiles); later spans count."""
    if not time.size:
        return joined[0].inputs(time)
    first, last = (bisect_right(joined, float(t), key=lambda span: span.start) for t in (time[0], time[-1]))
    known = joined[max(first - 1, 0) : max(last, 1)]
    edges = np.searchsorted(time, [span.start for span in known[1:]])
    parts = np.split(time, edges)
    return np.concatenate([span.inputs(part) for span, part in zip(known, parts, strict=True)])
