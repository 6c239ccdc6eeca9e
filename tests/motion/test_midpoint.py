"""The midpoint rule: momenta that are the whole arm's, order 2, and energy that does not drift."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import whole_arm
from conftest import SCENARIOS, motion, moving, rone2012
from scipy.integrate import solve_ivp
from whole_arm import (
    bare_scene,
    difference_matrix,
    full_scene,
    gradient,
    heavy_scene,
    random_state,
    relative_error,
    stiff_scene,
)

from continuum_dyn import Scenario, Trajectory, load_scenario, modes, simulate
from continuum_dyn.effects import MaterialDamping
from continuum_dyn.integrators.midpoint import advance, momentum_passes
from continuum_dyn.integrators.scipy_solvers import MidpointSolver
from continuum_dyn.modes import fastest_frequency
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.record import write_log
from continuum_dyn.scenario.intervals import Interval, cut_into_intervals
from continuum_dyn.scenario.profiles import Constant, Profile, Sine, Step
from continuum_dyn.scenario.solver import Accuracy, Solver
from continuum_dyn.scenario.studies import MotionStudy
from statics import InputError, Outcome, Scene, equilibrium
from statics.kernels.slots import SCALARS

FIRST_PERIOD = 1 / 23.24
"""Of the paper's arm at rest under 2 N, released, s."""


def undamped(scene: Scene, without: str = "") -> Scene:
    """The scene without damping, and without the effect of that name."""
    left_out = ("material_damping", without)
    return Scene(scene.arm, (effect for effect in scene.effects if effect.name not in left_out))


def stiff(disks: int = 4) -> Scene:
    """The paper's arm without extension and damping."""
    return undamped(moving(rone2012(disks=disks), damping=False), without="extension")


def release(duration: float, samples: int, step: float | None = None, scene: Scene | None = None) -> Scenario:
    """The motion from rest under 2 N after the cable is cut."""
    study = MotionStudy(duration, samples=samples)
    asked = Solver("midpoint", step=step)
    return Scenario(scene or stiff(), (Step(before=2.0, after=0.0),), study, asked)


def energy_error(found: Trajectory) -> np.ndarray:
    """Energy less that at the start, over the range of the kinetic energy, shape (samples,)."""
    parts = ("kinetic_energy", "elastic_energy", "gravity_energy")
    energy = np.sum([found.ledger[name] for name in parts], axis=0)
    return (energy - energy[0]) / np.ptp(found.ledger["kinetic_energy"])


# ---- momenta ----


@pytest.mark.parametrize("scene_of", [full_scene, stiff_scene, bare_scene, heavy_scene])
def test_momenta_and_slopes_are_those_of_the_whole_arm(scene_of: Callable[[int], Scene]) -> None:
    """Momenta M u, dT/dq and dV/dq of all bodies."""
    scene = undamped(scene_of(3))
    arm, tension = whole_arm.whole_arm(scene), np.array([1.3, 0.7])[: scene.cables]
    kernel, *tables = Dynamics(scene).midpoint
    for seed in range(5):
        q, u = random_state(scene, seed)
        rates = u.T.ravel()
        by_q, p, slope = np.empty_like(q), np.empty_like(q), np.empty_like(q)
        chain, arm_tables = np.empty((len(q), kernel.widths["chain"])), (np.empty((0, 6)), *tables)
        scalars = np.empty(SCALARS)
        momentum_passes(kernel.passes, q, u, tension, arm_tables, chain, by_q, p, slope, scalars)
        mass = whole_arm.mass_and_forcing(arm, q, u, tension)[0]
        assert relative_error(p, (mass @ rates).reshape(-1, arm.n).T) < 1e-13
        assert relative_error(slope, whole_arm.kinetic_slope(arm, q, u)) < 1e-12
        potential = gradient(lambda q: whole_arm.potential_energy(arm, q, tension), q)
        assert relative_error(by_q, potential) < 1e-12


# ---- the step as a map ----


def one_step(scene: Scene, h: float) -> Callable[[np.ndarray], np.ndarray]:
    """The map (q, p) -> (q, p) of one step under 1 N, q and p in one vector."""
    kernel, *tables = Dynamics(scene).midpoint
    arm = (np.array([[0.0, 1.0, 0.0, 0.0, 0.0]]), *tables)
    shape = (2, scene.arm.disks, len(scene.coordinates))

    def step(z: np.ndarray) -> np.ndarray:
        q, p = np.empty(shape), np.empty(shape)
        q[0], p[0] = z.reshape(shape)
        past = np.zeros((3, *shape[1:]))
        taken, _ = advance(kernel.passes, 0.0, h, (q, p, np.zeros(2)), past, 1e-17, arm)
        assert taken == 1
        return np.concatenate([q[1].ravel(), p[1].ravel()])

    return step


