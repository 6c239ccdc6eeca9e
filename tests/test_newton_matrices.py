"""Newton's matrices in random scenes: what is eliminated are the differences of the residual."""

from dataclasses import replace
from typing import Any

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st
from random_scenes import Case, dynamics_of, following, holds_in, inextensible, interpreted, loaded, meshed
from whole_arm import difference_matrix

from continuum_dyn import implicit_kernel
from continuum_dyn.effects import QuadraticDrag
from statics import Scene, codegen, statics_kernel

KINDS = (loaded, following, meshed, inextensible)
"""Not with friction: its matrix leaves out what changes of turning angles do to tensions."""
STEPS = (3e-3, 10.0, 1e3)
"""Of differences of sixth order, rad, rad/s, rad/s^2: rates and accelerations enter as polynomials."""
SLACK = 3e-4
"""Stretch (m) that such a step may take from a cable: there the stiffness jumps."""
CLOSE = 1e-8


class Sweeps:
    """A kernel's residual and its elimination, for a case, in coordinates that are alike in stiffness.

    Elongations count in radii of gyration of the core, so that extending by 1 is as hard as bending by 1 rad.
    """

    def __init__(self, case: Case, recipe: codegen.Recipe) -> None:
        scene = case.scene.at_rest if recipe is statics_kernel.RECIPE else case.scene
        self.kernel = interpreted(scene, recipe)
        self.segments = scene.table("segment", self.kernel.SEGMENT_COLUMNS)
        self.disks = scene.table("disk", self.kernel.DISK_COLUMNS)
        self.inputs = case.scene.held(case.drives)
        self.shape = case.q.shape
        self.chain = np.empty((self.shape[0], self.kernel.CHAIN_COLUMNS))
        gyration = np.sqrt(scene.arm.per_disk("second_moment") / scene.arm.per_disk("area"))[0]
        self.unit = np.tile([1.0, gyration][: self.shape[1]], self.shape[0])

    def residual(self, *state: np.ndarray) -> np.ndarray:
        """At rest in q, or at (q, u, w), all without units; N m."""
        sweep = self.kernel.pose_sweep if len(state) == 1 else self.kernel.motion_sweep
        of_state = ((part * self.unit).reshape(self.shape) for part in state)
        sweep(*of_state, self.inputs, self.segments, self.disks, self.chain)
        residual = np.empty(self.shape)
        self.kernel.residual_sweep(self.disks, self.chain, residual)
        return residual.ravel() * self.unit

    def inverse(self, *start: float) -> np.ndarray:
        """That of what is eliminated, where the residual was last measured; ``start`` are its weights."""
        columns = []
        for torque in np.eye(self.unit.size):
            residual = (-torque / self.unit).reshape(self.shape)
            descent, change, pivots = np.empty(self.shape), np.empty(self.shape), np.empty((len(residual), 3))
            weights: Any = (*start, *self.kernel.ELIMINATE_START[len(start) :])
            self.kernel.eliminate_sweep(
                weights, self.segments, self.disks, self.chain, residual, descent, pivots
            )
            self.kernel.substitute_sweep(self.chain, descent, change)
            columns.append(change.ravel() / self.unit)
        return np.column_stack(columns)


def assert_inverse(inverse: np.ndarray, matrix: np.ndarray) -> None:
    size = (np.abs(matrix) @ np.abs(inverse)).max()
    assert np.abs(matrix @ inverse - np.eye(len(matrix))).max() < CLOSE * size


def stays_taut_or_slack(case: Case) -> bool:
    """Whether no cable that is driven by its length is about to go slack or to catch."""
    dynamics, y, _ = dynamics_of(case)
    seen = dynamics.observe(y[None], case.drives[None])
    driven = case.scene.driven_by_length
    shift = np.zeros(len(case.drives))
    shift[driven] = SLACK
    more, less = (
        case.scene.driven_by((case.drives + change)[None], seen.disk_x, seen.disk_y, seen.disk_theta)
        for change in (shift, -shift)
    )
    return bool(((more["tension"] > 0) == (less["tension"] > 0))[:, driven].all())


def differences_at(sweeps: Sweeps, *state: np.ndarray) -> list[np.ndarray]:
    """Matrices of the residual's derivatives by each part of the state, at that state."""
    matrices = []
    for part, (values, step) in enumerate(zip(state, STEPS[: len(state)], strict=True)):
        others = list(state)

        def along(changed: np.ndarray, part: int = part, others: list[np.ndarray] = others) -> np.ndarray:
            return sweeps.residual(*others[:part], changed, *others[part + 1 :])

        matrices.append(difference_matrix(along, values, np.full(values.size, step)))
    return matrices


@holds_in(*KINDS)
def test_matrix_at_rest_is_the_residuals_differences(case: Case) -> None:
    """Symmetric, and with loads that follow their disk unsymmetric."""
    assume(stays_taut_or_slack(case))
    sweeps = Sweeps(case, statics_kernel.RECIPE)
    q = case.q.ravel() / sweeps.unit
    (stiffness,) = differences_at(sweeps, q)
    sweeps.residual(q)
    as_it_is = (0.0,) if case.scene.without_potential else (0.0, 0.0, 1.0)
    assert_inverse(sweeps.inverse(*as_it_is), stiffness)


@holds_in(*KINDS, exponent=st.floats(-5.0, -2.0))
def test_matrix_of_an_implicit_stage_is_the_residuals_differences(case: Case, exponent: float) -> None:
    """M + g C + g^2 K at a state without motion; quadratic drag has no part in it there."""
    assume(stays_taut_or_slack(case))
    effects = case.scene.effects
    calm = [QuadraticDrag(0.0) if isinstance(effect, QuadraticDrag) else effect for effect in effects]
    sweeps = Sweeps(replace(case, scene=Scene(case.scene.arm, calm)), implicit_kernel.RECIPE)
    q, g = case.q.ravel() / sweeps.unit, 10**exponent
    still = np.zeros_like(q)
    stiffness, damping, mass = differences_at(sweeps, q, still, still)
    sweeps.residual(q, still, still)
    assert_inverse(sweeps.inverse(g, g**2), mass + g * damping + g**2 * stiffness)
