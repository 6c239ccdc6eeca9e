"""Newton's matrices in random scenes: what is eliminated are the differences of the residual."""

from dataclasses import replace
from typing import Any

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st
from passes_by_hand import Passes
from random_scenes import Case, dynamics_of, following, holds_in, inextensible, loaded, meshed
from whole_arm import difference_matrix

from continuum_dyn.effects import QuadraticDrag
from continuum_dyn.passes.motion_passes import MOTION
from statics import Scene
from statics.kernels.loading import Family
from statics.passes.rest_passes import REST

KINDS = (loaded, following, meshed, inextensible)
"""Not with friction: its matrix leaves out what changes of turning angles do to tensions."""
STEPS = (3e-3, 10.0, 1e3)
"""Of differences of sixth order, rad, rad/s, rad/s^2: rates and accelerations enter as polynomials."""
SLACK = 3e-4
"""Stretch (m) that such a step may take from a cable: there the stiffness jumps."""
CLOSE = 1e-8


class Unitless:
    """A kernel's residual and its elimination, for a case, in coordinates that are alike in stiffness.

    Elongations count in radii of gyration of the core, so that extending by 1 is as hard as bending by 1 rad.
    """

    def __init__(self, case: Case, family: Family) -> None:
        scene = case.scene.at_rest if family is REST else case.scene
        self.passes = Passes(scene, family)
        self.inputs = case.scene.with_zero_rates(case.drives)
        gyration = np.sqrt(scene.arm.per_disk("second_moment") / scene.arm.per_disk("area"))[0]
        segments, dofs = self.passes.shape
        self.unit = np.tile([1.0, gyration][:dofs], segments)

    def residual(self, *state: np.ndarray) -> np.ndarray:
        """At rest in q, or at (q, u, w), all without units; N m."""
        outward: Any = self.passes.pose if len(state) == 1 else self.passes.motion
        outward(*((part * self.unit).reshape(self.passes.shape) for part in state), self.inputs)
        return self.passes.residual().ravel() * self.unit

    def inverse(self, **given: float) -> np.ndarray:
        """Inverse of the matrix that is eliminated, where the residual was last measured."""
        columns = []
        for torque in np.eye(self.unit.size):
            change, _ = self.passes.solve((-torque / self.unit).reshape(self.passes.shape), **given)
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


def differences_at(unitless: Unitless, *state: np.ndarray) -> list[np.ndarray]:
    """Matrices of the residual's derivatives by each part of the state, at that state."""
    matrices = []
    for part, (values, step) in enumerate(zip(state, STEPS[: len(state)], strict=True)):
        others = list(state)

        def along(changed: np.ndarray, part: int = part, others: list[np.ndarray] = others) -> np.ndarray:
            return unitless.residual(*others[:part], changed, *others[part + 1 :])

        matrices.append(difference_matrix(along, values, np.full(values.size, step)))
    return matrices


@holds_in(*KINDS)
def test_matrix_at_rest_is_the_residuals_differences(case: Case) -> None:
    """Symmetric, and with loads that follow their disk unsymmetric."""
    assume(stays_taut_or_slack(case))
    unitless = Unitless(case, REST)
    q = case.q.ravel() / unitless.unit
    (stiffness,) = differences_at(unitless, q)
    unitless.residual(q)
    assert_inverse(unitless.inverse(keep_sign=1.0), stiffness)


@holds_in(*KINDS, exponent=st.floats(-5.0, -2.0))
def test_matrix_of_an_implicit_stage_is_the_residuals_differences(case: Case, exponent: float) -> None:
    """M + g C + g^2 K at a state without motion; quadratic drag has no part in it there."""
    assume(stays_taut_or_slack(case))
    effects = case.scene.effects
    calm = [QuadraticDrag(0.0) if isinstance(effect, QuadraticDrag) else effect for effect in effects]
    unitless = Unitless(replace(case, scene=Scene(case.scene.arm, calm)), MOTION)
    q, g = case.q.ravel() / unitless.unit, 10**exponent
    still = np.zeros_like(q)
    stiffness, damping, mass = differences_at(unitless, q, still, still)
    unitless.residual(q, still, still)
    assert_inverse(
        unitless.inverse(damping_weight=g, stiffness_weight=g**2), mass + g * damping + g**2 * stiffness
    )
