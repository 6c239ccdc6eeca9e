"""Newton's method on the chain that ends in a stable equilibrium: plain Python, composed into kernels.

The potential energy must fall (Armijo); pivot blocks are made positive as they come, so that every step
descends. At a saddle the search stops, so that it can be told, and goes on along the direction of negative
curvature that the elimination knows. A trial beyond a geometric limit counts as infinitely high.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from statics.cable_sweep import measure_cables
    from statics.chain import eliminate_sweep, residual_sweep, substitute_sweep
    from statics.generated import (
        CHAIN_COLUMNS,
        COUPLED,
        ELIMINATE_START,
        PIVOT_COLUMNS,
        pose_start,
        pose_step,
    )
    from statics.search import (
        AT_LIMIT,
        AT_REST,
        FALLING,
        LARGEST_TURN,
        LIMIT,
        NOT_FOUND,
        STABLE,
        TOWARDS_LIMIT,
        UNSTABLE,
        advance,
        measure,
        observe,
    )

ROUNDING = 1e-11
"""A predicted fall of the potential below this part of its scale cannot be seen in it."""
FAR_FROM_REST = 1e-6
"""A Newton step above this (rad, or elongation over L0) from where all forces balance goes elsewhere: the
matrix is singular there."""


def pose_sweep(
    q: np.ndarray, inputs: np.ndarray, segments: np.ndarray, disks: np.ndarray, chain: np.ndarray
) -> tuple[float, float, float]:
    """Outwards, at rest: potential energy, the sum of its parts' sizes, and the clearance."""
    measure_cables(q, inputs, segments, chain)
    carried = pose_start(inputs, segments, chain)
    for i in range(q.shape[0]):
        carried = pose_step(i, carried, q, inputs, segments, disks, chain)
    return carried[0], carried[1], carried[2]


def eliminate_exactly(
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    residual: np.ndarray,
    descent: np.ndarray,
    pivots: np.ndarray,
) -> int:
    """Eliminate with the pivots as they are; returns the number of negative eigenvalues of the matrix."""
    start = (0.0, 0.0, 1.0, *ELIMINATE_START[3:])
    return int(eliminate_sweep(start, segments, disks, chain, residual, descent, pivots)[0])


def descend(
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    residual: np.ndarray,
    descent: np.ndarray,
    pivots: np.ndarray,
) -> int:
    """Eliminate so that the step descends, exactly where it does so by itself; returns the negative pivots.

    Cables of given length may hold what is unstable without them: then pivots are negative, the matrix not.
    """
    negative = int(eliminate_sweep(ELIMINATE_START, segments, disks, chain, residual, descent, pivots)[0])
    if COUPLED and negative > 0:
        if eliminate_exactly(segments, disks, chain, residual, descent, pivots) == 0:
            return 0
        eliminate_sweep(ELIMINATE_START, segments, disks, chain, residual, descent, pivots)
    return negative


def inner(first: np.ndarray, second: np.ndarray) -> float:
    """Scalar product of two arrays of one row for each segment."""
    total = 0.0
    for i in range(first.shape[0]):
        for k in range(first.shape[1]):
            total += first[i, k] * second[i, k]
    return total


def saddle_direction(
    unit: float, chain: np.ndarray, pivots: np.ndarray, descent: np.ndarray, change: np.ndarray
) -> float:
    """Into ``change`` a direction of negative curvature, at most 0.1 rad; returns its curvature.

    The negative pivot nearest to the tip gives its own eigenvector; substitution gives what follows.
    """
    descent[:] = 0.0
    curvature = 0.0
    for i in range(descent.shape[0] - 1, -1, -1):
        if descent.shape[1] == 1:
            if pivots[i, 0] < 0.0:
                descent[i, 0], curvature = 1.0, pivots[i, 0]
                break
        else:
            a, b, c = pivots[i, 0], pivots[i, 1] * unit, pivots[i, 2] * unit * unit
            low = 0.5 * (a + c) - math.hypot(0.5 * (a - c), b)
            if low < 0.0:
                turn = 0.5 * math.atan2(2.0 * b, a - c)
                descent[i, 0], descent[i, 1] = -math.sin(turn), math.cos(turn) * unit
                curvature = low
                break
    substitute_sweep(chain, descent, change)
    shrink = 0.1 / max(measure(change, unit)[1], 1e-30)
    for i in range(change.shape[0]):
        for k in range(change.shape[1]):
            change[i, k] *= shrink
    return curvature * shrink * shrink


def shorten(
    q: np.ndarray,
    change: np.ndarray,
    factor: float,
    promised: tuple[float, float, float],
    clearance: float,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    trial: np.ndarray,
) -> tuple[float, tuple[float, float, float]]:
    """Halve the step until the potential falls enough (Armijo) and no geometric limit comes too close.

    ``promised`` is the potential to fall from, its slope and its curvature along ``change``; of the
    ``clearance`` at q a part must be left. Returns the factor, 0 if there is none, and what ``pose_sweep``
    says of ``trial``, the accepted q.
    """
    potential, slope, curvature = promised
    for _ in range(60):
        advance(q, factor, change, trial)
        seen = pose_sweep(trial, inputs, segments, disks, chain)
        fall = 1e-4 * (factor * slope + 0.5 * factor * factor * curvature)
        if seen[2] > TOWARDS_LIMIT * clearance and seen[0] <= potential + fall:
            return factor, seen
        factor *= 0.5
    return 0.0, (potential, 0.0, 0.0)


