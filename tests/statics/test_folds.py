"""Folds: an arm bent by nature that snaps over, against the energy of the whole arm."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import whole_arm
from conftest import rone2012
from scipy.optimize import root

from continuum_dyn import Run, load_scenario, simulate
from continuum_dyn.record import read_log, write_log
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.studies import RampStudy
from continuum_dyn.views.figures import log_plots
from statics import (
    Arm,
    Bending,
    Critical,
    DiskLoad,
    DiskLoads,
    Equilibrium,
    InputError,
    Outcome,
    Scene,
    StaticSolver,
    equilibrium,
    follow_path,
    tension_ramp,
)
from statics.arc_length import follow
from statics.passes import search
from statics.ramp import ramp

SNAP = Path(__file__).parents[2] / "scenarios" / "snap_through.toml"


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario(SNAP)


@pytest.fixture(scope="module")
def followed(scenario: Scenario) -> Run:
    return simulate(scenario)


def folds_of(run: Run) -> list[Equilibrium]:
    return [point for point in run.equilibria if point.critical is Critical.FOLD]


def tension_at_fold_of_whole_arm(scene: Scene, near: Equilibrium) -> float:
    """Where the energy's dense Hessian loses its rank: grad = 0, H v = 0, |v| = 1 (Moore, Spence 1980)."""
    n, with_area = scene.arm.segments, replace(scene.arm, area=1.0)  # of no account without extension
    arm = whole_arm.whole_arm(Scene(with_area, scene.effects))

    def gradient(bends: np.ndarray, tension: float) -> np.ndarray:
        def energy(q: np.ndarray) -> complex:
            return whole_arm.potential_energy(arm, q, np.array([tension]))

        return whole_arm.gradient(energy, bends[:, None])[:, 0]

    def turned(bends: np.ndarray, tension: float, way: np.ndarray) -> np.ndarray:
        along = whole_arm.difference_matrix(
            lambda t: gradient(bends + t[0] * way, tension), np.zeros(1), [1e-3]
        )
        return along[:, 0]

    def unbalanced(unknown: np.ndarray) -> np.ndarray:
        bends, null, tension = unknown[:n], unknown[n : 2 * n], unknown[-1]
        return np.concatenate([gradient(bends, tension), turned(bends, tension, null), [null @ null - 1.0]])

    hessian = np.column_stack([turned(near.bend_angle, near.tension[0], way) for way in np.eye(n)])
    null = np.linalg.eigh(hessian)[1][:, 0]
    start = np.concatenate([near.bend_angle, null, near.tension])
    found = root(unbalanced, start, options={"xtol": 1e-11})
    return float(found.x[-1])


def test_folds_are_where_the_energy_of_the_whole_arm_has_them(scenario: Scenario, followed: Run) -> None:
    folds = folds_of(followed)
    assert len(folds) == 2
    for fold in folds:
        dense = tension_at_fold_of_whole_arm(scenario.scene, fold)
        assert fold.tension[0] == pytest.approx(dense, rel=1e-6)


def test_path_by_arc_length_marks_what_is_unstable_between_its_folds(followed: Run) -> None:
    assert followed.outcome is Outcome.COMPLETED
    first, second = (number for number, point in enumerate(followed.equilibria) if point.critical)
    unstable = [number for number, point in enumerate(followed.equilibria) if not point.stable]
    assert unstable == list(range(first, second + 1))
    assert followed.message.count("the path folds at tension") == 2
    assert max(point.residual for point in followed.equilibria) < 1e-10  # N m, of 0.06


def test_path_passes_the_ramps_points_exactly_and_again_after_a_fold(
    scenario: Scenario, followed: Run
) -> None:
    at_two = [point for point in followed.equilibria if point.tension[0] == 2.0]
    assert [point.stable for point in at_two] == [True, False, True]
    asked = set(scenario.ramps[0])
    assert {point.tension[0] for point in followed.equilibria if not point.critical} == asked


def test_plain_ramp_tells_where_it_jumps(scenario: Scenario, followed: Run) -> None:
    run = simulate(replace(scenario, study=RampStudy()))
    jumps = [point for point in run.equilibria if point.jumped]
    assert [point.tension[0] for point in jumps] == [4.5]
    assert jumps[0].lost_at is not None
    assert jumps[0].lost_at.tension[0] == pytest.approx(folds_of(followed)[0].tension[0], rel=1e-9)
    assert "jumps between tension 4 N and tension 4.5 N: the path folds at tension 4.343" in run.message
    assert all(point.stable for point in run.equilibria)


def test_ramp_up_and_down_jumps_at_the_one_fold_and_at_the_other(scenario: Scenario) -> None:
    up = scenario.ramps[0]
    both = replace(scenario, drives=((*up, *up[-2::-1]),), study=RampStudy())
    jumps = [point for point in simulate(both).equilibria if point.jumped]
    assert [
        (point.tension[0], round(float(point.lost_at.tension[0]), 3)) for point in jumps if point.lost_at
    ] == [
        (4.5, 4.344),
        (1.0, 1.013),
    ]


@pytest.mark.parametrize("points", [2, 51])
def test_folds_close_together_are_passed_however_fine_the_ramp(scenario: Scenario, points: int) -> None:
    """Hardly too heavy to stand: it snaps over by 0.3 rad, and back where the tension is 11 mN less."""
    scene = scenario.scene
    light = Scene(replace(scene.arm, disk_mass=0.775 * 0.07146), scene.effects)
    tensions = np.linspace(2.6, 2.7, points).tolist()
    path = follow_path(light, tensions)
    assert [(at.critical, round(float(at.tension[0]), 3)) for at in path.critical] == [
        (Critical.FOLD, 2.645),
        (Critical.FOLD, 2.634),
    ]
    assert sum(point.jumped for point in tension_ramp(light, tensions)) == 1


