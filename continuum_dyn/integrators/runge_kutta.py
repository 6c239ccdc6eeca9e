"""Steps of a diagonally implicit Runge-Kutta method on the chain.

Because q' = u, the acceleration w is the only unknown of a stage: with g = gamma h,

    u = U + g w,   q = Q + g u,   r(q, u, w) = 0,   Newton matrix M + g C + g^2 K

U and Q are known from the stages before. The matrix leaves out the velocity's own terms, so that it is the
chain's; Newton's method then takes about two iterations. Errors are metres: the largest displacement of a
disk under the error of the coordinates and, in an explicit method or where cables rub, under that of the
rates for as long as it may last. At the edge of their stability explicit steps let every stiff mode
oscillate within the tolerance: its displacement is negligible, but its rates and dissipation exceed those
of the motion.

Where cables rub, a stage's equations are solved until the rates are right, too, to a part of the slip speed,
about which friction changes its sign. In a short step, equations solved to a part of the tolerance leave
them wrong by many times that speed: friction takes the wrong sign, the next step is as short, and the arm
chatters.

Arguments travel in groups:

- ``arm``: pieces of the inputs' profiles, segment table, disk table;
- ``method``: a, c, error weights, predictor of the tableau; ``lasting``, the time (s) for which an error of
  the rates is taken to last; ``slip_speed`` (m/s), infinite without friction;
- ``stages``: q, u, w, shape (stages, n, dofs);
- ``workspace``: chain; six arrays like q, shape (6, n, dofs); scalars;
- ``records``: times, states, accelerations (rows, n, dofs), powers (rows, 3, 2): row r is the end of step r,
  its powers, in and dissipated, those at Lobatto's two inner points of that step and at its end.
"""

import math

import numpy as np

from continuum_dyn.passes.accelerations import (
    acceleration,
    clearance_of,
    displacement,
    inputs_at,
    motion_pass,
)
from continuum_dyn.passes.motion_passes import MotionPasses
from statics.kernels.calling import run
from statics.kernels.compiled import compiled
from statics.kernels.slots import (
    DAMPING_WEIGHT,
    DISSIPATED_POWER,
    INPUT_POWER,
    SCALARS,
    STIFFNESS_WEIGHT,
)
from statics.passes.search import copy

Records = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
Method = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, float, float]
Triple = tuple[np.ndarray, np.ndarray, np.ndarray]

MOST_ITERATIONS = 8
"""Largest number of Newton iterations of a stage."""
STAGE_PART = 0.02
"""Largest error of a stage's equations, over the tolerance, and of its rates, over the slip speed."""
ROOT_5 = math.sqrt(5.0)
LEAST_FALL = 0.03
"""Smallest ratio of an error estimate to the one expected: a lower estimate may pass through zero."""
SAFETY, MOST_GROWTH, MOST_SHRINK = 0.9, 5.0, 0.2

GOING_ON, FINISHED, TOO_SMALL, NO_ROOM = 0, 1, 2, 3


@compiled
def prepare(
    s: int,
    h: float,
    y: np.ndarray,
    a: np.ndarray,
    predictor: np.ndarray,
    stage_u: np.ndarray,
    stage_w: np.ndarray,
    known_q: np.ndarray,
    known_u: np.ndarray,
) -> None:
    """Sum what stage s takes from the stages before it, and predict its w; rows of all coordinates.

    One stage after the other, so that the inner loops run on vectors.
    """
    size = known_q.size
    for m in range(size):
        known_q[m], known_u[m], stage_w[s, m] = y[m], y[size + m], 0.0
    for j in range(s):
        part, weight = h * a[s, j], predictor[s, j]
        if part != 0.0:
            for m in range(size):
                known_q[m] += part * stage_u[j, m]
                known_u[m] += part * stage_w[j, m]
        if weight != 0.0:
            for m in range(size):
                stage_w[s, m] += weight * stage_w[j, m]


