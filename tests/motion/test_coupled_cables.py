"""Cables that rub or are driven by length: the chain's forces and matrices against the whole arm's."""

from typing import Any

import numpy as np
import pytest
import whole_arm
from whole_arm import difference_matrix, directional, gradient, random_state, relative_error
from whole_cables import WholeCables

from continuum_dyn.effects import Inertia, MaterialDamping, RotaryInertia
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Interval
from statics import (
    Arm,
    Bending,
    Cable,
    CableFriction,
    Cables,
    Extension,
    Gravity,
    Scene,
    StaticSolver,
)
from statics.arm import CableKind

TENSION, RUBS = CableKind(), CableKind(rubs=True)
LENGTH, BOTH = CableKind(driven_by_length=True), CableKind(driven_by_length=True, rubs=True)
KINDS = [(RUBS,), (LENGTH,), (BOTH,), (BOTH, TENSION, RUBS)]
BY_DEFAULT = KINDS[:2]
ON_ANY_MESH = [
    pytest.param(
        kinds, subsegments, marks=() if subsegments == 1 and kinds in BY_DEFAULT else pytest.mark.slow
    )
    for kinds in KINDS
    for subsegments in (1, 2)
]
STIFFNESS, SLIP_SPEED, DRAWING = 300.0, 0.02, 0.05
DRIVE = {TENSION: 0.7, RUBS: 1.3, LENGTH: 0.02, BOTH: 0.025}
"""Tensions (N), or displacements (m) that leave no cable slack in any of the states below."""


def scene_of(
    kinds: tuple[CableKind, ...], subsegments: int = 1, *, moves: bool = False, start: int | None = None
) -> Scene:
    """Three disks, and cables on either side whose holes differ; the last cable ends at the second disk.

    The first one leaves its sheath at the disk ``start``.
    """
    cables = tuple(
        Cable(
            f"cable_{number}",
            (0.009, 0.008, 0.006, 0.006)[: 3 + (number < 2)] if number % 2 == 0 else -0.006,
            anchor=2 if number == 2 else None,
            cable_stiffness=STIFFNESS if kind.driven_by_length else None,
            friction=0.2 + 0.1 * number if kind.rubs else 0.0,
            slip_speed=SLIP_SPEED,
            start=start if number == 0 else None,
        )
        for number, kind in enumerate(kinds)
    )
    arm = Arm.preset(
        "rone2012",
        disks=3,
        subsegments=subsegments,
        core_density=7800.0 if subsegments > 1 else None,
        reference_curvature=3.0,
        cables=cables,
    )
    friction = [CableFriction()] if any(kind.rubs for kind in kinds) else []
    motion = [Inertia(), RotaryInertia(), MaterialDamping(1.2e-3)] if moves else []
    return Scene(arm, [Bending(), Extension(), Gravity(), Cables(), *friction, *motion])


def drive_of(kinds: tuple[CableKind, ...]) -> np.ndarray:
    return np.array([DRIVE[kind] for kind in kinds])


def pieces_of(scene: Scene, drive: np.ndarray) -> np.ndarray:
    """Inputs that stay as they are; cables driven by length are said to be drawn in, all the same."""
    pieces = np.zeros((len(scene.inputs), 6))
    pieces[:, 1] = DRAWING
    pieces[: drive.size, 1] = drive
    return pieces


@pytest.mark.parametrize("start", [None, 1])
@pytest.mark.parametrize(("kinds", "subsegments"), ON_ANY_MESH)
def test_motion_agrees_with_kanes_method_under_the_tensions_of_the_laws(
    kinds: tuple[CableKind, ...], subsegments: int, start: int | None
) -> None:
    scene = scene_of(kinds, subsegments, moves=True, start=start)
    oracle, dynamics = WholeCables(scene, drive_of(kinds)), Dynamics(scene)
    interval = Interval(0.0, 1.0, pieces_of(scene, oracle.drive))
    for seed in range(3):
        q, u = random_state(scene, seed, bend=0.7)
        y = np.concatenate([q.ravel(), u.ravel(), [0.0, 0.0]])
        rate = dynamics.rate(0.0, y, interval)
        expected = whole_arm.accelerations(oracle.arm, q, u, oracle.in_motion(q, u))
        assert relative_error(rate[q.size : 2 * q.size].reshape(q.shape), expected) < 1e-11
        drives, lengths = oracle.drives(q), oracle.lengths
        speed = np.where(oracle.stiffness > 0.0, DRAWING, -directional(lengths, q, u).sum(axis=1))
        pulled_in = drives @ speed
        lost = np.sum((drives[:, None] - oracle.in_motion(q, u)) * -directional(lengths, q, u))
        core = rate[-1] - lost
        assert rate[-2] == pytest.approx(pulled_in, rel=1e-11)
        assert lost >= 0.0
        assert core > 0.0


