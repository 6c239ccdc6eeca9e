"""Kelvin-Voigt damping of the core: stress follows the strain's rate as well."""

from typing import Any, ClassVar

from pydantic.dataclasses import dataclass

from statics.arm import Arm
from statics.effects.effect import Account, Pair, Site
from statics.support.checked import STRICT, NonNegative


@dataclass(frozen=True, config=STRICT)
class MaterialDamping:
    """M = -(eta J / L0) phi' along phi, F = -(eta A / L0) e' along e; ``retardation_time`` is eta / E."""

    retardation_time: NonNegative

    name: ClassVar[str] = "material_damping"
    site: ClassVar[Site] = "segment"
    account: ClassVar[Account] = "dissipated_power"
    acts_at_rest: ClassVar[bool] = False
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ("youngs_modulus", "second_moment")
    quantities: ClassVar[tuple[str, ...]] = ("retardation_time",)
    source: ClassVar[str] = "Linn, Lang and Tuganov 2013, Kelvin-Voigt rods"

    def pairs(self, at: Any) -> list[Pair]:
        """Two pairs: damping moment and bend angle, damping force and elongation."""
        per_length = at.retardation_time / at.rest_length
        return [
            Pair(-per_length * at.bending_stiffness * at.bend_angle_rate, at.bend_angle),
            Pair(-per_length * at.axial_stiffness * at.elongation_rate, at.elongation),
        ]

    def columns(self, arm: Arm) -> dict[str, float]:
        """The retardation time."""
        return {"retardation_time": self.retardation_time}