@compiled
def solve_stage(
    passes: MotionPasses,
    known_q: np.ndarray,
    known_u: np.ndarray,
    g: float,
    tolerance: float,
    slip_speed: float,
    rate: float,
    stage: Triple,
    inputs: np.ndarray,
    arm: Triple,
    workspace: Triple,
) -> tuple[int, float]:
    """Newton's method for one ``stage``: its q, u and w (n, dofs), w from its predictor; ``tolerance`` in m.

    Returns the iterations (negative if it did not converge), and the rate of convergence. That of earlier
    stages is not believed while an iteration changes speeds by more than ``slip_speed``, m/s: friction may
    have changed its sign on the way.
    """
    q, u, w = stage
    _, segments, disks = arm
    chain, work, scalars = workspace
    residual, descent, change = work[0], work[1], work[2]
    n = q.shape[0]
    # At a given error of the displacement, that of the rates is the larger the shorter the step.
    slip = g * slip_speed if g > 0.0 else math.inf
    allowed = STAGE_PART * min(tolerance, slip)
    last, iterations = 0.0, 0
    while True:
        for i in range(q.shape[0]):
            for k in range(q.shape[1]):
                u[i, k] = known_u[i, k] + g * w[i, k]
                q[i, k] = known_q[i, k] + g * u[i, k]
        if iterations > 0 and last <= slip and last * rate <= allowed * (1.0 - rate):
            return iterations, rate
        if iterations == MOST_ITERATIONS:
            return -iterations, rate
        motion_pass(passes, q, u, w, inputs, segments, disks, chain, scalars)
        run(passes.residual, n, scalars, disks, chain, residual)
        scalars[DAMPING_WEIGHT], scalars[STIFFNESS_WEIGHT] = g, g * g
        run(passes.eliminate, n, scalars, segments, disks, chain, residual, descent, descent)
        run(passes.substitute, n, scalars, chain, descent, change)
        size = g * g * displacement(passes, chain, change, scalars)
        for i in range(q.shape[0]):
            for k in range(q.shape[1]):
                w[i, k] += change[i, k]
        if iterations > 0:
            rate = max(0.3 * rate, size / max(last, 1e-300))
        last = size
        iterations += 1
        if rate >= 0.9 or not math.isfinite(size):
            return -iterations, 0.5


@compiled
def step_once(
    passes: MotionPasses,
    t: float,
    h: float,
    y: np.ndarray,
    rate: float,
    method: Method,
    tolerance: float,
    arm: Triple,
    stages: Triple,
    workspace: Triple,
    next_y: np.ndarray,
) -> tuple[float, float, int]:
    """All stages of one step from (t, y), whose first acceleration is known.

    The new state goes into ``next_y`` (without the integrals of the power); its acceleration is the last
    stage's. Returns the error (m; infinite if a stage did not converge), the rate of convergence, and the
    Newton iterations.
    """
    a, c, error_weights, predictor, lasting, slip_speed = method
    stage_q, stage_u, stage_w = stages
    chain, work, scalars = workspace
    count, n, dofs = stage_w.shape
    size = n * dofs
    flat_q, flat_u = stage_q.reshape((count, size)), stage_u.reshape((count, size))
    flat_w = stage_w.reshape((count, size))
    flat = work.reshape((work.shape[0], size))
    known_q, known_u, error = flat[3], flat[4], flat[5]
    inputs = np.empty(passes.inputs)
    for m in range(size):
        flat_q[0, m], flat_u[0, m] = y[m], y[size + m]
    iterations = 0
    for s in range(1, count):
        prepare(s, h, y, a, predictor, flat_u, flat_w, known_q, known_u)
        inputs_at(t + c[s] * h, arm[0], inputs)
        took, rate = solve_stage(
            passes,
            work[3],
            work[4],
            a[s, s] * h,
            tolerance,
            slip_speed,
            rate,
            (stage_q[s], stage_u[s], stage_w[s]),
            inputs,
            arm,
            workspace,
        )
        iterations += abs(took)
        if took < 0:
            return math.inf, rate, iterations
    last = count - 1
    for m in range(size):
        next_y[m], next_y[size + m] = flat_q[last, m], flat_u[last, m]
        error[m] = 0.0
        for s in range(count):
            error[m] += h * error_weights[s] * (flat_u[s, m] + lasting * flat_w[s, m])
    return displacement(passes, chain, work[5], scalars), rate, iterations


@compiled
def shrinkage(part: float, order: int) -> float:
    """Factor for a step whose error was ``part`` times the tolerance, too much or not finite."""
    return max(MOST_SHRINK, SAFETY * part ** (-1.0 / order)) if math.isfinite(part) else 0.25


@compiled
def growth(part: float, last_part: float, ratio: float, order: int) -> float:
    """Factor for the step after one whose error was ``part`` of the tolerance, after one of ``last_part``.

    Proportional and integral control (Hairer and Wanner 1996, sec. IV.2), within bounds. ``ratio`` is that of
    the two steps, or 0 for the first of them.
    """
    believed = max(part, LEAST_FALL * last_part * ratio**order)
    factor = SAFETY * believed ** (-0.7 / order) * last_part ** (0.3 / order)
    return min(MOST_GROWTH, max(MOST_SHRINK, factor))


