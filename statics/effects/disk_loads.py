"""Forces and moments on disks, dead or turning with their disk; either may change in time.

A dead force keeps its direction as the arm moves, and has the potential -F . r. A follower force has none:
its work depends on the way (Bolotin 1963).
"""

from dataclasses import field
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass

from statics.arm import Arm, DiskNumber
from statics.effects.effect import Account, Pair, Site
from statics.errors import InputError
from statics.support.checked import STRICT, Vector


@dataclass(frozen=True, config=STRICT)
class DiskLoad:
    """A force (N) at the centre of one disk and a moment (N m) on it.

    The force of a ``follower`` turns with its disk: its components are along the core's tangent there and
    along the disk's y axis. Force and moment of a ``driven`` load are multiplied by a factor that is an input
    of the motion, as tensions are.
    """

    disk: DiskNumber
    force: Vector = (0.0, 0.0)
    moment: float = 0.0
    driven: bool = False
    follower: bool = False


DRIVEN = ("driven_force_x", "driven_force_y", "driven_moment")
"""Components that a driven load's factor multiplies; its force is in the disk's axes if it follows."""
FOLLOWING = ("follower_force_x", "follower_force_y")
"""Sums over the constant loads that turn with their disk, in its axes."""


@dataclass(frozen=True, config=STRICT)
class DiskLoads:
    """F along the disk's position, M along its angle; loads on one disk add up.

    With R the rotation of its disk, a follower's force is R F.
    """

    loads: Annotated[tuple[DiskLoad, ...], Field(strict=False)] = field(default=())

    name: ClassVar[str] = "loads"
    site: ClassVar[Site] = "disk"
    account: ClassVar[Account] = "input_power"
    acts_at_rest: ClassVar[bool] = True
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ()
    quantities: ClassVar[tuple[str, ...]] = ("load_force_x", "load_force_y", "load_moment")
    source: ClassVar[str] = "Rone 2012, Eq. 7"

    def pairs(self, at: Any) -> list[Pair]:
        """Two pairs, force and position, moment and angle; one for followers; two for each driven load."""
        pairs = [
            Pair((at.load_force_x, at.load_force_y), at.position),
            Pair(at.load_moment, at.angle),
        ]
        if at.has_followers:
            pairs.append(Pair(at.rotated(at.follower_force_x, at.follower_force_y), at.position))
        for factor, (force_x, force_y), moment in at.driven_loads:
            pairs.append(Pair((factor * force_x, factor * force_y), at.position))
            pairs.append(Pair(factor * moment, at.angle))
        return pairs

    @property
    def driven(self) -> tuple[DiskLoad, ...]:
        """The loads that are driven."""
        return tuple(load for load in self.loads if load.driven)

    @property
    def has_followers(self) -> bool:
        """Whether some load that is not driven turns with its disk."""
        return any(load.follower and not load.driven for load in self.loads)

    def columns(self, arm: Arm) -> dict[str, np.ndarray]:
        """Sums over the constant loads of each disk, and each driven load; shape (segments,).

        Zero on nodes between disks. Raises ``InputError`` for a disk beyond the arm.
        """
        for load in self.loads:
            if load.disk > arm.disks:
                kind = "follower load" if load.follower else "load"
                raise InputError(
                    f"{kind} on disk {load.disk}: beyond the arm. Allowed: disks 1 to {arm.disks}."
                )
        dead, following = np.zeros((3, arm.disks)), np.zeros((2, arm.disks))
        for load in self.loads:
            if not load.driven:
                (following if load.follower else dead)[:2, load.disk - 1] += load.force
                dead[2, load.disk - 1] += load.moment
        columns = dict(zip(self.quantities, dead, strict=True))
        if self.has_followers:
            columns |= dict(zip(FOLLOWING, following, strict=True))
        for number, load in enumerate(self.driven, start=1):
            for name, value in zip(DRIVEN, (*load.force, load.moment), strict=True):
                columns[f"{name}_{number}"] = np.where(np.arange(arm.disks) == load.disk - 1, value, 0.0)
        return {name: arm.at_disks(values) for name, values in columns.items()}
