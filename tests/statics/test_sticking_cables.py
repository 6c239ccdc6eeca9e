"""Ramps of cables that rub, through sticking and slipping and up to the hole limit: no point is lost."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import whole_arm
from conftest import SCENARIOS, edited
from scipy.optimize import brentq
from typer.testing import CliRunner
from whole_arm import gradient
from whole_cables import WholeCables

from continuum_dyn import simulate
from continuum_dyn.answers.settling import settling
from continuum_dyn.cli import app
from continuum_dyn.record import read_log, write_log
from statics import Arm, Bending, Cable, CableFriction, Cables, Extension, Gravity, Outcome, Scene
from statics.equilibria import Equilibrium, StaticSolver
from statics.ramp import ramp

STIFFNESS, LENGTH, OFFSET = 2.1e11 * 2.011e-14, 0.08, 0.008
SLIP_LENGTH = 1e-6
"""As the theory says, over the arm's length."""


def one_arc(friction: float) -> Scene:
    cable = Cable("upper", OFFSET, friction=friction)
    arm = Arm(1, LENGTH, youngs_modulus=2.1e11, second_moment=2.011e-14, cables=(cable,))
    return Scene(arm, (Bending(), Cables(), CableFriction()))


def paper_arm(friction: float, *effects: Extension | Gravity, disks: int = 4) -> Scene:
    arm = Arm.preset("rone2012", disks=disks, cables=(Cable("upper", OFFSET, friction=friction),))
    return Scene(arm, (Bending(), *effects, Cables(), CableFriction()))


def there_and_back(tension: float, points: int = 10) -> np.ndarray:
    up = np.linspace(0.0, tension, points)
    return np.concatenate([up, up[-2::-1]])


def found_along(scene: Scene, tensions: np.ndarray) -> list[Equilibrium]:
    return ramp(StaticSolver(scene), tensions[:, None])


# ---- one arc, in closed form ----


def holding(bend: float) -> float:
    """Tension beyond the base's hole that holds the arc: EJ phi / L = -T dl/dphi, chord l(phi)."""
    h = bend / 2
    chord, slope = np.sinc(h / np.pi), (np.cos(h) - np.sinc(h / np.pi)) / (2 * h)
    return STIFFNESS * bend / LENGTH / -(slope * (LENGTH - bend * OFFSET) - chord * OFFSET)


def bend_in_turn(tension: float, before: float, friction: float) -> float:
    """Bend angle of cables that stick where they were while Euler's capstan lets them, and else slip.

    The base's hole turns the cable by half the bend angle.
    """
    if tension == 0.0:
        return 0.0
    held = holding(before) if before > 0.0 else 0.0
    if tension * np.exp(-friction * before / 2) <= held <= tension * np.exp(friction * before / 2):
        return before
    way = -1.0 if held < tension else 1.0
    return float(
        brentq(lambda phi: holding(phi) - tension * np.exp(way * friction * phi / 2), 1e-9, 6.1, xtol=1e-14)
    )


@pytest.mark.parametrize("friction", [0.1, 0.3, 0.5])
def test_one_arc_sticks_and_slips_as_its_closed_form_says(friction: float) -> None:
    before = 0.0
    tensions = np.array([0, 20, 19, 18, 17, 16, 15, 14, 10, 5, 0], dtype=float)
    for tension, point in zip(tensions, found_along(one_arc(friction), tensions), strict=True):
        before = bend_in_turn(tension, before, friction)
        assert point.stable
        assert point.bend_angle[0] == pytest.approx(before, abs=1e-4)  # what creeps: some slip lengths over r


def test_one_arc_at_friction_of_03_rests_at_known_angles() -> None:
    points = found_along(one_arc(0.3), np.array([0.0, 20.0, 10.0, 5.0]))
    assert [point.tip[2] for point in points] == pytest.approx([0.0, 3.48729, 3.48729, 2.1757], abs=2e-5)


@pytest.mark.parametrize("friction", [0.1, 0.5])
def test_one_arc_comes_up_to_where_its_holes_meet_and_back(friction: float) -> None:
    """They meet at 2 pi; at 6 rad a thirtieth of the cable is left."""
    tensions, before = there_and_back(holding(6.0) * np.exp(friction * 3.0)), 0.0
    for tension, point in zip(tensions, found_along(one_arc(friction), tensions), strict=True):
        before = bend_in_turn(tension, before, friction)
        assert point.stable
        assert point.bend_angle[0] == pytest.approx(before, abs=1e-4)


# ---- the paper's arm, against the whole arm's balance ----


def nearly(point: Equilibrium) -> np.ndarray:
    """Coordinates without a straight segment, for which the whole arm has no formula."""
    q = point.coordinates
    q[q[:, 0] == 0.0, 0] = 1e-12
    return q


def unbalanced(scene: Scene, before: Equilibrium, point: Equilibrium) -> float:
    """Largest unbalanced generalized force of the whole arm (N m, N), by the capstan law of the theory."""
    oracle, (q, q_before) = WholeCables(scene, point.tension), map(nearly, (point, before))
    slip = oracle.beyond(q_before) - oracle.beyond(q)
    slip /= SLIP_LENGTH * scene.arm.total_length
    tension = oracle.tensions(q, slip, oracle.turns(q))
    force = gradient(lambda q: whole_arm.potential_energy(oracle.arm, q, np.zeros(1)), q)
    pull = gradient(oracle.lengths, q).reshape(q.size, -1) @ tension.ravel()
    return float(np.abs(force.ravel() + pull).max())


