"""Inertia of disks and payloads against angular acceleration in the plane."""

from typing import Any, ClassVar

from pydantic.dataclasses import dataclass

from statics.arm import Arm
from statics.effects.effect import Account, Pair, Site
from statics.support.checked import STRICT


@dataclass(frozen=True, config=STRICT)
class RotaryInertia:
    """M = -I alpha along each disk's angle; I is about an in-plane diameter, Table 1's I_xx.

    A payload's I is about its own centre: what its offset adds is ``inertia``'s.
    """

    name: ClassVar[str] = "rotary_inertia"
    site: ClassVar[Site] = "mass"
    account: ClassVar[Account] = "kinetic_energy"
    acts_at_rest: ClassVar[bool] = False
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ("disk_inertia",)
    quantities: ClassVar[tuple[str, ...]] = ()
    source: ClassVar[str] = "Kane and Levinson 1985, generalized inertia forces"

    def pairs(self, at: Any) -> list[Pair]:
        """A pair for the disk and for each payload: inertia moment, angle of the disk."""
        return [Pair(-m.inertia * at.angular_acceleration, at.angle) for m in at.masses]

    def columns(self, arm: Arm) -> dict[str, float]:
        """None of its own."""
        return {}
