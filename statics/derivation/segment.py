"""One constant-curvature segment and one disk in sympy: the symbols that effects are written in.

A segment's coordinates are its bend angle phi = k L and its elongation e = L - L0; the paper's (k, L)
follow from them. With h = phi / 2 its far end is a chord at half the angle (Rone 2012, Eq. 11):

    x = L sigma_0(h) cos h,   y = L sigma_0(h) sin h,   theta = phi

The point of its core at the fraction s of its length is the end of a segment with s phi and s L.
"""

from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import sympy as sp

from statics.arm import CableKind
from statics.derivation.frames import ACCELERATION, POSE, TWIST, norm, rotate, split
from statics.derivation.sigma import Sigma
from statics.derivation.trace import symbol
from statics.errors import did_you_mean
from statics.quantities import QUANTITIES


def _parameter(name: str) -> sp.Symbol:
    if name.startswith("_") or name not in QUANTITIES:
        raise AttributeError(f"no quantity '{name}' in the glossary.{did_you_mean(name, QUANTITIES)}")
    return symbol(name)


class CableSymbols(NamedTuple):
    """One cable from hole to hole: its length (Eq. 23) and its tension.

    ``passes`` is 1 where the cable passes, and 0 beyond its anchor and between disks. ``tension`` is that at
    the base and ``tension_lost`` how much of it friction takes up to here; both are zero where the cable does
    not pass. ``gap`` is the length with a sign: negative once the holes have passed each other. ``angle`` is
    the cable's against the near disk's normal, ``far_angle`` against the far disk's.
    """

    number: int
    kind: CableKind
    passes: Any
    tension: Any
    tension_lost: Any
    length: Any
    gap: Any
    angle: Any
    far_angle: Any


def _cable(number: int, kind: CableKind, length: Any, gap: Any, angle: Any, turn: Any) -> CableSymbols:
    """A cable between two disks, the far one rotated by ``turn`` against the near one."""
    passes = symbol(f"cable_passes_{number}")
    lost = passes * symbol(f"tension_lost_{number}") if kind.rubs else sp.Integer(0)
    tension = passes * symbol(f"tension_{number}")
    return CableSymbols(number, kind, passes, tension, lost, length, gap, angle, angle - turn)


def _hole_offsets(number: int, holes_differ: bool) -> tuple[sp.Symbol, sp.Symbol]:
    """Offsets of a cable's holes at the near and the far disk."""
    far = symbol(f"hole_offset_{number}")
    return (symbol(f"near_hole_offset_{number}") if holes_differ else far), far


class SegmentSymbols:
    """One segment: coordinates, rates, geometry; any other glossary name is a parameter of it.

    Raises ``AttributeError`` for a name that is not in the glossary.
    """

    def __init__(
        self, coordinates: tuple[str, ...], cables: tuple[CableKind, ...], holes_differ: bool = False
    ) -> None:
        self.holes_differ = holes_differ
        self.coordinates = [symbol(name) for name in coordinates]
        self.rates = [symbol(f"{name}_rate") for name in coordinates]
        self.accelerations = [symbol(f"{name}_acceleration") for name in coordinates]
        self.cable_kinds = cables
        extends = "elongation" in coordinates
        self.bend_angle = symbol("bend_angle")
        self.elongation = symbol("elongation") if extends else sp.Integer(0)
        self.bend_angle_rate = symbol("bend_angle_rate")
        self.elongation_rate = symbol("elongation_rate") if extends else sp.Integer(0)
        self.length = symbol("rest_length") + self.elongation

    def __getattr__(self, name: str) -> sp.Symbol:
        return _parameter(name)

    @cached_property
    def half_angle(self) -> Any:
        """Half the bend angle, h = phi / 2, rad."""
        return self.bend_angle / 2

    @cached_property
    def displacement(self) -> sp.Matrix:
        """Far end in the near end's frame, shape (2, 1), m. Rone 2012, Eq. 11."""
        return self.displacement_at(1)

    def displacement_at(self, fraction: float) -> sp.Matrix:
        """Point of the core at a fraction of its length, in the near end's frame, shape (2, 1), m."""
        h = fraction * self.half_angle
        chord = fraction * self.length * Sigma(0, h)
        return sp.Matrix([chord * Sigma(-1, h), chord * h * Sigma(0, h)])

    @cached_property
    def cables(self) -> list[CableSymbols]:
        """Every cable of the scene, along a segment between neighbouring disks."""
        return [self._cable(number, kind) for number, kind in enumerate(self.cable_kinds, start=1)]

    def _cable(self, number: int, kind: CableKind) -> CableSymbols:
        near, far = _hole_offsets(number, self.holes_differ)
        h, mean = self.half_angle, (near + far) / 2
        along = Sigma(0, h) * (self.length - self.bend_angle * mean)
        across = (far - near) * Sigma(-1, h)
        length = sp.sqrt(along**2 + across**2) if self.holes_differ else along
        angle = h + sp.atan(across / along) if self.holes_differ else h
        return _cable(number, kind, length, along, angle, self.bend_angle)


