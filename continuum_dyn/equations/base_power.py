"""What a moving base does on the arm: plain Python, composed into the kernels of such scenes only."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from continuum_dyn.equations.motion_passes import acceleration, motion_sweep
    from continuum_dyn.generated import CHAIN_COLUMNS
    from statics.chain import residual_sweep

BASE_MOTION = 6
"""Inputs at the end that are the base's velocities, then its accelerations."""


def add_base_power(
    q: np.ndarray,
    u: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    power: np.ndarray,
) -> None:
    """Add to ``power``, shape (samples,), W, the base's: its wrench on the arm times its velocities.

    q and u have shape (samples, n, dofs), inputs (samples, INPUTS).
    """
    w, residual = np.empty(q.shape[1:]), np.empty(q.shape[1:])
    chain = np.empty((q.shape[1], CHAIN_COLUMNS))
    for s in range(q.shape[0]):
        acceleration(q[s], u[s], inputs[s], segments, disks, chain, w)
        motion_sweep(q[s], u[s], w, inputs[s], segments, disks, chain)
        wrench = residual_sweep(disks, chain, residual)
        for k in range(3):
            power[s] += wrench[k] * inputs[s, inputs.shape[1] - BASE_MOTION + k]
