"""Inertia of the masses against acceleration."""

from typing import Any, ClassVar

from pydantic.dataclasses import dataclass

from statics.arm import Arm
from statics.effects.effect import Account, Pair, Site
from statics.errors import InputError
from statics.support.checked import STRICT


@dataclass(frozen=True, config=STRICT)
class Inertia:
    """F = -m a along the position of each mass (d'Alembert)."""

    name: ClassVar[str] = "inertia"
    site: ClassVar[Site] = "mass"
    account: ClassVar[Account] = "kinetic_energy"
    acts_at_rest: ClassVar[bool] = False
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ("disk_mass",)
    quantities: ClassVar[tuple[str, ...]] = ()
    source: ClassVar[str] = "Kane and Levinson 1985, generalized inertia forces"

    def pairs(self, at: Any) -> list[Pair]:
        """A pair for each mass: inertia force, position."""
        return [Pair(tuple(-m.mass * a for a in m.acceleration), m.position) for m in at.masses]

    def columns(self, arm: Arm) -> dict[str, float]:
        """None of its own. Raises ``InputError`` for an arm without any mass."""
        if arm.total_mass == 0.0:
            raise InputError(
                "effect 'inertia': nothing of the arm has mass. Give disk_mass, core_density or a payload."
            )
        return {}