class DrivenLoad(NamedTuple):
    """A load on a disk that changes in time: a factor times a force, in base axes, and a moment."""

    factor: Any
    force: tuple[Any, Any]
    moment: Any


class SpanSymbols:
    """The core from one disk to the next, if it has several segments: the poses of its two ends.

    The span ends at the disk whose pose is x, y, theta, and starts at the one whose names begin with
    ``span_``; any other glossary name is a parameter of it.
    """

    def __init__(self, cables: tuple[CableKind, ...], holes_differ: bool = False) -> None:
        self.cable_kinds = cables
        self.holes_differ = holes_differ
        self.coordinates, self.rates, self.accelerations = (
            [symbol(f"{end}{name}") for end in ("", "span_") for name in names]
            for names in (POSE, TWIST, ACCELERATION)
        )

    def __getattr__(self, name: str) -> sp.Symbol:
        return _parameter(name)

    @cached_property
    def cables(self) -> list[CableSymbols]:
        """Every cable of the scene, straight from hole to hole."""
        return [self._cable(number, kind) for number, kind in enumerate(self.cable_kinds, start=1)]

    def _cable(self, number: int, kind: CableKind) -> CableSymbols:
        x, y, theta, span_x, span_y, span_theta = self.coordinates
        near, far = _hole_offsets(number, self.holes_differ)
        along_x = x - span_x - far * sp.sin(theta) + near * sp.sin(span_theta)
        along_y = y - span_y + far * sp.cos(theta) - near * sp.cos(span_theta)
        mean = (theta + span_theta) / 2
        seen_x, seen_y = rotate((sp.cos(span_theta), -sp.sin(span_theta)), (along_x, along_y))
        return _cable(
            number,
            kind,
            length=sp.sqrt(along_x**2 + along_y**2),
            gap=along_x * sp.cos(mean) + along_y * sp.sin(mean),
            angle=sp.atan2(seen_y, seen_x),
            turn=theta - span_theta,
        )


class MassSymbols(NamedTuple):
    """A mass: kg and kg m^2, and the motion of its centre, vectors in base axes."""

    mass: Any
    inertia: Any
    position: tuple[Any, Any]
    velocity: tuple[Any, Any]
    acceleration: tuple[Any, Any]


