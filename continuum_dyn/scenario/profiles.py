"""Profiles of the inputs over time, as data: pieces between corners, evaluated in compiled code.

A piece is a row (start, value, slope, amplitude, angular frequency, phase) and means

    value + slope (t - start) + amplitude sin(angular frequency (t - start) + phase)

from its start to the next one's, so its derivative is a piece, too. At a jump the later piece counts.
"""

from functools import cached_property
from math import inf, pi, sin
from typing import Annotated, Literal, Protocol

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass

from statics.errors import InputError
from statics.support.checked import STRICT, NonNegative, Positive

TIME_RESOLUTION = 1e-300
"""Shortest time between rows of a table, s; slopes over less are beyond floating point."""

Value = Annotated[float, Field(description="value at all times, in the unit of the driven quantity")]
Before = Annotated[float, Field(description="value before the change, in the unit of the driven quantity")]
After = Annotated[float, Field(description="value after the change, in the unit of the driven quantity")]
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
    """Linear between given times (s) and values; before the first and after the last they hold.

    Of several ``periods`` these are one. It jumps between two of them if one ends with another value than it
    begins with.
    """

    time: Annotated[tuple[float, ...], Field(strict=False, min_length=1)]
    value: Annotated[tuple[float, ...], Field(strict=False, min_length=1)]
    periods: Annotated[int, Field(ge=1)] = 1
    profile: Literal["table"] = "table"

    def __post_init__(self) -> None:
        if len(self.time) != len(self.value):
            raise InputError(f"{len(self.time)} times, but {len(self.value)} values")
        steps = np.diff(self.time)
        wrong = np.flatnonzero(steps < TIME_RESOLUTION)
        if wrong.size:
            raise InputError(_disorder(int(wrong[0]) + 2, *self.time[wrong[0] : wrong[0] + 2]))
        if self.periods > 1 and 0.0 < self.period <= np.spacing(self.end):
            raise InputError(
                f"a period of {self.period:g} s is below the rounding of its end, {self.end:g} s"
            )

    @property
    def period(self) -> float:
        """Time from the first row to the last, s."""
        return self.time[-1] - self.time[0]

    @property
    def end(self) -> float:
        """Time of the last row of the last period, s."""
        return self.time[-1] + (self.periods - 1) * self.period

    @property
    def initial(self) -> float:
        """Value at the equilibrium that the motion starts from."""
        since = -self.time[0]
        if self.period < since < self.periods * self.period:
            since %= self.period
        return float(np.interp(self.time[0] + since, self.time, self.value))

    def pieces(self) -> list[Piece]:
        """One piece before the first row, one from each row to the next, one after the last."""
        return [tuple(row) for row in self.pieces_from(-inf, 2 + self.periods * len(self.time)).tolist()]

    def pieces_from(self, start: float, count: int) -> np.ndarray:
        """The piece at time ``start`` (s) and those after it, at most ``count``, shape (pieces, 6)."""
        spans = len(self.time) - 1
        last = 1 + self.periods * spans
        rows = self._rows(np.arange(max(self._number_at(start) - 1, 0), last + 1)[: count + 2], last)
        active = max(int(np.searchsorted(rows[:, 0], start, side="right")) - 1, 0)
        return rows[active : active + count]

    def _number_at(self, start: float) -> int:
        """Number of the piece at that time (s), or of one before it by as much as rounding may hide."""
        time, spans = self._columns[0], len(self.time) - 1
        since = start - time[0]
        if since <= 0.0 or not spans:
            return 0
        period = min(int(since / self.period), self.periods - 1)
        roundings = 8.0 * np.spacing(max(abs(start), self.end))
        row = int(np.searchsorted(time, start - period * self.period - roundings, side="right"))
        return period * spans + min(row, spans)

    @cached_property
    def _columns(self) -> tuple[np.ndarray, np.ndarray]:
        return np.array(self.time), np.array(self.value)

    def _rows(self, numbers: np.ndarray, last: int) -> np.ndarray:
        """The pieces of these consecutive numbers: 0 before the first row, ``last`` after the last one."""
        time, value = self._columns
        rows = np.zeros((len(numbers), 6))
        number, row = np.divmod(numbers - 1, max(len(time) - 1, 1))
        start = np.where(numbers == last, self.end, time[row] + number * self.period)
        start = np.where(numbers == 0, min(0.0, time[0]), start)
        rows[:, 0] = np.maximum.accumulate(start)
        rows[:, 1] = np.where(numbers == last, value[-1], np.where(numbers == 0, value[0], value[row]))
        inside = (numbers[:-1] > 0) & (numbers[:-1] < last)
        length = np.diff(rows[:, 0])
        rises = inside & (length > 0.0)  # what rounding leaves no time for is a jump
        row = row[:-1][rises]
        rows[:-1, 2][rises] = (value[row + 1] - value[row]) / length[rises]
        return rows


def _disorder(row: int, earlier: float, later: float) -> str:
    if later <= earlier:
        return f"row {row}: time {later:g} s does not come after {earlier:g} s; times must increase"
    return f"row {row}: {later - earlier:g} s after the row before; at least {TIME_RESOLUTION:g} s"


def change_times(profile: "Profile") -> tuple[float, float] | None:
    """Times (s) at which a profile first and last changes after time zero; None if it never does."""
    match profile:
        case Constant():
            found = None
        case Step():
            found = (profile.at, profile.at) if profile.before != profile.after else None
        case Ramp() | SmoothRamp():
            found = (profile.start, profile.end) if profile.before != profile.after else None
        case Sine():
            found = (0.0, inf) if profile.amplitude else None
        case Table():
            found = _change_times_of_table(profile)
    return found


def _change_times_of_table(table: Table) -> tuple[float, float] | None:
    changes = np.flatnonzero(np.diff(table.value))
    if not changes.size or table.end <= 0.0:
        return None
    last = table.time[changes[-1] + 1] + (table.periods - 1) * table.period
    return (max(0.0, table.time[changes[0]]), last) if last > 0.0 else None


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
