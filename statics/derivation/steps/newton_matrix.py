"""Newton matrices of the chain: mass, damping and stiffness, each times its weight."""

from dataclasses import dataclass
from typing import Any

import sympy as sp

from statics.derivation.segment import CableSymbols
from statics.derivation.trace import matrix_by_name, symbol
from statics.derivation.virtual_work import SceneForces


@dataclass(frozen=True)
class Weights:
    """A Newton matrix: mass M + damping C + stiffness K, each times its weight.

    A weight is a number, or a symbol whose value the caller of the pass gives. ``definite`` means that the
    matrix is taken as positive, so that its pivots are inverted as they are; ``coupled`` that cable tensions
    follow the cables' lengths, and are not fixed.
    """

    mass: Any
    damping: Any
    stiffness: Any
    definite: bool = True
    coupled: bool = True

    @property
    def given(self) -> list[sp.Symbol]:
        """The weights that are symbols."""
        return [w for w in (self.mass, self.damping, self.stiffness) if isinstance(w, sp.Symbol)]

    @property
    def of_mass_alone(self) -> bool:
        """Whether the matrix has neither damping nor stiffness."""
        return self.damping == self.stiffness == 0

    def is_symmetric(self, forces: SceneForces) -> bool:
        """Whether the matrix is symmetric in such a scene."""
        return forces.conservative or not self.coupled or self.of_mass_alone

    def coupled_cables(self, forces: SceneForces) -> list[CableSymbols]:
        """The cables that couple all segments in this matrix."""
        return forces.coupled if self.coupled and not self.of_mass_alone else []

    def matrix(self, forces: SceneForces, site: str) -> sp.Matrix:
        """The part of the forces at one site, by the names that an outward pass gave; square."""
        part, symmetric = forces.sites[site], self.is_symmetric(forces)
        return (
            self.mass * matrix_by_name(f"{site}_mass", part.mass, symmetric)
            + self.damping * matrix_by_name(f"{site}_damping", part.damping, symmetric)
            + self.stiffness * matrix_by_name(f"{site}_stiffness", part.stiffness, symmetric)
        )


STATIC = Weights(0, 0, 1, definite=False)
FIXED_TENSION = Weights(0, 0, 1, definite=False, coupled=False)
ACCELERATION = Weights(1, 0, 0)
IMPLICIT = Weights(1, symbol("damping_weight"), symbol("stiffness_weight"))
CONSERVATIVE = Weights(1, 0, symbol("stiffness_weight"))
