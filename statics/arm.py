"""The arm as data: its core, its disks, its cables; and the arm of Rone's Table 1.

Positive senses, everywhere in the program::

      y ^            hole at +hole_offset
        |        .---o---.                 bend_angle > 0 : the tip turns counter-clockwise,
        |        | disk 1|                                  towards +y
    ----+========|===+===|=========...     elongation > 0 : the segment is longer than disk_spacing
     base   seg. 1   |   |   seg. 2        tension    > 0 : the cable pulls
        |        '-------'                 disk_theta > 0 : the disk has turned counter-clockwise
        +-----------------------> x

A cable on the +y side bends the arm towards +y. Disks and segments count from 1 at the base. Segment i
ends in node i: the centre of disk i or, with ``subsegments`` segments from disk to disk, every
``subsegments``-th node is the centre of a disk, and the others are points of the core.
"""

from collections import Counter
from dataclasses import field
from math import pi
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass

from statics.core_mass import AT_END, AT_POINT
from statics.errors import InputError, did_you_mean
from statics.support.checked import STRICT, NonNegative, Positive, Vector

MAX_SEGMENTS = 10_000

DiskNumber = Annotated[int, Field(ge=1, le=MAX_SEGMENTS)]
Subsegments = Annotated[int, Field(ge=1, le=MAX_SEGMENTS)]


@dataclass(frozen=True, config=STRICT)
class Cable:
    """A cable through a hole of every disk up to its anchor; ``anchor=None`` is the last disk.

    With a ``start`` it reaches that disk in a sheath of constant length that is fixed there, like a Bowden
    cable: the disks before it feel nothing of the cable, and that disk is to it what the base is otherwise.
    ``hole_offset`` (m) is one number, or one for the base and each disk up to the anchor. With a
    ``cable_stiffness`` (N/m) the cable is driven by its length: its displacement, how much of it is drawn in
    at the base, is given, and its tension follows. ``friction`` is the coefficient at its holes, and
    ``slip_speed`` (m/s) that of the cable through a hole at which friction is three quarters of its most.
    """

    name: str
    hole_offset: float | Annotated[tuple[float, ...], Field(strict=False)]
    anchor: DiskNumber | None = None
    cable_stiffness: Positive | None = None
    friction: NonNegative = 0.0
    slip_speed: Positive = 1e-5
    start: DiskNumber | None = None

    @property
    def driven_by_length(self) -> bool:
        """Whether its displacement is given, not its tension."""
        return self.cable_stiffness is not None

    @property
    def holes_differ(self) -> bool:
        """Whether its holes do not all have the same offset."""
        return isinstance(self.hole_offset, tuple) and len(set(self.hole_offset)) > 1

    def holes(self, disks: int) -> np.ndarray:
        """Offsets of its holes in the base and in each disk, shape (disks + 1,), m; the last one goes on."""
        given = np.atleast_1d(np.asarray(self.hole_offset, dtype=float))
        return given[np.minimum(np.arange(max(disks + 1, given.size)), given.size - 1)]


class CableKind(NamedTuple):
    """Kind of a cable's equations: whether its length is given, not its tension, and whether it rubs."""

    driven_by_length: bool = False
    rubs: bool = False

    @property
    def coupled(self) -> bool:
        """Whether its tension depends on all the segments that it passes."""
        return self.driven_by_length or self.rubs


PositiveList = Annotated[tuple[Positive, ...], Field(strict=False, min_length=1)]
MassList = Annotated[tuple[NonNegative, ...], Field(strict=False, min_length=1)]


@dataclass(frozen=True, config=STRICT)
class PerDisk:
    """Numbers of an arm whose disks, or the cores before them, differ: one for each disk, from the base on.

    They override the arm's single number of that name.
    """

    disk_spacing: PositiveList | None = None
    youngs_modulus: PositiveList | None = None
    area: PositiveList | None = None
    second_moment: PositiveList | None = None
    disk_mass: MassList | None = None
    disk_inertia: MassList | None = None
    reference_curvature: Annotated[tuple[float, ...], Field(strict=False)] | None = None


@dataclass(frozen=True, config=STRICT)
class Payload:
    """A body fixed to a disk: its mass (kg), and moment of inertia (kg m^2) about its own centre.

    ``offset`` (m) leads to its centre from the disk's: along the core's tangent there, and along the disk's
    y axis.
    """

    disk: DiskNumber
    mass: NonNegative
    inertia: NonNegative = 0.0
    offset: Vector = (0.0, 0.0)


