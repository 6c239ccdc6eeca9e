"""Reaches of a segment: from its near disk to its far end, and to the points that carry its mass.

The reach is a chord at half the angle of its end (Rone 2012, Eq. 11): in axes along it one number, and so its
derivatives stay short.
"""

from dataclasses import dataclass
from typing import Any

import sympy as sp

from statics.derivation.segment import CorePointSymbols, symbol
from statics.derivation.sigma import Sigma
from statics.derivation.trace import Trace
from statics.derivation.virtual_work import SceneForces


@dataclass(frozen=True)
class Reach:
    """An end seen from the segment's near disk, in base axes, with its derivatives by q.

    ``prefix`` begins the names of all that is computed of that end; the far disk's is empty.
    """

    prefix: str
    whole: sp.Matrix  # (2, 1)
    by_q: sp.Matrix  # (2, dofs)
    by_qq: list[list[sp.Matrix]]  # (dofs, dofs) of (2, 1)
    turn_by_q: sp.Matrix  # (1, dofs)

    @property
    def partials(self) -> sp.Matrix:
        """The partials S, shape (3, dofs): the end's pose by the segment's coordinates."""
        return self.by_q.col_join(self.turn_by_q)

    @property
    def transition(self) -> sp.Matrix:
        """The transition X, shape (3, 3): the end's pose by the near disk's."""
        across = turned(self.whole)
        return sp.Matrix([[1, 0, across[0]], [0, 1, across[1]], [0, 0, 1]])


def turned(vector: sp.Matrix) -> sp.Matrix:
    """The product z x vector, in the plane."""
    return sp.Matrix([-vector[1], vector[0]])


def reach_of(forces: SceneForces, trace: Trace | None = None, to: CorePointSymbols | None = None) -> Reach:
    """The reach to the far disk or to a point of the core.

    Derived into ``trace``, or by name only where another step has derived it.
    """
    segment = forces.segment
    prefix, fraction = ("", 1) if to is None else (f"{to.name}_", to.fraction)
    half, dofs = fraction * segment.half_angle, range(len(segment.coordinates))
    along = _along_chord(trace, prefix, half)

    def named(name: str, local: sp.Matrix) -> sp.Matrix:
        if trace is not None:
            return trace.let(prefix + name, along * local)
        return sp.Matrix([symbol(f"{prefix}{name}_{row}") for row in range(2)]) if any(local) else local

    def by(local: sp.Matrix, q: sp.Symbol) -> sp.Matrix:
        return local.diff(q) + half.diff(q) * turned(local)

    d = sp.Matrix([fraction * segment.length * Sigma(0, half), 0])
    d_q = [by(d, q) for q in segment.coordinates]
    second = {
        (a, b): named(f"reach_{a}{b}", by(d_q[a], segment.coordinates[b]))
        for a in dofs
        for b in dofs
        if a <= b
    }
    return Reach(
        prefix,
        named("reach", d),
        sp.Matrix.hstack(*[named(f"reach_q{a}", d_q[a]) for a in dofs]),
        [[second[min(a, b), max(a, b)] for b in dofs] for a in dofs],
        fraction * sp.Matrix([[1, *[0 for _ in segment.coordinates[1:]]]]),
    )


def _along_chord(trace: Trace | None, prefix: str, half: Any) -> sp.Matrix:
    """Rotation from the axes of the chord, at half the angle of its end, to the base's."""
    if trace is None:
        return sp.eye(2)
    cosine, sine = symbol("cosine"), symbol("sine")
    turn_cos, turn_sin = Sigma(-1, half), trace.let(f"{prefix}half_sine", half * Sigma(0, half))
    chord_cos = trace.let(f"{prefix}chord_cosine", cosine * turn_cos - sine * turn_sin)
    chord_sin = trace.let(f"{prefix}chord_sine", sine * turn_cos + cosine * turn_sin)
    return sp.Matrix([[chord_cos, -chord_sin], [chord_sin, chord_cos]])


def core_reaches(forces: SceneForces, trace: Trace | None = None) -> list[tuple[CorePointSymbols, Reach]]:
    """Reaches to the points of the core that carry mass, of which a scene may have none."""
    return [(point, reach_of(forces, trace, point)) for point in forces.core]