def column(segments: int) -> Scene:
    """A column of steel, 3 m, under a dead load of 1 N along it, times a factor."""
    arm = Arm(1, 3.0, youngs_modulus=2.1e11, second_moment=0.1**4 / 12, disk_mass=0.0, subsegments=segments)
    return Scene(arm, (Bending(), DiskLoads((DiskLoad(1, (-1.0, 0.0), driven=True),))))


def buckling_loads(scene: Scene) -> np.ndarray:
    """Eigenvalues, N: by bends phi the load's end comes closer by phi G phi / 2, arc by arc."""
    arm, n = scene.arm, scene.arm.segments
    length, bending = 3.0 / n, arm.per_disk("youngs_modulus")[0] * arm.per_disk("second_moment")[0]
    middles = np.tri(n, k=-1) + 0.5 * np.eye(n)
    return bending / length**2 / np.linalg.eigvalsh(middles.T @ middles + np.eye(n) / 12)[::-1]


@pytest.mark.parametrize(("segments", "factor"), [(1, 1e7), (2, 1e8), (16, 3e7), (64, 1e8)])
def test_column_branches_at_each_eigenvalue_however_many_a_step_passes(segments: int, factor: float) -> None:
    scene = column(segments)
    path = follow(StaticSolver(scene), np.array([[0.0], [factor]]))
    loads = buckling_loads(scene)
    passed = loads[loads < factor]
    assert len(passed) >= 1
    assert [point.critical for point in path.critical] == [Critical.BRANCHING] * len(passed)
    found = [point.inputs[0] for point in path.critical]
    np.testing.assert_allclose(found, passed, rtol=1e-5)
    assert [point.unstable_directions for point in path.critical] == list(range(len(passed)))
    assert path.outcome is Outcome.COMPLETED


def is_stable(solver: StaticSolver, inputs: np.ndarray) -> bool:
    straight = np.zeros((solver.scene.arm.segments, 1))
    return solver.examine(straight, inputs, search.STABLE).unstable_directions == 0


@pytest.mark.parametrize("beyond", [1.074, 1.0756])
def test_two_branchings_that_cancel_within_a_step_are_both_reported(beyond: float) -> None:
    """A column whose load moves from its tip to its middle: on the way it is stable over less than a step."""
    arm = Arm(20, 0.05, youngs_modulus=1.0, second_moment=1.0)
    loads = (DiskLoad(disk, (-1.0, 0.0), driven=True) for disk in (20, 10))
    solver = StaticSolver(Scene(arm, (Bending(), DiskLoads(tuple(loads)))))
    at_tip, at_middle = beyond * np.diag([2.46867, 9.88992])  # the loads that buckle it one at a time
    parts = np.linspace(0.4, 0.6, 101)
    stable = [part for part in parts if is_stable(solver, at_tip + part * (at_middle - at_tip))]
    path = follow(solver, np.array([0.0 * at_tip, at_tip, at_middle]))
    passed = [1.0 / beyond, 1.0 + stable[0], 1.0 + stable[-1]]
    found = [parameter for parameter in path.parameters if parameter not in (0.0, 1.0, 2.0)]
    np.testing.assert_allclose(found, passed, atol=2e-3)
    assert [point.critical for point in path.critical] == [Critical.BRANCHING] * 3


def test_plain_ramp_tells_the_first_of_many_branchings() -> None:
    scene = column(64)
    _, end = ramp(StaticSolver(scene), np.array([[0.0], [1e8]]))
    assert end.lost_at is not None
    assert end.lost_at.critical is Critical.BRANCHING
    assert end.lost_at.inputs[0] == pytest.approx(buckling_loads(scene)[0], rel=1e-4)


@pytest.mark.parametrize("turns", [(0.0, 10.0, 0.0), (0.0, 3.0, 3.0, 1.0, 10.0), (5.0, 0.0, 5.0, 2.0)])
def test_path_of_a_ramp_that_turns_back_goes_there_and_back(turns: tuple[float, ...]) -> None:
    """Every point is regular: each is the one equilibrium that a search from straight finds."""
    scene = rone2012()
    path = follow_path(scene, turns)
    assert path.outcome is Outcome.COMPLETED
    assert path.parameters == list(range(len(turns)))
    assert [float(point.tension[0]) for point in path.points] == list(turns)
    alone = [equilibrium(scene, tension).tip for tension in turns]
    np.testing.assert_allclose([point.tip for point in path.points], alone, atol=1e-11)


def test_picture_of_a_path_marks_its_folds(followed: Run, tmp_path: Path) -> None:
    write_log(followed, tmp_path / "path.h5")
    log = read_log(tmp_path / "path.h5")
    assert log.equilibria["critical"].sum() == 2
    labels = log_plots.picture(log, ["tip"]).axes[0].get_legend_handles_labels()[1]
    assert labels == ["stable", "unstable", "fold"]


@pytest.mark.parametrize(
    ("scenario_file", "hindrance"), [("friction_ramp", "friction"), ("follower_tip", "follower")]
)
def test_path_of_a_scene_without_a_potential_is_refused(scenario_file: str, hindrance: str) -> None:
    scene = load_scenario(SNAP.with_stem(scenario_file)).scene
    with pytest.raises(InputError, match=f"needs a potential; without one: {hindrance}"):
        follow_path(scene, [np.zeros(scene.cables), np.ones(scene.cables)])