def check_every_point(scene: Scene, tensions: np.ndarray) -> None:
    points = found_along(scene, tensions)
    assert [point.outcome for point in points] == len(points) * [Outcome.COMPLETED]
    for before, point in pairwise(points):
        assert unbalanced(scene, before, point) < 1e-10 * max(1.0, tensions.max())  # the rounding of s


@pytest.mark.parametrize(("friction", "tension"), [(0.1, 50.0), (0.3, 20.0), (0.5, 2.0), (0.5, 50.0)])
def test_ramp_there_and_back_balances_the_whole_arm_at_every_point(friction: float, tension: float) -> None:
    check_every_point(paper_arm(friction), there_and_back(tension))


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.1, 0.2, 0.3, 0.4, 0.5])
@pytest.mark.parametrize("tension", [2.0, 5.0, 10.0, 20.0, 30.0, 50.0])
def test_no_point_of_the_grid_is_lost(friction: float, tension: float) -> None:
    check_every_point(paper_arm(friction), there_and_back(tension))
    check_every_point(paper_arm(friction, Extension(), Gravity()), there_and_back(tension, 6))
    assert all(point.stable for point in found_along(one_arc(friction), there_and_back(tension)))


def test_ramp_beyond_the_hole_limit_goes_on_from_the_last_point_that_was_found() -> None:
    tensions = np.array([0.0, 30.0, 60.0, 200.0, 300.0, 59.0, 30.0, 0.0])
    points = found_along(paper_arm(0.2), tensions)
    outcomes = [point.outcome for point in points]
    assert outcomes == [*3 * [Outcome.COMPLETED], *2 * [Outcome.GEOMETRY_LIMIT], *3 * [Outcome.COMPLETED]]
    assert unbalanced(paper_arm(0.2), points[2], points[5]) < 1e-8


REVERSAL = np.array([0.0, 2.0, 1.86])
HOLD = np.array([0.0, 0.5, *21 * [1.0]])
FINE = there_and_back(2.0, 81)


@pytest.mark.parametrize(
    ("friction", "tensions", "tip"),
    [
        (0.3, REVERSAL, (0.0789797341, 0.0109528776, 0.279305176)),
        (0.2, HOLD, (0.0797483056, 0.0054348708, 0.14012512)),
        (0.2, FINE, (0.0799972384, -0.000614590247, -0.010845837)),
    ],
    ids=["reversal", "hold", "fine"],
)
def test_tip_is_where_an_independent_whole_arm_newton_puts_it(
    friction: float, tensions: np.ndarray, tip: tuple[float, float, float]
) -> None:
    """Computed apart from the program, point by point, with the same memory."""
    points = found_along(paper_arm(friction, Extension(), Gravity()), tensions)
    assert all(point.stable for point in points)
    assert points[-1].tip == pytest.approx(tip, abs=1e-9)
    assert sum(point.iterations for point in points) < 25 * len(points)


def test_friction_that_couples_the_whole_arm_is_found_with_the_exact_matrix() -> None:
    """Sixteen disks, friction 0.6: at 40 N nothing converges without the change of the holes' angles."""
    check_every_point(paper_arm(0.6, Gravity((6.4, 7.4)), disks=16), there_and_back(40.0, 8))


# ---- cables driven by their length ----


def test_straight_arm_held_by_two_cables_is_found_though_its_angle_falls_for_ever() -> None:
    """Upright, with a residual below rounding that each step makes smaller by a quarter."""
    cables = tuple(Cable(name, r, cable_stiffness=127.996) for name, r in (("u", 0.008), ("d", -0.008)))
    area, second_moment = np.pi * 4e-4**2, np.pi * 4e-4**4 / 4
    arm = Arm(
        1,
        0.08,
        youngs_modulus=2.1e11,
        area=area,
        second_moment=second_moment,
        disk_mass=0.181336,
        cables=cables,
    )
    scene = Scene(arm, (Bending(), Extension(), Gravity((-9.81, 0.0)), Cables()))
    solver, drive = StaticSolver(scene), 0.000466093
    point = solver.solve(np.pad([drive, drive], (0, len(scene.inputs) - 2)))
    assert point.stable
    assert point.tip == pytest.approx((0.0799986, 0.0, 0.0), abs=5e-8)
    assert point.iterations < 10


# ---- where a motion rests ----


def test_run_and_settle_measure_from_one_place_of_rest(tmp_path: Path) -> None:
    """It stops between the branches, 28 um apart, and not at the equilibrium that remembers the start."""
    friction = ("hole_offset = 0.008", "hole_offset = 0.008\nfriction = 0.05")
    shorter = ("duration = 1.0", "duration = 0.6")
    run = simulate(edited(SCENARIOS / "step_response.toml", tmp_path, friction, shorter))
    assert run.trajectory is not None
    assert run.rest is not None
    assert run.static_gap is not None
    tip, rests = np.array(run.trajectory.tip[:2]), [point.tip for point in run.rests]
    assert len(rests) == 3
    assert rests[1] == run.equilibria[-1].tip
    assert np.hypot(*(tip - run.rest)) == pytest.approx(run.static_gap, abs=1e-15)
    assert np.hypot(*(tip - rests[1][:2])) > 2.0 * run.static_gap
    write_log(run, tmp_path / "log.h5")
    found = settling(read_log(tmp_path / "log.h5"))
    assert abs(found.along[-1] - found.travel) < run.static_gap + 1e-12
    arguments = ["settle", str(tmp_path / "log.h5"), "--out", str(tmp_path)]
    shown = CliRunner(env={"COLUMNS": "100", "NO_COLOR": "1"}).invoke(app, arguments)
    assert "The linear mode is for sticking cables" in shown.output
