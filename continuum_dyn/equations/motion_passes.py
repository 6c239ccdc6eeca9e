"""The equations of motion on the chain: plain Python, composed into motion kernels.

The integrator's state is y = (q, u, input_work, dissipated_energy): coordinates and rates of all
segments, row by row, and the two time integrals of the power ledger; where the base moves the first of them
is the work without ``transport_energy`` (``transport.py``).
"""

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from continuum_dyn.cable_change_sweep import measure_changes
    from continuum_dyn.generated import (
        CHAIN_COLUMNS,
        DISPLACEMENT_START,
        ELIMINATE_START,
        INPUTS,
        RESIDUAL_TANGENT_START,
        displacement_step,
        motion_start,
        motion_step,
        motion_tangent_start,
        motion_tangent_step,
        observe_start,
        observe_step,
        residual_tangent_step,
    )
    from continuum_dyn.moving_cable_sweep import measure_moving_cables
    from statics.chain import eliminate_sweep, residual_sweep, substitute_sweep


def inputs_at(t: float, pieces: np.ndarray, inputs: np.ndarray) -> None:
    """Inputs at time t from one piece of each profile; its columns are those of ``profiles.Piece``."""
    for c in range(pieces.shape[0]):
        since = t - pieces[c, 0]
        wave = pieces[c, 3] * math.sin(pieces[c, 4] * since + pieces[c, 5])
        inputs[c] = pieces[c, 1] + pieces[c, 2] * since + wave


def motion_sweep(
    q: np.ndarray,
    u: np.ndarray,
    w: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
) -> tuple[float, float]:
    """Outwards: motion and loads of all segments and disks; returns power in and power dissipated."""
    measure_moving_cables(q, u, inputs, segments, chain)
    carried = motion_start(inputs, segments, chain)
    for i in range(q.shape[0]):
        carried = motion_step(i, carried, q, u, w, inputs, segments, disks, chain)
    return carried[0], carried[1]


def solve_mass(
    segments: np.ndarray, disks: np.ndarray, chain: np.ndarray, residual: np.ndarray, w: np.ndarray
) -> None:
    """Set w to -M^-1 residual, in one inward and one outward sweep."""
    descent = np.empty_like(residual)
    eliminate_sweep(ELIMINATE_START, segments, disks, chain, residual, descent, descent)
    substitute_sweep(chain, descent, w)


def displacement(chain: np.ndarray, change: np.ndarray) -> float:
    """Largest displacement (m) of a disk under a small change of coordinates, shape (n, dofs)."""
    carried = DISPLACEMENT_START
    for i in range(change.shape[0]):
        carried = displacement_step(i, carried, chain, change)
    return math.sqrt(carried[0])


def acceleration(
    q: np.ndarray,
    u: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    w: np.ndarray,
) -> tuple[float, float]:
    """Accelerations of all coordinates into ``w``, shape (n, dofs); returns power in and dissipated."""
    residual = np.empty_like(q)
    w[:] = 0.0
    powers = motion_sweep(q, u, w, inputs, segments, disks, chain)
    residual_sweep(disks, chain, residual)
    solve_mass(segments, disks, chain, residual, w)
    return powers


def rate(
    t: float, y: np.ndarray, pieces: np.ndarray, segments: np.ndarray, disks: np.ndarray, dofs: int
) -> np.ndarray:
    """dy/dt: the right-hand side for any integrator."""
    n = segments.shape[0]
    size = n * dofs
    q, u = y[:size].reshape((n, dofs)), y[size : 2 * size].reshape((n, dofs))
    inputs, chain = np.empty(INPUTS), np.empty((n, CHAIN_COLUMNS))
    inputs_at(t, pieces, inputs)
    y_rate = np.empty_like(y)
    y_rate[:size] = y[size : 2 * size]
    w = y_rate[size : 2 * size].reshape((n, dofs))
    y_rate[2 * size], y_rate[2 * size + 1] = acceleration(q, u, inputs, segments, disks, chain, w)
    return y_rate


def rate_jacobian(
    t: float, y: np.ndarray, pieces: np.ndarray, segments: np.ndarray, disks: np.ndarray, dofs: int
) -> np.ndarray:
    """d(rate)/dy, exact: one tangent sweep and one elimination for each coordinate and each rate.

    From M w = -r(q, u, w = 0) follows M dw = -(dr along dq, du at fixed w).
    """
    n = segments.shape[0]
    size = n * dofs
    q, u = y[:size].copy().reshape((n, dofs)), y[size : 2 * size].copy().reshape((n, dofs))
    inputs, chain = np.empty(INPUTS), np.empty((n, CHAIN_COLUMNS))
    inputs_at(t, pieces, inputs)
    w, residual, w_change = np.empty((n, dofs)), np.empty((n, dofs)), np.empty((n, dofs))
    acceleration(q, u, inputs, segments, disks, chain, w)
    motion_sweep(q, u, w, inputs, segments, disks, chain)
    residual_sweep(disks, chain, residual)
    jacobian = np.zeros((y.shape[0], y.shape[0]))
    direction = np.zeros((2, n, dofs))
    for column in range(2 * size):
        k = column % size
        direction[column // size, k // dofs, k % dofs] = 1.0
        measure_changes(q, u, inputs, segments, chain, direction[0], direction[1])
        carried = motion_tangent_start(inputs, segments, chain)
        for i in range(n):
            carried = motion_tangent_step(
                i, carried, q, u, w, inputs, segments, disks, chain, direction[0], direction[1]
            )
        jacobian[2 * size, column], jacobian[2 * size + 1, column] = carried[0], carried[1]
        inward = RESIDUAL_TANGENT_START
        for i in range(n - 1, -1, -1):
            inward = residual_tangent_step(i, inward, disks, chain, residual)
        solve_mass(segments, disks, chain, residual, w_change)
        direction[column // size, k // dofs, k % dofs] = 0.0
        if column >= size:
            jacobian[k, column] = 1.0
        jacobian[size : 2 * size, column] = w_change.ravel()
    return jacobian


def observe(
    q: np.ndarray,
    u: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    pose: np.ndarray,
    velocity: np.ndarray,
    ledger: np.ndarray,
) -> None:
    """What follows from q, u (samples, n, dofs) and inputs (samples, INPUTS), for every sample.

    Poses and velocities of the disks, shape (samples, n, 3); and into ``ledger``, shape (samples, columns),
    the results of ``observe_step``: kinetic, elastic and gravity energy, power in, power dissipated, ...
    """
    chain = np.empty((q.shape[1], CHAIN_COLUMNS))
    for s in range(q.shape[0]):
        measure_moving_cables(q[s], u[s], inputs[s], segments, chain)
        carried = observe_start(inputs[s], segments, chain)
        for i in range(q.shape[1]):
            carried = observe_step(
                i, carried, q[s], u[s], inputs[s], segments, disks, chain, pose[s], velocity[s]
            )
        for k in range(ledger.shape[1]):
            ledger[s, k] = carried[k]
