"""The arm's shape as points to draw, from the columns of a log."""

from collections.abc import Mapping

import numpy as np


def poses(columns: Mapping[str, np.ndarray], rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centres, shape (rows, disks + 1, 2), m, and normals of the base and of the disks."""
    x, y, theta = (
        np.pad(columns[name][rows], ((0, 0), (1, 0))) for name in ("disk_x", "disk_y", "disk_theta")
    )
    return np.stack([x, y], axis=-1), np.stack([-np.sin(theta), np.cos(theta)], axis=-1)


def backbone(columns: Mapping[str, np.ndarray], rows: np.ndarray, points: int) -> np.ndarray:
    """Points along the core, base first, ``points`` for each segment; shape (rows, points x disks + 1, 2), m.

    Each segment is a circular arc: a chord at half its angle (Rone 2012, Eq. 11).
    """
    length, theta = columns["length"][rows], columns["disk_theta"][rows]
    start, _ = poses(columns, rows)
    along = np.arange(1, points + 1) / points
    half = 0.5 * (columns["curvature"][rows] * length)[..., None] * along
    chord = length[..., None] * along * np.sinc(half / np.pi)
    angle = np.pad(theta, ((0, 0), (1, 0)))[:, :-1, None] + half
    arcs = start[:, :-1, None] + chord[..., None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return np.concatenate([start[:, :1], arcs.reshape(len(rows), -1, 2)], axis=1)