@pytest.mark.parametrize("start", [None, 1])
@pytest.mark.parametrize(
    "kinds", [pytest.param(kinds, marks=() if kinds in BY_DEFAULT else pytest.mark.slow) for kinds in KINDS]
)
def test_jacobian_of_the_motion_is_exact(kinds: tuple[CableKind, ...], start: int | None) -> None:
    scene = scene_of(kinds, moves=True, start=start)
    dynamics, interval = Dynamics(scene), Interval(0.0, 1.0, pieces_of(scene, drive_of(kinds)))
    q, u = random_state(scene, seed=1, bend=0.7)
    y = np.concatenate([q.ravel(), u.ravel(), [0.0, 0.0]])
    steps = np.concatenate([np.tile([1e-3, 1e-5], len(q)), np.tile([1e-2, 1e-4], len(q)), [1.0, 1.0]])
    expected = difference_matrix(lambda y: dynamics.rate(0.0, y, interval), y, steps)
    found = dynamics.jacobian(0.0, y, interval)
    assert np.abs(found - expected).max(axis=1) == pytest.approx(0.0, abs=1e-6 * np.abs(expected).max())
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-8 * np.abs(expected).max())


def newton_step(scene: Scene, q: np.ndarray, drive: np.ndarray, before: np.ndarray) -> tuple[Any, ...]:
    """Residual and Newton step of the chain at rest with the pivots' signs, and how many are negative."""
    solver = StaticSolver(scene)
    kernel, segments, disks = solver.kernel, solver.segments, solver.disks
    for number, lengths in enumerate(before, start=1):
        if (name := f"length_before_{number}") in kernel.segment_columns:
            segments[:, kernel.segment_columns.index(name)] = np.repeat(lengths, scene.arm.subsegments)
    residual, descent, change = (np.empty_like(q) for _ in range(3))
    chain, pivots = np.empty((len(q), kernel.widths["chain"])), np.empty((len(q), 3))
    if "beyond" in kernel.signatures:
        kernel.run("lengths", q, drive, segments, chain)
        kernel.run("beyond", chain)
    kernel.run("pose", q, drive, segments, disks, chain)
    kernel.run("residual", disks, chain, residual)
    weights = {"keep_sign": 1.0} if kernel.conservative else {"slowing": 0.0}
    counted = kernel.run("eliminate", segments, disks, chain, residual, descent, pivots, **weights)
    kernel.run("substitute", chain, descent, change)
    return residual, change, counted.get("negative_pivots", np.nan)


@pytest.mark.parametrize("start", [None, 1])
@pytest.mark.parametrize(("kinds", "subsegments"), ON_ANY_MESH)
def test_newton_step_at_rest_solves_the_dense_system_but_for_turning_angles(
    kinds: tuple[CableKind, ...], subsegments: int, start: int | None
) -> None:
    """What changes of turning angles do to tensions is left out of the matrix, and of this one, too."""
    scene = scene_of(kinds, subsegments, start=start)
    oracle, slip_length = WholeCables(scene, drive_of(kinds)), 1e-6 * scene.arm.total_length
    unit = np.tile([1.0, scene.arm.rest_length], scene.arm.segments)
    for seed in range(4):
        q, _ = random_state(scene, seed, bend=0.7)
        turns, shape = oracle.turns(q), q.shape
        before = np.real(oracle.beyond(q)) + slip_length * np.random.default_rng(seed).normal(
            size=turns.shape
        )

        def tensions(q: np.ndarray, before: np.ndarray = before, turns: np.ndarray = turns) -> np.ndarray:
            return oracle.tensions(q, (before - oracle.beyond(q)) / slip_length, turns)

        def of_core(q: np.ndarray) -> np.ndarray:
            return gradient(lambda q: whole_arm.potential_energy(oracle.arm, q, 0 * oracle.drive), q).ravel()

        def pulls(q: np.ndarray) -> np.ndarray:
            return gradient(oracle.lengths, q).reshape(q.size, -1)

        def by_q(function: Any, q: np.ndarray = q) -> np.ndarray:
            steps = 0.01 * unit
            return difference_matrix(lambda y: function(y.reshape(q.shape)).ravel(), q.ravel(), steps)

        tau = tensions(q).ravel()
        of_cables = by_q(lambda q, tau=tau: pulls(q) @ tau)
        by_tension = pulls(q) @ gradient(tensions, q).reshape(q.size, -1).T
        matrix = by_q(of_core) + of_cables + by_tension
        expected = of_core(q) + pulls(q) @ tau
        residual, change, counted = newton_step(scene, q, oracle.drive, before)
        assert relative_error(residual, expected.reshape(shape)) < 1e-11
        dense = np.linalg.solve(matrix, -expected).reshape(shape)
        assert relative_error(change, dense) < 1e-8
        if RUBS not in kinds and BOTH not in kinds:
            scaled = matrix * unit[:, None] * unit
            assert counted == np.sum(np.linalg.eigvalsh((scaled + scaled.T) / 2) < 0)
