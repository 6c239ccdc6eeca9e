"""The guard around every solver: budgets, non-finite states, geometric limits, Ctrl-C, progress.

SciPy's solvers have none of these. A guarded one fails at the first step that breaks a bound, and the
``Monitor`` knows why.
"""

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

from continuum_dyn.scenario.solver import Solver
from statics.outcome import Outcome
from statics.support.interruption import Interruption

Item = TypeVar("Item")


@dataclass(frozen=True)
class Budget:
    """Largest cost of one run; by default that of ``Solver``."""

    steps: int = Solver.max_steps
    seconds: float = Solver.max_seconds

    def is_spent(self, started: float) -> bool:
        """Whether the seconds from ``started``, a time of ``time.monotonic``, are used up."""
        return time.monotonic() - started > self.seconds

    def spent_on(self, items: Iterable[Item], started: float) -> Iterator[Item]:
        """Yield the items that come before the seconds from ``started`` are used up."""
        for item in items:
            if self.is_spent(started):
                return
            yield item


class StepAbandonedError(Exception):
    """The budget of time, or Ctrl-C, ends a run within a step; the monitor has noted which."""


@dataclass
class Monitor:
    """Watches a run over all of its intervals; ``outcome`` is set when a bound is broken.

    ``inspect(t, y)`` returns the outcome and a message if a state is not acceptable, else
    None; ``progress(t)`` is called after each step. ``reached`` is the last acceptable time and state.
    """

    inspect: Callable[[float, np.ndarray], tuple[Outcome, str] | None]
    progress: Callable[[float], None] | None = None
    budget: Budget = Budget()
    steps: int = 0
    rejections: int = 0
    started: float = field(default_factory=time.monotonic)
    interruption: Interruption = field(default_factory=Interruption)
    reached: tuple[float, np.ndarray] = (0.0, np.zeros(0))
    outcome: Outcome | None = None
    message: str = ""

    def stop(self, outcome: Outcome, message: str) -> str:
        """Note why the run ends; the first reason counts."""
        if self.outcome is None:
            self.outcome, self.message = outcome, message
        return self.message

    def after_step(self, t: float, y: np.ndarray, steps: int) -> str | None:
        """Count accepted steps and check the last one; a returned message says that it must stay the last."""
        self.steps += steps
        found = self.inspect(t, y)
        if found is not None:
            return self.stop(*found)
        self.reached = (t, y)
        if self.steps >= self.budget.steps:
            return self.stop(
                Outcome.BUDGET_EXCEEDED, f"max_steps = {self.budget.steps} reached at t = {t:.6g} s"
            )
        if self._out_of_time(t):
            return self.message
        if self.progress is not None:
            self.progress(t)
        return None

    def within_step(self) -> None:
        """Raise ``StepAbandonedError`` if the step must end now: one of a large arm takes minutes."""
        if self._out_of_time(self.reached[0]):
            raise StepAbandonedError(self.message)

    def _out_of_time(self, t: float) -> bool:
        if self.interruption.asked:
            self.stop(Outcome.INTERRUPTED, f"interrupted at t = {t:.6g} s")
        elif self.budget.is_spent(self.started):
            self.stop(
                Outcome.BUDGET_EXCEEDED, f"max_seconds = {self.budget.seconds:g} used up at t = {t:.6g} s"
            )
        else:
            return False
        return True


_SolverClass: Any = object
"""A class under a guard: one of SciPy's, or a ``Stepper``."""


class Guard(_SolverClass):
    """Mixin before a solver class: the same steps, watched. Takes ``monitor`` as a solver option.

    A solver whose step is many may count them in ``internal_steps`` and ``internal_rejections``; it should
    take no more than ``steps_left``. If they differ in size, ``internal_times`` are where they begin and end.
    """

    internal_steps = 1
    internal_times: np.ndarray | None = None
    internal_rejections = 0
    steps_left = 1

    def __init__(self, fun: Callable[..., Any], *arguments: Any, monitor: Monitor, **options: Any) -> None:
        self.monitor, self.stepping = monitor, False

        def watched(t: float, y: np.ndarray) -> Any:
            if self.stepping:
                monitor.within_step()
            return fun(t, y)

        super().__init__(watched, *arguments, **options)

    def step(self) -> str | None:
        """One step of the solver; failed if the solver fails or the monitor objects."""
        self.steps_left = self.monitor.budget.steps - self.monitor.steps
        self.stepping = True
        try:
            with np.errstate(all="ignore"):
                message = super().step()
        except StepAbandonedError:
            self.status = "failed"
            return self.monitor.message
        except (ArithmeticError, ValueError, np.linalg.LinAlgError) as error:
            self.status = "failed"
            return self.monitor.stop(Outcome.DIVERGED, f"{error} after t = {self.t:.6g} s")
        finally:
            self.stepping = False
        if self.status == "failed":
            return self.monitor.stop(Outcome.DIVERGED, f"{message} at t = {self.t:.6g} s")
        self.monitor.rejections += self.internal_rejections
        objection = self.monitor.after_step(self.t, self.y, self.internal_steps)
        if objection is not None:
            self.status = "failed"
            return objection
        return message
