"""The equations of motion on the chain, and their exact Jacobian.

The integrator's state is y = (q, u, input_work, dissipated_energy): coordinates and rates of all
segments, row by row, and the two time integrals of the power ledger; if the base moves the first of them
is the work without ``transport_energy`` (``equations/transport.py``).
"""

import math

import numpy as np

from continuum_dyn.passes.motion_passes import LinearizedPasses, MotionPasses
from statics.kernels.calling import run
from statics.kernels.compiled import compiled
from statics.kernels.slots import (
    CLEARANCE,
    DAMPING_WEIGHT,
    DISSIPATED_POWER,
    DISSIPATED_POWER_CHANGE,
    INPUT_POWER,
    INPUT_POWER_CHANGE,
    LARGEST,
    SCALARS,
    STIFFNESS_WEIGHT,
)

Passes = MotionPasses | LinearizedPasses


@compiled
def inputs_at(t: float, pieces: np.ndarray, inputs: np.ndarray) -> None:
    """Inputs at time t from one piece of each profile; its columns are those of ``profiles.Piece``."""
    for c in range(pieces.shape[0]):
        since = t - pieces[c, 0]
        wave = pieces[c, 3] * math.sin(pieces[c, 4] * since + pieces[c, 5])
        inputs[c] = pieces[c, 1] + pieces[c, 2] * since + wave


@compiled
def motion_pass(
    passes: Passes,
    q: np.ndarray,
    u: np.ndarray,
    w: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    scalars: np.ndarray,
) -> None:
    """Outward: motion and loads of all segments and disks; power in and power dissipated into ``scalars``."""
    n = q.shape[0]
    if passes.lengths != 0:
        run(passes.lengths, n, scalars, q, u, inputs, segments, chain)
        run(passes.beyond, n, scalars, chain)
    run(passes.motion, n, scalars, q, u, w, inputs, segments, disks, chain)


@compiled
def acceleration(
    passes: Passes,
    q: np.ndarray,
    u: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    work: np.ndarray,
    w: np.ndarray,
    scalars: np.ndarray,
) -> None:
    """Accelerations of all coordinates into ``w``, shape (n, dofs); powers into ``scalars``.

    ``work``, shape (2, n, dofs), is overwritten.
    """
    n, dofs = q.shape
    for i in range(n):
        for k in range(dofs):
            w[i, k] = 0.0
    motion_pass(passes, q, u, w, inputs, segments, disks, chain, scalars)
    residual, descent = work[0], work[1]
    scalars[DAMPING_WEIGHT], scalars[STIFFNESS_WEIGHT] = 0.0, 0.0
    run(passes.residual, n, scalars, disks, chain, residual)
    run(passes.eliminate, n, scalars, segments, disks, chain, residual, descent, descent)
    run(passes.substitute, n, scalars, chain, descent, w)


@compiled
def displacement(passes: MotionPasses, chain: np.ndarray, change: np.ndarray, scalars: np.ndarray) -> float:
    """Largest displacement (m) of a disk under a small change of coordinates, shape (n, dofs)."""
    run(passes.displacement, change.shape[0], scalars, chain, change)
    return math.sqrt(scalars[LARGEST])


@compiled
def rate(
    passes: LinearizedPasses,
    pieces: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    dofs: int,
    t: float,
    y: np.ndarray,
    y_rate: np.ndarray,
) -> None:
    """Set ``y_rate`` to dy/dt: the right-hand side for any integrator."""
    n = segments.shape[0]
    size = n * dofs
    q, u = y[:size].reshape((n, dofs)), y[size : 2 * size].reshape((n, dofs))
    inputs, chain, scalars = np.empty(passes.inputs), np.empty((n, passes.chain_columns)), np.empty(SCALARS)
    inputs_at(t, pieces, inputs)
    w = y_rate[size : 2 * size].reshape((n, dofs))
    acceleration(passes, q, u, inputs, segments, disks, chain, np.empty((2, n, dofs)), w, scalars)
    for m in range(size):
        y_rate[m] = y[size + m]
    y_rate[2 * size], y_rate[2 * size + 1] = scalars[INPUT_POWER], scalars[DISSIPATED_POWER]


@compiled
def rate_jacobian(
    passes: LinearizedPasses,
    pieces: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    dofs: int,
    t: float,
    y: np.ndarray,
    jacobian: np.ndarray,
) -> None:
    """Set ``jacobian``, zero before, to d(rate)/dy, exact.

    One tangent pass and one elimination for each coordinate and each rate.

    From M w = -r(q, u, w = 0) follows M dw = -(dr along dq, du at fixed w).
    """
    n = segments.shape[0]
    size = n * dofs
    q, u = y[:size].reshape((n, dofs)), y[size : 2 * size].reshape((n, dofs))
    inputs, chain, scalars = np.empty(passes.inputs), np.empty((n, passes.chain_columns)), np.empty(SCALARS)
    inputs_at(t, pieces, inputs)
    w, residual, descent = np.zeros((n, dofs)), np.empty((n, dofs)), np.empty((n, dofs))
    if passes.lengths != 0:
        run(passes.lengths, n, scalars, q, u, inputs, segments, chain)
        run(passes.beyond, n, scalars, chain)
    run(passes.motion, n, scalars, q, u, w, inputs, segments, disks, chain)
    run(passes.residual, n, scalars, disks, chain, residual)
    run(passes.eliminate, n, scalars, segments, disks, chain, residual, descent, descent)
    run(passes.substitute, n, scalars, chain, descent, w)
    run(passes.motion, n, scalars, q, u, w, inputs, segments, disks, chain)
    run(passes.residual, n, scalars, disks, chain, residual)
    direction = np.zeros((2, n, dofs))
    q_change, u_change, w_change = direction[0], direction[1], np.empty((n, dofs))
    for column in range(2 * size):
        k = column % size
        direction[column // size, k // dofs, k % dofs] = 1.0
        if passes.lengths != 0:
            run(passes.lengths_tangent, n, scalars, q, u, inputs, segments, chain, q_change, u_change)
            run(passes.beyond_tangent, n, scalars, chain)
        run(passes.motion_tangent, n, scalars, q, u, w, inputs, segments, disks, chain, q_change, u_change)
        run(passes.residual_tangent, n, scalars, disks, chain, residual)
        run(passes.eliminate, n, scalars, segments, disks, chain, residual, descent, descent)
        run(passes.substitute, n, scalars, chain, descent, w_change)
        direction[column // size, k // dofs, k % dofs] = 0.0
        jacobian[2 * size, column] = scalars[INPUT_POWER_CHANGE]
        jacobian[2 * size + 1, column] = scalars[DISSIPATED_POWER_CHANGE]
        for m in range(size):
            jacobian[size + m, column] = w_change[m // dofs, m % dofs]
        if column >= size:
            jacobian[k, column] = 1.0


@compiled
def clearance_of(passes: MotionPasses, segments: np.ndarray, q: np.ndarray) -> float:
    """Smallest length or hole-to-hole length over L0; at zero the arm is at a geometric limit."""
    scalars = np.empty(SCALARS)
    run(passes.clearance, q.shape[0], scalars, q, segments)
    return scalars[CLEARANCE]
