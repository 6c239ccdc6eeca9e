"""Cables that rub at their holes: two branches at rest, the loop between them, and motion along it."""

from pathlib import Path

import numpy as np
import pytest
import whole_arm
from scipy.integrate import trapezoid
from whole_arm import gradient
from whole_cables import WholeCables

from continuum_dyn import Scenario, load_scenario, simulate
from continuum_dyn.effects import Inertia, MaterialDamping, RotaryInertia
from continuum_dyn.scenario.profiles import Table
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.scenario.studies import StepResponseStudy
from statics import (
    Arm,
    Bending,
    Cable,
    CableFriction,
    Cables,
    Extension,
    Gravity,
    InputError,
    Outcome,
    Scene,
)
from statics.equilibria import Equilibrium, Slip, StaticSolver
from statics.passes.rest_passes import REST
from statics.ramp import ramp

SCENARIOS = Path(__file__).parents[2] / "scenarios"
FRICTION = 0.3


def rubbing(friction: float = FRICTION) -> Scene:
    cable = Cable("upper", 0.008, friction=friction)
    effects = (Bending(), Extension(), Gravity(), Cables(), CableFriction())
    return Scene(Arm.preset("rone2012", cables=(cable,)), effects)


def solver_of(scene: Scene) -> StaticSolver:
    return StaticSolver(scene)


def turning_angle(point: Equilibrium) -> float:
    """Sum of the angles by which the holes turn the cable, rad: its last stretch against the base."""
    return float(point.disk_theta[-1] - point.bend_angle[-1] / 2)


def tension_at_the_anchor(scene: Scene, point: Equilibrium) -> float:
    """From the balance of the last segment alone, without weights: bending moment over the cable's arm."""
    h = point.bend_angle[-1] / 2
    by_bend = whole_arm.directional(
        lambda q: np.sinc(q / 2 / np.pi) * (point.length[-1] - q * 0.008), np.array(2 * h), np.array(1.0)
    )
    stiffness = scene.arm.segment_columns()["bending_stiffness"][-1]
    return float(-stiffness * point.bend_angle[-1] / 0.02 / by_bend)


@pytest.mark.parametrize("slip", Slip)
def test_tension_falls_exponentially_with_the_turning_angle_against_the_slip(slip: Slip) -> None:
    """Euler's capstan: exp(-mu theta) from end to end, if drawn in, and exp(mu theta) if let out."""
    scene = Scene(rubbing().arm, (Bending(), Cables(), CableFriction()))
    point = solver_of(scene).solve(np.array([2.0]), before=slip)
    expected = 2.0 * np.exp(-slip * FRICTION * turning_angle(point))
    assert tension_at_the_anchor(scene, point) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("slip", Slip)
def test_branches_balance_the_forces_of_the_whole_arm(slip: Slip) -> None:
    scene = rubbing()
    point = solver_of(scene).solve(np.array([2.0]), before=slip)
    oracle, q = WholeCables(scene, np.array([2.0])), point.coordinates
    tension = oracle.tensions(q, np.full((1, 4), 100.0 * slip), oracle.turns(q))
    force = gradient(lambda q: whole_arm.potential_energy(oracle.arm, q, np.zeros(1)), q)
    pull = gradient(oracle.lengths, q).reshape(q.size, -1) @ tension.ravel()
    assert point.residual < 1e-12
    assert np.abs(force.ravel() + pull).max() < 1e-12


def test_ramp_up_and_down_goes_from_one_branch_to_the_other() -> None:
    solver = solver_of(rubbing())
    tensions = np.concatenate([np.linspace(0.0, 2.0, 9), np.linspace(2.0, 0.0, 9)[1:]])
    points = ramp(solver, tensions[:, None])
    for tension, point in zip(tensions[2:9], points[2:9], strict=True):
        drawn_in = solver.solve(np.array([tension]), before=Slip.DRAWN_IN)
        assert point.tip == pytest.approx(drawn_in.tip, abs=1e-9)
    for tension, point in zip(tensions[11:-2], points[11:-2], strict=True):
        let_out = solver.solve(np.array([tension]), before=Slip.LET_OUT)
        assert point.tip == pytest.approx(let_out.tip, abs=1e-9)
    assert all(point.stable for point in points)


