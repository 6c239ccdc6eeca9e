"""Common parts of both searches for an equilibrium: outcomes, limits, steps in mixed units."""

import math

import numpy as np

from statics.kernels.calling import run
from statics.kernels.compiled import compiled
from statics.kernels.slots import SCALARS
from statics.passes.rest_passes import RestPasses

STABLE, UNSTABLE, LIMIT, NOT_FOUND, BALANCED = 0, 1, 2, 3, 4
"""Outcomes of a search; BALANCED is an equilibrium of unknown stability."""
UNKNOWN = -1
"""Number of an equilibrium's unstable directions if it is not known."""

AT_REST = 1e-8
"""Largest last Newton step (rad, or elongation over L0): its square is below rounding."""
ROUNDED = 1e-15
"""Largest Newton step that is rounding even if it still falls: towards zero it may fall for ever."""
FALLING = 0.9
"""Largest ratio of a residual or a step to the last one while it still falls; above, it is rounding."""
AT_LIMIT = 1e-6
"""Largest clearance (over L0) at which an arm that still descends has reached its geometric limit."""
TOWARDS_LIMIT = 0.1
"""Smallest part of the clearance that a step must leave: else a step that is too long looks like a limit."""
UNBALANCED = 1e-8
"""Largest residual over the size of the forces that meet in it, at an equilibrium."""
ROUNDED_FORCE = 1e-12
"""Largest residual from rounding, over the largest such size or the softest segment's torque at 1 rad."""
LARGEST_TURN = 1.0
"""Largest turn of any disk in one step, rad."""


@compiled
def measure(change: np.ndarray, rest_length: float) -> tuple[float, float]:
    """Largest single change (rad, or elongation over L0), and largest change of any disk's angle."""
    single, angle, turn = 0.0, 0.0, 0.0
    for i in range(change.shape[0]):
        angle += change[i, 0]
        turn = max(turn, abs(angle))
        single = max(single, abs(change[i, 0]))
        if change.shape[1] == 2:
            single = max(single, abs(change[i, 1]) / rest_length)
    return single, max(single, turn)


@compiled
def add_scaled(q: np.ndarray, factor: float, change: np.ndarray, trial: np.ndarray) -> None:
    """Set trial to q + factor * change."""
    for i in range(q.shape[0]):
        for k in range(q.shape[1]):
            trial[i, k] = q[i, k] + factor * change[i, k]


@compiled
def clear(values: np.ndarray) -> None:
    """Set every number of an array, shape (n, columns), to zero."""
    for i in range(values.shape[0]):
        for k in range(values.shape[1]):
            values[i, k] = 0.0


@compiled
def copy(source: np.ndarray, target: np.ndarray) -> None:
    """Set every number of one array, shape (n, columns), to that of another."""
    for i in range(source.shape[0]):
        for k in range(source.shape[1]):
            target[i, k] = source[i, k]


@compiled
def largest(values: np.ndarray) -> float:
    """Largest absolute value of an array, shape (n, columns); not a number if one is not."""
    found = 0.0
    for i in range(values.shape[0]):
        for k in range(values.shape[1]):
            size = abs(values[i, k])
            if not size <= found:
                found = size
    return found


@compiled
def pose_pass(
    passes: RestPasses,
    q: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    scalars: np.ndarray,
) -> None:
    """Outward pass at rest for the inward passes, after the lengths of coupled cables."""
    n = q.shape[0]
    if passes.lengths != 0:
        run(passes.lengths, n, scalars, q, inputs, segments, chain)
        run(passes.beyond, n, scalars, chain)
    run(passes.pose, n, scalars, q, inputs, segments, disks, chain)


@compiled
def are_small(residual: np.ndarray, sizes: np.ndarray, unit: float) -> bool:
    """Whether every unbalanced force is small relative to the forces that contribute to it.

    ``sizes`` are these forces, and then the segment's stiffness against bending; ``unit`` is the length that
    makes torques of forces.
    """
    n, dofs = residual.shape
    greatest, softest = 0.0, math.inf
    for i in range(n):
        softest = min(softest, sizes[i, dofs])
        for k in range(dofs):
            greatest = max(greatest, sizes[i, k] * (unit if k == 1 else 1.0))
    for i in range(n):
        for k in range(dofs):
            lever = unit if k == 1 else 1.0
            allowed = UNBALANCED * sizes[i, k] * lever + ROUNDED_FORCE * (greatest + softest)
            if not abs(residual[i, k]) * lever <= allowed:
                return False
    return True


@compiled
def is_balanced(
    passes: RestPasses, disks: np.ndarray, chain: np.ndarray, residual: np.ndarray, unit: float
) -> bool:
    """Whether the unbalanced forces at the q of ``chain`` are small.

    ``unit`` is the length that makes torques of forces.
    """
    n, scalars = residual.shape[0], np.empty(SCALARS)
    sizes = np.empty((n, passes.size_columns))
    run(passes.sizes, n, scalars, disks, chain, sizes)
    return are_small(residual, sizes, unit)
