"""Several segments from disk to disk: they tend to the exact rod, in statics and in motion."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENARIOS, UPPER, motion, moving, rone2012

from continuum_dyn import Scenario, Trajectory, load_scenario, simulate
from continuum_dyn.experiments import cost
from continuum_dyn.integrators import Budget
from continuum_dyn.scenario.profiles import Sine, Step
from continuum_dyn.scenario.solver import Accuracy, Method, Solver
from continuum_dyn.scenario.studies import MotionStudy
from continuum_dyn.simulation.accuracy import tip_distance
from continuum_dyn.simulation.mesh import extrapolate, richardson, search_mesh
from statics import Arm, Extension, InputError, Outcome, Scene, equilibrium
from statics.judges.exact_rod import exact_rod
from statics.passes.rest_passes import REST

TENSIONS = (0.0, 1.0, 2.0, 5.0, 10.0)


def meshed(subsegments: int, scene: Scene | None = None, density: float | None = None) -> Scene:
    scene = scene or rone2012()
    return Scene(replace(scene.arm, subsegments=subsegments, core_density=density), scene.effects)


def errors(tension: float, subsegments: int) -> tuple[float, float]:
    """Distance of the tip (m) and its angle (rad) from the exact rod's."""
    found = np.array(equilibrium(meshed(subsegments), tension).tip)
    apart = np.abs(found - exact_rod(rone2012(), tension).tip)
    return float(np.hypot(*apart[:2])), float(apart[2])


# ---- statics ----


@pytest.mark.parametrize("tension", TENSIONS)
def test_tip_tends_to_the_exact_rods_with_second_order(tension: float) -> None:
    found = np.array([errors(tension, subsegments) for subsegments in (8, 16, 32)])
    np.testing.assert_allclose(np.log2(found[:-1] / found[1:]), 2.0, atol=0.07)


def test_known_errors_of_the_arm_of_table_1() -> None:
    at_rest = [errors(0.0, subsegments)[0] for subsegments in (1, 2, 4, 8)]
    pulled = [errors(2.0, subsegments)[0] for subsegments in (1, 2, 4, 8)]
    np.testing.assert_allclose(at_rest, [12.05e-6, 3.01e-6, 0.75e-6, 0.19e-6], atol=5e-9)
    np.testing.assert_allclose(pulled, [11.37e-6, 2.40e-6, 0.57e-6, 0.14e-6], atol=5e-9)


@pytest.mark.parametrize("tension", TENSIONS)
def test_two_meshes_tell_where_the_exact_rod_is_with_fourth_order(tension: float) -> None:
    rod = np.array(exact_rod(rone2012(), tension).tip)
    tips = {m: np.array(equilibrium(meshed(m), tension).tip) for m in (4, 8, 16, 32)}
    left = [np.hypot(*(richardson(tips[m], tips[2 * m]) - rod)[:2]) for m in (4, 8, 16)]
    np.testing.assert_allclose(np.log2(np.divide(left[:-1], left[1:])), 4.0, atol=0.15)


@pytest.mark.slow
def test_without_extension_the_order_is_the_same() -> None:
    scene = rone2012()
    stiff = Scene(scene.arm, (effect for effect in scene.effects if not isinstance(effect, Extension)))
    rod = exact_rod(stiff, 2.0).tip
    found = [np.hypot(*np.subtract(equilibrium(meshed(m, stiff), 2.0).tip, rod)[:2]) for m in (8, 16, 32)]
    np.testing.assert_allclose(np.log2(np.divide(found[:-1], found[1:])), 2.0, atol=0.07)


def test_one_segment_from_disk_to_disk_costs_nothing_extra() -> None:
    """Nothing of spans is in its kernel: neither in the steps nor in the tables."""
    assert "span" not in REST.write(meshed(1).structure)
    assert "span" in REST.write(meshed(2).structure)


