"""Compiled equations of motion of a scene, with the interface of an integrator."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from continuum_dyn.passes import accelerations, observation
from continuum_dyn.passes.motion_passes import LINEARIZED, MIDPOINT, MOTION
from continuum_dyn.scenario.intervals import Interval
from statics.errors import InputError
from statics.kernels.loading import Family, Kernel, Loader, load
from statics.scene import Scene

LEDGER = ("kinetic_energy", "elastic_energy", "gravity_energy", "input_power", "dissipated_power")


@dataclass(frozen=True)
class Observation:
    """Quantities that follow from states: arrays over samples and disks; ``ledger`` by glossary name.

    ``coordinates`` and ``rates`` have shape (samples, segments, dofs). ``transport_energy`` (J) is what the
    state's ``input_work`` leaves out if the base moves: see ``transport.py``.
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

    def __init__(self, scene: Scene, load: Loader = load) -> None:
        if not scene.has("inertia"):
            raise InputError("motion needs the effect 'inertia'. Add inertia = {} to [effects].")
        self.scene = scene
        self.dofs = len(scene.coordinates)
        self.size = scene.arm.segments * self.dofs
        self.state_size = 2 * self.size + 2
        self.load = load
        self._bound: tuple[Interval | None, Callable[..., None]] = None, lambda: None

    def state(self, coordinates: np.ndarray, rates: np.ndarray | None = None) -> np.ndarray:
        """State from coordinates and rates, shape (segments, dofs), at rest by default; ledger at zero."""
        u = np.zeros_like(coordinates) if rates is None else rates
        return np.concatenate([coordinates.ravel(), u.ravel(), [0.0, 0.0]])

    def rate(self, t: float, y: np.ndarray, interval: Interval) -> np.ndarray:
        """dy/dt."""
        if interval is not self._bound[0]:
            kernel, *tables = self.linearized
            self._bound = (
                interval,
                accelerations.rate.bind(kernel.passes, interval.pieces, *tables, self.dofs),
            )
        y_rate = np.empty_like(y)
        self._bound[1](t, y, y_rate)
        return y_rate

    def jacobian(self, t: float, y: np.ndarray, interval: Interval) -> np.ndarray:
        """d(rate)/dy, exact."""
        kernel, *tables = self.linearized
        jacobian = np.zeros((y.size, y.size))
        accelerations.rate_jacobian(kernel.passes, interval.pieces, *tables, self.dofs, t, y, jacobian)
        return jacobian

    def clearance(self, y: np.ndarray) -> float:
        """Smallest length or hole-to-hole length over L0."""
        return self._clearance(y[: self.size].reshape(-1, self.dofs))

    @cached_property
    def _clearance(self) -> Callable[[np.ndarray], float]:
        kernel, segments, _ = self.motion
        return accelerations.clearance_of.bind(kernel.passes, segments)

    def closest_disk(self, y: np.ndarray) -> int:
        """Number of the disk before which the arm is nearest to a geometric limit."""
        arm, (kernel, table, _) = self.scene.arm, self.motion
        q = y[: self.size].reshape(arm.disks, arm.subsegments, self.dofs)
        segments = table.reshape(*q.shape[:2], -1)
        rows = zip(segments, q, strict=True)
        return int(np.argmin([accelerations.clearance_of(kernel.passes, *row) for row in rows])) + 1

    @cached_property
    def frequency(self) -> float:
        """Scale of the arm's lowest frequency, sqrt((EJ / L) / (m n L^2)), rad/s; 1 without bending."""
        arm = self.scene.arm
        columns = arm.segment_columns()
        stiffness = float(np.mean(columns.get("bending_stiffness", 0.0))) / arm.total_length
        inertia = arm.total_mass * arm.total_length**2
        return float(np.sqrt(stiffness / inertia)) if stiffness else 1.0

    @cached_property
    def slip_speed(self) -> float:
        """Smallest slip speed of the cables that rub, m/s; infinite if none does."""
        kinds = zip(self.scene.arm.cables, self.scene.cable_kinds, strict=False)
        return min((cable.slip_speed for cable, kind in kinds if kind.rubs), default=np.inf)

    def scales(self) -> np.ndarray:
        """Size of each entry of the state that compares with one rad of bending, for absolute tolerances.

        Elongations: the rest length; rates: the same times the arm's frequency; energies: the bending
        stiffness over the rest length. Shape of the state.
        """
        arm = self.scene.arm
        stiffness = arm.segment_columns().get("bending_stiffness", arm.rest_lengths)
        energy = float(np.mean(stiffness)) / arm.rest_length
        q = np.tile([1.0, arm.rest_length][: self.dofs], arm.segments)
        return np.concatenate([q, self.frequency * q, np.full(2, energy)])

    @cached_property
    def motion(self) -> tuple[Kernel, np.ndarray, np.ndarray]:
        """The passes of steps on the chain and of observations, with segment and disk tables."""
        return self._loaded(MOTION)

    @cached_property
    def linearized(self) -> tuple[Kernel, np.ndarray, np.ndarray]:
        """The passes of the right-hand side and of its Jacobian, with segment and disk tables."""
        return self._loaded(LINEARIZED)

    @cached_property
    def midpoint(self) -> tuple[Kernel, np.ndarray, np.ndarray]:
        """The passes of the midpoint rule, with segment and disk tables."""
        return self._loaded(MIDPOINT)

    def _loaded(self, family: Family) -> tuple[Kernel, np.ndarray, np.ndarray]:
        kernel = self.load(self.scene.structure, family)
        tables = ("segment", kernel.segment_columns), ("disk", kernel.disk_columns)
        segments, disks = (self.scene.table(site, columns) for site, columns in tables)
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
        _, velocity, _ = self._observed(q, np.ascontiguousarray(change)[None], inputs[None])
        return velocity[0, self.scene.arm.disk_nodes]

    def _observed(
        self, q: np.ndarray, u: np.ndarray, inputs: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
        """Poses and velocities of the nodes, shape (samples, nodes, 3), and the ledger by name."""
        names = [*LEDGER, *(["transport_energy"] if self.scene.arm.base_moves else [])]
        pose, velocity = np.empty((2, *q.shape[:2], 3))
        ledger = np.empty((len(q), len(names)))
        kernel, *tables = self.motion
        observation.observe(kernel.passes, q, u, inputs, *tables, pose, velocity, ledger)
        return pose, velocity, dict(zip(names, ledger.T, strict=True))

    def observe(self, states: np.ndarray, inputs: np.ndarray) -> Observation:
        """Poses, tip speed, energies and powers at states (samples, size) under inputs (samples, inputs)."""
        q, u = self.split(states)
        pose, velocity, ledger = self._observed(q, u, inputs)
        if self.scene.arm.base_moves:
            power = np.ascontiguousarray(ledger["input_power"])
            ledger["input_power"] = power
            kernel, *tables = self.motion
            observation.add_base_power(kernel.passes, q, u, inputs, *tables, power)
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
