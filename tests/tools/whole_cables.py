"""The tensions of cables that rub or are driven by length, on the whole arm: an oracle for the chain's.

Every hole is placed, lengths and turning angles are measured there, and the two laws applied stretch by
stretch. Nothing is taken from the program but the numbers of a scene.
"""

import numpy as np
import whole_arm
from whole_arm import WholeArm, directional

from statics.scene import Scene


class WholeCables:
    """Tensions of a scene's cables on all stretches, shape (cables, disks).

    ``drive`` holds a tension (N) for each, or its displacement (m) where the cable is driven by its length;
    ``arm`` is the scene's by default.
    """

    def __init__(self, scene: Scene, drive: np.ndarray, arm: WholeArm | None = None) -> None:
        self.arm = whole_arm.whole_arm(scene) if arm is None else arm
        cables = scene.arm.cables[: len(drive)]
        self.drive = np.array(drive, dtype=float)
        self.stiffness = np.array([cable.cable_stiffness or 0.0 for cable in cables])
        rubs = float(scene.has("cable_friction"))
        self.friction = np.array([rubs * cable.friction for cable in cables])[:, None]
        self.slip_speed = np.array([cable.slip_speed for cable in cables])[:, None]
        unloaded = np.zeros((self.arm.n, len(scene.coordinates)))
        unloaded[:, 0] = np.where(self.arm.k0 == 0.0, 1e-9, self.arm.k0 * self.arm.L0)
        self.rest = self.lengths(unloaded).sum(axis=1)

    def lengths(self, q: np.ndarray) -> np.ndarray:
        """Hole-to-hole lengths up to the anchors, shape (cables, disks)."""
        return self.arm.tension_along(whole_arm.cable_lengths(self.arm, q))

    def beyond(self, q: np.ndarray) -> np.ndarray:
        """Lengths beyond the near hole of each stretch."""
        return np.cumsum(self.lengths(q)[:, ::-1], axis=1)[:, ::-1]

    def turns(self, q: np.ndarray) -> np.ndarray:
        """Angle by which each near hole turns the cable, which comes to the first along its disk's normal."""
        x, y, theta = (
            np.append(base, values)[:: self.arm.step]
            for base, values in zip(whole_arm.base_pose(self.arm), whole_arm.poses(self.arm, q), strict=True)
        )
        turns = np.empty_like(self.arm.r_h[:, 1:])
        for c, r_h in enumerate(self.arm.r_h):
            way = np.diff((x - r_h * np.sin(theta)) + 1j * (y + r_h * np.cos(theta)))
            first = self.arm.first[c]
            turns[c, :first] = 0.0
            pulled = np.concatenate([[np.exp(1j * theta[first])], way[first:-1]])
            turns[c, first:] = np.angle(way[first:] / pulled)
        return turns

    def drives(self, q: np.ndarray) -> np.ndarray:
        """Tension of each cable at the base."""
        stretch = self.beyond(q)[:, 0] - self.rest + self.drive
        pull = self.stiffness * np.where(np.real(stretch) > 0, stretch, 0)
        return np.where(self.stiffness > 0, pull, self.drive)

    def tensions(self, q: np.ndarray, slip: np.ndarray, turns: np.ndarray) -> np.ndarray:
        """By the capstan law, for slips in units of what friction wants."""
        fall = np.cumsum(-self.friction * np.abs(turns) * np.tanh(slip), axis=1)
        return self.drives(q)[:, None] * np.exp(fall)

    def in_motion(self, q: np.ndarray, u: np.ndarray) -> np.ndarray:
        """Those of a moving arm."""
        return self.tensions(q, -directional(self.beyond, q, u) / self.slip_speed, self.turns(q))
