"""A scenario's motion, ready to be integrated."""

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np

from continuum_dyn.integrators import Budget, Choice, Monitor, choose
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import cut_into_intervals
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.integration import inspector, integrate, warm_up, with_step
from continuum_dyn.simulation.samples import Samples
from continuum_dyn.simulation.trajectory import Trajectory
from statics.equilibria import Equilibrium, StaticSolver
from statics.ramp import ramp
from statics.support.interruption import Interruption


class Motion:
    """All that the integration of a scenario's motion needs.

    ``samples`` (s) are the times that are requested, ``timeline`` the time, cut at corners of the inputs.
    Raises ``InputError`` for a study without motion.
    """

    def __init__(self, scenario: Scenario) -> None:
        self.scenario, self.study = (
            scenario,
            scenario.require_motion("only a study of motion can be integrated"),
        )
        self.statics, self.dynamics = StaticSolver(scenario.scene), Dynamics(scenario.scene)
        self.timeline = cut_into_intervals(scenario.profiles, self.study.duration)
        self.samples = np.linspace(0.0, self.study.duration, self.study.samples)

    @cached_property
    def rest(self) -> Equilibrium:
        """The equilibrium that the motion starts from, or the search for it if there is none."""
        (rest,) = ramp(self.statics, [self.scenario.initial_inputs])
        return rest

    @cached_property
    def start(self) -> np.ndarray:
        """State at the start, shape (size,); of no use if ``rest`` is not found."""
        return self.dynamics.state(self.rest.coordinates)

    @property
    def last_inputs(self) -> np.ndarray:
        """Inputs at the end, in the order of ``Scene.inputs``."""
        return self.timeline.last.inputs(np.array([self.study.duration]))[0]

    def choose_method(self) -> Choice:
        """The method for ``method = "auto"``, with the reason."""
        exact = self.scenario.accuracy is not None
        return choose(self.dynamics, self.start, self.timeline.first, self.study.duration, exact)

    def choose_solver(self) -> Solver:
        """The scenario's solver, with the method and the step chosen if the scenario does not fix them."""
        solver = self.scenario.solver
        if solver.chooses_method:
            solver = replace(solver, method=self.choose_method().method)
        return with_step(self.dynamics, solver, self.timeline, self.start)

    def warm_up(self, solver: Solver) -> None:
        """Compile or load the kernels of the method, so that later calls only solve."""
        warm_up(self.dynamics, solver, self.timeline.first)

    def monitor(
        self,
        budget: Budget | None = None,
        interruption: Interruption | None = None,
        progress: Callable[[float], None] | None = None,
    ) -> Monitor:
        """A monitor of one run; ``progress`` is called with the fraction done."""
        duration = self.study.duration
        return Monitor(
            inspect=inspector(self.dynamics),
            progress=None if progress is None else lambda t: progress(t / duration),
            budget=budget or Budget(),
            interruption=interruption or Interruption(),
        )

    def integrate(self, solver: Solver, monitor: Monitor, gathered: Samples | None = None) -> Trajectory:
        """The motion by that solver, up to where the monitor stops it; samples join those ``gathered``."""
        return integrate(self.dynamics, self.timeline, self.samples, self.start, solver, monitor, gathered)

    def complete(self, solver: Solver, budget: Budget | None = None) -> Trajectory | None:
        """The motion by that solver, or None if it does not reach its end."""
        monitor = self.monitor(budget)
        trajectory = self.integrate(solver, monitor)
        return None if monitor.outcome else trajectory
