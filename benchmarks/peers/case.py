"""The one case that all are measured on: arm, samples, reference, and this program's own error and time."""

import statistics
import time
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np

from continuum_dyn import load_scenario
from continuum_dyn.integrators import Monitor
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import cut_into_intervals
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.scenario.studies import MotionStudy
from continuum_dyn.simulation.integration import inspector, integrate, warm_up
from statics import equilibrium
from statics.effects import Gravity

from ..scaling import cut

SCENARIO = Path(__file__).parents[2] / "scenarios" / "step_response.toml"
PAPER_DISKS = 4
"""Disks of the scenario's arm, the one on which all settings of all peers are tried."""
TOLERANCES = tuple(10.0 ** (-k / 2) for k in range(2, 23))
"""Those among which this program's is chosen: half a decade apart, from 0.1 to 1e-11."""


class Answer(NamedTuple):
    """What a peer did with the case.

    ``tip`` holds x and y (m) at the samples, shape (samples, 2); ``seconds`` is the solve alone, in the
    median; ``lacks`` is what the model or the tool does without. Answers with one ``model`` differ by their
    solver only.
    """

    model: str
    settings: str
    seconds: float
    tip: np.ndarray
    lacks: str


class Case:
    """The step response of ``scenarios/step_response.toml``, its numbers laid open for the peers.

    With other than the paper's 4 disks it is the same arm in finer segments: of the same length, core, cable
    and mass, so that each disk has 4 / ``disks`` of the paper's mass and inertia. ``duration`` in s; a sample
    is a millisecond.
    """

    def __init__(self, disks: int = PAPER_DISKS, duration: float = 1.0) -> None:
        study = MotionStudy(duration, samples=round(1000 * duration) + 1)
        self.scenario = replace(cut(load_scenario(SCENARIO), disks, extension=True), study=study)
        effects = {effect.name: effect for effect in self.scenario.scene.effects}
        arm, gravity = self.scenario.scene.arm, effects["gravity"]
        assert isinstance(gravity, Gravity)
        self.disks, self.L0 = arm.disks, arm.disk_spacing
        self.EJ = (arm.youngs_modulus or 0.0) * (arm.second_moment or 0.0)
        self.EA = (arm.youngs_modulus or 0.0) * (arm.area or 0.0)
        self.mass, self.inertia = arm.disk_mass or 0.0, arm.disk_inertia or 0.0
        self.hole = float(arm.cables[0].holes(0)[0])
        self.gravity = np.array(gravity.acceleration)
        self.retardation: float = getattr(effects["material_damping"], "retardation_time")  # noqa: B009
        self.duration = duration
        self.samples = np.linspace(0.0, duration, study.samples)
        self.stretches = cut_into_intervals(self.scenario.profiles, self.duration)
        self.tension = float(self.stretches.last.inputs(self.samples[-1:])[0, 0])
        self.dynamics = Dynamics(self.scenario.scene)
        self.rest = equilibrium(self.scenario.scene, self.scenario.initial_inputs).coordinates

    def tip(self, solver: Solver) -> np.ndarray:
        """This program's answer."""
        monitor = Monitor(inspect=inspector(self.dynamics))
        start = self.dynamics.state(self.rest)
        found = integrate(self.dynamics, self.stretches, self.samples, start, solver, monitor)
        return np.column_stack([found.disk_x[:, -1], found.disk_y[:, -1]])

    @cached_property
    def reference(self) -> np.ndarray:
        """This program's answer at tolerances far below every peer's error."""
        return self.tip(Solver("chain", rtol=1e-12, atol=1e-14))

    def error(self, tip: np.ndarray) -> float:
        """Largest distance from the reference over the samples, m; inf if the peer's motion diverged."""
        apart = float(np.max(np.hypot(*(tip - self.reference).T)))
        return apart if np.isfinite(apart) else np.inf

    @cached_property
    def own_errors(self) -> list[tuple[float, float]]:
        """Pairs of tolerance and this program's error, loosest first."""
        return [(rtol, self.error(self.tip(solver_at(rtol)))) for rtol in TOLERANCES]

    def own_time(self, error: float) -> tuple[float, float, float]:
        """Tolerance, error (m) and seconds of this program where its error is no larger than that.

        Of the tolerances that qualify, the quickest of the three loosest; the tightest if none does.
        """
        fitting = [pair for pair in self.own_errors if pair[1] <= error][:3] or self.own_errors[-1:]
        found = [(*pair, self._seconds(solver_at(pair[0]))) for pair in fitting]
        return min(found, key=lambda each: each[2])

    def _seconds(self, solver: Solver) -> float:
        warm_up(self.dynamics, solver, self.stretches[0])
        return timed(lambda: self.tip(solver), 11)[0]


class Stopwatch:
    """Seconds by the clock or of this process on its cores, whichever are fewer.

    So the work of other processes counts for no one, and threads count for those who have them.
    """

    def __init__(self) -> None:
        self.started, self.worked = time.perf_counter(), time.process_time()

    def seconds(self) -> float:
        """Since it was made."""
        return min(time.perf_counter() - self.started, time.process_time() - self.worked)


def solver_at(rtol: float) -> Solver:
    """This program's integrator at that tolerance."""
    return Solver("chain", rtol=rtol, atol=1e-3 * rtol)


def timed(solve: Callable[[], np.ndarray], repeats: int) -> tuple[float, np.ndarray]:
    """Median seconds of some repeats, after one that is not counted, and what they found."""
    found, times = solve(), []
    for _ in range(repeats):
        watch = Stopwatch()
        found = solve()
        times.append(watch.seconds())
    return statistics.median(times), found
