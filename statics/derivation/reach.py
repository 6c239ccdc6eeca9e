"""Reaches of a segment: from its near disk to its far end, and to the points that carry its mass.

The reach is a chord at half the angle of its end (Rone 2012, Eq. 11). In axes along the chord it is a single
number, so its derivatives stay short.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import sympy as sp

from statics.derivation.frames import NEAR_ROTATION, linear, perpendicular, rotate, transition
from statics.derivation.segment import CorePointSymbols
from statics.derivation.sigma import Sigma
from statics.derivation.trace import Trace, derivative, jacobian, symbol_column
from statics.derivation.virtual_work import SceneForces


@dataclass(frozen=True)
class Reach:
    """The vector from a segment's near disk to one of its points, in base axes, and its derivatives by q.

    ``prefix`` begins the names of everything computed of that point; the far disk's is empty.
    """

    prefix: str
    whole: sp.Matrix  # (2, 1), m
    by_q: list[sp.Matrix]  # dofs of (2, 1)
    by_qq: list[list[sp.Matrix]]  # (dofs, dofs) of (2, 1)
    angle_by_q: sp.Matrix  # (1, dofs)

    @property
    def position_partials(self) -> sp.Matrix:
        """The partials of the point's position by the segment's coordinates, shape (2, dofs)."""
        return sp.Matrix.hstack(*self.by_q)

    @property
    def partials(self) -> sp.Matrix:
        """The partials S of the point's pose by the segment's coordinates, shape (3, dofs)."""
        return self.position_partials.col_join(self.angle_by_q)

    @property
    def transition(self) -> sp.Matrix:
        """The partials X of the point's pose by the near disk's, shape (3, 3)."""
        return transition(self.whole)

    @property
    def position_transition(self) -> sp.Matrix:
        """The partials of the point's position by the near disk's pose, shape (2, 3)."""
        return linear(self.transition)


def reach_of(forces: SceneForces, trace: Trace | None = None, to: CorePointSymbols | None = None) -> Reach:
    """The reach to the far disk, or to a point of the core.

    Named in ``trace``; without one by the names that an earlier step gave.
    """
    segment = forces.segment
    prefix, fraction = ("", 1) if to is None else (f"{to.name}_", to.fraction)
    half, dofs = fraction * segment.half_angle, range(len(segment.coordinates))
    rotation = None if trace is None else _chord_rotation(trace, prefix, half)

    def in_base_axes(name: str, vector: sp.Matrix) -> sp.Matrix:
        if trace is not None and rotation is not None:
            return trace.name(prefix + name, sp.Matrix(rotate(rotation, vector)))
        return symbol_column(prefix + name, 2) if any(vector) else vector

    whole, by_q, by_qq = _along_chord(fraction * segment.length, half, tuple(segment.coordinates))
    second = {
        (a, b): in_base_axes(f"reach_{a}{b}", vector)
        for a, row in enumerate(by_qq)
        for b, vector in enumerate(row[a:], start=a)
    }
    return Reach(
        prefix,
        in_base_axes("reach", whole),
        [in_base_axes(f"reach_q{a}", vector) for a, vector in enumerate(by_q)],
        [[second[min(a, b), max(a, b)] for b in dofs] for a in dofs],
        fraction * sp.Matrix([[1, *[0 for _ in segment.coordinates[1:]]]]),
    )


@cache
def _along_chord(length: Any, half: Any, coordinates: tuple[sp.Symbol, ...]) -> tuple[Any, Any, Any]:
    """A reach in axes along its chord, which stands at half the end's angle; derivatives by q and by q, q."""

    def by(vector: sp.Matrix, q: sp.Symbol) -> sp.Matrix:
        return jacobian(vector, [q]) + derivative(half, q) * perpendicular(vector)

    whole = sp.Matrix([length * Sigma(0, half), 0])
    by_q = [by(whole, q) for q in coordinates]
    return whole, by_q, [[by(vector, q) for q in coordinates] for vector in by_q]


def _chord_rotation(trace: Trace, prefix: str, half: Any) -> tuple[Any, Any]:
    """Cosine and sine of the chord's angle in base axes: the near disk's and half the angle of the end."""
    half_turn = Sigma(-1, half), trace.name(f"{prefix}half_sine", half * Sigma(0, half))
    cosine, sine = rotate(NEAR_ROTATION, half_turn)
    return trace.name(f"{prefix}chord_cosine", cosine), trace.name(f"{prefix}chord_sine", sine)


def core_reaches(forces: SceneForces, trace: Trace | None = None) -> list[tuple[CorePointSymbols, Reach]]:
    """The points of the core that carry mass, none in some scenes, each with its reach."""
    return [(point, reach_of(forces, trace, point)) for point in forces.core]
