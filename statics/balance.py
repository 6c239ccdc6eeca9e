"""A search for equilibria under loads without a potential: plain Python, composed into kernels.

Where no energy falls, the arm is let go instead: it creeps as in a viscous bath, D dq/dt = -r(q), in
implicit steps that lengthen as the residual r falls, and so end as Newton's (pseudo-transient continuation,
Kelley and Keyes 1998). It leaves what is unstable in such a bath, and knows of no other stability. The
matrix need not be exact: then the last steps converge linearly.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from statics.cable_sweep import measure_cables
    from statics.chain import eliminate_sweep, residual_sweep, substitute_sweep
    from statics.generated import CHAIN_COLUMNS, ELIMINATE_START, pose_start, pose_step
    from statics.held_tensions import count_held
    from statics.search import (
        AT_LIMIT,
        AT_REST,
        BALANCED,
        FALLING,
        LARGEST_TURN,
        LIMIT,
        NOT_FOUND,
        UNKNOWN,
        advance,
        measure,
        observe,
    )

FIRST_SLOWING, LEAST_SLOWING, MOST_SLOWING = 10.0, 1e-2, 1e3
"""What slows the arm down, over its residual."""
FAITHFUL, UNFAITHFUL = 0.25, 0.5
"""Errors of a step's linear prediction, over the residual, below or above which the next one is longer or
shorter."""


def pose_sweep(
    q: np.ndarray, inputs: np.ndarray, segments: np.ndarray, disks: np.ndarray, chain: np.ndarray
) -> float:
    """Outwards, at rest: what the inward sweeps need; returns the clearance."""
    measure_cables(q, inputs, segments, chain)
    carried = pose_start(inputs, segments, chain)
    for i in range(q.shape[0]):
        carried = pose_step(i, carried, q, inputs, segments, disks, chain)
    return carried[0]


def size(residual: np.ndarray, unit: float) -> float:
    """Root of the summed squares of torques, and of forces times ``unit``, N m."""
    squares = 0.0
    for i in range(residual.shape[0]):
        squares += residual[i, 0] ** 2
        if residual.shape[1] == 2:
            squares += (residual[i, 1] * unit) ** 2
    return math.sqrt(squares)


def unforeseen(
    residual: np.ndarray,
    before: np.ndarray,
    change: np.ndarray,
    factor: float,
    slowing: float,
    unit: float,
    difference: np.ndarray,
) -> float:
    """Size of what a step's linear prediction, (1 - factor) r - factor slowing D dq, missed by, N m."""
    for i in range(residual.shape[0]):
        for k in range(residual.shape[1]):
            drag = slowing * change[i, k] / (unit * unit if k == 1 else 1.0)
            difference[i, k] = residual[i, k] - (1.0 - factor) * before[i, k] + factor * drag
    return size(difference, unit)


def within_limits(
    q: np.ndarray,
    change: np.ndarray,
    factor: float,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    trial: np.ndarray,
) -> tuple[float, float]:
    """Halve the step until no geometric limit is crossed; returns the factor, and the clearance of ``trial``.

    The factor is 0 if there is none.
    """
    for _ in range(60):
        advance(q, factor, change, trial)
        clearance = pose_sweep(trial, inputs, segments, disks, chain)
        if clearance > 0.0:
            return factor, clearance
        factor *= 0.5
    return 0.0, 0.0


def find_equilibrium(
    q: np.ndarray, inputs: np.ndarray, segments: np.ndarray, disks: np.ndarray, unit: float, most: int
) -> tuple[int, int]:
    """Move ``q``, shape (n, dofs), to an equilibrium; ``unit`` is the length elongations compare with.

    Returns how it ended (BALANCED, LIMIT, NOT_FOUND) and the iterations (at most ``most``).
    """
    chain = np.empty((q.shape[0], CHAIN_COLUMNS))
    residual, before, difference = np.empty_like(q), np.empty_like(q), np.empty_like(q)
    descent, change, trial = np.empty_like(q), np.empty_like(q), np.empty_like(q)
    pose_sweep(q, inputs, segments, disks, chain)
    residual_sweep(disks, chain, residual)
    left, per_residual = size(residual, unit), FIRST_SLOWING
    for iteration in range(1, most + 1):
        slowing = per_residual * left
        eliminate_sweep((slowing, *ELIMINATE_START[1:]), segments, disks, chain, residual, descent, descent)
        substitute_sweep(chain, descent, change)
        single, turn = measure(change, unit)
        longest = min(1.0, LARGEST_TURN / max(turn, 1e-30))
        factor, clearance = within_limits(q, change, longest, inputs, segments, disks, chain, trial)
        if factor == 0.0:
            return NOT_FOUND, iteration
        q[:] = trial
        before[:] = residual
        residual_sweep(disks, chain, residual)
        last, left = left, size(residual, unit)
        if single < AT_REST and not left < FALLING * last:
            return BALANCED, iteration
        if clearance < AT_LIMIT:
            return LIMIT, iteration
        missed = unforeseen(residual, before, change, factor, slowing, unit, difference)
        if missed > UNFAITHFUL * last:
            per_residual = min(4.0 * per_residual, MOST_SLOWING)
        elif missed < FAITHFUL * last:
            per_residual = max(0.5 * per_residual, LEAST_SLOWING)
    return NOT_FOUND, most


def examine(
    q: np.ndarray, inputs: np.ndarray, segments: np.ndarray, disks: np.ndarray, pose: np.ndarray
) -> tuple[float, float, float, int]:
    """Poses of the disks into ``pose``, shape (n, 3).

    Returns elastic energy, gravity energy (J), the largest residual (N or N m), and the number of unstable
    directions, or UNKNOWN: the signs of an unsymmetric matrix tell nothing of oscillations that grow.
    """
    chain, residual = np.empty((q.shape[0], CHAIN_COLUMNS)), np.empty_like(q)
    pose_sweep(q, inputs, segments, disks, chain)
    residual_sweep(disks, chain, residual)
    negative = np.full(1, UNKNOWN)
    count_held(segments, disks, chain, residual, negative)
    elastic, gravity = observe(q, inputs, segments, disks, chain, pose)
    return elastic, gravity, np.abs(residual).max(), int(negative[0])
