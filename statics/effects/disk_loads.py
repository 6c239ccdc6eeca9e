"""Dead forces and moments on disks: they keep their direction as the arm moves, but may change in time."""

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
    """A force (N) at the centre of one disk and a moment (N m) on it.

    Those of a ``driven`` load are multiplied by a factor that is an input of the motion, as tensions are.
    """

    disk: DiskNumber
    force: Vector = (0.0, 0.0)
    moment: float = 0.0
    driven: bool = False


DRIVEN = ("driven_force_x", "driven_force_y", "driven_moment")
"""What a driven load's factor multiplies."""


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
        """Two pairs, force and position, moment and angle; and two more for each driven load."""
        pairs = [
            Pair((at.load_force_x, at.load_force_y), at.position),
            Pair(at.load_moment, at.angle),
        ]
        for factor, (force_x, force_y), moment in at.driven_loads:
            pairs.append(Pair((factor * force_x, factor * force_y), at.position))
            pairs.append(Pair(factor * moment, at.angle))
        return pairs

    @property
    def driven(self) -> int:
        """Number of the loads that are driven."""
        return sum(load.driven for load in self.loads)

    def columns(self, arm: Arm) -> dict[str, np.ndarray]:
        """Sums over the constant loads of each disk, and each driven load; shape (segments,).

        Zero on nodes between disks. Raises ``InputError`` for a disk beyond the arm.
        """
        constant, columns = np.zeros((3, arm.disks)), {}
        number = 0
        for load in self.loads:
            if load.disk > arm.disks:
                raise InputError(
                    f"load on disk {load.disk}: beyond the arm. Allowed: disks 1 to {arm.disks}."
                )
            target = constant
            if load.driven:
                number, target = number + 1, np.zeros((3, arm.disks))
            target[:, load.disk - 1] += (*load.force, load.moment)
            if load.driven:
                names = (f"{name}_{number}" for name in DRIVEN)
                columns |= dict(zip(names, map(arm.at_disks, target), strict=True))
        return columns | dict(zip(self.quantities, map(arm.at_disks, constant), strict=True))