@compiled
def advance(
    passes: MotionPasses,
    t_bound: float,
    h: float,
    longest: float,
    rate: float,
    records: Records,
    method: Method,
    order: int,
    tolerance: float,
    arm: Triple,
) -> tuple[int, int, float, float, int, int]:
    """Steps from row 0 of the records until they are full or ``t_bound`` (s) is reached.

    The first is tried with size ``h``, none is longer than ``longest``, s. One that leaves the arm at a limit
    or not finite is taken only as the first of its batch, so that those before it are kept. Returns how it
    ended, steps taken, next step's size, rate of convergence, rejected steps, and Newton iterations.
    """
    times, states, accelerations, _ = records
    count = len(method[1])
    _, n, dofs = accelerations.shape
    shape = (count, n, dofs)
    stages = (np.empty(shape), np.empty(shape), np.empty(shape))
    workspace = (np.empty((n, passes.chain_columns)), np.empty((6, n, dofs)), np.empty(SCALARS))
    taken, rejected, iterations, last_part, last_step = 0, 0, 0, 1.0, 0.0
    while taken < len(times) - 1:
        t = times[taken]
        left = t_bound - t
        if left <= 0.0:
            return FINISHED, taken, h, rate, rejected, iterations
        if h < 16.0 * 2.2e-16 * abs(t) or h < 1e-300:
            return TOO_SMALL, taken, h, rate, rejected, iterations
        h = min(h, longest)
        reaches = h >= 0.99 * left
        step = left if reaches else min(h, 0.5 * left)
        copy(accelerations[taken], stages[2][0])
        y, next_y = states[taken], states[taken + 1]
        error, rate, took = step_once(
            passes, t, step, y, rate, method, tolerance, arm, stages, workspace, next_y
        )
        iterations += took
        if not error <= tolerance:
            rejected += 1
            h = step * shrinkage(error / tolerance, order)
            continue
        part = max(error / tolerance, 1e-6)
        factor = growth(part, last_part, step / last_step if last_step > 0.0 else 0.0, order)
        last_part, last_step = part, step
        h = max(h, step) if reaches and factor > 1.0 else step * factor
        next_y[2 * n * dofs], next_y[2 * n * dofs + 1] = 0.0, 0.0
        bad = clearance_of(passes, arm[1], stages[0][count - 1]) <= 0.0 or not finite(next_y)
        if bad and taken > 0:
            return NO_ROOM, taken, step, rate, rejected, iterations
        taken += 1
        times[taken] = t_bound if reaches else t + step
        copy(stages[2][count - 1], accelerations[taken])
        add_work(passes, taken, records, arm, workspace)
        if bad:
            return NO_ROOM, taken, h, rate, rejected, iterations
    return (FINISHED if times[taken] >= t_bound else GOING_ON), taken, h, rate, rejected, iterations


@compiled
def finite(row: np.ndarray) -> bool:
    """Whether every number of a row is finite; makes no array of its own."""
    good = True
    for m in range(len(row)):
        good = good and math.isfinite(row[m])
    return good


@compiled
def add_work(
    passes: MotionPasses,
    row: int,
    records: Records,
    arm: Triple,
    workspace: Triple,
) -> None:
    """The integrals of the powers at the end of step ``row``, by Lobatto's rule on the step's interpolant.

    The stages would do for that in principle; but damping multiplies the stages' own, lower order in
    stiff coordinates, which the ends of the steps do not have.
    """
    times, states, accelerations, powers = records
    _, n, dofs = accelerations.shape
    size = n * dofs
    pieces, segments, disks = arm
    chain, work, scalars = workspace
    inputs, between, at = np.empty(passes.inputs), np.empty((3, states.shape[1])), np.empty(3)
    h = times[row] - times[row - 1]
    middle, apart = times[row - 1] + 0.5 * h, 0.5 * h / ROOT_5
    at[0], at[1], at[2] = middle - apart, middle + apart, times[row]
    interpolate(at[:2], records, row - 1, between)
    for m in range(states.shape[1]):
        between[2, m] = states[row, m]
    for m in range(3):
        inputs_at(at[m], pieces, inputs)
        q, u = between[m, :size].reshape((n, dofs)), between[m, size : 2 * size].reshape((n, dofs))
        motion_pass(passes, q, u, work[0], inputs, segments, disks, chain, scalars)
        powers[row, m, 0], powers[row, m, 1] = scalars[INPUT_POWER], scalars[DISSIPATED_POWER]
    for part in range(2):
        start, first, second, end = (
            powers[row - 1, 2, part],
            powers[row, 0, part],
            powers[row, 1, part],
            powers[row, 2, part],
        )
        gained = h / 12.0 * (start + 5.0 * (first + second) + end)
        states[row, 2 * size + part] = states[row - 1, 2 * size + part] + gained


