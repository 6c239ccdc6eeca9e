"""A search for equilibria under loads without a potential.

Without an energy to minimize, the arm is released in a viscous fluid, D dq/dt = -r(q). The implicit steps
grow as the residual r falls, so the last ones are Newton steps (pseudo-transient continuation, Kelley and
Keyes 1998). It leaves equilibria that are unstable in such a fluid, and cannot judge any other stability. If
the matrix is not exact, the last steps converge linearly.
"""

import math

import numpy as np

from statics.kernels.calling import run
from statics.kernels.compiled import compiled
from statics.kernels.slots import (
    CLEARANCE,
    ELASTIC_ENERGY,
    GRAVITY_ENERGY,
    KEEP_SIGN,
    NEGATIVE_PIVOTS,
    SCALARS,
    SLOWING,
)
from statics.passes.rest_passes import RestPasses
from statics.passes.search import (
    AT_LIMIT,
    AT_REST,
    BALANCED,
    FALLING,
    LARGEST_TURN,
    LIMIT,
    NOT_FOUND,
    ROUNDED,
    UNKNOWN,
    add_scaled,
    copy,
    is_balanced,
    largest,
    measure,
    pose_pass,
)

FIRST_SLOWING, LEAST_SLOWING, MOST_SLOWING = 10.0, 1e-2, 1e3
"""Damping of the creep over its residual."""
FAITHFUL, UNFAITHFUL = 0.25, 0.5
"""Errors of a step's linear prediction, over the residual, below or above which the next one is longer or
shorter."""


@compiled
def size(residual: np.ndarray, unit: float) -> float:
    """Root of the summed squares of torques, and of forces times ``unit``, N m."""
    squares = 0.0
    for i in range(residual.shape[0]):
        squares += residual[i, 0] ** 2
        if residual.shape[1] == 2:
            squares += (residual[i, 1] * unit) ** 2
    return math.sqrt(squares)


@compiled
def unforeseen(
    residual: np.ndarray,
    before: np.ndarray,
    change: np.ndarray,
    factor: float,
    slowing: float,
    unit: float,
    difference: np.ndarray,
) -> float:
    """Size of the error of a step's linear prediction, (1 - factor) r - factor slowing D dq, N m."""
    for i in range(residual.shape[0]):
        for k in range(residual.shape[1]):
            drag = slowing * change[i, k] / (unit * unit if k == 1 else 1.0)
            difference[i, k] = residual[i, k] - (1.0 - factor) * before[i, k] + factor * drag
    return size(difference, unit)


@compiled
def within_limits(
    passes: RestPasses,
    q: np.ndarray,
    change: np.ndarray,
    factor: float,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    trial: np.ndarray,
    scalars: np.ndarray,
) -> float:
    """Halve the step until no geometric limit is crossed; returns the factor, 0 if there is none.

    ``trial`` is the accepted q, and ``scalars`` hold its clearance.
    """
    for _ in range(60):
        add_scaled(q, factor, change, trial)
        pose_pass(passes, trial, inputs, segments, disks, chain, scalars)
        if scalars[CLEARANCE] > 0.0:
            return factor
        factor *= 0.5
    return 0.0


@compiled
def find_balance(
    passes: RestPasses,
    q: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    unit: float,
    most: int,
) -> tuple[int, int]:
    """Move ``q``, shape (n, dofs), to an equilibrium; ``unit`` is the length elongations compare with.

    Returns the outcome (BALANCED, LIMIT, NOT_FOUND) and the iterations (at most ``most``).
    """
    n, dofs = q.shape
    chain, scalars = np.empty((n, passes.chain_columns)), np.empty(SCALARS)
    residual, before, difference = np.empty((n, dofs)), np.empty((n, dofs)), np.empty((n, dofs))
    descent, change, trial = np.empty((n, dofs)), np.empty((n, dofs)), np.empty((n, dofs))
    pose_pass(passes, q, inputs, segments, disks, chain, scalars)
    run(passes.residual, n, scalars, disks, chain, residual)
    left, per_residual = size(residual, unit), FIRST_SLOWING
    for iteration in range(1, most + 1):
        slowing = per_residual * left
        scalars[SLOWING] = slowing
        run(passes.eliminate, n, scalars, segments, disks, chain, residual, descent, descent)
        run(passes.substitute, n, scalars, chain, descent, change)
        single, turn = measure(change, unit)
        longest = min(1.0, LARGEST_TURN / max(turn, 1e-30))
        factor = within_limits(passes, q, change, longest, inputs, segments, disks, chain, trial, scalars)
        if factor == 0.0:
            return NOT_FOUND, iteration
        copy(trial, q)
        copy(residual, before)
        clearance = scalars[CLEARANCE]
        run(passes.residual, n, scalars, disks, chain, residual)
        last, left = left, size(residual, unit)
        if single < AT_REST and not (single > ROUNDED and left < FALLING * last):
            return BALANCED, iteration
        if clearance < AT_LIMIT:
            return LIMIT, iteration
        missed = unforeseen(residual, before, change, factor, slowing, unit, difference)
        if missed > UNFAITHFUL * last:
            per_residual = min(4.0 * per_residual, MOST_SLOWING)
        elif missed < FAITHFUL * last:
            per_residual = max(0.5 * per_residual, LEAST_SLOWING)
    return NOT_FOUND, most


@compiled
def examine_balance(
    passes: RestPasses,
    q: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    rest_length: float,
    pose: np.ndarray,
) -> tuple[float, float, float, int, bool]:
    """Put the disks' poses into ``pose``, shape (n, 3).

    Returns elastic energy, gravity energy (J), the largest residual (N or N m), the number of unstable
    directions, or UNKNOWN, and whether the forces balance. The signs of an unsymmetric matrix do not show
    oscillations that grow. Friction only dissipates energy: at fixed tensions the other loads have a
    potential, and at its minimum nothing grows.
    """
    n, dofs = q.shape
    chain, scalars = np.empty((n, passes.chain_columns)), np.empty(SCALARS)
    residual, descent = np.empty((n, dofs)), np.empty((n, dofs))
    pose_pass(passes, q, inputs, segments, disks, chain, scalars)
    run(passes.residual, n, scalars, disks, chain, residual)
    balanced = is_balanced(passes, disks, chain, residual, rest_length)
    negative = UNKNOWN
    if passes.eliminate_held != 0:
        pivots = np.empty((n, passes.pivot_columns))
        scalars[KEEP_SIGN] = 1.0
        run(passes.eliminate_held, n, scalars, segments, disks, chain, residual, descent, pivots)
        negative = int(scalars[NEGATIVE_PIVOTS])
    run(passes.observe, n, scalars, q, inputs, segments, disks, chain, pose)
    return scalars[ELASTIC_ENERGY], scalars[GRAVITY_ENERGY], largest(residual), negative, balanced
