"""Newton's method on the chain that ends in a stable equilibrium.

The potential energy must fall (Armijo); pivot blocks are made positive as they come, so that every step
descends. At a saddle the search stops, so that it can be reported, and continues along the direction of
negative curvature from the elimination. A trial beyond a geometric limit counts as infinitely high.

Arguments travel in groups:

- ``arm``: inputs, segment table, disk table;
- ``work``: chain; residual, descent, change, trial, shape of q; pivots; scalars.
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
    POTENTIAL,
    POTENTIAL_SCALE,
    SCALARS,
)
from statics.passes.rest_passes import RestPasses
from statics.passes.search import (
    AT_LIMIT,
    AT_REST,
    FALLING,
    LARGEST_TURN,
    LIMIT,
    NOT_FOUND,
    ROUNDED,
    STABLE,
    TOWARDS_LIMIT,
    UNSTABLE,
    add_scaled,
    clear,
    copy,
    is_balanced,
    largest,
    measure,
    pose_pass,
)

Arm = tuple[np.ndarray, np.ndarray, np.ndarray]
Work = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]

ROUNDING = 1e-11
"""Smallest predicted fall of the potential, over its scale, above rounding."""
FAR_FROM_REST = 1e-6
"""Largest Newton step (rad, or elongation over L0) at balanced forces; a larger one means that the matrix is
singular."""


@compiled
def eliminate(
    passes: RestPasses, keep_sign: float, segments: np.ndarray, disks: np.ndarray, work: Work
) -> int:
    """Eliminate every segment from H dq = -residual; returns the number of negative pivots.

    With ``keep_sign`` 1 pivots stay as they are, and those are the negative eigenvalues of the matrix; with 0
    they are made positive.
    """
    chain, residual, descent, _, _, pivots, scalars = work
    scalars[KEEP_SIGN] = keep_sign
    run(passes.eliminate, residual.shape[0], scalars, segments, disks, chain, residual, descent, pivots)
    return int(scalars[NEGATIVE_PIVOTS])


@compiled
def descend(passes: RestPasses, arm: Arm, work: Work) -> int:
    """Eliminate so that the step descends, exactly where it does so by itself; returns the negative pivots.

    Cables of given length may hold what is unstable without them: then pivots are negative, the matrix not.
    """
    _, segments, disks = arm
    negative = eliminate(passes, 0.0, segments, disks, work)
    if passes.lengths != 0 and negative > 0:
        if eliminate(passes, 1.0, segments, disks, work) == 0:
            return 0
        eliminate(passes, 0.0, segments, disks, work)
    return negative


@compiled
def substitute(passes: RestPasses, work: Work) -> None:
    """Set ``change`` from the result of the elimination."""
    chain, _, descent, change, _, _, scalars = work
    run(passes.substitute, change.shape[0], scalars, chain, descent, change)


@compiled
def inner(first: np.ndarray, second: np.ndarray) -> float:
    """Scalar product of two arrays of one row for each segment."""
    total = 0.0
    for i in range(first.shape[0]):
        for k in range(first.shape[1]):
            total += first[i, k] * second[i, k]
    return total


@compiled
def saddle_direction(passes: RestPasses, unit: float, work: Work) -> float:
    """Set ``change`` to a direction of negative curvature, at most 0.1 rad; returns its curvature.

    The negative pivot nearest to the tip gives its own eigenvector; substitution gives what follows.
    """
    _, _, descent, change, _, pivots, _ = work
    clear(descent)
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
    substitute(passes, work)
    shrink = 0.1 / max(measure(change, unit)[1], 1e-30)
    for i in range(change.shape[0]):
        for k in range(change.shape[1]):
            change[i, k] *= shrink
    return curvature * shrink * shrink


@compiled
def attempt(passes: RestPasses, q: np.ndarray, factor: float, arm: Arm, work: Work) -> None:
    """Set ``trial`` to q + factor * change; ``scalars`` hold its potential and clearance."""
    chain, _, _, change, trial, _, scalars = work
    add_scaled(q, factor, change, trial)
    pose_pass(passes, trial, arm[0], arm[1], arm[2], chain, scalars)


@compiled
def shorten(
    passes: RestPasses,
    q: np.ndarray,
    factor: float,
    enough: float,
    slope: float,
    curvature: float,
    clearance: float,
    arm: Arm,
    work: Work,
) -> float:
    """Halve the step until the potential falls enough (Armijo) and no geometric limit comes too close.

    ``enough`` is the potential to fall from, with its slope and curvature along ``change``; of the
    ``clearance`` at q a part must be left. Returns the factor, 0 if there is none; ``trial`` is the accepted
    q, ``scalars`` hold its potential and clearance.
    """
    scalars = work[6]
    for _ in range(60):
        attempt(passes, q, factor, arm, work)
        fall = 1e-4 * (factor * slope + 0.5 * factor * factor * curvature)
        if scalars[CLEARANCE] > TOWARDS_LIMIT * clearance and scalars[POTENTIAL] <= enough + fall:
            return factor
        factor *= 0.5
    return 0.0


@compiled
def lengthen(passes: RestPasses, q: np.ndarray, factor: float, longest: float, arm: Arm, work: Work) -> None:
    """Double an accepted step while that lowers the potential: an indefinite matrix predicts no length."""
    scalars = work[6]
    potential, clearance = scalars[POTENTIAL], scalars[CLEARANCE]
    while 2.0 * factor <= longest:
        attempt(passes, q, 2.0 * factor, arm, work)
        if scalars[CLEARANCE] <= TOWARDS_LIMIT * clearance or scalars[POTENTIAL] >= potential:
            break
        factor, potential, clearance = 2.0 * factor, scalars[POTENTIAL], scalars[CLEARANCE]
    attempt(passes, q, factor, arm, work)


@compiled
def leave_saddle(
    passes: RestPasses,
    q: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    unit: float,
) -> bool:
    """Move ``q`` off an unstable equilibrium, down along a direction of negative curvature.

    Returns whether the energy can fall within the geometric limits.
    """
    n, dofs = q.shape
    chain, pivots, scalars = (
        np.empty((n, passes.chain_columns)),
        np.empty((n, passes.pivot_columns)),
        np.empty(SCALARS),
    )
    rows = np.empty((4, n, dofs))
    residual, change, trial = rows[0], rows[2], rows[3]
    arm, work = (inputs, segments, disks), (chain, residual, rows[1], change, trial, pivots, scalars)
    pose_pass(passes, q, inputs, segments, disks, chain, scalars)
    potential, clearance = scalars[POTENTIAL], scalars[CLEARANCE]
    run(passes.residual, n, scalars, disks, chain, residual)
    descend(passes, arm, work)
    curvature = saddle_direction(passes, unit, work)
    slope = inner(residual, change)
    if slope > 0.0:
        add_scaled(change, -2.0, change, change)
        slope = -slope
    factor = shorten(passes, q, 1.0, potential, slope, curvature, clearance, arm, work)
    if factor == 0.0:
        return False
    lengthen(passes, q, factor, 10.0 * LARGEST_TURN, arm, work)
    copy(trial, q)
    return True


@compiled
def find_stable(
    passes: RestPasses,
    q: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    unit: float,
    most: int,
) -> tuple[int, int]:
    """Move ``q``, shape (n, dofs), to an equilibrium; ``unit`` is the length elongations compare with.

    Returns the outcome (STABLE, UNSTABLE, LIMIT, NOT_FOUND) and the iterations (at most ``most``). From an
    unstable one ``leave_saddle`` continues.
    """
    n, dofs = q.shape
    chain, pivots, scalars = (
        np.empty((n, passes.chain_columns)),
        np.empty((n, passes.pivot_columns)),
        np.empty(SCALARS),
    )
    rows = np.empty((4, n, dofs))
    residual, change, trial = rows[0], rows[2], rows[3]
    arm, work = (inputs, segments, disks), (chain, residual, rows[1], change, trial, pivots, scalars)
    pose_pass(passes, q, inputs, segments, disks, chain, scalars)
    single = math.inf
    for iteration in range(1, most + 1):
        potential, scale, clearance = scalars[POTENTIAL], scalars[POTENTIAL_SCALE], scalars[CLEARANCE]
        run(passes.residual, n, scalars, disks, chain, residual)
        negative = descend(passes, arm, work)
        substitute(passes, work)
        last = single
        single, turn = measure(change, unit)
        # Cables of given length may catch in a small step.
        if single < AT_REST and not (passes.lengths != 0 and single > ROUNDED and single < FALLING * last):
            return settle(passes, q, negative, unit, arm, work), iteration
        slope, enough = inner(residual, change), potential
        if slope > -ROUNDING * scale:
            enough = potential + scale  # the fall is below rounding: only the limits are checked
        longest = LARGEST_TURN / max(turn, 1e-30)
        factor = shorten(passes, q, min(1.0, longest), enough, slope, 0.0, clearance, arm, work)
        if factor == 0.0:
            return NOT_FOUND, iteration
        if negative > 0:
            lengthen(passes, q, factor, max(longest, 1.0), arm, work)
        copy(trial, q)
        if scalars[CLEARANCE] < AT_LIMIT:
            return LIMIT, iteration
    return NOT_FOUND, most


@compiled
def settle(passes: RestPasses, q: np.ndarray, negative: int, unit: float, arm: Arm, work: Work) -> int:
    """Take the last step to where all forces balance; returns whether that is STABLE or UNSTABLE."""
    change = work[3]
    if negative == 0:
        add_scaled(q, 1.0, change, q)
        return STABLE
    eliminate(passes, 1.0, arm[1], arm[2], work)
    substitute(passes, work)
    if measure(change, unit)[0] < FAR_FROM_REST:
        add_scaled(q, 1.0, change, q)
    return UNSTABLE


@compiled
def examine_stability(
    passes: RestPasses,
    q: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    rest_length: float,
    pose: np.ndarray,
) -> tuple[float, float, float, int, bool]:
    """Put the disks' poses into ``pose``, shape (n, 3).

    Returns elastic energy, gravity energy (J), the largest residual (N or N m), the number of negative
    eigenvalues of the potential energy's Hessian (at an equilibrium, its unstable directions), and whether
    the forces balance.
    """
    n, dofs = q.shape
    chain, scalars, residual = np.empty((n, passes.chain_columns)), np.empty(SCALARS), np.empty((n, dofs))
    pose_pass(passes, q, inputs, segments, disks, chain, scalars)
    run(passes.residual, n, scalars, disks, chain, residual)
    balanced = is_balanced(passes, disks, chain, residual, rest_length)
    negative = solve_exactly(passes, segments, disks, chain, residual, np.empty((n, dofs)))
    run(passes.observe, n, scalars, q, inputs, segments, disks, chain, pose)
    return scalars[ELASTIC_ENERGY], scalars[GRAVITY_ENERGY], largest(residual), negative, balanced


@compiled
def unbalanced(
    passes: RestPasses,
    q: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    residual: np.ndarray,
) -> float:
    """Unbalanced generalized forces into ``residual``, shape of q; returns the clearance."""
    scalars = np.empty(SCALARS)
    pose_pass(passes, q, inputs, segments, disks, chain, scalars)
    run(passes.residual, q.shape[0], scalars, disks, chain, residual)
    return scalars[CLEARANCE]


@compiled
def solve_exactly(
    passes: RestPasses,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    right: np.ndarray,
    change: np.ndarray,
) -> int:
    """Set change to -H^-1 right, for the q that ``chain`` is of; returns H's negative eigenvalues."""
    n, dofs = right.shape
    descent, pivots, scalars = np.empty((n, dofs)), np.empty((n, passes.pivot_columns)), np.empty(SCALARS)
    work = chain, right, descent, change, change, pivots, scalars
    negative = eliminate(passes, 1.0, segments, disks, work)
    substitute(passes, work)
    return negative