def test_balance_reaches_rounding_and_anchors_are_disks() -> None:
    cable = replace(UPPER, anchor=2)
    scene = meshed(8)
    found = equilibrium(Scene(replace(scene.arm, cables=(cable,)), scene.effects), 5.0)
    assert found.outcome is Outcome.COMPLETED
    assert found.residual < 2e-14
    assert found.bend_angle.shape == (32,)
    assert found.disk_x.shape == (4,)
    pulled, free = np.split(found.curvature, 2)
    assert pulled.min() > 5 * np.abs(free).max()


def test_hole_limit_is_found_between_disks_too() -> None:
    """The exact rod's holes meet at 71.97 N; with eight segments from disk to disk it is within 1 %."""
    below, above = (equilibrium(meshed(8), tension) for tension in (71.0, 73.0))
    assert below.outcome is Outcome.COMPLETED
    assert above.outcome is Outcome.GEOMETRY_LIMIT


# ---- motion ----


def drive(scene: Scene, method: Method = "chain", rtol: float = 1e-9) -> Scenario:
    study = MotionStudy(0.1, samples=101)
    return Scenario(scene, (Sine(1.0, 0.9, 8.0),), study, Solver(method, rtol, 1e-3 * rtol))


@pytest.mark.slow
def test_chain_agrees_with_radau_on_its_exact_jacobian() -> None:
    scene = moving(meshed(2, density=7800.0))
    chain, radau = motion(drive(scene, rtol=1e-11)), motion(drive(scene, "Radau", 1e-9))
    assert tip_distance(chain, radau) < 2e-10


@pytest.mark.slow
def test_nodes_without_mass_are_the_limit_of_light_ones() -> None:
    massless = motion(drive(moving(meshed(3))))
    apart = [tip_distance(massless, motion(drive(moving(meshed(3, density=rho))))) for rho in (100.0, 1.0)]
    assert apart[0] == pytest.approx(100 * apart[1], rel=0.1)
    assert apart[1] < 1e-6


def test_start_without_accelerations_keeps_the_order() -> None:
    """A jump of the tension, and with it of the massless nodes' rates: errors still follow the tolerance."""
    scenario = replace(drive(moving(meshed(3))), drives=(Step(0.0, 1.0),))
    exact = motion(replace(scenario, solver=Solver("chain", 1e-12, 1e-15)))
    found = [motion(replace(scenario, solver=Solver("chain", rtol, 1e-15))) for rtol in (1e-6, 1e-8, 1e-10)]
    distances = [tip_distance(trajectory, exact) for trajectory in found]
    assert all(error < 300 * rtol * 0.08 for error, rtol in zip(distances, (1e-6, 1e-8, 1e-10), strict=True))


@pytest.mark.slow
@pytest.mark.parametrize("density", [None, 7800.0])
def test_motion_tends_to_its_limit_with_second_order(density: float | None) -> None:
    runs = [motion(drive(moving(meshed(m, density=density)))) for m in (2, 4, 8)]
    coarse, fine = (tip_distance(*pair) for pair in pairwise(runs))
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("method", ["Radau", "LSODA", "DOP853", "explicit"])
def test_nodes_without_mass_are_refused_for_methods_that_cannot(method: Method) -> None:
    with pytest.raises(InputError, match="core_density"):
        simulate(drive(moving(meshed(2)), method))


def test_nodes_without_mass_are_refused_where_nothing_is_damped() -> None:
    with pytest.raises(InputError, match="core_density"):
        simulate(drive(moving(meshed(2), damping=False)))


# ---- a mesh for an accuracy ----


def continuous(scenario: Scenario) -> Trajectory:
    """The motion of the continuous arm, from two fine meshes at tight tolerances."""
    tight = Solver("chain", rtol=1e-11, atol=1e-14)
    runs = [motion(replace(scenario.with_mesh(m, 1.0), accuracy=None, solver=tight)) for m in (16, 32)]
    return extrapolate(*runs)


