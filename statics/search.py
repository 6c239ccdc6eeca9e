"""What both searches for an equilibrium share: how they end, and steps in coordinates of unlike units.

Plain Python, composed into kernels.
"""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from statics.generated import observe_start, observe_step

STABLE, UNSTABLE, LIMIT, NOT_FOUND, BALANCED = 0, 1, 2, 3, 4
"""How a search may end; BALANCED is an equilibrium of which it is not known whether it is stable."""
UNKNOWN = -1
"""Number of an equilibrium's unstable directions where it is not known."""

AT_REST = 1e-8
"""A Newton step below this (rad, or elongation over L0) is the last one: its square is below rounding."""
FALLING = 0.9
"""A residual or a step that no longer falls below this part of the last one has come to rounding."""
AT_LIMIT = 1e-6
"""Clearance (over L0) at which an arm that still descends has reached its geometric limit."""
TOWARDS_LIMIT = 0.1
"""Least part of the clearance that a step must leave: else a step that is too long looks like a limit."""
LARGEST_TURN = 1.0
"""Most that one step may turn any disk, rad."""


def measure(change: np.ndarray, rest_length: float) -> tuple[float, float]:
    """Largest single change (rad, or elongation over L0), and largest change of any disk's angle."""
    single, angle, turned = 0.0, 0.0, 0.0
    for i in range(change.shape[0]):
        angle += change[i, 0]
        turned = max(turned, abs(angle))
        single = max(single, abs(change[i, 0]))
        if change.shape[1] == 2:
            single = max(single, abs(change[i, 1]) / rest_length)
    return single, max(single, turned)


def advance(q: np.ndarray, factor: float, change: np.ndarray, trial: np.ndarray) -> None:
    """Set trial to q + factor * change."""
    for i in range(q.shape[0]):
        for k in range(q.shape[1]):
            trial[i, k] = q[i, k] + factor * change[i, k]


def observe(
    q: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    pose: np.ndarray,
) -> tuple[float, float]:
    """Poses of the disks into ``pose``, shape (n, 3); returns elastic and gravity energy, J."""
    carried = observe_start(inputs, segments, chain)
    for i in range(q.shape[0]):
        carried = observe_step(i, carried, q, inputs, segments, disks, pose)
    return carried[0], carried[1]
