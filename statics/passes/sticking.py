"""A search for the equilibrium of cables with friction, which stick or slip from their earlier position.

Friction at a hole is tanh(s) of its largest, s = (length before - length beyond) / slip length, with a slip
length of 1e-6 of the arm's. Newton's method in q alone overshoots when a hole changes from sticking to
slipping, because tanh is a step on the scale of q. So the signs, sigma = tanh(s), are unknowns of their own:

    r(q, sigma) = 0      length beyond(q) + slip length artanh(sigma) = length before

Neither is steep in q and sigma, and Newton's method on both together takes about ten iterations, as
primal-dual interior-point methods do, with the slip length as barrier (Chan, Golub and Mulet 1999 for a law
of the same form). No step takes a sign beyond 1. A hole's change of sign follows from that of q, so the
matrix for q is the kernel's own, and the elimination along the chain solves for it; the change of the holes'
angles, which it neglects, is corrected only if the search fails without it. The kernel has no signs as input:
it receives the length before that produces them.
"""

import math

import numpy as np

from statics.kernels.calling import run
from statics.kernels.compiled import compiled
from statics.kernels.slots import SCALARS, SLOWING
from statics.passes.pseudo_transient import within_limits
from statics.passes.rest_passes import RestPasses
from statics.passes.search import (
    AT_REST,
    BALANCED,
    FALLING,
    LARGEST_TURN,
    NOT_FOUND,
    add_scaled,
    clear,
    copy,
    largest,
    measure,
)

TOWARDS_SLIPPING = 0.95
"""Largest part of a sign's distance to 1 that one step may cover."""
SLIPPING = 1.0 - 1e-15
"""Largest sign; 1 has no artanh."""
SIGNS_AT_REST = 1e-4
"""Largest last change of a sign."""
DIFFERENCE = 1e-4
"""Change of signs, and part of a step, over which forces and lengths are differenced."""
SOLVED = 1e-4
"""Largest part of a step that an exact one may lack."""
MOST_DIRECTIONS = 20
"""Largest number of directions that an exact step is made of."""

Arm = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Inputs, segment table, disk table."""
Holes = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Columns; lengths beyond (m); signs. The latter of shape (segments, rubbing cables).

Columns, shape (rubbing cables, 3), are that of the length beyond in the chain, and those of the length before
and of the slip length in the segment table.
"""


@compiled
def measure_lengths(
    passes: RestPasses, q: np.ndarray, arm: Arm, columns: np.ndarray, chain: np.ndarray, beyond: np.ndarray
) -> None:
    """Measure the cables' lengths beyond all holes, m, into ``beyond``."""
    n, scalars = q.shape[0], np.empty(SCALARS)
    run(passes.lengths, n, scalars, q, arm[0], arm[1], chain)
    run(passes.beyond, n, scalars, chain)
    for i in range(n):
        for c in range(columns.shape[0]):
            beyond[i, c] = chain[i, int(columns[c, 0])]


@compiled
def unbalanced_with(
    passes: RestPasses,
    q: np.ndarray,
    factor: float,
    change: np.ndarray,
    arm: Arm,
    holes: Holes,
    chain: np.ndarray,
    residual: np.ndarray,
) -> None:
    """Set ``residual`` to the unbalanced forces under sign + factor * change; lengths are measured."""
    columns, beyond, sign = holes
    segments, n, scalars = arm[1], q.shape[0], np.empty(SCALARS)
    for i in range(n):
        for c in range(columns.shape[0]):
            tried = max(-SLIPPING, min(SLIPPING, sign[i, c] + factor * change[i, c]))
            slip = 0.5 * math.log((1.0 + tried) / (1.0 - tried))
            segments[i, int(columns[c, 1])] = beyond[i, c] + slip * segments[i, int(columns[c, 2])]
    run(passes.pose, n, scalars, q, arm[0], segments, arm[2], chain)
    run(passes.residual, n, scalars, arm[2], chain, residual)


@compiled
def lack(remembered: np.ndarray, segments: np.ndarray, holes: Holes, lacking: np.ndarray) -> None:
    """Change of every sign that its own equation requires at fixed q, linearized, into ``lacking``."""
    columns, beyond, sign = holes
    for i in range(sign.shape[0]):
        for c in range(columns.shape[0]):
            slip = 0.5 * math.log((1.0 + sign[i, c]) / (1.0 - sign[i, c]))
            wanted = (remembered[i, c] - beyond[i, c]) / segments[i, int(columns[c, 2])]
            lacking[i, c] = (1.0 - sign[i, c] ** 2) * (wanted - slip)


@compiled
def solve_lagged(
    passes: RestPasses,
    arm: Arm,
    load: np.ndarray,
    chain: np.ndarray,
    spare: np.ndarray,
    change: np.ndarray,
) -> None:
    """Set ``change`` to the step of q that the elimination finds against the load."""
    n, scalars = load.shape[0], np.empty(SCALARS)
    scalars[SLOWING] = 0.0
    run(passes.eliminate, n, scalars, arm[1], arm[2], chain, load, spare, spare)
    run(passes.substitute, n, scalars, chain, spare, change)