@pytest.mark.slow
def test_true_error_from_the_continuous_arm_is_below_what_was_asked_and_not_far_below() -> None:
    scenario = load_scenario(SCENARIOS / "continuous_arm.toml")
    exact = continuous(scenario)
    for tip in (1e-3, 1e-5, 1e-7):
        run = simulate(replace(scenario, accuracy=Accuracy(tip)))
        assert run.trajectory is not None
        assert run.tip_error is not None
        true_error = tip_distance(run.trajectory, exact)
        assert tip / 30 < true_error < run.tip_error < tip


def test_mesh_of_a_ramp_is_chosen_too() -> None:
    asked = load_scenario(SCENARIOS / "tension_ramp.toml")
    run = simulate(replace(asked, accuracy=Accuracy(1e-7), chooses_mesh=True))
    assert run.mesh is not None
    assert run.mesh.reached
    exact = [exact_rod(rone2012(), tension).tip for (tension,) in zip(*asked.ramps, strict=True)]
    found = [point.tip for point in run.equilibria]
    assert np.abs(np.subtract(found, exact))[:, :2].max() < 1e-7


def test_accuracy_that_no_mesh_meets_ends_with_what_was_reached() -> None:
    found = search_mesh(lambda m: np.array([[1.0 / m, 0.0]]), 1e-9, most=40)
    assert found is not None
    assert not found.reached
    assert found.subsegments == 10
    assert found.estimate > 1e-9


def test_search_for_a_mesh_that_is_stopped_keeps_what_it_found() -> None:
    found = search_mesh(lambda m: None if m > 8 else np.array([[m**-2.0 + m**-4.0, 0.0]]), 1e-9, most=4000)
    assert found is not None
    assert not found.reached
    assert search_mesh(lambda _: None, 1e-9, most=4000) is None


@pytest.mark.slow
def test_mesh_that_the_budget_does_not_allow_ends_as_such() -> None:
    """The budget holds for each mesh; the first one's motion does not fit."""
    scenario = load_scenario(SCENARIOS / "continuous_arm.toml")
    run = simulate(replace(scenario, accuracy=Accuracy(1e-8)), budget=Budget(steps=600))
    assert run.outcome is Outcome.BUDGET_EXCEEDED
    assert "max_steps = " in run.message


def test_cost_of_a_scene_with_massless_nodes_says_what_to_give() -> None:
    scenario = replace(drive(moving(meshed(2))), drives=(Step(0.0, 1.0),))
    with pytest.raises(InputError, match="core_density"):
        cost.measure(scenario)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ('"autos"', 'or "auto" is expected; read "autos"'),
        ("0", "greater than or equal to 1"),
        ("2.5", "a whole number is expected; read 2.5"),
        ("5000", "20000 segments"),
        ('"auto"', r"needs an accuracy"),
    ],
)
def test_subsegments_that_cannot_be_are_refused(tmp_path: Path, given: str, told: str) -> None:
    text = (SCENARIOS / "step_response.toml").read_text()
    path = tmp_path / "scenario.toml"
    path.write_text(text.replace("[arm]", f"[arm]\nsubsegments = {given}"))
    with pytest.raises(InputError, match=told):
        load_scenario(path)


def test_density_needs_an_area() -> None:
    with pytest.raises(InputError, match="area"):
        Arm(2, 0.1, core_density=7800.0)


@pytest.mark.slow
def test_midpoint_rule_knows_cables_past_nodes_between_disks() -> None:
    """Undamped: it tends to the explicit method's motion with second order, and keeps the energy."""
    scene = moving(meshed(2, density=7800.0), damping=False)
    scenario = Scenario(scene, (Step(1.0, 2.0),), MotionStudy(4e-3, samples=9))
    exact = motion(replace(scenario, solver=Solver("explicit", 1e-12, 1e-15)))
    found = [motion(replace(scenario, solver=Solver("midpoint", step=step))) for step in (1e-6, 5e-7)]
    coarse, fine = (tip_distance(trajectory, exact) for trajectory in found)
    assert fine < 1e-7
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.3)
    assert np.abs(found[1].ledger_gap).max() < 1e-4 * exact.ledger["kinetic_energy"].max()