def test_a_step_is_symplectic() -> None:
    """J' W J = W, with J the derivative of the map (Hairer, Lubich and Wanner 2006, VI.2)."""
    scene, h = stiff(disks=3), 5e-4
    q, u = random_state(scene, seed=1, bend=0.8)
    mass = whole_arm.mass_and_forcing(whole_arm.whole_arm(scene), q, u, np.array([1.0]))[0]
    units = np.repeat([1.0, mass.max() / h], 3)  # of coordinates and momenta, so that entries are alike
    step, z = one_step(scene, h), np.concatenate([q.ravel(), mass @ u.ravel()])
    J = difference_matrix(lambda x: step(units * x) / units, z / units, np.full(6, 1e-4))
    W = np.kron([[0.0, 1.0], [-1.0, 0.0]], np.eye(3))
    assert np.abs(J - np.eye(6)).max() > 1.0
    assert np.abs(J.T @ W @ J - W).max() < 1e-8


def test_motion_turned_back_returns_to_its_start() -> None:
    dynamics, (interval,) = Dynamics(stiff()), cut_into_intervals((Constant(1.0),), 0.5)
    y = dynamics.state(equilibrium(dynamics.scene, 2.0).coordinates)
    there = by_solve_ivp(dynamics, interval, y, step=1e-4).y[:, -1]
    moved = there * np.repeat([1.0, -1.0, 1.0], [4, 4, 2])
    back = by_solve_ivp(dynamics, interval, moved, step=1e-4).y[:, -1]
    assert np.abs(there[:4] - y[:4]).max() > 0.01
    np.testing.assert_allclose(back[:4], y[:4], atol=1e-11)
    np.testing.assert_allclose(back[4:8], 0.0, atol=1e-8)
    assert back[8] == pytest.approx(0.0, abs=1e-12)  # the work comes back, too


def by_solve_ivp(
    dynamics: Dynamics, interval: Interval, y: np.ndarray, step: float, **options: object
) -> Any:
    asked = {"dynamics": dynamics, "interval": interval, "step": step}
    return solve_ivp(lambda _t, y: y, (interval.start, interval.end), y, MidpointSolver, **asked, **options)  # pyright: ignore[reportArgumentType, reportCallIssue]


# ---- motions ----


@pytest.mark.slow
def test_midpoint_rule_is_of_second_order_under_a_changing_tension() -> None:
    scene, duration = stiff(), 0.05
    drive: tuple[Profile, ...] = (Sine(1.0, 0.9, 30.0),)
    asked = Scenario(scene, drive, MotionStudy(duration, samples=52))
    reference = motion(replace(asked, solver=Solver("DOP853", rtol=1e-12, atol=1e-14)))
    counts = np.array([1600, 2263, 3200, 4525, 6400])
    errors, works = [], []
    for count in counts:
        found = motion(replace(asked, solver=Solver("midpoint", step=duration / count)))
        assert found.counters["steps"] == count
        errors.append(np.abs(found.disk_y - reference.disk_y).max())
        works.append(np.abs(found.ledger["input_work"] - reference.ledger["input_work"]).max())
    assert np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(-2.0, abs=0.1)
    assert np.polyfit(np.log(counts), np.log(works), 1)[0] == pytest.approx(-2.0, abs=0.2)
    assert errors[0] < 1e-6


@pytest.mark.parametrize("periods", [600, pytest.param(10_000, marks=pytest.mark.slow)])
def test_energy_of_a_release_has_a_range_but_no_trend(periods: int) -> None:
    found = motion(release(periods * FIRST_PERIOD, samples=10_001))
    error = energy_error(found)
    trend = np.polyfit(found.time / found.time[-1], error, 1)[0]
    assert 1e-6 < np.ptp(error) < 1e-4
    assert abs(trend) < 0.03 * np.ptp(error)


def test_samples_between_the_steps_have_the_energy_of_the_steps() -> None:
    step = 2e-4
    at_steps = energy_error(motion(release(2000 * step, 2001, step)))
    between = energy_error(motion(release(2000 * step, 14_001, step)))
    assert np.ptp(between) < 1.02 * np.ptp(at_steps)


@pytest.mark.slow
def test_arm_with_extension_keeps_its_energy_and_follows_the_motion() -> None:
    asked = release(0.01, samples=101, scene=moving(rone2012(), damping=False))
    found = motion(asked)
    reference = motion(replace(asked, solver=Solver("DOP853", rtol=1e-11, atol=1e-14)))
    assert np.ptp(energy_error(found)) < 1e-6
    np.testing.assert_allclose(found.disk_y, reference.disk_y, atol=1e-7)


def test_rest_is_a_fixed_point_and_its_power_ledger_is_empty() -> None:
    asked = Solver("midpoint", step=1e-3)
    found = motion(Scenario(stiff(), (Constant(1.5),), MotionStudy(0.5, samples=11), asked))
    np.testing.assert_allclose(found.disk_y, np.tile(found.disk_y[0], (11, 1)), atol=1e-14)
    np.testing.assert_allclose(found.ledger["input_work"], 0.0, atol=1e-14)