@compiled
def find_step(
    passes: RestPasses,
    q: np.ndarray,
    arm: Arm,
    holes: Holes,
    lacking: np.ndarray,
    chain: np.ndarray,
    rows: np.ndarray,
) -> None:
    """Newton step of q and signs together: that of q into ``rows[3]``. ``rows`` are workspaces of q's shape.

    The change of the holes' angles is left out, as the elimination leaves it out.
    """
    residual, load, ahead = rows[0], rows[1], rows[2]
    most = largest(lacking)
    unbalanced_with(passes, q, 0.0, lacking, arm, holes, chain, residual)
    copy(residual, load)
    if most > 0.0:
        factor = DIFFERENCE / most
        unbalanced_with(passes, q, factor, lacking, arm, holes, chain, ahead)
        add_scaled(load, 0.5 / factor, ahead, load)
        unbalanced_with(passes, q, -factor, lacking, arm, holes, chain, ahead)
        add_scaled(load, -0.5 / factor, ahead, load)
        unbalanced_with(passes, q, 0.0, lacking, arm, holes, chain, residual)
    solve_lagged(passes, arm, load, chain, ahead, rows[3])


@compiled
def change_lengths(
    passes: RestPasses,
    q: np.ndarray,
    factor: float,
    change: np.ndarray,
    arm: Arm,
    columns: np.ndarray,
    chain: np.ndarray,
    trial: np.ndarray,
    spare: np.ndarray,
    by_step: np.ndarray,
) -> None:
    """Set ``by_step`` to the derivative of the lengths beyond along factor * change, m."""
    add_scaled(q, DIFFERENCE * factor, change, trial)
    measure_lengths(passes, trial, arm, columns, chain, by_step)
    add_scaled(q, -DIFFERENCE * factor, change, trial)
    measure_lengths(passes, trial, arm, columns, chain, spare)
    for i in range(by_step.shape[0]):
        for c in range(by_step.shape[1]):
            by_step[i, c] = 0.5 * (by_step[i, c] - spare[i, c]) / DIFFERENCE


@compiled
def scale(values: np.ndarray, factor: float) -> None:
    """Multiply every number of an array, shape (n, columns), by a factor."""
    for i in range(values.shape[0]):
        for k in range(values.shape[1]):
            values[i, k] *= factor


@compiled
def inner(one: np.ndarray, other: np.ndarray, unit: float) -> float:
    """Scalar product of two changes of q, rad^2; elongations count over ``unit``."""
    total = 0.0
    for i in range(one.shape[0]):
        total += one[i, 0] * other[i, 0]
        if one.shape[1] == 2:
            total += one[i, 1] * other[i, 1] / (unit * unit)
    return total


@compiled
def apply_exactly(
    passes: RestPasses,
    q: np.ndarray,
    along: np.ndarray,
    unit: float,
    arm: Arm,
    holes: Holes,
    chain: np.ndarray,
    other_chain: np.ndarray,
    rows: np.ndarray,
    at_holes: np.ndarray,
    result: np.ndarray,
) -> None:
    """Set ``result`` to A^-1 J along: J is the exact matrix, differenced, and A the elimination's."""
    columns, _, sign = holes
    ahead, behind, trial = rows[0], rows[1], rows[2]
    lengths, turning = at_holes[0], at_holes[1]
    size = 1.0 / max(measure(along, unit)[0], 1e-30)
    change_lengths(passes, q, size, along, arm, columns, other_chain, trial, lengths, turning)
    most = 1.0
    for i in range(sign.shape[0]):
        for c in range(columns.shape[0]):
            turning[i, c] *= -(1.0 - sign[i, c] ** 2) / arm[1][i, int(columns[c, 2])]
            most = max(most, abs(turning[i, c]))
    part = DIFFERENCE / most
    moved = (columns, lengths, sign)
    add_scaled(q, part * size, along, trial)
    measure_lengths(passes, trial, arm, columns, other_chain, lengths)
    unbalanced_with(passes, trial, part, turning, arm, moved, other_chain, ahead)
    add_scaled(q, -part * size, along, trial)
    measure_lengths(passes, trial, arm, columns, other_chain, lengths)
    unbalanced_with(passes, trial, -part, turning, arm, moved, other_chain, behind)
    for i in range(q.shape[0]):
        for k in range(q.shape[1]):
            ahead[i, k] = -0.5 * (ahead[i, k] - behind[i, k]) / (part * size)
    solve_lagged(passes, arm, ahead, chain, behind, result)