def lengthen(
    q: np.ndarray,
    change: np.ndarray,
    factor: float,
    largest: float,
    seen: tuple[float, float, float],
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    trial: np.ndarray,
) -> tuple[float, float, float]:
    """Double an accepted step while that lowers the potential: an indefinite matrix says little of length."""
    while 2.0 * factor <= largest:
        advance(q, 2.0 * factor, change, trial)
        further = pose_sweep(trial, inputs, segments, disks, chain)
        if further[2] <= TOWARDS_LIMIT * seen[2] or further[0] >= seen[0]:
            break
        factor, seen = 2.0 * factor, further
    advance(q, factor, change, trial)
    return pose_sweep(trial, inputs, segments, disks, chain)


def leave_saddle(
    q: np.ndarray, inputs: np.ndarray, segments: np.ndarray, disks: np.ndarray, unit: float
) -> bool:
    """Move ``q`` off an unstable equilibrium, down along a direction of negative curvature.

    Returns whether there is a way down within the geometric limits.
    """
    chain = np.empty((q.shape[0], CHAIN_COLUMNS))
    residual, descent = np.empty_like(q), np.empty_like(q)
    change, trial = np.empty_like(q), np.empty_like(q)
    pivots = np.empty((q.shape[0], PIVOT_COLUMNS))
    potential, _, clearance = pose_sweep(q, inputs, segments, disks, chain)
    residual_sweep(disks, chain, residual)
    descend(segments, disks, chain, residual, descent, pivots)
    curvature = saddle_direction(unit, chain, pivots, descent, change)
    slope = inner(residual, change)
    if slope > 0.0:
        advance(change, -2.0, change, change)
        slope = -slope
    promised = (potential, slope, curvature)
    factor, seen = shorten(q, change, 1.0, promised, clearance, inputs, segments, disks, chain, trial)
    if factor == 0.0:
        return False
    lengthen(q, change, factor, 10.0 * LARGEST_TURN, seen, inputs, segments, disks, chain, trial)
    q[:] = trial
    return True


def find_equilibrium(
    q: np.ndarray, inputs: np.ndarray, segments: np.ndarray, disks: np.ndarray, unit: float, most: int
) -> tuple[int, int]:
    """Move ``q``, shape (n, dofs), to an equilibrium; ``unit`` is the length elongations compare with.

    Returns how it ended (STABLE, UNSTABLE, LIMIT, NOT_FOUND) and the iterations (at most ``most``). From an
    unstable one ``leave_saddle`` knows the way on.
    """
    chain = np.empty((q.shape[0], CHAIN_COLUMNS))
    residual, descent = np.empty_like(q), np.empty_like(q)
    change, trial = np.empty_like(q), np.empty_like(q)
    pivots = np.empty((q.shape[0], PIVOT_COLUMNS))
    potential, scale, clearance = pose_sweep(q, inputs, segments, disks, chain)
    single = math.inf
    for iteration in range(1, most + 1):
        residual_sweep(disks, chain, residual)
        negative = descend(segments, disks, chain, residual, descent, pivots)
        substitute_sweep(chain, descent, change)
        last, (single, turn) = single, measure(change, unit)
        if single < AT_REST and not (COUPLED and single < FALLING * last):  # cables may catch in a small step
            if negative == 0:
                advance(q, 1.0, change, q)
                return STABLE, iteration
            eliminate_exactly(segments, disks, chain, residual, descent, pivots)
            substitute_sweep(chain, descent, change)
            if measure(change, unit)[0] < FAR_FROM_REST:
                advance(q, 1.0, change, q)
            return UNSTABLE, iteration
        slope, fall_from = inner(residual, change), potential
        if slope > -ROUNDING * scale:
            fall_from = potential + scale  # the fall is below rounding: only the limits are checked
        factor, seen = shorten(
            q,
            change,
            min(1.0, LARGEST_TURN / max(turn, 1e-30)),
            (fall_from, slope, 0.0),
            clearance,
            inputs,
            segments,
            disks,
            chain,
            trial,
        )
        if factor == 0.0:
            return NOT_FOUND, iteration
        if negative > 0:
            largest = max(LARGEST_TURN / max(turn, 1e-30), 1.0)
            seen = lengthen(q, change, factor, largest, seen, inputs, segments, disks, chain, trial)
        q[:] = trial
        potential, scale, clearance = seen
        if clearance < AT_LIMIT:
            return LIMIT, iteration
    return NOT_FOUND, most


def examine(
    q: np.ndarray, inputs: np.ndarray, segments: np.ndarray, disks: np.ndarray, pose: np.ndarray
) -> tuple[float, float, float, int]:
    """Poses of the disks into ``pose``, shape (n, 3).

    Returns elastic energy, gravity energy (J), the largest residual (N or N m), and the number of negative
    eigenvalues of the potential energy's Hessian: at an equilibrium, its unstable directions.
    """
    chain, residual, descent = np.empty((q.shape[0], CHAIN_COLUMNS)), np.empty_like(q), np.empty_like(q)
    pivots = np.empty((q.shape[0], PIVOT_COLUMNS))
    pose_sweep(q, inputs, segments, disks, chain)
    residual_sweep(disks, chain, residual)
    negative = eliminate_exactly(segments, disks, chain, residual, descent, pivots)
    elastic, gravity = observe(q, inputs, segments, disks, chain, pose)
    return elastic, gravity, np.abs(residual).max(), negative
