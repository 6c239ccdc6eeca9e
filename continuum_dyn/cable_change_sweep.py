"""The sweeps that differentiate what ``moving_cable_sweep`` measures: plain Python, composed into kernels."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from continuum_dyn.generated import (
        BEYOND_TANGENT_START,
        beyond_tangent_step,
        lengths_tangent_start,
        lengths_tangent_step,
    )


def measure_changes(
    q: np.ndarray,
    u: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    chain: np.ndarray,
    q_change: np.ndarray,
    u_change: np.ndarray,
) -> None:
    """Changes of what ``measure_moving_cables`` measures along a change of coordinates and rates."""
    outward, inward = lengths_tangent_start(inputs, segments, chain), BEYOND_TANGENT_START
    for i in range(q.shape[0]):
        outward = lengths_tangent_step(i, outward, q, u, inputs, segments, chain, q_change, u_change)
    for i in range(q.shape[0] - 1, -1, -1):
        inward = beyond_tangent_step(i, inward, chain)
