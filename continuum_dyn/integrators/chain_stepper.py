"""Runge-Kutta methods on the chain with SciPy's interface: many compiled steps per call."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from continuum_dyn.integrators import runge_kutta
from continuum_dyn.integrators.runge_kutta import FINISHED, MOST_GROWTH, NO_ROOM, TOO_SMALL
from continuum_dyn.integrators.stepper import Interpolant, Stepper
from continuum_dyn.integrators.tableau import ESDIRK5, SDIRK4, Tableau
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Interval

BATCH = 256
"""Largest number of internal steps per step of SciPy: a call through ``solve_ivp`` costs as much as one."""

FIRST_PART = 0.01
"""Largest displacement of a disk in the first step, over the tolerance: it resolves a jump."""

LEAST_ROUNDINGS = 100.0
"""Shortest step after an interval of one or two roundings of the time, in such roundings."""

CORNER_STEP = 0.1
"""Largest first step after a corner of an input, in radians of the arm's lowest frequency."""
DRIVE_STEP = 0.5
"""Longest step, in radians of a wave of the inputs, whose work is interpolated within a step. Waves that are
faster than the arm's lowest frequency are resolved as far as they move it."""
SAME_SLOPE = 1e-9
"""Relative difference below which two slopes of an input are one."""


class ChainStepper(Stepper):
    """ESDIRK on the chain, O(n) a stage, error in metres.

    Options: ``dynamics`` and ``intervals``, whose right-hand side this is (``fun`` is not called), one after
    the other without a jump of accelerations; ``tolerance``, the largest displacement (m) of any disk by the
    error of one step; ``first_step`` (s), at most; ``tableau``. ``internal_times`` (s) are where internal
    steps begin and end. Where nodes carry no mass the start's accelerations are not known; a first step by
    ``SDIRK4``, which does not need them, ends in consistent ones.
    """

    steps_left = BATCH

    def __init__(
        self,
        fun: Any,
        t0: float,
        y0: np.ndarray,
        t_bound: float,
        vectorized: bool = False,
        *,
        dynamics: Dynamics,
        intervals: Sequence[Interval],
        tolerance: float,
        first_step: float,
        tableau: Tableau = ESDIRK5,
    ) -> None:
        super().__init__(t0, y0, t_bound)
        self.kernel, segments, disks = dynamics.motion
        self.tables = segments, disks
        self.intervals, self.current = intervals, 0
        self.tableau = tableau
        self.tolerance = tolerance
        self.slip_speed = dynamics.slip_speed
        rates_count = tableau.explicit or np.isfinite(self.slip_speed)
        self.frequency = dynamics.frequency
        self.lasting = 1.0 / self.frequency if rates_count else 0.0
        self.corner_step = CORNER_STEP / self.frequency
        shape = (BATCH + 1, dynamics.scene.arm.segments, dynamics.dofs)
        self.records = (
            np.empty(shape[0]),
            np.empty((shape[0], y0.size)),
            np.empty(shape),
            np.empty((shape[0], 3, 2)),
        )
        push = runge_kutta.start_records(
            self.kernel.passes, t0, np.asarray(y0, dtype=float), self._arm, self.records
        )
        self.next_step = first_step
        self.knows_acceleration = not dynamics.scene.arm.massless_nodes
        if not self.knows_acceleration:
            self.records[2][0] = 0.0
        elif push > 0.0:
            self.next_step = min(first_step, np.sqrt(2.0 * FIRST_PART * tolerance / push))
        self.rate = 0.1

    @property
    def _arm(self) -> tuple[np.ndarray, ...]:
        return (self.intervals[self.current].pieces, *self.tables)

    def _step_impl(self) -> tuple[bool, str | None]:
        for column in self.records:
            column[0] = column[self.internal_steps]
        rows = min(BATCH, self.steps_left) if self.knows_acceleration else 1
        taken, ended, self.internal_rejections = 0, FINISHED, 0
        while taken < rows and ended == FINISHED and self.records[0][taken] < self.t_bound:
            if self.records[0][taken] >= self.intervals[self.current].end:
                self._enter_next_interval(taken)
            more, ended = self._advance(slice(taken, rows + 1))
            if ended == NO_ROOM and taken > 0 and more == 1:
                break  # the step ends where the arm cannot be: it is the next batch's first
            taken += more
        self.internal_steps = taken
        if taken == 0:
            reason = "the step size fell below rounding" if ended == TOO_SMALL else "no step converged"
            return False, f"{reason} ({self.next_step:.3g} s)"
        self.knows_acceleration = True
        self.internal_times = self.records[0][: taken + 1]
        self.t, self.y = float(self.records[0][taken]), self.records[1][taken].copy()
        return True, None

    def _enter_next_interval(self, row: int) -> None:
        """Restart the step size if a slope changes, to resolve the oscillations that this excites.

        An interval of next to no length may have been a jump: no step is much longer than the one before.
        """
        self.current += 1
        slope, slope_before = (
            self.intervals[number].pieces[:, 2] for number in (self.current, self.current - 1)
        )
        if np.any(np.abs(slope - slope_before) > SAME_SLOPE * (np.abs(slope) + np.abs(slope_before))):
            self.next_step = min(self.next_step, self.corner_step)
        if row > 0:
            t, before = self.records[0][row], self.records[0][row - 1]
            most = max(MOST_GROWTH * (t - before), LEAST_ROUNDINGS * np.spacing(t))
            self.next_step = min(self.next_step, most)

    @property
    def _longest_step(self) -> float:
        """Longest step (s) in this interval: a stiff arm follows a slow drive without a visible error."""
        amplitude, frequency = self.intervals[self.current].pieces[:, 3:5].T
        if not amplitude.any():
            return np.inf
        slow = frequency[(amplitude != 0.0) & (frequency <= self.frequency)]
        fastest = float(np.max(slow, initial=0.0))
        return DRIVE_STEP / fastest if fastest > 0.0 else np.inf

    def _advance(self, rows: slice) -> tuple[int, int]:
        """Steps within one interval from the first of these rows on: how many, and how they ended."""
        tableau = self.tableau if self.knows_acceleration else SDIRK4
        ended, taken, self.next_step, self.rate, rejected, iterations = runge_kutta.advance(
            self.kernel.passes,
            self.intervals[self.current].end,
            self.next_step,
            self._longest_step,
            self.rate,
            tuple(column[rows] for column in self.records),
            (tableau.a, tableau.c, tableau.error_weights, tableau.predictor, self.lasting, self.slip_speed),
            tableau.order,
            self.tolerance,
            self._arm,
        )
        self.internal_rejections += rejected
        self.nfev += iterations
        self.njev += iterations
        self.nlu += iterations
        return taken, ended

    def dense_output(self) -> Interpolant:
        """The state at every time within the last step."""
        rows = slice(0, self.internal_steps + 1)
        return ChainInterpolant(tuple(column[rows].copy() for column in self.records))


class ChainInterpolant(Interpolant):
    """The state within a batch of steps: quintic Hermite polynomials of the coordinates."""

    def __init__(self, records: tuple[np.ndarray, ...]) -> None:
        super().__init__(float(records[0][0]), float(records[0][-1]))
        self.records = records

    @property
    def size(self) -> int:
        """Size of a state."""
        return self.records[1].shape[1]

    def states(self, times: np.ndarray) -> np.ndarray:
        """The states at increasing times (s), shape (times, size)."""
        found = np.empty((times.size, self.size))
        runge_kutta.interpolate(times, self.records, 0, found)
        return found
