"""Cables, straight from hole to hole, each under one tension."""

from typing import Any, ClassVar

import numpy as np
from pydantic.dataclasses import dataclass

from statics.arm import Arm, Cable
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


def cable_ways(
    arm: Arm, cable: Cable, disk_x: np.ndarray, disk_y: np.ndarray, disk_theta: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """A cable's straight ways from hole to hole, from the base to its anchor, shape (anchor, 2), m.

    Takes the poses of disks 1..n, shape (disks,), m and rad. Returns the holes' places in the disks as well,
    as seen from the disks' centres, shape (anchor + 1, 2), m; all in base axes. Rone 2012, Eq. 22.
    """
    last = cable.anchor or arm.disks
    theta = np.concatenate([[0.0], disk_theta])[: last + 1]
    center = np.column_stack([np.concatenate([[0.0], disk_x]), np.concatenate([[0.0], disk_y])])
    normal = np.column_stack([-np.sin(theta), np.cos(theta)])
    r_h = cable.holes(arm.disks)[: last + 1, None] * normal
    return np.diff(center[: last + 1] + r_h, axis=0), r_h


def cable_lengths(
    arm: Arm, disk_x: np.ndarray, disk_y: np.ndarray, disk_theta: np.ndarray
) -> list[np.ndarray]:
    """Hole-to-hole lengths of every cable, each of shape (anchor,), m. Rone 2012, Eq. 23."""
    ways = (cable_ways(arm, cable, disk_x, disk_y, disk_theta)[0] for cable in arm.cables)
    return [np.hypot(*way.T) for way in ways]


def drive_tensions(
    arm: Arm, drives: np.ndarray, disk_x: np.ndarray, disk_y: np.ndarray, disk_theta: np.ndarray
) -> np.ndarray:
    """Tension of every cable at the base, shape (cables,), N, from its tension or displacement."""
    lengths = cable_lengths(arm, disk_x, disk_y, disk_theta)
    tensions = np.array(drives[: len(arm.cables)], dtype=float)
    for number, (cable, length) in enumerate(zip(arm.cables, lengths, strict=True)):
        if cable.cable_stiffness is not None:
            stretch = length.sum() - arm.cable_rest_length(cable) + drives[number]
            tensions[number] = cable.cable_stiffness * max(0.0, stretch)
    return tensions


def disk_loads(
    arm: Arm, tension: np.ndarray, disk_x: np.ndarray, disk_y: np.ndarray, disk_theta: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Force and moment of the cables on each disk, as the paper writes them.

    Takes tensions, shape (cables,), N, and the poses of disks 1..n, shape (disks,), m and rad. Returns
    force, shape (disks, 2), N, and moment about the disk's centre, shape (disks,), N m.
    Rone 2012, Eq. 22-25.
    """
    force = np.zeros((arm.disks, 2))
    moment = np.zeros(arm.disks)
    for cable, tau in zip(arm.cables, tension, strict=True):
        p_h, r_h = cable_ways(arm, cable, disk_x, disk_y, disk_theta)
        pull = tau * p_h / np.linalg.norm(p_h, axis=1, keepdims=True)
        on_disk = -pull
        on_disk[:-1] += pull[1:]
        force[: len(pull)] += on_disk
        moment[: len(pull)] += r_h[1:, 0] * on_disk[:, 1] - r_h[1:, 1] * on_disk[:, 0]
    return force, moment
