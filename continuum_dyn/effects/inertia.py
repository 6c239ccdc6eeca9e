"""Inertia of the masses against acceleration."""

from typing import Any, ClassVar

from pydantic.dataclasses import dataclass

from statics.arm import Arm
from statics.checked import STRICT
from statics.effects.effect import Account, Pair, Place


@dataclass(frozen=True, config=STRICT)
class Inertia:
    """F = -m a along each node's position (d'Alembert)."""

    name: ClassVar[str] = "inertia"
    place: ClassVar[Place] = "disk"
    account: ClassVar[Account] = "kinetic_energy"
    acts_at_rest: ClassVar[bool] = False
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ("disk_mass",)
    quantities: ClassVar[tuple[str, ...]] = ()
    source: ClassVar[str] = "Kane and Levinson 1985, generalized inertia forces"

    def pairs(self, at: Any) -> list[Pair]:
        """One pair: inertia force, position of the node."""
        a_x, a_y = at.acceleration
        return [Pair((-at.node_mass * a_x, -at.node_mass * a_y), at.position)]

    def columns(self, arm: Arm) -> dict[str, float]:
        """None of its own."""
        return {}
