"""Extension of the core: an axial force proportional to the change of length."""

from typing import Any, ClassVar

from pydantic.dataclasses import dataclass

from statics.arm import Arm
from statics.effects.effect import Account, Pair, Site
from statics.support.checked import STRICT


@dataclass(frozen=True, config=STRICT)
class Extension:
    """F = -(EA / L0) e along e, on each segment; it brings the coordinate ``elongation``.

    The printed Eq. 21 gives the two ends of a segment different directions, a pair that does not
    balance; as a load along the elongation it does.
    """

    name: ClassVar[str] = "extension"
    site: ClassVar[Site] = "segment"
    account: ClassVar[Account] = "elastic_energy"
    acts_at_rest: ClassVar[bool] = True
    coordinates: ClassVar[tuple[str, ...]] = ("elongation",)
    arm_quantities: ClassVar[tuple[str, ...]] = ("youngs_modulus", "area")
    quantities: ClassVar[tuple[str, ...]] = ()
    source: ClassVar[str] = "Rone 2012, Eq. 21, as a conservative pair"

    def pairs(self, at: Any) -> list[Pair]:
        """One pair: axial force, elongation."""
        return [Pair(-(at.axial_stiffness / at.rest_length) * at.elongation, at.elongation)]

    def columns(self, arm: Arm) -> dict[str, float]:
        """None of its own."""
        return {}
