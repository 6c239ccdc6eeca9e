"""Drag of a fast, thin fluid on the disks: proportional to the squares of their speeds."""

from typing import Any, ClassVar

import numpy as np
from pydantic.dataclasses import dataclass

from statics.arm import Arm
from statics.effects.effect import Account, Pair, Site
from statics.support.checked import STRICT, NonNegative


@dataclass(frozen=True, config=STRICT)
class QuadraticDrag:
    """F = -c_2 |v| v along each disk's position, M = -c_r2 |omega| omega along its angle.

    In N s^2/m^2 and N m s^2. For a body of drag coefficient C and frontal area A in a fluid of density rho,
    c_2 is rho C A / 2.
    """

    drag_per_speed_squared: NonNegative
    rotary_drag_per_speed_squared: NonNegative = 0.0

    name: ClassVar[str] = "quadratic_drag"
    site: ClassVar[Site] = "disk"
    account: ClassVar[Account] = "dissipated_power"
    acts_at_rest: ClassVar[bool] = False
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ()
    quantities: ClassVar[tuple[str, ...]] = ("drag_per_speed_squared", "rotary_drag_per_speed_squared")
    source: ClassVar[str] = "Batchelor 1967, sec. 5.11, drag at large Reynolds number"

    def pairs(self, at: Any) -> list[Pair]:
        """Two pairs: drag and position, drag's moment and angle."""
        v_x, v_y = at.velocity
        drag = at.drag_per_speed_squared * at.speed
        moment = at.rotary_drag_per_speed_squared * at.angular_speed * at.angular_velocity
        return [Pair((-drag * v_x, -drag * v_y), at.position), Pair(-moment, at.angle)]

    def columns(self, arm: Arm) -> dict[str, np.ndarray]:
        """Both coefficients, shape (segments,): zero on nodes between disks."""
        values = self.drag_per_speed_squared, self.rotary_drag_per_speed_squared
        return dict(zip(self.quantities, map(arm.at_disks, values), strict=True))
