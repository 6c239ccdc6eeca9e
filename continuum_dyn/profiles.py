"""A tension or a load over time, as data: pieces between corners, evaluated in compiled code.

A piece is a row (start, value, slope, amplitude, angular frequency) and means
value + slope (t - start) + amplitude sin(angular frequency t) from its start to the next one's. At a jump
the later piece counts.
"""

import dataclasses
from itertools import pairwise
from math import pi
from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass

from statics.checked import STRICT, NonNegative, Positive
from statics.errors import InputError

TIME_RESOLUTION = 1e-300
"""Rows of a table closer than this (s) would have slopes beyond floating point."""

Piece = tuple[float, float, float, float, float]
"""Start (s), value, slope (1/s), amplitude, angular frequency (rad/s); values in N for a tension."""


@dataclass(frozen=True, config=STRICT)
class Constant:
    """``value`` at all times."""

    value: float
    profile: Literal["constant"] = "constant"

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        return self.value

    def pieces(self) -> list[Piece]:
        """One piece."""
        return [(0.0, self.value, 0.0, 0.0, 0.0)]


@dataclass(frozen=True, config=STRICT)
class Step:
    """``before`` until the time ``at``, ``after`` from then on.

    With ``at`` = 0 the arm starts from the equilibrium of ``before``.
    """

    before: float
    after: float
    at: NonNegative = 0.0
    profile: Literal["step"] = "step"

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        return self.before

    def pieces(self) -> list[Piece]:
        """Two pieces, or one if the step is at time zero."""
        after = (self.at, self.after, 0.0, 0.0, 0.0)
        return [(0.0, self.before, 0.0, 0.0, 0.0), after] if self.at > 0 else [after]


@dataclass(frozen=True, config=STRICT)
class Ramp:
    """``before`` until ``start``, ``after`` from ``end`` on, linear between."""

    before: float
    after: float
    start: NonNegative
    end: Positive
    profile: Literal["ramp"] = "ramp"

    def __post_init__(self) -> None:
        if self.end <= self.start:
            raise InputError(
                f"a ramp must end after it starts; start is {self.start:g} s, end {self.end:g} s"
            )

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        return self.before

    def pieces(self) -> list[Piece]:
        """Three pieces, or two if the ramp starts at time zero."""
        slope = (self.after - self.before) / (self.end - self.start)
        rising = [(self.start, self.before, slope, 0.0, 0.0), (self.end, self.after, 0.0, 0.0, 0.0)]
        return [(0.0, self.before, 0.0, 0.0, 0.0), *rising] if self.start > 0 else rising


@dataclass(frozen=True, config=STRICT)
class Sine:
    """``mean`` + ``amplitude`` sin(2 pi ``frequency`` t)."""

    mean: float
    amplitude: float
    frequency: Positive
    profile: Literal["sine"] = "sine"

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        return self.mean

    def pieces(self) -> list[Piece]:
        """One piece."""
        return [(0.0, self.mean, 0.0, self.amplitude, 2 * pi * self.frequency)]


@dataclass(frozen=True, config=STRICT)
class Table:
    """Linear between given times (s) and values; before the first and after the last they hold."""

    time: Annotated[tuple[float, ...], Field(strict=False, min_length=1)]
    value: Annotated[tuple[float, ...], Field(strict=False, min_length=1)]
    profile: Literal["table"] = "table"

    def __post_init__(self) -> None:
        if len(self.time) != len(self.value):
            raise InputError(f"{len(self.time)} times, but {len(self.value)} values")
        for row, (earlier, later) in enumerate(pairwise(self.time), start=2):
            if later <= earlier:
                raise InputError(
                    f"row {row}: time {later:g} s does not come after {earlier:g} s; times must increase"
                )
            if later - earlier < TIME_RESOLUTION:
                raise InputError(
                    f"row {row}: {later - earlier:g} s after the row before; at least {TIME_RESOLUTION:g} s"
                )

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        return float(np.interp(0.0, self.time, self.value))

    def pieces(self) -> list[Piece]:
        """One piece before the first row, one from each row to the next, one after the last."""
        rows = list(zip(self.time, self.value, strict=True))
        between = [
            (t, value, (later[1] - value) / (later[0] - t), 0.0, 0.0) for (t, value), later in pairwise(rows)
        ]
        first, last = (min(0.0, self.time[0]), self.value[0]), rows[-1]
        return [(*first, 0.0, 0.0, 0.0), *between, (*last, 0.0, 0.0, 0.0)]


def lowest(profile: "Profile") -> float:
    """The least value that a profile takes, or comes near to."""
    if isinstance(profile, Sine):
        return profile.mean - abs(profile.amplitude)
    if isinstance(profile, Table):
        return min(profile.value)
    return min(profile.initial, *(piece[1] for piece in profile.pieces()))


Profile = Constant | Step | Ramp | Sine | Table
PROFILES: dict[str, type[Profile]] = {
    "constant": Constant,
    "step": Step,
    "ramp": Ramp,
    "sine": Sine,
    "table": Table,
}


@dataclasses.dataclass(frozen=True)
class Span:
    """A stretch of time without corners, and each profile's piece over it, shape (profiles, 5)."""

    start: float
    end: float
    pieces: np.ndarray

    def inputs(self, time: np.ndarray) -> np.ndarray:
        """Values at the given times of this span, shape (times, profiles); N for tensions."""
        start, value, slope, amplitude, frequency = self.pieces.T
        t = np.asarray(time)[:, None]
        return value + slope * (t - start) + amplitude * np.sin(frequency * t)


def spans(profiles: tuple[Profile, ...], duration: float) -> list[Span]:
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
        result.append(Span(start, end, np.array(active).reshape(len(profiles), 5)))
    return result
