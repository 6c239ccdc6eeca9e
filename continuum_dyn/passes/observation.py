"""Quantities that follow from the states of a motion: poses, velocities, energies, powers."""

import numpy as np

from continuum_dyn.passes.accelerations import acceleration, motion_pass
from continuum_dyn.passes.motion_passes import MotionPasses
from statics.kernels.calling import run
from statics.kernels.compiled import compiled
from statics.kernels.slots import LEDGER, SCALARS, WRENCH

BASE_MOTION = 6
"""Inputs at the end that are the base's velocities, then its accelerations."""


@compiled
def observe(
    passes: MotionPasses,
    q: np.ndarray,
    u: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    pose: np.ndarray,
    velocity: np.ndarray,
    ledger: np.ndarray,
) -> None:
    """Observe every sample of q, u (samples, n, dofs) under inputs (samples, inputs).

    Poses and velocities of the disks, shape (samples, n, 3); and into ``ledger``, shape (samples, columns):
    kinetic, elastic and gravity energy, power in, power dissipated, ...
    """
    n, scalars = q.shape[1], np.empty(SCALARS)
    chain = np.empty((n, passes.chain_columns))
    for s in range(q.shape[0]):
        if passes.lengths != 0:
            run(passes.lengths, n, scalars, q[s], u[s], inputs[s], segments, chain)
            run(passes.beyond, n, scalars, chain)
        run(passes.observe, n, scalars, q[s], u[s], inputs[s], segments, disks, chain, pose[s], velocity[s])
        for k in range(ledger.shape[1]):
            ledger[s, k] = scalars[LEDGER + k]


@compiled
def add_base_power(
    passes: MotionPasses,
    q: np.ndarray,
    u: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    power: np.ndarray,
) -> None:
    """Add to ``power``, shape (samples,), W, the base's: its wrench on the arm times its velocities.

    q and u have shape (samples, n, dofs), inputs (samples, inputs).
    """
    n, dofs = q.shape[1], q.shape[2]
    w, work, scalars = np.empty((n, dofs)), np.empty((2, n, dofs)), np.empty(SCALARS)
    chain = np.empty((n, passes.chain_columns))
    for s in range(q.shape[0]):
        acceleration(passes, q[s], u[s], inputs[s], segments, disks, chain, work, w, scalars)
        motion_pass(passes, q[s], u[s], w, inputs[s], segments, disks, chain, scalars)
        run(passes.residual, n, scalars, disks, chain, work[0])
        for k in range(3):
            power[s] += scalars[WRENCH + k] * inputs[s, inputs.shape[1] - BASE_MOTION + k]