@compiled
def start_records(passes: MotionPasses, t: float, y: np.ndarray, arm: Triple, records: Records) -> float:
    """Row 0 of the records: a time, a state, its acceleration and its powers.

    Returns the largest acceleration of a disk that comes of the coordinates' own, m/s^2.
    """
    times, states, accelerations, powers = records
    pieces, segments, disks = arm
    _, n, dofs = accelerations.shape
    inputs, chain, scalars = np.empty(passes.inputs), np.empty((n, passes.chain_columns)), np.empty(SCALARS)
    inputs_at(t, pieces, inputs)
    times[0] = t
    for m in range(len(y)):
        states[0, m] = y[m]
    work = np.empty((2, n, dofs))
    q, u = states[0, : n * dofs].reshape((n, dofs)), states[0, n * dofs : 2 * n * dofs].reshape((n, dofs))
    acceleration(passes, q, u, inputs, segments, disks, chain, work, accelerations[0], scalars)
    powers[0, 2, 0], powers[0, 2, 1] = scalars[INPUT_POWER], scalars[DISSIPATED_POWER]
    return displacement(passes, chain, accelerations[0], scalars)


@compiled
def interpolate(at: np.ndarray, records: Records, row: int, found: np.ndarray) -> None:
    """States at the increasing times ``at``, from the step after ``row`` on, into ``found``, (len(at), size).

    Quintic Hermite for coordinates, from their rates and accelerations at both ends of a step; its
    derivative for rates; the integrals of the powers are those of the cubics through their four values.
    """
    times, states, accelerations, powers = records
    _, n, dofs = accelerations.shape
    size = n * dofs
    flat = accelerations.reshape((len(accelerations), size))
    for m in range(len(at)):
        while row < len(times) - 2 and at[m] > times[row + 1]:
            row += 1
        h = times[row + 1] - times[row]
        s = (at[m] - times[row]) / h
        s2, s3 = s * s, s * s * s
        rest = 1.0 - s
        end = s3 * (10.0 - 15.0 * s + 6.0 * s2)
        start_rate, end_rate = s * rest * rest * rest * (1.0 + 3.0 * s), s3 * rest * (3.0 * s - 4.0)
        start_push, end_push = 0.5 * s2 * rest * rest * rest, 0.5 * s3 * rest * rest
        end_slope = 30.0 * s2 * rest * rest
        start_rate_slope = 1.0 - 18.0 * s2 + 32.0 * s3 - 15.0 * s2 * s2
        end_rate_slope = -12.0 * s2 + 28.0 * s3 - 15.0 * s2 * s2
        start_push_slope = s - 4.5 * s2 + 6.0 * s3 - 2.5 * s2 * s2
        end_push_slope = 1.5 * s2 - 4.0 * s3 + 2.5 * s2 * s2
        w0, w1 = flat[row], flat[row + 1]
        at_start, at_end, between = states[row], states[row + 1], found[m]
        for j in range(size):
            change = at_end[j] - at_start[j]
            u0, u1 = at_start[size + j], at_end[size + j]
            between[j] = (
                at_start[j]
                + end * change
                + h * (start_rate * u0 + end_rate * u1 + h * (start_push * w0[j] + end_push * w1[j]))
            )
            between[size + j] = (
                end_slope * change / h
                + start_rate_slope * u0
                + end_rate_slope * u1
                + h * (start_push_slope * w0[j] + end_push_slope * w1[j])
            )
        for part in range(2):
            y0, y1 = states[row, 2 * size + part], states[row + 1, 2 * size + part]
            power0, power1 = powers[row, 2, part], powers[row + 1, 2, part]
            apart = ROOT_5 * (powers[row + 1, 0, part] - powers[row + 1, 1, part])
            found[m, 2 * size + part] = (
                y0
                + s2 * (3.0 - 2.0 * s) * (y1 - y0)
                + h * s * rest * (rest * power0 - s * power1)
                + 1.25 * h * s2 * rest * rest * (apart + power1 - power0)
            )
