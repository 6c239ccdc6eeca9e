"""Weight of the masses, in any direction of the plane."""

from typing import Any, ClassVar

from pydantic.dataclasses import dataclass

from statics.arm import Arm
from statics.effects.effect import Account, Pair, Site
from statics.support.checked import STRICT, Vector


@dataclass(frozen=True, config=STRICT)
class Gravity:
    """F = m g along the position of each mass; ``acceleration`` is g, m/s^2."""

    acceleration: Vector = (0.0, -9.81)

    name: ClassVar[str] = "gravity"
    site: ClassVar[Site] = "mass"
    account: ClassVar[Account] = "gravity_energy"
    acts_at_rest: ClassVar[bool] = True
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ("disk_mass",)
    quantities: ClassVar[tuple[str, ...]] = ("gravity_x", "gravity_y")
    source: ClassVar[str] = "Rone 2012, Eq. 19"

    def pairs(self, at: Any) -> list[Pair]:
        """A pair for each mass: weight, position."""
        return [Pair((m.mass * at.gravity_x, m.mass * at.gravity_y), m.position) for m in at.masses]

    def columns(self, arm: Arm) -> dict[str, float]:
        """Components of g."""
        return {"gravity_x": self.acceleration[0], "gravity_y": self.acceleration[1]}
