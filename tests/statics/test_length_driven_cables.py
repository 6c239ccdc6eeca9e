"""Cables driven by their length: elastic, never pushing; at rest, in motion, and holding an arm up."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conftest import MOTION
from scipy.optimize import brentq

from continuum_dyn import Scenario, load_scenario, simulate
from continuum_dyn.scenario.profiles import Constant, Step
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.scenario.studies import EquilibriumStudy, MotionStudy, RampStudy
from statics import Arm, Bending, Cable, Cables, Extension, Gravity, InputError, Outcome, Scene
from statics.arc_length import follow
from statics.equilibria import Equilibrium, StaticSolver
from statics.ramp import ramp

SCENARIOS = Path(__file__).parents[2] / "scenarios"
STIFFNESS = 2e4


def driven(*cables: Cable, stiffness: float = 1.0, disks: int = 4) -> Scene:
    arm = Arm.preset("rone2012", disks=disks, youngs_modulus=2.1e11 * stiffness, cables=cables)
    return Scene(arm, (Bending(), Extension(), Gravity(), Cables()))


def at_rest(scene: Scene, *drives: float) -> Equilibrium:
    inputs = np.pad(drives, (0, len(scene.inputs) - len(drives)))
    return StaticSolver(scene).solve(inputs)


BY_LENGTH = Cable("upper", 0.008, cable_stiffness=STIFFNESS)


def test_one_segment_bends_as_its_closed_form_says() -> None:
    """EJ phi / L0 = -T dl/dphi with T = k (l - L0 + delta), l = sigma_0(phi/2) (L0 - phi r)."""
    arm = Arm(1, 0.02, youngs_modulus=2.1e11, second_moment=2.011e-14, cables=(BY_LENGTH,))
    found = at_rest(Scene(arm, (Bending(), Cables())), 1e-3)

    def unbalanced(phi: float) -> float:
        h, r = phi / 2, 0.008
        chord, slope = np.sin(h) / h, (np.cos(h) - np.sin(h) / h) / phi
        length = chord * (0.02 - phi * r)
        tension = STIFFNESS * (length - 0.02 + 1e-3)
        return 2.1e11 * 2.011e-14 / 0.02 * phi + tension * (slope * (0.02 - phi * r) - chord * r)

    assert found.bend_angle[0] == pytest.approx(brentq(unbalanced, 1e-3, 1.0, xtol=1e-15), rel=1e-10)


@pytest.mark.parametrize("displacement", [-1e-3, 0.0, 1e-3])
def test_equilibrium_study_takes_one_displacement(displacement: float) -> None:
    """As a ramp of that one number, and as the closed form of one segment."""
    arm = Arm(1, 0.02, youngs_modulus=2.1e11, second_moment=2.011e-14, cables=(BY_LENGTH,))
    scene = Scene(arm, (Bending(), Cables()))
    one = simulate(Scenario(scene, (Constant(displacement),), EquilibriumStudy()))
    many = simulate(Scenario(scene, ((displacement,),), RampStudy()))
    assert one.outcome is many.outcome is Outcome.COMPLETED
    assert one.tip == many.tip == at_rest(scene, displacement).tip
    assert (one.equilibria[0].tension[0] > 0.0) == (displacement > 0.0)


def test_equilibrium_study_refuses_a_displacement_that_changes() -> None:
    with pytest.raises(InputError, match="one number for each tension, displacement and load factor"):
        Scenario(driven(BY_LENGTH), (Step(0.0, 1e-3),), EquilibriumStudy())


def test_slack_cable_is_none() -> None:
    found = at_rest(driven(BY_LENGTH), -2e-3)
    without = at_rest(Scene(driven(BY_LENGTH).arm, (Bending(), Extension(), Gravity())))
    assert found.tension[0] == 0.0
    np.testing.assert_allclose(found.coordinates, without.coordinates, rtol=1e-12, atol=1e-18)


@pytest.mark.parametrize("gravity", [(0.0, 2e-4), (0.25, 0.0)])
def test_cable_that_catches_in_the_last_step_of_the_search_is_in_balance(
    gravity: tuple[float, float],
) -> None:
    """One step leads to rest from straight, where the cables are on the verge of slack."""
    cables = tuple(Cable(f"{r}", r, cable_stiffness=500.0) for r in (0.007, -0.005))
    scene = Scene(driven(*cables, disks=1).arm, (Bending(), Extension(), Gravity(gravity), Cables()))
    found = at_rest(scene, 0.0, 0.0)
    assert 0.0 < found.tension.max() < 1e-6  # N
    assert found.residual < 1e-14  # N, N m


@pytest.mark.parametrize("displacement", [5e-4, 2e-3, 4e-3])
def test_arm_rests_as_under_the_tension_that_the_length_makes(displacement: float) -> None:
    found = at_rest(driven(BY_LENGTH), displacement)
    under = at_rest(driven(Cable("upper", 0.008)), float(found.tension[0]))
    np.testing.assert_allclose(found.coordinates, under.coordinates, rtol=1e-9, atol=1e-13)
    drawn_in = under.cable_displacement[0] + found.tension[0] / STIFFNESS
    assert drawn_in == pytest.approx(displacement, abs=1e-12)


def test_ramp_that_a_cable_catches_in_does_not_jump_and_its_path_is_followed() -> None:
    """The path has a corner there, at -0.087 mm: so much does the hanging arm draw out of a slack cable."""
    solver = StaticSolver(driven(BY_LENGTH))
    displacements = np.array([[-2e-3], [4e-3]])
    inputs = np.hstack([displacements, np.zeros((2, len(solver.scene.inputs) - 1))])
    path, points = follow(solver, inputs), ramp(solver, inputs)
    assert path.outcome is Outcome.COMPLETED
    assert not path.critical
    assert not points[1].jumped
    np.testing.assert_allclose(path.end.coordinates, points[1].coordinates, atol=1e-12)


def test_ramp_takes_rows_of_any_layout_in_memory() -> None:
    """As lists for one cable of given length and one of given tension make them, one after the other."""
    scene = driven(*(Cable(f"{r}", r, cable_stiffness=STIFFNESS) for r in (0.008, -0.008)))
    rows = np.array([[5e-4, 0.0, 0.0, 0.0], [1e-3, -5e-4, 0.0, 0.0], [5e-4, 0.0, 0.0, 0.0]])
    found, expected = (ramp(StaticSolver(scene), points) for points in (np.asfortranarray(rows), rows))
    assert [point.tip for point in found] == [point.tip for point in expected]
    path, its = (follow(StaticSolver(scene), points).points for points in (np.asfortranarray(rows), rows))
    assert [point.tip for point in path] == [point.tip for point in its]


def test_cables_of_given_length_hold_an_arm_up_that_would_buckle() -> None:
    """Upright, and too soft to stand by itself: unstable without cables or under tensions, stable held."""
    offsets = (0.008, -0.008)
    held = driven(*(Cable(f"{r}", r, cable_stiffness=STIFFNESS) for r in offsets), stiffness=0.003)
    pulled = driven(*(Cable(f"{r}", r) for r in offsets), stiffness=0.003)
    effects = (Bending(), Extension(), Gravity((-9.81, 0.0)), Cables())
    upright = [Scene(scene.arm, effects) for scene in (held, pulled)]
    stands = at_rest(upright[0], 1e-5, 1e-5)
    falls = at_rest(upright[1], *stands.tension)
    assert stands.stable
    assert np.abs(stands.bend_angle).max() < 1e-12
    assert np.abs(falls.bend_angle).max() > 0.1


@pytest.mark.slow
def test_motion_with_a_cable_that_goes_slack_and_catches_keeps_its_ledger() -> None:
    scenario = load_scenario(SCENARIOS / "length_driven.toml")
    run = simulate(replace(scenario, solver=Solver("chain", rtol=1e-9, atol=1e-11)))
    motion = run.trajectory
    assert motion is not None
    lower = motion.tension[:, 1]
    assert (np.diff((lower > 0.0).astype(int)) > 0).any()  # it catches
    assert lower.min() == 0.0
    energy = max(np.abs(values).max() for name, values in motion.ledger.items() if "power" not in name)
    assert np.abs(motion.ledger_gap).max() < 2e-5 * energy
    assert run.static_gap is not None
    assert run.static_gap < 1e-5


@pytest.mark.slow
def test_jump_of_the_length_puts_its_work_into_the_ledger() -> None:
    scenario = load_scenario(SCENARIOS / "length_driven.toml")
    steps = (Step(0.0, 5e-4, at=0.01), Step(0.0, -1e-3, at=0.01))
    motion = simulate(replace(scenario, drives=steps)).trajectory
    assert motion is not None
    work = motion.ledger["input_work"]
    assert np.diff(work).max() > 0.5 * STIFFNESS * 4e-4**2
    assert np.abs(motion.ledger_gap).max() < 1e-3 * np.abs(work).max()


def test_cable_of_given_length_past_points_of_the_core_acts_as_its_tension() -> None:
    """Two segments from disk to disk: the cable joins poses that are further apart."""
    displacement = 1e-3
    arms = [replace(driven(cable).arm, subsegments=2) for cable in (BY_LENGTH, Cable("upper", 0.008))]
    by_length, by_tension = (Scene(arm, (Bending(), Gravity(), Cables())) for arm in arms)
    found = at_rest(by_length, displacement)
    under = at_rest(by_tension, float(found.tension[0]))
    assert found.tension[0] > 0.5  # N
    np.testing.assert_allclose(found.coordinates, under.coordinates, rtol=1e-9, atol=1e-13)
    assert under.cable_displacement[0] + found.tension[0] / STIFFNESS == pytest.approx(
        displacement, abs=1e-12
    )


def test_arm_held_by_four_cables_of_given_length_stays_at_rest() -> None:
    """Three of them are slack: so much are they let out."""
    offsets, lengths = (0.008, 0.004, 0.0, -0.004), (1e-3, -1e-3, -1e-3, -1e-3)
    cables = tuple(Cable(f"c{r}", r, cable_stiffness=1e4) for r in offsets)
    scene = Scene(driven(*cables).arm, (Bending(), Gravity(), Cables(), *MOTION))
    scenario = Scenario(scene, tuple(map(Constant, lengths)), MotionStudy(0.1, samples=11))
    run = simulate(scenario)
    assert run.outcome is Outcome.COMPLETED
    assert run.trajectory is not None
    assert np.ptp(run.trajectory.disk_y[:, -1]) < 1e-12
    assert (run.trajectory.tension[-1] > 0.0).tolist() == [True, False, False, False]
