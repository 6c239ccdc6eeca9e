"""Trajectories: a motion at its samples."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from continuum_dyn.passes.dynamics import Dynamics
from statics.equilibria import shape_of


@dataclass(frozen=True)
class Trajectory:
    """A motion at its samples; SI units.

    ``time`` and energies have shape (samples,), ``inputs`` (samples, inputs) as ``Scene.inputs`` names them,
    ``tension`` and ``cable_displacement``, both at the base, (samples, cables), ``load_factor`` (samples,
    driven loads) or None, the base's pose (samples,) or None in an arm without ``base``, coordinates,
    curvature and length (samples, segments), poses (samples, disks).
    ``step_size`` is that of the integrator's step that a sample lies in, zero if no step led to it.
    ``elongation`` and its rate are None in a scene without extension. ``ledger`` holds energies (J), powers
    (W), and the integrals ``input_work`` and ``dissipated_energy`` (J) by glossary name. ``counters`` are the
    solver's: steps, evaluations, Jacobians, decompositions.
    """

    time: np.ndarray
    inputs: np.ndarray
    tension: np.ndarray
    cable_displacement: np.ndarray
    load_factor: np.ndarray | None
    bend_angle: np.ndarray
    bend_angle_rate: np.ndarray
    elongation: np.ndarray | None
    elongation_rate: np.ndarray | None
    curvature: np.ndarray
    length: np.ndarray
    disk_x: np.ndarray
    disk_y: np.ndarray
    disk_theta: np.ndarray
    tip_speed: np.ndarray
    step_size: np.ndarray
    ledger: dict[str, np.ndarray]
    counters: dict[str, int] = field(default_factory=dict)
    base_x: np.ndarray | None = None
    base_y: np.ndarray | None = None
    base_theta: np.ndarray | None = None

    @property
    def tip(self) -> tuple[float, float, float]:
        """x, y (m) and theta (rad) of the last disk at the last sample."""
        return float(self.disk_x[-1, -1]), float(self.disk_y[-1, -1]), float(self.disk_theta[-1, -1])

    def finite(self) -> "Trajectory":
        """The samples before the first one that has a number which is not finite."""
        columns = [
            value for value in (*vars(self).values(), *self.ledger.values()) if isinstance(value, np.ndarray)
        ]
        good = np.all([np.isfinite(c).all(axis=tuple(range(1, c.ndim))) for c in columns], axis=0)
        return self.first(good.size if good.all() else int(np.argmin(good)))

    def first(self, count: int) -> "Trajectory":
        """The first samples, that many."""
        return self._part(slice(0, count))

    def after(self, count: int) -> "Trajectory":
        """The samples after that many."""
        return self._part(slice(count, None))

    def _part(self, rows: slice) -> "Trajectory":
        cut = {name: value[rows] for name, value in vars(self).items() if isinstance(value, np.ndarray)}
        return replace(self, **cut, ledger={name: value[rows] for name, value in self.ledger.items()})

    @property
    def stored_energy(self) -> np.ndarray:
        """Kinetic, elastic and gravity's energy, shape (samples,), J."""
        parts = ("kinetic_energy", "elastic_energy", "gravity_energy")
        return np.sum([self.ledger[name] for name in parts], axis=0)

    @property
    def ledger_gap(self) -> np.ndarray:
        """Energy stored since the start, less work put in, plus energy dissipated, shape (samples,), J.

        Zero up to the integrator's error.
        """
        stored = self.stored_energy
        return stored - stored[0] - self.ledger["input_work"] + self.ledger["dissipated_energy"]

    @property
    def largest_energy(self) -> float:
        """The largest energy that moved, J: stored, kinetic, put in or dissipated."""
        compared = ("kinetic_energy", "input_work", "dissipated_energy")
        moved = (float(np.abs(self.ledger[name]).max()) for name in compared)
        return max(float(np.ptp(self.stored_energy)), *moved)

    @property
    def travel(self) -> float:
        """Largest distance of any disk from where it started, m."""
        return float(np.hypot(self.disk_x - self.disk_x[0], self.disk_y - self.disk_y[0]).max())


def join(blocks: Sequence[Trajectory], counters: dict[str, int]) -> Trajectory:
    """Concatenate consecutive trajectories."""
    first = blocks[0]
    if len(blocks) == 1:
        return replace(first, counters=counters)
    columns = {
        name: np.concatenate([getattr(block, name) for block in blocks])
        for name, value in vars(first).items()
        if isinstance(value, np.ndarray)
    }
    ledger = {name: np.concatenate([block.ledger[name] for block in blocks]) for name in first.ledger}
    return replace(first, **columns, ledger=ledger, counters=counters)


def observe_trajectory(
    dynamics: Dynamics,
    times: np.ndarray,
    states: np.ndarray,
    inputs: np.ndarray,
    step_size: np.ndarray,
    counters: dict[str, int],
) -> Trajectory:
    """The trajectory of states (samples, size) at those times under inputs (samples, inputs).

    ``step_size`` (s), shape (samples,), is zero for a sample that no step led to.
    """
    arm = dynamics.scene.arm
    seen = dynamics.observe(states, inputs)
    q, u = seen.coordinates, seen.rates
    extends = dynamics.dofs == 2
    elongation = q[:, :, 1] if extends else None
    input_work = states[:, -2] + seen.transport_energy
    return Trajectory(
        time=times,
        inputs=inputs,
        **dynamics.scene.driven_by(inputs, seen.disk_x, seen.disk_y, seen.disk_theta),
        bend_angle=q[:, :, 0],
        bend_angle_rate=u[:, :, 0],
        elongation=elongation,
        elongation_rate=u[:, :, 1] if extends else None,
        **shape_of(arm, q[:, :, 0], elongation),
        disk_x=seen.disk_x,
        disk_y=seen.disk_y,
        disk_theta=seen.disk_theta,
        tip_speed=seen.tip_speed,
        step_size=step_size,
        ledger=seen.ledger | {"input_work": input_work, "dissipated_energy": states[:, -1]},
        counters=counters,
    )