def test_cable_sticks_where_the_ramp_turns_back() -> None:
    """Lowering the tension by a hundredth moves the arm by less than a tenth of what it would."""
    moved = []
    for friction in (FRICTION, 1e-9):
        points = ramp(solver_of(rubbing(friction)), np.array([[1.0], [2.0], [1.98]]))
        moved.append(points[1].tip[1] - points[2].tip[1])
    assert 0.0 <= moved[0] < 0.1 * moved[1]


def test_work_around_the_loop_is_what_friction_takes() -> None:
    """Positive, and in proportion to the friction while that is small; a frictionless loop has none."""
    tensions = np.concatenate([np.linspace(0.0, 2.0, 41), np.linspace(2.0, 0.0, 41)[1:]])
    work = []
    for friction in (1e-9, 0.01, 0.02):
        points = ramp(solver_of(rubbing(friction)), tensions[:, None])
        displacement = np.array([point.cable_displacement[0] for point in points])
        work.append(trapezoid(tensions, displacement))
    assert abs(work[0]) < 1e-9 * trapezoid(tensions[:41], np.linspace(0, 1e-3, 41))
    assert work[2] / work[1] == pytest.approx(2.0, rel=0.05)


def test_cable_without_friction_leaves_no_trace() -> None:
    """With a coefficient of zero nothing of it is in the generated source."""
    without = Scene(rubbing().arm, (Bending(), Extension(), Gravity(), Cables()))
    sources = [REST.write(scene.structure).partition("\n\n")[2] for scene in (rubbing(0.0), without)]
    assert sources[0].partition("import math")[2] == sources[1].partition("import math")[2]
    assert "tension_lost" not in sources[0]


def test_friction_without_cables_is_refused_by_name() -> None:
    with pytest.raises(InputError, match="'cable_friction' needs effect 'cables'"):
        Scene(rubbing().arm, (Bending(), CableFriction()))


@pytest.mark.slow
def test_slow_motion_follows_the_loop_of_the_equilibria() -> None:
    """Within what creeps and lags: 70 um, where the two branches are up to 200 um apart."""
    run = simulate(load_scenario(SCENARIOS / "friction_motion.toml"))
    motion, path = run.trajectory, run.static_path
    assert motion is not None
    gaps = np.array([point.tip[1] for point in path]) - motion.disk_y[:, -1]
    assert np.abs(gaps).max() < 7e-5
    lost = motion.ledger["dissipated_energy"]
    assert np.diff(lost).min() > -1e-9 * lost[-1]
    assert np.abs(motion.ledger_gap).max() < 1e-3 * lost[-1]


@pytest.mark.slow
def test_arm_that_is_pulled_over_to_its_other_rest_is_settled_between_its_branches() -> None:
    """Upright beyond its buckling load; its cable pulls it up and lets go, and it falls to the other side."""
    arm = Arm.preset("rone2012", youngs_modulus=1.4e9, cables=(Cable("upper", 0.008, friction=0.2),))
    moves = (Inertia(), RotaryInertia(), MaterialDamping(2e-2))
    scene = Scene(arm, (Bending(), Gravity((-9.81, -0.02)), Cables(), CableFriction(), *moves))
    pull = Table((0.0, 0.2, 0.8, 1.0), (0.001, 0.02, 0.02, 0.001))
    run = simulate(Scenario(scene, (pull,), StepResponseStudy(12.0, samples=61), Solver("chain", rtol=1e-6)))
    assert run.outcome is Outcome.SETTLED
    assert (
        "at another equilibrium than the one next to the start: tip at x 0.04348 m, y 0.05941 m"
        in run.message
    )
    assert run.static_gap is not None
    assert run.static_gap < 3e-6  # m from the line between the branches, which are 0.4 mm apart