@compiled
def correct_step(
    passes: RestPasses,
    q: np.ndarray,
    change: np.ndarray,
    unit: float,
    arm: Arm,
    holes: Holes,
    chain: np.ndarray,
    directions: np.ndarray,
) -> None:
    """Correct an approximate step by generalized conjugate residuals (Eisenstat, Elman, Schultz).

    ``directions``, shape (2 most, n, dofs), is a workspace for directions and their images.
    """
    most, (n, dofs) = directions.shape[0] // 2, q.shape
    other_chain, at_holes = np.empty(chain.shape), np.empty((2, n, holes[0].shape[0]))
    rows = np.empty((4, n, dofs))
    left = rows[3]
    copy(change, left)
    clear(change)
    enough = SOLVED * SOLVED * inner(left, left, unit)
    for k in range(most):
        along, image = directions[2 * k], directions[2 * k + 1]
        copy(left, along)
        apply_exactly(passes, q, along, unit, arm, holes, chain, other_chain, rows, at_holes, image)
        for j in range(k):
            shared = inner(image, directions[2 * j + 1], unit)
            add_scaled(image, -shared, directions[2 * j + 1], image)
            add_scaled(along, -shared, directions[2 * j], along)
        size = max(math.sqrt(inner(image, image, unit)), 1e-300)
        scale(image, 1.0 / size)
        scale(along, 1.0 / size)
        taken = inner(left, image, unit)
        add_scaled(change, taken, along, change)
        add_scaled(left, -taken, image, left)
        if inner(left, left, unit) <= enough:
            break


@compiled
def change_signs(
    lacking: np.ndarray,
    factor: float,
    by_step: np.ndarray,
    segments: np.ndarray,
    holes: Holes,
) -> float:
    """Take the signs' part of the step, none beyond 1; ``by_step`` are the lengths' changes, m.

    Returns the largest change.
    """
    columns, _, sign = holes
    most = 0.0
    for i in range(sign.shape[0]):
        for c in range(columns.shape[0]):
            slipped = by_step[i, c] / segments[i, int(columns[c, 2])]
            change = factor * lacking[i, c] - (1.0 - sign[i, c] ** 2) * slipped
            up, down = TOWARDS_SLIPPING * (1.0 - sign[i, c]), TOWARDS_SLIPPING * (1.0 + sign[i, c])
            change = max(-down, min(up, change))
            sign[i, c] = max(-SLIPPING, min(SLIPPING, sign[i, c] + change))
            most = max(most, abs(change))
    return most


@compiled
def exchange(segments: np.ndarray, columns: np.ndarray, lengths: np.ndarray, put: bool) -> None:
    """Read the lengths before, m, from the segment table, or put them there."""
    for i in range(segments.shape[0]):
        for c in range(columns.shape[0]):
            if put:
                segments[i, int(columns[c, 1])] = lengths[i, c]
            else:
                lengths[i, c] = segments[i, int(columns[c, 1])]


@compiled
def find_sticking(
    passes: RestPasses,
    q: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    unit: float,
    columns: np.ndarray,
    exactly: bool,
    most: int,
) -> tuple[int, int]:
    """Move ``q``, shape (n, dofs), to an equilibrium, BALANCED, or say NOT_FOUND; and the iterations.

    Starts from cables that stick everywhere, without pull. ``unit`` is the length elongations compare with;
    ``columns`` are those of ``Holes``. Without ``exactly`` the change of the holes' angles is left out of the
    matrix, and the search ends close to the equilibrium only.
    """
    n, dofs = q.shape
    chain, scalars = np.empty((n, passes.chain_columns)), np.empty(SCALARS)
    rows, at_holes = np.empty((5, n, dofs)), np.zeros((6, n, columns.shape[0]))
    directions = np.empty((2 * MOST_DIRECTIONS if exactly else 0, n, dofs))
    remembered, beyond, sign, lacking, by_step = (
        at_holes[0],
        at_holes[1],
        at_holes[2],
        at_holes[3],
        at_holes[4],
    )
    change, trial = rows[3], rows[4]
    arm, holes = (inputs, segments, disks), (columns, beyond, sign)
    exchange(segments, columns, remembered, False)
    ended, iteration, single = NOT_FOUND, 0, math.inf
    while ended == NOT_FOUND and iteration < most:
        iteration += 1
        measure_lengths(passes, q, arm, columns, chain, beyond)
        lack(remembered, segments, holes, lacking)
        find_step(passes, q, arm, holes, lacking, chain, rows)
        if exactly:
            correct_step(passes, q, change, unit, arm, holes, chain, directions)
        last = single
        single, turn = measure(change, unit)
        longest = min(1.0, LARGEST_TURN / max(turn, 1e-30))
        factor = within_limits(passes, q, change, longest, inputs, segments, disks, chain, trial, scalars)
        if not factor > 0.0:
            break
        change_lengths(passes, q, factor, change, arm, columns, chain, rows[0], at_holes[5], by_step)
        copy(trial, q)
        turned = change_signs(lacking, factor, by_step, segments, holes)
        if single < AT_REST and turned < SIGNS_AT_REST and not (exactly and single < FALLING * last):
            ended = BALANCED
    exchange(segments, columns, remembered, True)
    return ended, iteration
