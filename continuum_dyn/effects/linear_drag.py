"""Drag of a slow, thick fluid on the disks: proportional to their speeds."""

from typing import Any, ClassVar

import numpy as np
from pydantic.dataclasses import dataclass

from statics.arm import Arm
from statics.effects.effect import Account, Pair, Site
from statics.support.checked import STRICT, NonNegative


@dataclass(frozen=True, config=STRICT)
class LinearDrag:
    """F = -c v along each disk's position, M = -c_r omega along its angle; N s/m and N m s."""

    drag_per_speed: NonNegative
    rotary_drag_per_speed: NonNegative = 0.0

    name: ClassVar[str] = "linear_drag"
    site: ClassVar[Site] = "disk"
    account: ClassVar[Account] = "dissipated_power"
    acts_at_rest: ClassVar[bool] = False
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ()
    quantities: ClassVar[tuple[str, ...]] = ("drag_per_speed", "rotary_drag_per_speed")
    source: ClassVar[str] = "Batchelor 1967, sec. 4.9, Stokes' law"

    def pairs(self, at: Any) -> list[Pair]:
        """Two pairs: drag and position, drag's moment and angle."""
        v_x, v_y = at.velocity
        return [
            Pair((-at.drag_per_speed * v_x, -at.drag_per_speed * v_y), at.position),
            Pair(-at.rotary_drag_per_speed * at.angular_velocity, at.angle),
        ]

    def columns(self, arm: Arm) -> dict[str, np.ndarray]:
        """Both coefficients, shape (segments,): zero on nodes between disks."""
        values = self.drag_per_speed, self.rotary_drag_per_speed
        return dict(zip(self.quantities, map(arm.at_disks, values), strict=True))
