"""Profiles of the inputs over time, as data: pieces between corners, evaluated in compiled code.

A piece is a row (start, value, slope, amplitude, angular frequency, phase) and means

    value + slope (t - start) + amplitude sin(angular frequency (t - start) + phase)

from its start to the next one's, so its derivative is a piece, too. At a jump the later piece counts.
"""

from math import pi, sin
from typing import Annotated, Literal, Protocol

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass

from statics.errors import InputError
from statics.support.checked import STRICT, NonNegative, Positive

TIME_RESOLUTION = 1e-300
"""Shortest time between rows of a table, s; slopes over less are beyond floating point."""

Value = Annotated[float, Field(description="value at all times, in the unit of the driven quantity")]
Before = Annotated[float, Field(description="value before, in the unit of the driven quantity")]
After = Annotated[float, Field(description="value after, in the unit of the driven quantity")]
Start = Annotated[NonNegative, Field(description="time at which the ramp starts, s")]
End = Annotated[Positive, Field(description="time at which the ramp ends, s")]

Piece = tuple[float, float, float, float, float, float]
"""Start (s), value, slope (1/s), amplitude, angular frequency (rad/s), phase; values in N for a tension."""


def straight(start: float, value: float, slope: float = 0.0) -> Piece:
    """The piece without a wave."""
    return start, value, slope, 0.0, 0.0, 0.0


@dataclass(frozen=True, config=STRICT)
class Constant:
    """``value`` at all times."""

    value: Value
    profile: Literal["constant"] = "constant"

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        return self.value

    def pieces(self) -> list[Piece]:
        """One piece."""
        return [straight(0.0, self.value)]


@dataclass(frozen=True, config=STRICT)
class Step:
    """``before`` until the time ``at``, ``after`` from then on.

    With ``at`` = 0 the arm starts from the equilibrium of ``before``.
    """

    before: Before
    after: After
    at: Annotated[NonNegative, Field(description="time of the step, s")] = 0.0
    profile: Literal["step"] = "step"

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        return self.before

    def pieces(self) -> list[Piece]:
        """Two pieces, or one if the step is at time zero."""
        after = straight(self.at, self.after)
        return [straight(0.0, self.before), after] if self.at > 0 else [after]


@dataclass(frozen=True, config=STRICT)
class Ramp:
    """``before`` until ``start``, ``after`` from ``end`` on, linear between."""

    before: Before
    after: After
    start: Start
    end: End
    profile: Literal["ramp"] = "ramp"

    def __post_init__(self) -> None:
        _check_order(self.start, self.end)

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        return self.before

    def pieces(self) -> list[Piece]:
        """Three pieces, or two if the ramp starts at time zero."""
        slope = (self.after - self.before) / (self.end - self.start)
        return _from_rest_to_rest(self, straight(self.start, self.before, slope))


@dataclass(frozen=True, config=STRICT)
class SmoothRamp:
    """``before`` until ``start``, ``after`` from ``end`` on, half a period of a cosine between.

    It has no jump and no corner; its second derivative jumps at both ends.
    """

    before: Before
    after: After
    start: Start
    end: End
    profile: Literal["smooth_ramp"] = "smooth_ramp"

    def __post_init__(self) -> None:
        _check_order(self.start, self.end)

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        return self.before

    def pieces(self) -> list[Piece]:
        """Three pieces, or two if the ramp starts at time zero."""
        mean, amplitude = (self.before + self.after) / 2, (self.after - self.before) / 2
        rise = self.start, mean, 0.0, amplitude, pi / (self.end - self.start), -pi / 2
        return _from_rest_to_rest(self, rise)


def _check_order(start: float, end: float) -> None:
    if end <= start:
        raise InputError(f"a ramp must end after it starts; start is {start:g} s, end {end:g} s")


def _from_rest_to_rest(ramp: Ramp | SmoothRamp, rise: Piece) -> list[Piece]:
    """The rise between the constant values before it, if it starts after zero, and after it."""
    rising = [rise, straight(ramp.end, ramp.after)]
    return [straight(0.0, ramp.before), *rising] if ramp.start > 0 else rising


@dataclass(frozen=True, config=STRICT)
class Sine:
    """``mean`` + ``amplitude`` sin(2 pi ``frequency`` t + ``phase``); ``phase`` in rad."""

    mean: Annotated[float, Field(description="mean value, in the unit of the driven quantity")]
    amplitude: Annotated[float, Field(description="amplitude, in the unit of the driven quantity")]
    frequency: Annotated[Positive, Field(description="frequency, Hz")]
    phase: Annotated[float, Field(description="phase at the start, rad")] = 0.0
    profile: Literal["sine"] = "sine"

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        return self.mean + self.amplitude * sin(self.phase)

    def pieces(self) -> list[Piece]:
        """One piece."""
        return [(0.0, self.mean, 0.0, self.amplitude, 2 * pi * self.frequency, self.phase)]


@dataclass(frozen=True, config=STRICT)
class Table:
    """Linear between given times (s) and values; before the first and after the last they hold."""

    time: Annotated[tuple[float, ...], Field(strict=False, min_length=1)]
    value: Annotated[tuple[float, ...], Field(strict=False, min_length=1)]
    profile: Literal["table"] = "table"

    def __post_init__(self) -> None:
        if len(self.time) != len(self.value):
            raise InputError(f"{len(self.time)} times, but {len(self.value)} values")
        steps = np.diff(self.time)
        wrong = np.flatnonzero(steps < TIME_RESOLUTION)
        if not wrong.size:
            return
        row = int(wrong[0]) + 2
        earlier, later = self.time[row - 2 : row]
        if later <= earlier:
            raise InputError(
                f"row {row}: time {later:g} s does not come after {earlier:g} s; times must increase"
            )
        raise InputError(
            f"row {row}: {later - earlier:g} s after the row before; at least {TIME_RESOLUTION:g} s"
        )

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        return float(np.interp(0.0, self.time, self.value))

    def pieces(self) -> list[Piece]:
        """One piece before the first row, one from each row to the next, one after the last."""
        return [tuple(row) for row in self.piece_array().tolist()]

    def piece_array(self) -> np.ndarray:
        """The pieces, shape (rows + 1, 6)."""
        time, value = np.array(self.time), np.array(self.value)
        rows = np.zeros((len(time) + 1, 6))
        rows[0, :2] = min(0.0, self.time[0]), self.value[0]
        rows[1:, 0], rows[1:, 1] = time, value
        rows[1:-1, 2] = np.diff(value) / np.diff(time)
        return rows


def lower_bound(profile: "Profile") -> float:
    """A lower bound of a profile's values, which it reaches or comes near to."""
    if isinstance(profile, Sine):
        return profile.mean - abs(profile.amplitude)
    if isinstance(profile, Table):
        return min(profile.value)
    return min(profile.initial, *(piece[1] for piece in profile.pieces()))


Profile = Constant | Step | Ramp | SmoothRamp | Sine | Table
PROFILES: dict[str, type[Profile]] = {
    "constant": Constant,
    "step": Step,
    "ramp": Ramp,
    "smooth_ramp": SmoothRamp,
    "sine": Sine,
    "table": Table,
}


class Piecewise(Protocol):
    """A profile, or a rate that follows from one."""

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        ...

    def pieces(self) -> list[Piece]:
        """The pieces, in order of their starts."""
        ...