@dataclass(frozen=True, config=STRICT)
class Base:
    """Mount of the arm: the core starts at (x, y), m, at an ``angle`` (rad) to the x axis.

    If it ``moves``, this is its pose at the start, and its motion is an input.
    """

    x: float = 0.0
    y: float = 0.0
    angle: float = 0.0
    moves: bool = False


RONE2012: dict[str, Any] = {
    # Rone and Ben-Tzvi 2012, Table 1. In-plane rotation is about a disk's diameter: I_xx, not I_zz.
    "disks": 4,  # n
    "disk_spacing": 0.02,  # L_0
    "youngs_modulus": 2.10e11,  # E
    "area": 5.027e-7,  # A
    "second_moment": 2.011e-14,  # J_xx
    "disk_mass": 7.782e-4,  # m
    "disk_inertia": 2.029e-8,  # I_xx
}
PRESETS: dict[str, dict[str, Any]] = {"rone2012": RONE2012}

RONE2012_HOLE_OFFSET = 0.008
"""r_h of Table 1, m."""


@dataclass(frozen=True, config=STRICT)
class Arm:
    """A planar arm. A number may stay None if no effect of the scene needs it; ``each`` has what differs.

    ``subsegments`` segments of constant curvature make the core from disk to disk. ``core_density`` gives the
    core a mass of its own, spread along each segment; ``disk_mass`` is then a disk's alone. Without a
    ``base`` the core starts at the origin, along x. Raises ``InputError`` for cables and payloads that do not
    fit, ``pydantic.ValidationError`` (a ``ValueError``) for numbers of the wrong kind or sign.
    """

    disks: DiskNumber
    disk_spacing: Positive
    youngs_modulus: Positive | None = None
    area: Positive | None = None
    second_moment: Positive | None = None
    disk_mass: NonNegative | None = None
    disk_inertia: NonNegative | None = None
    core_density: Positive | None = None
    reference_curvature: float = 0.0
    subsegments: Subsegments = 1
    each: PerDisk = field(default=PerDisk())
    cables: Annotated[tuple[Cable, ...], Field(strict=False)] = field(default=())
    payloads: Annotated[tuple[Payload, ...], Field(strict=False)] = field(default=())
    base: Base | None = None

    def __post_init__(self) -> None:
        if self.segments > MAX_SEGMENTS:
            raise InputError(
                f"{self.disks} disks with subsegments = {self.subsegments} make {self.segments} segments. "
                f"Allowed: {MAX_SEGMENTS}."
            )
        if self.core_density is not None and not self.has("area"):
            raise InputError("core_density needs the arm's area, which is not given. Give area.")
        for name, values in vars(self.each).items():
            if values is not None and len(values) != self.disks:
                raise InputError(f"{name}: {len(values)} numbers for {self.disks} disks. Give one for each.")
        for cable in self.cables:
            self._check(cable)
        for payload in self.payloads:
            if payload.disk > self.disks:
                raise InputError(
                    f"payload on disk {payload.disk}: beyond the arm. Allowed: disks 1 to {self.disks}."
                )
        for name, count in Counter(cable.name for cable in self.cables).items():
            if count > 1:
                raise InputError(f"{count} cables are named '{name}'. Give each its own name.")

    def _check(self, cable: Cable) -> None:
        if cable.anchor is not None and cable.anchor > self.disks:
            raise InputError(
                f"cable '{cable.name}': anchor {cable.anchor} is beyond the arm. "
                f"Allowed: disks 1 to {self.disks}."
            )
        last = cable.anchor or self.disks
        if cable.start is not None and cable.start >= last:
            raise InputError(
                f"cable '{cable.name}': start {cable.start} is not before its anchor, disk {last}. "
                f"Allowed: disks 1 to {last - 1}, or none for the base."
            )
        if isinstance(cable.hole_offset, tuple) and len(cable.hole_offset) != last + 1:
            raise InputError(
                f"cable '{cable.name}': {len(cable.hole_offset)} hole_offsets. Give one number, or "
                f"{last + 1}: for the base and each of the {last} disks up to the anchor."
            )
        holes = cable.holes(self.disks)
        across = self.per_disk("reference_curvature") * (holes[1:] + holes[:-1]) / 2
        if (np.abs(across) >= 1).any():
            raise InputError(
                f"cable '{cable.name}': reference_curvature x hole_offset is "
                f"{across[np.abs(across).argmax()]:g}, so its holes meet in the unloaded arm. "
                "Allowed: between -1 and 1. Reduce reference_curvature or hole_offset."
            )

    @classmethod
    def preset(cls, name: str, **changes: Any) -> "Arm":
        """An arm from the literature; ``changes`` override the preset.

        Raises ``InputError`` for a name that is not a preset.
        """
        if name not in PRESETS:
            raise InputError(f"unknown preset '{name}'.{did_you_mean(name, PRESETS)}")
        return cls(**{**PRESETS[name], **changes})

    @staticmethod
    def round_core(radius: float, inner_radius: float = 0.0) -> dict[str, float]:
        """Area and second moment of a round core or a tube of these radii (m), as arguments of ``Arm``."""
        return {
            "area": pi * (radius**2 - inner_radius**2),
            "second_moment": pi * (radius**4 - inner_radius**4) / 4,
        }

    @staticmethod
    def round_disk(
        mass: float, radius: float, thickness: float, inner_radius: float = 0.0
    ) -> dict[str, float]:
        """Mass (kg) and in-plane moment of inertia (kg m^2) of a disk or a ring, as arguments of ``Arm``.

        Of a body of even density, these radii and that thickness (m): m (3 (R^2 + r^2) + h^2) / 12.
        """
        squares = 3 * (radius**2 + inner_radius**2) + thickness**2
        return {"disk_mass": mass, "disk_inertia": mass * squares / 12}

    def has(self, name: str) -> bool:
        """Whether the number of that name is given, once or for each disk."""
        return getattr(self, name) is not None or getattr(self.each, name, None) is not None

    def per_disk(self, name: str) -> np.ndarray:
        """A number that is known, for each disk or the core before it, shape (disks,)."""
        given = getattr(self.each, name)
        return np.full(self.disks, getattr(self, name) if given is None else given, dtype=float)

    @property
    def rest_length(self) -> float:
        """Undeformed length of a segment, in the mean, m."""
        return self.total_length / self.segments

    @property
    def rest_lengths(self) -> np.ndarray:
        """Undeformed length L0 of each segment, shape (segments,), m."""
        return np.repeat(self.per_disk("disk_spacing") / self.subsegments, self.subsegments)

    @property
    def segments(self) -> int:
        """Number of segments, and of the nodes that they end in."""
        return self.disks * self.subsegments

    @property
    def disk_nodes(self) -> slice:
        """Indices of the nodes that are disks."""
        return slice(self.subsegments - 1, None, self.subsegments)

    @property
    def base_pose(self) -> tuple[float, float, float]:
        """x, y (m) and angle (rad) of the base, at the start of a motion if it moves."""
        return (0.0, 0.0, 0.0) if self.base is None else (self.base.x, self.base.y, self.base.angle)

    @property
    def base_moves(self) -> bool:
        """Whether the base moves."""
        return self.base is not None and self.base.moves

    @property
    def total_length(self) -> float:
        """Undeformed length of the whole arm, m."""
        return float(self.per_disk("disk_spacing").sum())

    @property
    def cable_names(self) -> tuple[str, ...]:
        """Names of the cables, in the order of the tensions."""
        return tuple(cable.name for cable in self.cables)

    @property
    def holes_differ(self) -> bool:
        """Whether some cable's holes differ in their offsets."""
        return any(cable.holes_differ for cable in self.cables)

    def segment_columns(self) -> dict[str, np.ndarray]:
        """Values on each segment, by glossary name, shape (segments,)."""
        columns = {"rest_length": self.rest_lengths}
        columns["disk_spacing"] = self._along("disk_spacing")
        columns["reference_curvature"] = self._along("reference_curvature")
        for stiffness, of_section in (("bending_stiffness", "second_moment"), ("axial_stiffness", "area")):
            if self.has("youngs_modulus") and self.has(of_section):
                columns[stiffness] = self._along("youngs_modulus") * self._along(of_section)
        if self.core_density is not None:
            columns["core_point_mass"] = AT_POINT * self.core_masses
        disk, is_disk = np.divmod(np.arange(1, self.segments + 1), self.subsegments)
        columns["span_start"] = np.roll(is_disk == 0, 1).astype(float)
        for number, cable in enumerate(self.cables, start=1):
            holes = cable.holes(self.disks)
            columns[f"hole_offset_{number}"] = np.repeat(holes[1:], self.subsegments)
            columns[f"near_hole_offset_{number}"] = np.repeat(holes[:-1], self.subsegments)
            felt = (disk > (cable.start or 0)) & (disk <= (cable.anchor or self.disks))
            passes = (is_disk == 0) & felt
            columns[f"cable_passes_{number}"] = passes.astype(float)
            if cable.cable_stiffness is not None:
                columns[f"cable_stiffness_{number}"] = np.full(self.segments, cable.cable_stiffness)
                columns[f"cable_rest_length_{number}"] = np.full(self.segments, self.cable_rest_length(cable))
        return columns

    def cable_rest_length(self, cable: Cable) -> float:
        """Length of a cable from its first hole to its anchor, along the unloaded arm, m. Eq. 23."""
        holes, spacing = cable.holes(self.disks), self.per_disk("disk_spacing")
        half = self.per_disk("reference_curvature") * spacing / 2
        along = np.sinc(half / pi) * (spacing - half * (holes[1:] + holes[:-1]))
        lengths = np.hypot(along, np.diff(holes) * np.cos(half))
        return float(lengths[cable.start or 0 : cable.anchor or self.disks].sum())

    def _along(self, name: str) -> np.ndarray:
        """A number of the core before each disk, for each segment, shape (segments,)."""
        return np.repeat(self.per_disk(name), self.subsegments)

    def node_columns(self) -> dict[str, np.ndarray]:
        """Values on each node, by glossary name, shape (segments,)."""
        columns = {}
        if self.has("disk_mass"):
            columns["node_mass"] = self.at_disks(self.per_disk("disk_mass")) + self._core_ends()
        if self.has("disk_inertia"):
            columns["node_inertia"] = self.at_disks(self.per_disk("disk_inertia"))
        return columns | self._payload_columns()

    @property
    def payloads_on_a_disk(self) -> int:
        """Largest number of payloads on one disk."""
        return max(Counter(payload.disk for payload in self.payloads).values(), default=0)

    def _payload_columns(self) -> dict[str, np.ndarray]:
        """The first, second, ... payload of every node, shape (segments,); zero if there is none."""
        names = ("payload_mass", "payload_inertia", "payload_offset_x", "payload_offset_y")
        values = np.zeros((self.payloads_on_a_disk, len(names), self.disks))
        placed = Counter[int]()
        for payload in self.payloads:
            numbers = (payload.mass, payload.inertia, *payload.offset)
            values[placed[payload.disk], :, payload.disk - 1] = numbers
            placed[payload.disk] += 1
        return {
            f"{name}_{number}": self.at_disks(value)
            for number, of_payload in enumerate(values, start=1)
            for name, value in zip(names, of_payload, strict=True)
        }

    @property
    def core_masses(self) -> np.ndarray:
        """The core's own mass in each segment, shape (segments,), kg; none without ``core_density``."""
        if self.core_density is None:
            return np.zeros(self.segments)
        return self.core_density * self._along("area") * self.rest_lengths

    @property
    def total_mass(self) -> float:
        """Mass of disks, core and payloads, kg; the arm must know its ``disk_mass``."""
        payloads = sum(payload.mass for payload in self.payloads)
        return float(self.per_disk("disk_mass").sum() + self.core_masses.sum()) + payloads

    @property
    def massless_nodes(self) -> bool:
        """Whether some nodes carry no mass: none of a disk, of the core, or of a payload."""
        columns = self.node_columns().items()
        masses = [values for name, values in columns if name.startswith(("node_mass", "payload_mass"))]
        return not np.all(np.sum(masses, axis=0) > 0.0)

    def at_disks(self, values: np.ndarray | float) -> np.ndarray:
        """Spread values on disks, shape (disks,) or a scalar, over all nodes, shape (segments,)."""
        spread = np.zeros(self.segments)
        spread[self.disk_nodes] = values
        return spread

    def on_nodes(self, of_segments: np.ndarray) -> np.ndarray:
        """Put half of each segment's value on either end, shape (segments,).

        The base takes the other half of the first.
        """
        return (of_segments + np.append(of_segments[1:], 0.0)) / 2

    def _core_ends(self) -> np.ndarray:
        """The part of the core's mass at quadrature points that are nodes, shape (segments,), kg."""
        return AT_END * (self.core_masses + np.append(self.core_masses[1:], 0.0))
