"""Steps of the variational midpoint rule on the chain.

For a scene without dissipation. From coordinates q0 and momenta p0 a step h finds the mean rate v of

    p(qm, v) + h/2 (r - dT/dq) - p0 = 0,   qm = q0 + h/2 v,   Newton matrix M + (h/2)^2 K
    q1 = q0 + h v,   p1 = p0 - h (r - dT/dq)

with r = dV/dq, the residual at rest, and the tensions and the base of the step's middle (Marsden and West
2001, sec. 2.3.1 and 2.5, for alpha = 1/2). The rule is symplectic, symmetric and of order 2, so the energy's
error stays bounded and does not grow (Hairer, Lubich and Wanner 2006, ch. VI.6 and IX.8). The same rule on
(q, u) is not symplectic, since the mass depends on q. The matrix leaves out the velocity's own terms, which
nearly cancel.

Arguments travel in groups:

- ``arm``: pieces of the inputs' profiles, segment table, disk table;
- ``records``: q, p, shape (rows, n, dofs), and input work (rows,): row r is the end of step r;
- ``past``: mean rates of the last steps, latest first, shape (PAST, n, dofs);
- ``work``: shape (WORK, n, dofs), left to the functions below.
"""

import math

import numpy as np

from continuum_dyn.passes.accelerations import inputs_at
from continuum_dyn.passes.motion_passes import MidpointPasses
from statics.kernels.calling import run
from statics.kernels.compiled import compiled
from statics.kernels.slots import CLEARANCE, INPUT_POWER, LARGEST, SCALARS, STIFFNESS_WEIGHT
from statics.passes.search import add_scaled, copy

Arm = tuple[np.ndarray, np.ndarray, np.ndarray]
Records = tuple[np.ndarray, np.ndarray, np.ndarray]

PAST, WORK = 3, 6
MOST_ITERATIONS = 20
"""Largest number of Newton iterations of a step."""
STAGNANT = 1e5
"""Factor on the allowed change below which rounding may keep changes from shrinking."""


@compiled
def momentum_passes(
    passes: MidpointPasses,
    q: np.ndarray,
    u: np.ndarray,
    inputs: np.ndarray,
    arm: Arm,
    chain: np.ndarray,
    residual: np.ndarray,
    momentum: np.ndarray,
    slope: np.ndarray,
    scalars: np.ndarray,
) -> float:
    """dV/dq into ``residual``, dT/du into ``momentum``, dT/dq into ``slope``; returns the power in."""
    n, (_, segments, disks) = q.shape[0], arm
    if passes.lengths != 0:
        run(passes.lengths, n, scalars, q, u, inputs, segments, chain)
        run(passes.beyond, n, scalars, chain)
    run(passes.velocity, n, scalars, q, u, inputs, segments, disks, chain)
    run(passes.residual, n, scalars, disks, chain, residual)
    run(passes.momentum, n, scalars, chain, momentum, slope)
    return scalars[INPUT_POWER]


@compiled
def solve_step(
    passes: MidpointPasses,
    t: float,
    h: float,
    q: np.ndarray,
    p: np.ndarray,
    v: np.ndarray,
    allowed: float,
    arm: Arm,
    chain: np.ndarray,
    work: np.ndarray,
    pull: np.ndarray,
    scalars: np.ndarray,
) -> tuple[int, float]:
    """Newton's method for the mean rate ``v`` of a step, from its predictor; ``allowed`` in m.

    It ends when the change is below ``allowed``, or as small as rounding permits. Leaves r - dT/dq
    in ``pull``; returns the iterations (negative if it did not converge) and the power in. A step of h = 0
    turns momenta into rates, v = M^-1 p.
    """
    middle, residual, momentum, slope, descent, change = work[0], work[1], work[2], work[3], work[4], work[5]
    n, (_, segments, disks) = q.shape[0], arm
    inputs = np.empty(passes.inputs)
    inputs_at(t + 0.5 * h, arm[0], inputs)
    last, power = math.inf, 0.0
    for iteration in range(1, MOST_ITERATIONS + 1):
        for i in range(q.shape[0]):
            for k in range(q.shape[1]):
                middle[i, k] = q[i, k] + 0.5 * h * v[i, k]
        power = momentum_passes(passes, middle, v, inputs, arm, chain, residual, momentum, slope, scalars)
        for i in range(q.shape[0]):
            for k in range(q.shape[1]):
                pull[i, k] = residual[i, k] - slope[i, k]
                residual[i, k] = momentum[i, k] + 0.5 * h * pull[i, k] - p[i, k]
        scalars[STIFFNESS_WEIGHT] = 0.25 * h * h
        run(passes.eliminate, n, scalars, segments, disks, chain, residual, descent, descent)
        run(passes.substitute, n, scalars, chain, descent, change)
        run(passes.displacement, n, scalars, chain, change)
        size = abs(h) * math.sqrt(scalars[LARGEST])
        for i in range(q.shape[0]):
            for k in range(q.shape[1]):
                v[i, k] += change[i, k]
        if not math.isfinite(size):
            return -iteration, power
        if size <= allowed or (size <= STAGNANT * allowed and size >= 0.5 * last):
            return iteration, power
        last = size
    return -MOST_ITERATIONS, power


