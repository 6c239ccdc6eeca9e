"""The interface of SciPy's ``OdeSolver`` for our own methods, without SciPy: to import it takes 0.4 s."""

from abc import ABC, abstractmethod
from typing import Any

import numpy as np


class Stepper(ABC):
    """A method that integrates from ``t`` to ``t_bound`` step by step; see SciPy's ``OdeSolver``.

    A step may be many; ``internal_steps`` and ``internal_rejections`` count those of the last call, which
    takes no more than ``steps_left``.
    """

    direction = 1.0
    steps_left = 1

    def __init__(self, t0: float, y0: np.ndarray, t_bound: float) -> None:
        self.t_old: float | None = None
        self.t, self.y, self.t_bound, self.n = t0, y0, t_bound, y0.size
        self.status = "running"
        self.nfev = self.njev = self.nlu = 0
        self.internal_steps = self.internal_rejections = 0

    @abstractmethod
    def _step_impl(self) -> tuple[bool, str | None]:
        """Move ``t`` and ``y``; whether that was possible, and if not, why."""

    @abstractmethod
    def dense_output(self) -> "Interpolant":
        """The state at every time within the last step."""

    def step(self) -> str | None:
        """Take one step; return the reason if it failed. Raises ``RuntimeError`` at the end."""
        if self.status != "running":
            raise RuntimeError(f"the solver cannot step: it has {self.status}.")
        before = self.t
        possible, message = self._step_impl()
        if possible:
            self.t_old = before
        self.status = "failed" if not possible else "finished" if self.t >= self.t_bound else "running"
        return message


class Interpolant(ABC):
    """The state within a step, which may be many; see SciPy's ``DenseOutput``."""

    def __init__(self, t_old: float, t: float) -> None:
        self.t_old, self.t = t_old, t

    @abstractmethod
    def states(self, times: np.ndarray) -> np.ndarray:
        """The states at increasing times (s), shape (times, size)."""

    def __call__(self, t: Any) -> np.ndarray:
        """The state at a time, shape (size,), or at several, shape (size, times)."""
        times = np.atleast_1d(np.asarray(t, dtype=float))
        order = np.argsort(times, kind="stable")
        states = np.empty((times.size, self.size))
        states[order] = self.states(times[order])
        return states[0] if np.ndim(t) == 0 else states.T

    @property
    @abstractmethod
    def size(self) -> int:
        """Size of a state."""
