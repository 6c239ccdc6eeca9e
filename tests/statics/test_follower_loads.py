"""Forces that turn with their disk: against Kane's method, differences, closed forms, and Beck's column."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import whole_arm
from conftest import JET, at_rest, cantilever, edited, motion
from scipy.integrate import solve_ivp
from whole_arm import difference_matrix, full_scene, random_state, relative_error, spanned_scene

from continuum_dyn import load_scenario, simulate
from continuum_dyn.effects import Inertia, MaterialDamping
from continuum_dyn.integrators import choose
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.passes.motion_passes import MOTION
from continuum_dyn.scenario.intervals import Interval, cut_into_intervals
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.scenario.studies import MotionStudy
from statics import (
    Arm,
    Bending,
    DiskLoad,
    DiskLoads,
    InputError,
    Outcome,
    Scene,
    StaticSolver,
    equilibrium,
)
from statics.derivation.virtual_work import derive_statics
from statics.judges.exact_rod import exact_rod
from statics.kernels.loading import kernel_key

FOLLOWERS = (DiskLoad(2, (0.5, -0.9), 0.01, follower=True), DiskLoad(1, (-0.7, 0.4), follower=True))


def with_followers(scene: Scene, *loads: DiskLoad) -> Scene:
    """The scene with these loads, beside a dead one on its tip."""
    others = (effect for effect in scene.effects if effect.name != "loads")
    return Scene(scene.arm, (*others, DiskLoads((*loads, DiskLoad(scene.arm.disks, (0.2, 0.3), 0.02)))))


def inextensible(disks: int) -> Scene:
    arm = Arm.preset("rone2012", disks=disks)
    return Scene(arm, (Bending(), Inertia(), MaterialDamping(1.2e-3)))


# ---- forces ----


def accelerations(scene: Scene, q: np.ndarray, u: np.ndarray, inputs: np.ndarray) -> np.ndarray:
    pieces = np.array([[0.0, value, 0.0, 0.0, 0.0, 0.0] for value in inputs]).reshape(-1, 6)
    y = np.concatenate([q.ravel(), u.ravel(), [0.0, 0.0]])
    rate = Dynamics(scene).rate(0.0, y, Interval(0.0, 1.0, pieces))
    return rate[q.size : 2 * q.size].reshape(q.shape)


@pytest.mark.slow
def test_accelerations_equal_kanes_method_with_forces_along_the_disks_axes() -> None:
    scene, tension = with_followers(full_scene(2), *FOLLOWERS), np.array([1.3, 0.4])
    for seed in range(3):
        q, u = random_state(scene, seed)
        expected = whole_arm.accelerations(whole_arm.whole_arm(scene), q, u, tension)
        assert relative_error(accelerations(scene, q, u, tension), expected) < 2e-12


def test_constant_factor_is_a_constant_follower() -> None:
    halved = (replace(load, driven=True) for load in FOLLOWERS)
    doubled = (
        replace(load, force=(3 * load.force[0], 3 * load.force[1]), moment=3 * load.moment)
        for load in FOLLOWERS
    )
    driven, constant = with_followers(inextensible(2), *halved), with_followers(inextensible(2), *doubled)
    assert driven.inputs == ("load_factor_1", "load_factor_2")
    q, u = random_state(driven, seed=4)
    found = accelerations(driven, q, u, np.array([3.0, 3.0]))
    np.testing.assert_allclose(found, accelerations(constant, q, u, np.empty(0)), rtol=1e-12)


def residual_of(solver: StaticSolver, tension: np.ndarray, q: np.ndarray) -> np.ndarray:
    chain, residual = np.empty((len(q), solver.kernel.widths["chain"])), np.empty_like(q)
    solver.kernel.run("pose", np.ascontiguousarray(q), tension, solver.segments, solver.disks, chain)
    solver.kernel.run("residual", solver.disks, chain, residual)
    return residual


def round_a_loop(scene: Scene, work: Callable[[np.ndarray, np.ndarray], float]) -> float:
    """Sum of ``work(q, dq/dt) dt`` round a circle in the two bend angles, by the trapezoidal rule."""
    t = 2 * np.pi * np.arange(64) / 64
    way = np.column_stack([0.5 + 0.6 * np.cos(t), -0.3 + 0.6 * np.sin(t)])
    speed = np.column_stack([-0.6 * np.sin(t), 0.6 * np.cos(t)])
    return sum(work(q[:, None], v[:, None]) for q, v in zip(way, speed, strict=True)) * 2 * np.pi / 64


def test_follower_does_work_round_a_closed_loop_and_a_dead_load_does_not() -> None:
    """And as much as its force along the disk's way does, by the whole arm's poses."""
    follower, dead = (cantilever(2, DiskLoad(2, (-3.0, 1.0), follower=follows)) for follows in (True, False))

    def by_chain(scene: Scene) -> float:
        solver = StaticSolver(scene)
        return round_a_loop(scene, lambda q, v: -float(np.sum(residual_of(solver, np.empty(0), q) * v)))

    def along_the_way(q: np.ndarray, v: np.ndarray) -> float:
        theta = whole_arm.poses(arm, q)[2]
        by_t = whole_arm.directional(lambda q: np.array(whole_arm.poses(arm, q)), q, v)
        cosine, sine = np.cos(theta[-1]), np.sin(theta[-1])
        return float((-3.0 * cosine - sine) * by_t[0, -1] + (-3.0 * sine + cosine) * by_t[1, -1])

    arm = whole_arm.whole_arm(Scene(replace(follower.arm, area=1.0), follower.effects))
    assert abs(by_chain(dead)) < 1e-13
    assert by_chain(follower) == pytest.approx(round_a_loop(follower, along_the_way), rel=1e-12)
    assert abs(by_chain(follower)) > 0.5


# ---- Newton's matrices ----


any_chain = pytest.mark.parametrize("scene_of", [inextensible, full_scene, spanned_scene])


@any_chain
def test_static_newton_step_equals_the_dense_solution(scene_of: Callable[[int], Scene]) -> None:
    scene = with_followers(scene_of(3), *FOLLOWERS)
    solver = StaticSolver(scene)
    kernel, segments, disks = solver.kernel, solver.segments, solver.disks
    tension = np.array([1.3, 0.7])[: scene.cables]
    unit, slowing = np.array([1.0, scene.arm.rest_length])[: len(scene.coordinates)], 0.02

    def scaled(z: np.ndarray) -> np.ndarray:
        return (unit * residual_of(solver, tension, unit * z.reshape(-1, unit.size))).ravel()

    for seed in range(3):
        q, _ = random_state(scene, seed, bend=0.7)
        matrix = difference_matrix(scaled, (q / unit).ravel(), np.full(q.size, 0.01))
        assert np.abs(matrix - matrix.T).max() > 1e-3 * scene.arm.rest_length
        matrix += slowing * np.eye(q.size)
        chain = np.empty((len(q), kernel.widths["chain"]))
        residual, step, descent = np.empty_like(q), np.empty_like(q), np.empty_like(q)
        kernel.run("pose", q, tension, segments, disks, chain)
        kernel.run("residual", disks, chain, residual)
        kernel.run("eliminate", segments, disks, chain, residual, descent, descent, slowing=slowing)
        kernel.run("substitute", chain, descent, step)
        dense = np.linalg.solve(matrix, -(unit * residual).ravel()).reshape(q.shape) * unit
        assert relative_error(step, dense) < 1e-9


@any_chain
def test_implicit_newton_step_equals_the_dense_solution(scene_of: Callable[[int], Scene]) -> None:
    """(M + C g + K g^2) x = -r at a state at rest, with each matrix from differences of the residual."""
    scene, g = with_followers(scene_of(3), *FOLLOWERS), 2e-3
    kernel, segments, disks = Dynamics(scene).motion
    tension = np.array([1.3, 0.7])[: scene.cables]
    q, _ = random_state(scene, seed=5, bend=0.7)
    shape, still = q.shape, np.zeros_like(q)
    chain = np.empty((len(q), kernel.widths["chain"]))
    residual, step, descent = np.empty_like(q), np.empty_like(q), np.empty_like(q)
    unit = np.tile(np.array([1.0, scene.arm.rest_length])[: shape[1]], shape[0])

    def at(*state: np.ndarray) -> np.ndarray:
        kernel.run("motion", *state, tension, segments, disks, chain)
        kernel.run("residual", disks, chain, residual)
        return residual.ravel().copy()

    zero = np.zeros(q.size)
    stiffness = difference_matrix(lambda z: at(z.reshape(shape), still, still), q.ravel(), 0.01 * unit)
    damping = difference_matrix(lambda z: at(q, z.reshape(shape), still), zero, unit)
    mass = difference_matrix(lambda z: at(q, still, z.reshape(shape)), zero, unit)
    expected = np.linalg.solve(mass + g * damping + g**2 * stiffness, -at(q, still, still)).reshape(shape)
    weights = {"damping_weight": g, "stiffness_weight": g**2}
    kernel.run("eliminate", segments, disks, chain, residual, descent, descent, **weights)
    kernel.run("substitute", chain, descent, step)
    assert relative_error(step, expected) < 1e-8


# ---- closed forms of equilibria ----


@pytest.mark.parametrize("bend", [0.3, 1.0, 2.5, -2.0])
def test_one_segment_under_a_force_across_its_disk(bend: float) -> None:
    """F L^2 / (E J) = phi^3 / (1 - cos phi), from n . dp/dphi = L (1 - cos phi) / phi^2 (Eq. 11, 14)."""
    force = bend**3 / (1.0 - np.cos(bend))
    rest = at_rest(cantilever(1, DiskLoad(1, (0.0, force), follower=True)))
    assert rest.bend_angle[0] == pytest.approx(bend, rel=1e-12)
    assert rest.stable is None
    assert rest.unstable_directions is None
    assert rest.outcome is Outcome.COMPLETED


def elastica(across: float) -> tuple[float, float, float]:
    """Tip of the elastica under a force across its tip: an initial value problem from there, E J = L = 1.

    With psi the angle of the tip less that at a distance s from it: psi' = kappa, kappa' = F cos psi.
    """

    def rate(_: float, y: np.ndarray) -> list[float]:
        psi, kappa = y[0], y[1]
        return [kappa, across * np.cos(psi), np.cos(psi), -np.sin(psi)]

    theta, _, x, y = solve_ivp(rate, (0.0, 1.0), np.zeros(4), "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    cosine, sine = np.cos(theta), np.sin(theta)
    return cosine * x - sine * y, sine * x + cosine * y, theta


@pytest.mark.parametrize("across", [1.0, 8.0, 40.0])
def test_many_segments_under_a_force_across_the_tip_are_the_elastica(across: float) -> None:
    load = (0.0, across)
    coarse, fine = (np.array(at_rest(cantilever(n, DiskLoad(n, load, follower=True))).tip) for n in (32, 64))
    exact = np.array(elastica(across))
    np.testing.assert_allclose((coarse - exact) / (fine - exact), 4.0, rtol=0.05)  # second order
    np.testing.assert_allclose((4 * fine - coarse) / 3, exact, atol=2e-4)


# ---- structure, and what is refused ----


def test_scene_without_followers_has_none_in_its_kernel() -> None:
    dead, follower = (cantilever(3, DiskLoad(3, (1.0, 0.0), follower=follows)) for follows in (False, True))
    assert "follower" not in MOTION.write(dead.structure)
    assert "follower_force_x" in MOTION.write(follower.structure)
    assert kernel_key(dead.structure, MOTION) != kernel_key(follower.structure, MOTION)


def test_scene_names_what_has_no_potential() -> None:
    for loads in ((), (DiskLoad(1),), FOLLOWERS, (DiskLoad(1, driven=True, follower=True),)):
        scene = cantilever(2, *loads)
        assert derive_statics(scene.structure).conservative == (not scene.without_potential)


def test_follower_of_no_size_is_no_load() -> None:
    none, absent = cantilever(3, DiskLoad(2, follower=True)), cantilever(3)
    q, u = random_state(none, seed=6)
    found = accelerations(none, q, u, np.empty(0))
    np.testing.assert_allclose(found, accelerations(absent, q, u, np.empty(0)), rtol=1e-12)


def test_follower_on_a_disk_that_is_not_there_is_refused_by_name() -> None:
    with pytest.raises(InputError, match="follower load on disk 4: beyond the arm"):
        cantilever(3, DiskLoad(4, (1.0, 0.0), follower=True))


def test_exact_rod_refuses_followers() -> None:
    with pytest.raises(InputError, match="has no follower loads"):
        exact_rod(with_followers(inextensible(3), *FOLLOWERS))


# ---- scenarios: from the file to the verdict ----


@pytest.mark.slow
def test_jet_settles_further_round_than_a_force_that_keeps_its_direction(tmp_path: Path) -> None:
    jet = simulate(load_scenario(JET))
    dead = equilibrium(edited(JET, tmp_path, ("follower = true", "follower = false")).scene)
    assert jet.outcome is Outcome.SETTLED
    assert jet.equilibria[-1].stable
    assert jet.tip is not None
    assert jet.tip[2] == pytest.approx(1.402, abs=1e-3)
    assert dead.tip[2] == pytest.approx(0.993, abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["chain", "explicit", "LSODA", "Radau", "DOP853"])
def test_work_of_a_follower_is_booked_by_every_method(tmp_path: Path, method: Any) -> None:
    """Work in: the force along the disk's way, by the trapezoidal rule over fine samples."""
    jet = edited(JET, tmp_path)
    moved = motion(replace(jet, study=MotionStudy(0.02, samples=2001), solver=Solver(method, 1e-9, 1e-11)))
    theta, x, y = moved.disk_theta[:, -1], moved.disk_x[:, -1], moved.disk_y[:, -1]
    along = np.column_stack([-2.0 * np.sin(theta), 2.0 * np.cos(theta)])
    way = np.diff(np.column_stack([x, y]), axis=0)
    work = float(np.sum((along[1:] + along[:-1]) / 2 * way))
    assert moved.ledger["input_work"][-1] == pytest.approx(work, rel=1e-5)
    assert np.abs(moved.ledger_gap).max() < 1e-4 * work


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("disk = 4", "disk = 5", "follower load on disk 5: beyond the arm. Allowed: disks 1 to 4"),
        ("follower = true", "folower = true", "Did you mean 'follower'?"),
        ("follower = true", "follower = 1", "follower: true or false is expected; read 1"),
        ("[study]", '[solver]\nmethod = "midpoint"\n\n[study]', "without one: follower loads"),
    ],
)
def test_bad_follower_is_named_with_what_is_allowed(tmp_path: Path, old: str, new: str, told: str) -> None:
    with pytest.raises(InputError) as caught:
        edited(JET, tmp_path, (old, new))
    assert told in str(caught.value)


def test_undamped_motion_under_a_follower_is_never_left_to_the_midpoint_rule() -> None:
    scene = cantilever(2, DiskLoad(2, (0.0, 0.1), follower=True))
    dynamics = Dynamics(scene)
    start, still = dynamics.state(at_rest(scene).coordinates), cut_into_intervals((), 1e5).first
    assert choose(dynamics, start, still, 1e5).method == "explicit"