@compiled
def predict(past: np.ndarray, v: np.ndarray) -> None:
    """Extrapolate the next step's mean rate into ``v``, by the parabola through the last three."""
    for i in range(v.shape[0]):
        for k in range(v.shape[1]):
            v[i, k] = 3.0 * (past[0, i, k] - past[1, i, k]) + past[2, i, k]


@compiled
def advance(
    passes: MidpointPasses,
    t: float,
    h: float,
    records: Records,
    past: np.ndarray,
    allowed: float,
    arm: Arm,
) -> tuple[int, int]:
    """Equal steps from (t, row 0 of the records) until they are full, or a step does not converge.

    A step that leaves the arm at a geometric limit is taken only as the first, so that the ones before it
    are not lost with it. Returns the steps taken and the Newton iterations.
    """
    qs, ps, input_work = records
    rows, n, dofs = qs.shape
    v, pull = np.empty((n, dofs)), np.empty((n, dofs))
    work, chain, scalars = np.empty((WORK, n, dofs)), np.empty((n, passes.chain_columns)), np.empty(SCALARS)
    iterations = 0
    for row in range(1, rows):
        predict(past, v)
        begin = t + (row - 1) * h
        took, power = solve_step(
            passes, begin, h, qs[row - 1], ps[row - 1], v, allowed, arm, chain, work, pull, scalars
        )
        iterations += abs(took)
        if took < 0:
            return row - 1, iterations
        for i in range(n):
            for k in range(dofs):
                qs[row, i, k] = qs[row - 1, i, k] + h * v[i, k]
                ps[row, i, k] = ps[row - 1, i, k] - h * pull[i, k]
        run(passes.clearance, n, scalars, qs[row], arm[1])
        bad = scalars[CLEARANCE] <= 0.0
        if bad and row > 1:
            return row - 1, iterations
        input_work[row] = input_work[row - 1] + h * power
        for m in range(PAST - 1, 0, -1):
            copy(past[m - 1], past[m])
        copy(v, past[0])
        if bad:
            return row, iterations
    return rows - 1, iterations


@compiled
def start_momenta(
    passes: MidpointPasses, t: float, q: np.ndarray, u: np.ndarray, arm: Arm, p: np.ndarray
) -> None:
    """The momenta of coordinates and rates at time t, into ``p``."""
    n, dofs = q.shape
    work, chain, scalars = np.empty((2, n, dofs)), np.empty((n, passes.chain_columns)), np.empty(SCALARS)
    inputs = np.empty(passes.inputs)
    inputs_at(t, arm[0], inputs)
    momentum_passes(passes, q, u, inputs, arm, chain, work[0], p, work[1], scalars)


@compiled
def sample(
    passes: MidpointPasses,
    at: np.ndarray,
    t: float,
    h: float,
    records: Records,
    allowed: float,
    arm: Arm,
    found: np.ndarray,
) -> None:
    """States at the increasing times ``at`` into ``found``, (len(at), size); ``t`` is the time of row 0.

    Each by a shorter step of the same rule from the row before: a polynomial between the rows would show
    energy errors of its own.
    """
    qs, ps, input_work = records
    rows, n, dofs = qs.shape
    size = n * dofs
    v, pull, p = np.empty((n, dofs)), np.empty((n, dofs)), np.empty((n, dofs))
    work, chain, scalars = np.empty((WORK, n, dofs)), np.empty((n, passes.chain_columns)), np.empty(SCALARS)
    for m in range(len(at)):
        row = min(int((at[m] - t) / h), rows - 1)
        part = at[m] - (t + row * h)
        end = min(row + 1, rows - 1)
        for i in range(n):
            for k in range(dofs):
                v[i, k] = (qs[end, i, k] - qs[end - 1, i, k]) / h
        _, power = solve_step(
            passes, t + row * h, part, qs[row], ps[row], v, allowed, arm, chain, work, pull, scalars
        )
        q = found[m, :size].reshape((n, dofs))
        add_scaled(qs[row], part, v, q)
        add_scaled(ps[row], -part, pull, p)
        solve_step(passes, at[m], 0.0, q, p, v, allowed, arm, chain, work, pull, scalars)
        copy(v, found[m, size : 2 * size].reshape((n, dofs)))
        found[m, 2 * size], found[m, 2 * size + 1] = input_work[row] + part * power, 0.0
