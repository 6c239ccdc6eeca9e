"""Motion: energy, the power ledger, rest where the statics say, and agreement of the integrators."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import SCENARIOS, motion, moving, rone2012

from continuum_dyn import Scenario, Trajectory, load_scenario, simulate
from continuum_dyn.integrators import Budget
from continuum_dyn.scenario.profiles import Constant, Ramp, Sine, Step
from continuum_dyn.scenario.solver import Method, Solver
from continuum_dyn.scenario.studies import MotionStudy, StepResponseStudy
from statics import Bending, Cables, Gravity, Outcome, Scene, equilibrium

TIGHT = Solver("chain", rtol=1e-9, atol=1e-12)


def without_extension(scene: Scene) -> Scene:
    return Scene(scene.arm, (effect for effect in scene.effects if effect.name != "extension"))


@pytest.fixture(scope="module")
def step_response() -> Scenario:
    return load_scenario(SCENARIOS / "step_response.toml")


def test_step_response_settles_to_the_static_equilibrium_within_a_micrometre(step_response: Scenario) -> None:
    run = simulate(step_response)
    assert run.outcome is Outcome.SETTLED
    assert run.static_gap is not None
    assert run.static_gap < 1e-6
    expected = equilibrium(step_response.scene, 1.0)
    np.testing.assert_allclose(np.array(run.tip), expected.tip, atol=1e-6)


def test_step_response_has_settled_after_half_a_second(step_response: Scenario) -> None:
    trajectory = motion(step_response)
    late = trajectory.time >= 0.5
    x, y, _ = equilibrium(step_response.scene, 1.0).tip
    away = np.hypot(trajectory.disk_x[late, -1] - x, trajectory.disk_y[late, -1] - y)
    assert away.max() < step_response.settled_within


def test_a_fifth_of_the_damping_does_not_settle_within_a_second() -> None:
    run = simulate(load_scenario(SCENARIOS / "step_response_light_damping.toml"))
    assert run.outcome is Outcome.NOT_SETTLED


def by_radau(step_response: Scenario, rtol: float) -> Trajectory:
    """Its first tenth of a second."""
    solver = Solver("Radau", rtol=rtol, atol=1e-3 * rtol)
    return motion(replace(step_response, study=MotionStudy(0.1, samples=101), solver=solver))


@pytest.fixture(scope="module")
def tight(step_response: Scenario) -> Trajectory:
    return by_radau(step_response, 1e-9)


def test_power_ledger_closes_to_the_tolerance(step_response: Scenario, tight: Trajectory) -> None:
    found = by_radau(step_response, 1e-5), by_radau(step_response, 1e-7), tight
    gaps = [np.abs(each.ledger_gap).max() / each.ledger["input_work"].max() for each in found]
    assert np.all(np.array(gaps) < [1e-5, 1e-7, 1e-9])


@pytest.mark.parametrize("method", ["DOP853", pytest.param("LSODA", marks=pytest.mark.slow)])
def test_undamped_release_keeps_its_energy(method: Method) -> None:
    scene = without_extension(moving(rone2012(), damping=False))
    solver = Solver(method, rtol=1e-13, atol=1e-16)
    release = Scenario(scene, (Step(before=2.0, after=0.0),), MotionStudy(0.05, samples=101), solver)
    ledger = motion(release).ledger
    energy = ledger["kinetic_energy"] + ledger["elastic_energy"] + ledger["gravity_energy"]
    assert np.ptp(energy) < 1e-9 * np.ptp(ledger["kinetic_energy"])
    np.testing.assert_array_equal(ledger["input_work"], 0.0)


@pytest.mark.slow
def test_undamped_release_with_extension_keeps_its_energy() -> None:
    scene = moving(rone2012(), damping=False)
    solver = Solver("DOP853", rtol=1e-12, atol=1e-15)
    release = Scenario(scene, (Step(before=2.0, after=0.0),), MotionStudy(0.004, samples=41), solver)
    ledger = motion(release).ledger
    energy = ledger["kinetic_energy"] + ledger["elastic_energy"] + ledger["gravity_energy"]
    assert np.ptp(energy) < 1e-9 * np.ptp(ledger["kinetic_energy"])


def test_work_of_a_constant_tension_is_tension_times_shortening(tight: Trajectory) -> None:
    half = tight.bend_angle / 2
    lengths = np.sinc(half / np.pi) * (tight.length - tight.bend_angle * 0.008)
    shortening = lengths[0].sum() - lengths.sum(axis=1)
    np.testing.assert_allclose(tight.ledger["input_work"], 1.0 * shortening, atol=1e-12)


def test_static_equilibrium_is_a_fixed_point_of_the_motion() -> None:
    scenario = Scenario(moving(rone2012()), (Constant(1.5),), StepResponseStudy(0.5, samples=11), TIGHT)
    run = simulate(scenario)
    assert run.trajectory is not None
    assert run.outcome is Outcome.SETTLED
    np.testing.assert_allclose(run.trajectory.disk_y, np.tile(run.equilibria[0].disk_y, (11, 1)), atol=1e-13)


@pytest.fixture(scope="module")
def swung() -> Scenario:
    """An arm without extension under a tension that swings."""
    scene = without_extension(moving(rone2012()))
    return Scenario(scene, (Sine(1.0, 0.5, 8.0),), MotionStudy(0.05, samples=41))


@pytest.fixture(scope="module")
def reference(swung: Scenario) -> Trajectory:
    return motion(replace(swung, solver=Solver("DOP853", rtol=1e-11, atol=1e-13)))


@pytest.mark.parametrize("method", ["RK45", "DOP853", "BDF", "LSODA", "Radau"])
def test_every_method_gives_the_same_motion(method: Method, swung: Scenario, reference: Trajectory) -> None:
    found = motion(replace(swung, solver=Solver(method, rtol=1e-8, atol=1e-11)))
    np.testing.assert_allclose(found.disk_y, reference.disk_y, atol=2e-8)


def test_extension_that_is_infinitely_stiff_is_no_extension() -> None:
    asked = (Step(before=0.0, after=1.0),), MotionStudy(0.1, samples=101)
    plain = rone2012()
    stiff = Scene(replace(plain.arm, area=5.027e-7 * 1e4), plain.effects)
    found = motion(Scenario(moving(stiff), *asked, TIGHT))
    expected = motion(Scenario(without_extension(moving(plain)), *asked, TIGHT))
    np.testing.assert_allclose(found.disk_y, expected.disk_y, atol=2e-8)


def test_a_scene_without_extension_has_one_coordinate_everywhere() -> None:
    scene = without_extension(moving(rone2012()))
    run = simulate(Scenario(scene, (Constant(1.0),), MotionStudy(0.01, samples=3)))
    assert run.trajectory is not None
    assert run.trajectory.elongation is None
    assert run.trajectory.elongation_rate is None
    assert run.equilibria[0].elongation is None
    assert run.equilibria[0].coordinates.shape == (4, 1)


def test_slow_ramp_follows_its_static_path() -> None:
    scenario = Scenario(
        moving(rone2012()), (Ramp(0.0, 2.0, 0.0, 4.0),), MotionStudy(4.0, samples=201, static_path=True)
    )
    run = simulate(scenario)
    assert run.trajectory is not None
    path = np.array([point.tip[1] for point in run.static_path])
    lag = np.abs(run.trajectory.disk_y[:, -1] - path)
    assert lag.max() < 5e-5  # of 12 mm of travel
    assert lag[100:].max() < 1e-5


def test_gravity_alone_swings_a_hanging_arm_about_rest() -> None:
    plain = rone2012()
    scene = moving(Scene(plain.arm, (Bending(), Gravity((0.0, -9.81)), Cables())))
    run = simulate(Scenario(scene, (Step(before=0.2, after=0.0),), StepResponseStudy(1.0), Solver("Radau")))
    assert run.outcome is Outcome.SETTLED


@pytest.mark.slow
@pytest.mark.parametrize("method", ["LSODA", "Radau", "BDF"])
def test_drive_that_starts_gently_from_rest_is_not_stepped_over(method: Method) -> None:
    study = MotionStudy(100.0, samples=2)
    asked = Scenario(moving(rone2012()), (Sine(1.0, 0.9, 20.0),), study, Solver(method))
    run = simulate(asked, budget=Budget(steps=1500))
    assert run.outcome is Outcome.BUDGET_EXCEEDED
    assert run.trajectory is not None
    assert 0.05 < run.trajectory.time[-1] < 20.0
    assert run.trajectory.tip_speed[-1] > 1e-3


def test_what_has_not_settled_says_by_how_much_and_when_it_would() -> None:
    scenario = load_scenario(SCENARIOS / "step_response_light_damping.toml")
    run, longer = simulate(scenario), simulate(replace(scenario, study=replace(scenario.study, duration=5.0)))
    assert run.trajectory is not None
    assert longer.trajectory is not None
    assert run.static_gap is not None
    assert f"{1e3 * run.static_gap:.2g} mm from the final equilibrium" in run.message
    assert f"moves at {1e3 * run.trajectory.tip_speed[-1]:.3g} mm/s" in run.message
    assert f"(limit {1e3 * scenario.settled_within:.2g} mm)" in run.message
    moved, (x, y, _) = longer.trajectory, longer.equilibria[-1].tip
    away = np.hypot(moved.disk_x[:, -1] - x, moved.disk_y[:, -1] - y)
    unsettled = np.maximum(away, moved.tip_speed) >= scenario.settled_within
    foreseen = float(run.message.rsplit(" s", 1)[0].rsplit(" ", 1)[1])
    assert foreseen == pytest.approx(moved.time[unsettled][-1], rel=0.2)
