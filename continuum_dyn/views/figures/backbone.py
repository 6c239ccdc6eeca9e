"""The arm's shape as points to draw, from the columns of a log."""

from collections.abc import Mapping
from typing import Any

import numpy as np


def base_pose(columns: Mapping[str, np.ndarray], rows: np.ndarray) -> tuple[np.ndarray, ...]:
    """x, y (m) and theta (rad) of the base, each of shape (rows, 1): zero in an arm without one."""
    names = ("base_x", "base_y", "base_theta")
    return tuple(columns[name][rows, None] if name in columns else np.zeros((len(rows), 1)) for name in names)


def poses(columns: Mapping[str, np.ndarray], rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centres, shape (rows, disks + 1, 2), m, and unit vectors across the core, of base and disks."""
    disks = (columns[name][rows] for name in ("disk_x", "disk_y", "disk_theta"))
    x, y, theta = (np.hstack(both) for both in zip(base_pose(columns, rows), disks, strict=True))
    return np.stack([x, y], axis=-1), np.stack([-np.sin(theta), np.cos(theta)], axis=-1)


def disk_reach(arm: Mapping[str, Any], columns: Mapping[str, np.ndarray]) -> float:
    """Half the width that a disk is drawn with, m: a little beyond the outermost hole."""
    outermost_hole = float(np.abs(arm["hole_offset"]).max(initial=0.0))
    spacing = columns["length"][0].sum() / columns["disk_x"].shape[1]
    return 1.2 * outermost_hole or 0.25 * float(spacing)


def backbone(columns: Mapping[str, np.ndarray], rows: np.ndarray, points: int) -> np.ndarray:
    """Points along the core, base first, ``points`` for each segment.

    Shape (rows, points x segments + 1, 2), m. Each segment is a circular arc: a chord at half its angle
    (Rone 2012, Eq. 11).
    """
    length = columns["length"][rows]
    bend = columns["curvature"][rows] * length
    along = np.arange(1, points + 1) / points
    half = 0.5 * bend[..., None] * along
    x, y, theta = base_pose(columns, rows)
    angle = (theta + np.cumsum(bend, axis=1) - bend)[..., None] + half
    chord = length[..., None] * along * np.sinc(half / np.pi)
    arcs = chord[..., None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    arcs[:, 1:] += np.cumsum(arcs[:, :-1, -1], axis=1)[:, :, None]
    base = np.stack([x, y], axis=-1)
    return base + np.pad(arcs.reshape(len(rows), -1, 2), ((0, 0), (1, 0), (0, 0)))