def test_power_ledger_of_a_driven_arm_closes_to_second_order() -> None:
    asked = Scenario(stiff(), (Sine(1.0, 0.9, 9.0),), MotionStudy(1.0, samples=301))
    gaps = []
    for step in (2e-4, 1e-4):
        found = motion(replace(asked, solver=Solver("midpoint", step=step)))
        gaps.append(np.abs(found.ledger_gap).max() / np.abs(found.ledger["input_work"]).max())
        np.testing.assert_array_equal(found.ledger["dissipated_energy"], 0.0)
    assert gaps[0] < 1e-3
    assert gaps[0] / gaps[1] == pytest.approx(4.0, rel=0.2)


# ---- the solver behind SciPy's interface ----


def test_sampling_does_not_change_the_steps() -> None:
    dynamics, (interval,) = Dynamics(stiff()), cut_into_intervals((Step(before=2.0, after=0.0),), 0.2)
    y = dynamics.state(equilibrium(dynamics.scene, 2.0).coordinates)
    plain = by_solve_ivp(dynamics, interval, y, step=1e-4, dense_output=True)
    np.testing.assert_allclose(plain.sol(plain.t), plain.y, rtol=1e-9, atol=1e-12)
    at = np.linspace(0.0, 0.2, 57)
    sampled = by_solve_ivp(dynamics, interval, y, step=1e-4, t_eval=at)
    assert sampled.nfev == plain.nfev
    np.testing.assert_allclose(sampled.y, plain.sol(at), rtol=1e-9, atol=1e-12)


def test_work_is_counted_and_iterations_are_few() -> None:
    run = simulate(release(0.2, samples=201))
    assert run.trajectory is not None
    assert run.solver is not None
    assert run.solver.step is not None
    counters = run.trajectory.counters
    assert counters["steps"] == np.ceil(0.2 / run.solver.step)
    assert counters["segment_evaluations"] == 4 * counters["newton_iterations"]
    assert counters["newton_iterations"] < 5 * counters["steps"]


def test_log_names_the_step_and_no_tolerances(tmp_path: Path) -> None:
    run = simulate(release(0.01, samples=3))
    write_log(run, tmp_path / "release.h5")
    assert run.solver is not None
    with h5py.File(tmp_path / "release.h5") as file:
        assert file.attrs["step"] == run.solver.step
        assert "rtol" not in file.attrs


def test_step_that_is_much_too_long_says_so() -> None:
    asked = Solver("midpoint", step=3e-3)
    run = simulate(Scenario(stiff(), (Step(before=0.0, after=20.0),), MotionStudy(0.1, samples=3), asked))
    assert run.outcome is Outcome.DIVERGED
    assert "try a smaller [solver] step" in run.message


@pytest.mark.parametrize(("frequency", "expected"), [(9.0, 1 / 833.8), (5000.0, 1 / 5000)])
def test_default_step_is_a_twentieth_of_the_shortest_period_of_the_arm_or_its_drive(
    frequency: float, expected: float
) -> None:
    run = simulate(Scenario(stiff(), (Sine(1.0, 0.9, frequency),), MotionStudy(0.01), Solver("midpoint")))
    assert run.solver is not None
    assert run.solver.step == pytest.approx(expected / 20, rel=1e-3)


@pytest.mark.parametrize(("disks", "extension"), [(4, True), (30, False)])
def test_fastest_frequency_is_the_same_by_iteration(
    monkeypatch: pytest.MonkeyPatch, disks: int, extension: bool
) -> None:
    scene = moving(rone2012(disks=disks), damping=False) if extension else stiff(disks)
    dynamics, (interval,) = Dynamics(scene), cut_into_intervals((Step(before=2.0, after=0.0),), 1.0)
    y = dynamics.state(equilibrium(scene, 2.0).coordinates)
    dense = fastest_frequency(dynamics, interval, y)
    monkeypatch.setattr(modes, "MOST_DENSE", 0)
    assert fastest_frequency(dynamics, interval, y) == pytest.approx(dense, rel=1e-3)


# ---- what does not fit is refused ----


def test_damped_scene_is_refused() -> None:
    with pytest.raises(
        InputError,
        match=r'is for scenes without damping; damped by: material_damping\. Give method = "chain"',
    ):
        release(1.0, 3, scene=moving(rone2012()))
    free = stiff()
    release(1.0, 3, scene=Scene(free.arm, (*free.effects, MaterialDamping(retardation_time=0.0))))


def test_accuracy_is_refused() -> None:
    with pytest.raises(InputError, match=r"\[accuracy\] chooses tolerances"):
        replace(release(1.0, 3), accuracy=Accuracy(1e-6))


@pytest.mark.parametrize(
    ("solver", "said"),
    [
        ('method = "chain"\nstep = 1e-4', 'step belongs to method = "midpoint"'),
        ('method = "midpoint"\nrtol = 1e-9', r"rtol beside method = \"midpoint\": its steps are equal"),
        ('method = "midpoint"\nstep = 0.0', "greater than 0"),
    ],
)
def test_settings_of_other_methods_are_refused(tmp_path: Path, solver: str, said: str) -> None:
    good = (SCENARIOS / "step_response.toml").read_text()
    path = tmp_path / "scenario.toml"
    path.write_text(good.replace("[study]", f"[solver]\n{solver}\n[study]"))
    with pytest.raises(InputError, match=said):
        load_scenario(path)
