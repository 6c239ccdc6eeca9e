"""The answer to a scenario, and the interface that receives a motion's samples while it runs."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.mesh import Mesh
from continuum_dyn.simulation.messages import failure_message
from continuum_dyn.simulation.rest_gap import (
    Place,
    has_settled,
    place_of_rest,
    tip_gap,
    unsettled_message,
)
from continuum_dyn.simulation.trajectory import Trajectory
from continuum_dyn.stability import Growth
from continuum_dyn.warnings.collected import warnings_of
from continuum_dyn.warnings.results import bending_strain
from statics.equilibria import Equilibrium
from statics.outcome import Outcome


@dataclass(frozen=True)
class Run:
    """The answer to a scenario.

    ``equilibria`` are those of the study; for a motion the first and the last one, and if requested those of
    every sample in ``static_path``. ``rests`` is where a motion may end, ``StaticSolver.rests`` of its last
    equilibrium; ``rest`` is the place there that is next to the tip, x and y, m, and ``static_gap`` the
    distance to it, m. ``tip_error`` (m) is the estimate of the largest tip error if an accuracy was
    requested; ``mesh`` is the mesh that was found, with its part of the error, if the program chose that,
    too. ``solve_time`` (s) is the solving alone, with kernels loaded.
    """

    scenario: Scenario
    outcome: Outcome
    message: str = ""
    equilibria: list[Equilibrium] = field(default_factory=list)
    static_path: list[Equilibrium] = field(default_factory=list)
    trajectory: Trajectory | None = None
    rests: list[Equilibrium] = field(default_factory=list)
    rest: Place | None = None
    static_gap: float | None = None
    solver: Solver | None = None
    tip_error: float | None = None
    mesh: Mesh | None = None
    solve_time: float = 0.0

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Warnings about valid but unusual inputs or results, one or two sentences each."""
        return warnings_of(self)

    @property
    def bending_strain(self) -> float | None:
        """Largest bending strain of a round core; None if its radius is not known."""
        return bending_strain(self)

    @property
    def tips(self) -> np.ndarray | None:
        """Positions of the tip at the samples or points, shape (samples, 2), m; None if some are missing."""
        if not (self.outcome.answered or self.outcome is Outcome.UNSTABLE_EQUILIBRIUM):
            return None
        if self.trajectory is not None:
            return np.column_stack([self.trajectory.disk_x[:, -1], self.trajectory.disk_y[:, -1]])
        if not all(point.found for point in self.equilibria):
            return None
        return np.array([point.tip[:2] for point in self.equilibria])

    @property
    def tip(self) -> tuple[float, float, float] | None:
        """x, y (m) and theta (rad) of the last disk at the end of the run; None if it has no state."""
        if self.trajectory is not None:
            return self.trajectory.tip
        found = [point for point in self.equilibria if point.found]
        return found[-1].tip if found else None

    def with_trajectory(
        self, trajectory: Trajectory, rests: list[Equilibrium], growth: Growth | None = None
    ) -> "Run":
        """The run with that motion, its distance from ``rests`` and the verdict of a step response.

        ``growth`` is what grows about the last equilibrium.
        """
        end, tips = self.equilibria[-1], [point.tip for point in rests if point.found]
        rest = place_of_rest(trajectory.tip, tips) if tips else None
        gap = tip_gap(trajectory.tip, tips) if tips else None
        run = replace(self, trajectory=trajectory, rests=rests, rest=rest, static_gap=gap)
        if not self.scenario.study.settles:
            return run
        if gap is None or end.outcome is not Outcome.COMPLETED:
            return replace(run, outcome=end.outcome, message=failure_message(end, growth))
        speeds, within = trajectory.tip_speed, self.scenario.settled_within
        if has_settled(gap, float(speeds[-1]), within):
            return replace(run, outcome=Outcome.SETTLED)
        way = zip(trajectory.disk_x[:, -1], trajectory.disk_y[:, -1], strict=True)
        gaps = np.array([tip_gap((x, y, 0.0), tips) for x, y in way])
        message = unsettled_message(trajectory.time, gaps, speeds, within, _slip_speed(self.scenario))
        return replace(run, outcome=Outcome.NOT_SETTLED, message=message)


def _slip_speed(scenario: Scenario) -> float:
    """Least slip speed of the cables that rub, m/s; infinite without any."""
    scene = scenario.scene
    pairs = zip(scene.arm.cables, scene.cable_kinds, strict=False)
    return min((cable.slip_speed for cable, kind in pairs if kind.rubs), default=np.inf)


def interrupted_early(scenario: Scenario) -> Run:
    """The run that Ctrl-C ended while its kernels were loaded."""
    return Run(scenario, Outcome.INTERRUPTED, "interrupted before anything was computed")


class Sink(Protocol):
    """Receives a motion's samples while it runs."""

    def begin(self, run: Run) -> None:
        """Start a motion, or with an accuracy requested a trial; the run holds what is known of it."""

    def add(self, block: Trajectory) -> None:
        """Append the next samples; those since the last block are in the answer alone."""
