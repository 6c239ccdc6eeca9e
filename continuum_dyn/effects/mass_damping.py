"""Damping proportional to mass: the first term of Rayleigh's."""

from typing import Any, ClassVar

from pydantic.dataclasses import dataclass

from statics.arm import Arm
from statics.effects.effect import Account, Pair, Site
from statics.support.checked import STRICT, NonNegative


@dataclass(frozen=True, config=STRICT)
class MassDamping:
    """F = -alpha m v along the position of each mass, M = -alpha I omega along its angle; alpha in 1/s.

    With ``inertia`` and ``rotary_inertia`` every mode of angular frequency omega has the damping ratio
    alpha / (2 omega). The second term of Rayleigh's, proportional to stiffness, is ``material_damping``.
    """

    mass_damping_rate: NonNegative

    name: ClassVar[str] = "mass_damping"
    site: ClassVar[Site] = "mass"
    account: ClassVar[Account] = "dissipated_power"
    acts_at_rest: ClassVar[bool] = False
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ("disk_mass", "disk_inertia")
    quantities: ClassVar[tuple[str, ...]] = ("mass_damping_rate",)
    source: ClassVar[str] = "Rayleigh 1877, The Theory of Sound, vol. 1, sec. 97"

    def pairs(self, at: Any) -> list[Pair]:
        """Two pairs for each mass: damping force and position, damping moment and angle."""
        rate, omega = at.mass_damping_rate, at.angular_velocity
        forces = [Pair(tuple(-rate * m.mass * v for v in m.velocity), m.position) for m in at.masses]
        return forces + [Pair(-rate * m.inertia * omega, at.angle) for m in at.masses]

    def columns(self, arm: Arm) -> dict[str, float]:
        """The rate alpha."""
        return {"mass_damping_rate": self.mass_damping_rate}
