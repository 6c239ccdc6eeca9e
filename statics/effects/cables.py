"""Cables, straight from hole to hole, each under one tension."""

from typing import Any, ClassVar

import numpy as np
from pydantic.dataclasses import dataclass

from statics.arm import Arm, Cable
from statics.effects.effect import Account, Pair, Site
from statics.support.checked import STRICT


@dataclass(frozen=True, config=STRICT)
class Cables:
    """F = -tau along the hole-to-hole length l, for each of the arm's cables, from start to anchor."""

    name: ClassVar[str] = "cables"
    site: ClassVar[Site] = "span"
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


Poses = tuple[np.ndarray, np.ndarray, np.ndarray]
"""x and y (m) and theta (rad) of the base and all disks, shape (..., disks + 1) each."""


def cable_ways(cable: Cable, poses: Poses) -> tuple[np.ndarray, np.ndarray]:
    """A cable's straight ways from hole to hole, from its start to its anchor, shape (..., ways, 2), m.

    Returns the holes' places in base and disks as well, as seen from their centres, shape
    (..., ways + 1, 2), m; all in base axes. Rone 2012, Eq. 22.
    """
    disks = poses[0].shape[-1] - 1
    felt = slice(cable.start or 0, (cable.anchor or disks) + 1)
    x, y, theta = (values[..., felt] for values in poses)
    offsets = cable.holes(disks)[felt]
    r_h = np.stack([-offsets * np.sin(theta), offsets * np.cos(theta)], axis=-1)
    return np.diff(np.stack([x, y], axis=-1) + r_h, axis=-2), r_h


def cable_lengths(cable: Cable, poses: Poses) -> np.ndarray:
    """A cable's lengths from hole to hole, start to anchor, shape (..., ways), m. Rone 2012, Eq. 23."""
    return np.linalg.norm(cable_ways(cable, poses)[0], axis=-1)


def disk_loads(
    arm: Arm, tension: np.ndarray, disk_x: np.ndarray, disk_y: np.ndarray, disk_theta: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Force and moment of the cables on each disk, as the paper writes them.

    Takes tensions, shape (cables,), N, and the poses of disks 1..n, shape (disks,), m and rad; the base is
    where the arm has it. Returns
    force, shape (disks, 2), N, and moment about the disk's centre, shape (disks,), N m.
    Rone 2012, Eq. 22-25.
    """
    of_disks = zip(arm.base_pose, (disk_x, disk_y, disk_theta), strict=True)
    x, y, theta = (np.append(base, values) for base, values in of_disks)
    poses = x, y, theta
    force, moment = np.zeros((arm.disks + 1, 2)), np.zeros(arm.disks + 1)  # the base's are left out
    for cable, tau in zip(arm.cables, tension, strict=True):
        p_h, r_h = cable_ways(cable, poses)
        pull = tau * p_h / np.linalg.norm(p_h, axis=1, keepdims=True)
        at_holes = np.diff(pull, axis=0, prepend=0.0, append=0.0)
        felt = slice(cable.start or 0, (cable.start or 0) + len(r_h))
        force[felt] += at_holes
        moment[felt] += r_h[:, 0] * at_holes[:, 1] - r_h[:, 1] * at_holes[:, 0]
    return force[1:], moment[1:]
