"""The midpoint rule with SciPy's interface: many compiled steps per call."""

import math
from typing import Any

import numpy as np

from continuum_dyn.integrators import midpoint
from continuum_dyn.integrators.stepper import Interpolant, Stepper
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Interval

BATCH = 256
"""Largest number of internal steps per step of SciPy."""

ROUNDING = 1e-17
"""Largest displacement of a disk in a step's last iteration, over the arm's length."""


class MidpointStepper(Stepper):
    """Variational midpoint rule for a scene without dissipation.

    Options: ``dynamics`` and ``interval``, whose right-hand side this is (``fun`` is not called); ``step``
    (s), at most: the time to ``t_bound`` is cut into equal ones.
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
        interval: Interval,
        step: float,
    ) -> None:
        super().__init__(t0, y0, t_bound)
        self.kernel, segments, disks = dynamics.midpoint
        self.arm = (interval.pieces, segments, disks)
        self.allowed = ROUNDING * dynamics.scene.arm.total_length
        self.steps = max(1, math.ceil((t_bound - t0) / step * (1.0 - 1e-12)))
        self.size, self.start, self.taken = (t_bound - t0) / self.steps, t0, 0
        q, u = (part[0] for part in dynamics.split(np.asarray(y0, dtype=float)[None, :]))
        shape = (BATCH + 1, *q.shape)
        self.records = np.empty(shape), np.empty(shape), np.empty(shape[0])
        self.records[0][0], self.records[2][0] = q, y0[-2]
        midpoint.start_momenta(self.kernel.passes, t0, q, u, self.arm, self.records[1][0])
        self.past = np.tile(u, (midpoint.PAST, 1, 1))

    def _time(self, taken: int) -> float:
        return self.start + taken * self.size

    def _step_impl(self) -> tuple[bool, str | None]:
        for column in self.records:
            column[0] = column[self.internal_steps]
        rows = min(BATCH, self.steps_left, self.steps - self.taken) + 1
        records = tuple(column[:rows] for column in self.records)
        taken, iterations = midpoint.advance(
            self.kernel.passes, self._time(self.taken), self.size, records, self.past, self.allowed, self.arm
        )
        self.internal_steps = taken
        self.taken += taken
        self.nfev += iterations
        self.njev += iterations
        self.nlu += iterations
        if taken == 0:
            return False, f"no solution for a step of {self.size:.3g} s; try a smaller [solver] step"
        self.t = self.t_bound if self.taken == self.steps else self._time(self.taken)
        self.y = self.dense_output()(self.t)
        return True, None

    def dense_output(self) -> Interpolant:
        """The state at every time within the last step."""
        rows = slice(0, self.internal_steps + 1)
        records = tuple(column[rows].copy() for column in self.records)
        start = self._time(self.taken - self.internal_steps)
        return MidpointInterpolant(self.kernel, start, self.size, records, self.allowed, self.arm)


class MidpointInterpolant(Interpolant):
    """The state within a batch of steps: by a shorter step of the same rule."""

    def __init__(
        self,
        kernel: Any,
        start: float,
        size: float,
        records: tuple[np.ndarray, ...],
        allowed: float,
        arm: tuple[np.ndarray, ...],
    ) -> None:
        super().__init__(start, start + (len(records[0]) - 1) * size)
        self.kernel, self.records = kernel, records
        self.step, self.allowed, self.arm = size, allowed, arm

    @property
    def size(self) -> int:
        """Size of a state."""
        return 2 * self.records[0][0].size + 2

    def states(self, times: np.ndarray) -> np.ndarray:
        """The states at increasing times (s), shape (times, size)."""
        found = np.empty((times.size, self.size))
        arguments = (self.t_old, self.step, self.records, self.allowed, self.arm)
        midpoint.sample(self.kernel.passes, times, *arguments, found)
        return found
