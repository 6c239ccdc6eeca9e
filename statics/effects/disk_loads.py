"""Dead forces and moments on disks: they keep their direction as the arm moves."""

from dataclasses import field
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass

from statics.arm import Arm, DiskNumber
from statics.checked import STRICT, Vector
from statics.effects.effect import Account, Pair, Place
from statics.errors import InputError


@dataclass(frozen=True, config=STRICT)
class DiskLoad:
    """A force (N) at the centre of one disk and a moment (N m) on it."""

    disk: DiskNumber
    force: Vector = (0.0, 0.0)
    moment: float = 0.0


@dataclass(frozen=True, config=STRICT)
class DiskLoads:
    """F along the disk's position, M along its angle; loads on one disk add up."""

    loads: Annotated[tuple[DiskLoad, ...], Field(strict=False)] = field(default=())

    name: ClassVar[str] = "loads"
    place: ClassVar[Place] = "disk"
    account: ClassVar[Account] = "input_power"
    acts_at_rest: ClassVar[bool] = True
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ()
    quantities: ClassVar[tuple[str, ...]] = ("load_force_x", "load_force_y", "load_moment")
    source: ClassVar[str] = "Rone 2012, Eq. 7"

    def pairs(self, at: Any) -> list[Pair]:
        """Two pairs: force and position, moment and angle."""
        return [
            Pair((at.load_force_x, at.load_force_y), at.position),
            Pair(at.load_moment, at.angle),
        ]

    def columns(self, arm: Arm) -> dict[str, np.ndarray]:
        """Sums over the loads of each disk, shape (segments,): zero on nodes between disks.

        Raises ``InputError`` for a disk beyond the arm.
        """
        total = np.zeros((3, arm.disks))
        for load in self.loads:
            if load.disk > arm.disks:
                raise InputError(
                    f"load on disk {load.disk}: beyond the arm. Allowed: disks 1 to {arm.disks}."
                )
            total[:, load.disk - 1] += (*load.force, load.moment)
        return dict(zip(self.quantities, map(arm.at_disks, total), strict=True))
