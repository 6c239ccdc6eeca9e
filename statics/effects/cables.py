"""Frictionless cables, straight from hole to hole, each under one tension."""

from typing import Any, ClassVar

import numpy as np
from pydantic.dataclasses import dataclass

from statics.arm import Arm
from statics.checked import STRICT
from statics.effects.effect import Account, Pair, Place


@dataclass(frozen=True, config=STRICT)
class Cables:
    """F = -tau along the hole-to-hole length l, for each of the arm's cables, up to its anchor."""

    name: ClassVar[str] = "cables"
    place: ClassVar[Place] = "span"
    account: ClassVar[Account] = "input_power"
    acts_at_rest: ClassVar[bool] = True
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ("cables",)
    quantities: ClassVar[tuple[str, ...]] = ()
    source: ClassVar[str] = "Rone 2012, Eq. 22-24"

    def pairs(self, at: Any) -> list[Pair]:
        """A pair for each cable: tension (against), hole-to-hole length."""
        return [Pair(-cable.tension, cable.length) for cable in at.cables]

    def columns(self, arm: Arm) -> dict[str, float]:
        """None of its own: cables are the arm's."""
        return {}


def disk_loads(
    arm: Arm, tension: np.ndarray, disk_x: np.ndarray, disk_y: np.ndarray, disk_theta: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Force and moment of the cables on each disk, as the paper writes them.

    Takes tensions, shape (cables,), N, and the poses of disks 1..n, shape (disks,), m and rad; the base is
    where the arm has it. Returns
    force, shape (disks, 2), N, and moment about the disk's centre, shape (disks,), N m.
    Rone 2012, Eq. 22-25.
    """
    base_x, base_y, base_theta = arm.base_pose
    theta = np.concatenate([[base_theta], disk_theta])
    center = np.column_stack([np.concatenate([[base_x], disk_x]), np.concatenate([[base_y], disk_y])])
    normal = np.column_stack([-np.sin(theta), np.cos(theta)])
    force = np.zeros((arm.disks, 2))
    moment = np.zeros(arm.disks)
    for cable, tau in zip(arm.cables, tension, strict=True):
        last = cable.anchor or arm.disks
        r_h = cable.holes(arm.disks)[: last + 1, None] * normal[: last + 1]
        p_h = np.diff(center[: last + 1] + r_h, axis=0)
        pull = tau * p_h / np.linalg.norm(p_h, axis=1, keepdims=True)
        on_disk = -pull
        on_disk[:-1] += pull[1:]
        force[:last] += on_disk
        moment[:last] += r_h[1:, 0] * on_disk[:, 1] - r_h[1:, 1] * on_disk[:, 0]
    return force, moment
