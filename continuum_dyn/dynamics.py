"""A scene's compiled equations of motion, under the names that an integrator asks for."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from continuum_dyn import implicit_kernel, midpoint_kernel
from continuum_dyn.motion_kernel import RECIPE
from continuum_dyn.scenario.intervals import Interval
from statics import codegen
from statics.errors import InputError
from statics.scene import Scene

LEDGER = ("kinetic_energy", "elastic_energy", "gravity_energy", "input_power", "dissipated_power")


@dataclass(frozen=True)
class Observation:
    """What follows from states: arrays over samples and disks; ``ledger`` by glossary name.

    ``coordinates`` and ``rates`` have shape (samples, segments, dofs). ``transport_energy`` (J) is what the
    state's ``input_work`` leaves out where the base moves: see ``transport.py``.
    """

    coordinates: np.ndarray
    rates: np.ndarray
    disk_x: np.ndarray
    disk_y: np.ndarray
    disk_theta: np.ndarray
    tip_speed: np.ndarray
    ledger: dict[str, np.ndarray]
    transport_energy: np.ndarray | float = 0.0


class Dynamics:
    """The motion kernel and the numbers of one scene.

    The state is y = (q, u, input_work, dissipated_energy); q and u hold each segment's coordinates and
    rates in turn. ``load`` makes the kernel: compiled, or interpreted. Raises ``InputError`` for a scene
    without inertia: it has no acceleration.
    """

    def __init__(self, scene: Scene, load: codegen.Loader = codegen.load) -> None:
        if not scene.has("inertia"):
            raise InputError("motion needs the effect 'inertia'. Add inertia = {} to [effects].")
        self.scene = scene
        self.dofs = len(scene.coordinates)
        self.size = scene.arm.segments * self.dofs
        self.state_size = 2 * self.size + 2
        self.load = load
        self.kernel, self.segments, self.disks = self._loaded(RECIPE)

    def state(self, coordinates: np.ndarray, rates: np.ndarray | None = None) -> np.ndarray:
        """State from coordinates and rates, shape (segments, dofs), at rest by default; ledger at zero."""
        u = np.zeros_like(coordinates) if rates is None else rates
        return np.concatenate([coordinates.ravel(), u.ravel(), [0.0, 0.0]])

    def rate(self, t: float, y: np.ndarray, span: Interval) -> np.ndarray:
        """dy/dt."""
        return self.kernel.rate(t, y, span.pieces, self.segments, self.disks, self.dofs)

    def jacobian(self, t: float, y: np.ndarray, span: Interval) -> np.ndarray:
        """d(rate)/dy, exact."""
        return self.kernel.rate_jacobian(t, y, span.pieces, self.segments, self.disks, self.dofs)

    def clearance(self, y: np.ndarray) -> float:
        """Smallest length or hole-to-hole length over L0."""
        return self.kernel.clearance_sweep(y[: self.size].reshape(-1, self.dofs), self.segments)

    def closest_disk(self, y: np.ndarray) -> int:
        """Number of the disk before which the arm is nearest to a geometric limit."""
        arm = self.scene.arm
        q = y[: self.size].reshape(arm.disks, arm.subsegments, self.dofs)
        segments = self.segments.reshape(*q.shape[:2], -1)
        alone = [self.kernel.clearance_sweep(*span) for span in zip(q, segments, strict=True)]
        return int(np.argmin(alone)) + 1

    @cached_property
    def frequency(self) -> float:
        """Scale of the arm's lowest frequency, sqrt((EJ / L) / (m n L^2)), rad/s; 1 without bending."""
        arm = self.scene.arm
        columns = arm.segment_columns()
        stiffness = float(np.mean(columns.get("bending_stiffness", 0.0))) / arm.total_length
        inertia = arm.total_mass * arm.total_length**2
        return float(np.sqrt(stiffness / inertia)) if stiffness else 1.0

    def scales(self) -> np.ndarray:
        """What one rad of bending compares with in each entry of the state, for absolute tolerances.

        Elongations: the rest length; rates: the same times the arm's frequency; energies: the bending
        stiffness over the rest length. Shape of the state.
        """
        arm = self.scene.arm
        stiffness = arm.segment_columns().get("bending_stiffness", arm.rest_lengths)
        energy = float(np.mean(stiffness)) / arm.rest_length
        q = np.tile([1.0, arm.rest_length][: self.dofs], arm.segments)
        return np.concatenate([q, self.frequency * q, np.full(2, energy)])

    @cached_property
    def implicit(self) -> tuple[Any, np.ndarray, np.ndarray]:
        """The kernel of implicit steps, with its segment and disk tables."""
        return self._loaded(implicit_kernel.RECIPE)

    @cached_property
    def midpoint(self) -> tuple[Any, np.ndarray, np.ndarray]:
        """The kernel of the midpoint rule, with its segment and disk tables."""
        return self._loaded(midpoint_kernel.RECIPE)

    def _loaded(self, recipe: codegen.Recipe) -> tuple[Any, np.ndarray, np.ndarray]:
        kernel = self.load(self.scene, recipe)
        tables = ("segment", kernel.SEGMENT_COLUMNS), ("disk", kernel.DISK_COLUMNS)
        segments, disks = (self.scene.table(place, columns) for place, columns in tables)
        return kernel, segments, disks

    def split(self, states: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and rates, each (samples, segments, dofs), of states (samples, size)."""
        shape = (len(states), self.scene.arm.segments, self.dofs)
        q, u = states[:, : self.size], states[:, self.size : 2 * self.size]
        return np.ascontiguousarray(q).reshape(shape), np.ascontiguousarray(u).reshape(shape)

    def displacements(self, y: np.ndarray, change: np.ndarray, inputs: np.ndarray) -> np.ndarray:
        """First-order change of the disks' poses by that of the coordinates, shape (segments, dofs).

        Shape (disks, 3), m, m, rad: the velocities under rates of that size, on a base that does not move.
        """
        q, _ = self.split(y[None, : 2 * self.size])
        _, velocity, _ = self._observed(q, change[None], inputs[None])
        return velocity[0, self.scene.arm.disk_nodes]

    def _observed(
        self, q: np.ndarray, u: np.ndarray, inputs: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
        """Poses and velocities of the nodes, shape (samples, nodes, 3), and the ledger by name."""
        names = [*LEDGER, *(["transport_energy"] if self.scene.arm.base_moves else [])]
        pose, velocity = np.empty((2, *q.shape[:2], 3))
        ledger = np.empty((len(q), len(names)))
        self.kernel.observe(q, u, inputs, self.segments, self.disks, pose, velocity, ledger)
        return pose, velocity, dict(zip(names, ledger.T, strict=True))

    def observe(self, states: np.ndarray, inputs: np.ndarray) -> Observation:
        """Poses, tip speed, energies and powers at states (samples, size) under inputs (samples, inputs)."""
        q, u = self.split(states)
        pose, velocity, ledger = self._observed(q, u, inputs)
        if self.scene.arm.base_moves:
            self.kernel.add_base_power(q, u, inputs, self.segments, self.disks, ledger["input_power"])
        disk_x, disk_y, disk_theta = np.moveaxis(pose[:, self.scene.arm.disk_nodes], -1, 0)
        return Observation(
            coordinates=q,
            rates=u,
            disk_x=disk_x,
            disk_y=disk_y,
            disk_theta=disk_theta,
            tip_speed=np.hypot(velocity[:, -1, 0], velocity[:, -1, 1]),
            transport_energy=ledger.pop("transport_energy", 0.0),
            ledger=ledger,
        )
