"""Bending of the core: a moment proportional to the change of curvature."""

from typing import Any, ClassVar

from pydantic.dataclasses import dataclass

from statics.arm import Arm
from statics.effects.effect import Account, Pair, Site
from statics.support.checked import STRICT


@dataclass(frozen=True, config=STRICT)
class Bending:
    """M = -(EJ / L0) (phi - k0 L0) along phi, on each segment."""

    name: ClassVar[str] = "bending"
    site: ClassVar[Site] = "segment"
    account: ClassVar[Account] = "elastic_energy"
    acts_at_rest: ClassVar[bool] = True
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ("youngs_modulus", "second_moment")
    quantities: ClassVar[tuple[str, ...]] = ()
    source: ClassVar[str] = "Rone 2012, Eq. 20"

    def pairs(self, at: Any) -> list[Pair]:
        """One pair: bending moment, bend angle."""
        bend = at.bend_angle - at.reference_curvature * at.rest_length
        return [Pair(-(at.bending_stiffness / at.rest_length) * bend, at.bend_angle)]

    def columns(self, arm: Arm) -> dict[str, float]:
        """None of its own."""
        return {}