class DiskSymbols:
    """One disk, or a node between disks: pose, velocity, acceleration, all in base axes.

    Any other glossary name is a parameter of it. ``payloads`` is the largest number of payloads on one disk;
    ``followers_among_driven`` says of each load that changes in time whether it turns with its disk,
    ``has_followers`` whether any constant load does.
    """

    def __init__(
        self, payloads: int = 0, followers_among_driven: Sequence[bool] = (), has_followers: bool = False
    ) -> None:
        self.number_of_payloads = payloads
        self.followers_among_driven = followers_among_driven
        self.has_followers = has_followers
        self.coordinates, self.rates, self.accelerations = (
            [symbol(name) for name in names] for names in (POSE, TWIST, ACCELERATION)
        )
        self.position, self.angle = split(self.coordinates)
        self.velocity, self.angular_velocity = split(self.rates)
        self.acceleration, self.angular_acceleration = split(self.accelerations)

    def __getattr__(self, name: str) -> sp.Symbol:
        return _parameter(name)

    def rotated(self, along: Any, across: Any) -> tuple[Any, Any]:
        """A vector in base axes from its components along the core's tangent and the disk's y axis."""
        return rotate((sp.cos(self.angle), sp.sin(self.angle)), (along, across))

    @cached_property
    def driven_loads(self) -> list[DrivenLoad]:
        """Every load that changes in time."""
        return [self._driven(*load) for load in enumerate(self.followers_among_driven, start=1)]

    def _driven(self, number: int, follows: bool) -> DrivenLoad:
        force = symbol(f"driven_force_x_{number}"), symbol(f"driven_force_y_{number}")
        return DrivenLoad(
            symbol(f"load_factor_{number}"),
            self.rotated(*force) if follows else force,
            symbol(f"driven_moment_{number}"),
        )

    @cached_property
    def masses(self) -> list[MassSymbols]:
        """The disk's own mass, and its payloads'."""
        mass, inertia = symbol("node_mass"), symbol("node_inertia")
        own = MassSymbols(mass, inertia, self.position, self.velocity, self.acceleration)
        return [own, *(self._payload(number) for number in range(1, self.number_of_payloads + 1))]

    def _payload(self, number: int) -> MassSymbols:
        """A payload with its centre d from the disk's: v + omega z x d, a + alpha z x d - omega^2 d."""
        d_x, d_y = self.rotated(symbol(f"payload_offset_x_{number}"), symbol(f"payload_offset_y_{number}"))
        (x, y), (v_x, v_y), (a_x, a_y) = self.position, self.velocity, self.acceleration
        omega, alpha = self.angular_velocity, self.angular_acceleration
        return MassSymbols(
            symbol(f"payload_mass_{number}"),
            symbol(f"payload_inertia_{number}"),
            (x + d_x, y + d_y),
            (v_x - omega * d_y, v_y + omega * d_x),
            (a_x - alpha * d_y - omega**2 * d_x, a_y + alpha * d_x - omega**2 * d_y),
        )

    @property
    def speed(self) -> Any:
        """The speed |v| of its centre, m/s."""
        return norm(*self.velocity)

    @property
    def angular_speed(self) -> Any:
        """The angular speed |omega|, rad/s."""
        return norm(self.angular_velocity)


class CorePointSymbols:
    """One of the points along a segment that carry the core's own mass: position, velocity, acceleration.

    ``fraction`` is its distance along the core over the segment's length. It has no angle: the core's rotary
    inertia is left out.
    """

    def __init__(self, number: int, fraction: float) -> None:
        self.name = f"core_{number}"
        self.fraction = fraction
        self.position, self.velocity, self.acceleration = (
            (symbol(f"{self.name}_{quantity}_x"), symbol(f"{self.name}_{quantity}_y"))
            for quantity in ("position", "velocity", "acceleration")
        )
        self.angle = self.angular_velocity = self.angular_acceleration = sp.Integer(0)
        self.coordinates = [*self.position]
        self.rates = [*self.velocity]
        self.accelerations = [*self.acceleration]

    def __getattr__(self, name: str) -> sp.Symbol:
        return _parameter(name)

    @cached_property
    def masses(self) -> list[MassSymbols]:
        """The point's own mass, without extent."""
        own = MassSymbols(
            symbol("core_point_mass"), sp.Integer(0), self.position, self.velocity, self.acceleration
        )
        return [own]
