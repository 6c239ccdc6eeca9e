"""Rone and Ben-Tzvi 2012 computed again: its printed equations, where they part from the program's, why."""

import csv
import re
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import whole_arm
from conftest import UPPER, rone2012
from test_forces_against_energy import chain_statics
from typer.testing import CliRunner
from whole_arm import difference_matrix, relative_error

from continuum_dyn.cli import app
from continuum_dyn.experiments.reproduce import (
    TABLE_2_FINITE_ELEMENTS,
    TABLE_2_VIRTUAL_WORK,
    Rone2012,
    reproduce,
    with_core_spread,
)
from continuum_dyn.views.figures import plots
from statics import Arm, Equilibrium, Extension, InputError, Scene, equilibrium
from statics.judges.exact_rod import RodShape
from statics.judges.rone2012 import PrintedArm, PrintedError, jacobians, local_jacobians, local_poses, poses

MM, UM = 1e-3, 1e-6
SEEDS = range(10)
L0, EA = 0.02, 2.10e11 * 5.027e-7

runner = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1"})


def random_k(seed: int, n: int = 4) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-60.0, 60.0, n)


def interleaved(k: np.ndarray, L: np.ndarray) -> np.ndarray:
    return np.column_stack([k, L]).ravel()


def printed_force(scene: Scene, q: np.ndarray, tension: float, axial_sign: float) -> np.ndarray:
    """The printed equations' force along bend angles and elongations, by the chain rule, shape of q."""
    L = L0 + q[:, 1]
    k = q[:, 0] / L
    by_k, by_L = (
        PrintedArm(scene, axial_sign)
        .generalized_force(interleaved(k, L), np.array([tension]))
        .reshape(-1, 2)
        .T
    )
    return np.column_stack([by_k / L, by_L - k * by_k / L])


def program_force(scene: Scene, q: np.ndarray, tension: float) -> np.ndarray:
    return -chain_statics(scene, q, np.array([tension])).residual


# ---- the printed formulas ----


@pytest.mark.parametrize("seed", SEEDS)
def test_poses_are_those_of_eq_9_to_12(seed: int) -> None:
    k, L = random_k(seed), np.linspace(0.019, 0.021, 4)
    arm = whole_arm.whole_arm(rone2012())
    expected = whole_arm.poses(arm, np.column_stack([k * L, L - L0]))
    np.testing.assert_allclose(poses(k, L).T, expected, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_segment_and_its_derivatives_are_eq_11_14_and_18(seed: int) -> None:
    k, L = random_k(seed), np.linspace(0.019, 0.021, 4)
    phi, c, s = k * L, np.cos(k * L), np.sin(k * L)
    np.testing.assert_allclose(local_poses(k, L).T, [s / k, (1 - c) / k, phi], rtol=1e-11)
    by_k, by_L = np.moveaxis(local_jacobians(k, L), -1, 0)
    np.testing.assert_allclose(by_k.T, [(phi * c - s) / k**2, (phi * s + c - 1) / k**2, L], rtol=1e-9)
    np.testing.assert_allclose(by_L.T, [c, s, k])


@pytest.mark.parametrize("bend", [0.0, 1e-9, 1e-4, 0.3, -40.0])
def test_whole_arm_jacobian_of_eq_13_to_18_equals_differences_through_straight(bend: float) -> None:
    k, L = bend * np.array([1.0, -0.5, 0.2, 1.1]), np.linspace(0.019, 0.021, 4)
    q = interleaved(k, L)
    differences = difference_matrix(lambda q: poses(q[0::2], q[1::2]).ravel(), q, np.tile([0.5, 1e-4], 4))
    assert np.abs(jacobians(k, L).reshape(12, 8) - differences).max() < 1e-10


@pytest.mark.parametrize("seed", SEEDS)
def test_printed_equations_are_the_programs_where_nothing_is_stretched(paper_arm: Scene, seed: int) -> None:
    """Eq. 5, 7, 8, 10-20 and 22-25: at L = L0 the axial force is zero, and Eq. 20 is the program's."""
    q = np.column_stack([random_k(seed) * L0, np.zeros(4)])
    for tension in (0.0, 2.0):
        printed = printed_force(paper_arm, q, tension, axial_sign=1.0)
        assert relative_error(printed, program_force(paper_arm, q, tension)) < 1e-12


def test_axial_force_is_a_follower_force_on_the_last_disk_where_all_are_stretched_alike(
    paper_arm: Scene,
) -> None:
    """Eq. 21: what the disks between feel cancels, in the direction of the wrong end of the segment."""
    theta = np.array([0.1, 0.3, 0.2, 0.7])
    force = PrintedArm(paper_arm).axial_forces(np.full(4, 1.001 * L0), theta)
    assert np.abs(force[:3]).max() < 1e-10
    np.testing.assert_allclose(force[3], 0.001 * EA * np.array([np.cos(0.7), np.sin(0.7)]))


# ---- Eq. 21 is not conservative ----


def work_around(force: Callable[[np.ndarray], np.ndarray]) -> float:
    """Work of the forces along the bend angles, J, around a rectangle in those of segments 1 and 4."""
    corners = np.zeros((5, 4))
    corners[1:4, 0], corners[2:4, 3] = [0.3, 0.3, 0.0], 0.4
    nodes, weights = np.polynomial.legendre.leggauss(12)
    work = 0.0
    for start, end in pairwise(corners):
        for node, weight in zip((1 + nodes) / 2, weights / 2, strict=True):
            work += weight * force(start + node * (end - start)) @ (end - start)
    return work


@pytest.mark.parametrize("tension", [0.0, 2.0])
def test_printed_axial_force_does_work_around_a_closed_loop_and_nothing_else_does(
    paper_arm: Scene, tension: float
) -> None:
    shorter = np.full(4, -1e-5 * L0)  # 1.06 N of compression

    def work(force: Callable[[np.ndarray], np.ndarray]) -> float:
        return work_around(lambda phi: force(np.column_stack([phi, shorter]))[:, 0])

    assert abs(work(lambda q: program_force(paper_arm, q, tension))) < 1e-16
    assert abs(work(lambda q: printed_force(paper_arm, q, tension, axial_sign=0.0))) < 1e-16
    printed = work(lambda q: printed_force(paper_arm, q, tension, axial_sign=1.0))
    assert abs(printed) > 1e-4
    assert work(lambda q: printed_force(paper_arm, q, tension, axial_sign=-1.0)) == pytest.approx(-printed)


class BalancedArm(PrintedArm):
    """The printed equations, but the axial force works along its own segment's length."""

    def generalized_force(self, q: np.ndarray, tension: np.ndarray) -> np.ndarray:
        """Shape (2 n,); without Eq. 21 if ``axial_sign`` is 0."""
        along = interleaved(np.zeros(q.size // 2), -EA / L0 * (q[1::2] - L0))
        return super().generalized_force(q, tension) + along


@pytest.mark.parametrize("tension", [0.0, 0.1, 1.0, 2.0])
def test_with_a_balanced_axial_force_the_printed_equations_are_the_programs(
    paper_arm: Scene, tension: float
) -> None:
    """What is left is Eq. 20's moment per deformed length, a relative (L - L0) / L0 of 2e-5 at 2 N."""
    balanced = BalancedArm(paper_arm, axial_sign=0.0).solve(tension).tip
    np.testing.assert_allclose(balanced, equilibrium(paper_arm, tension).tip, rtol=3e-5, atol=1e-10)


# ---- the paper's numbers ----


@pytest.fixture(scope="module")
def found() -> Rone2012:
    return reproduce("rone2012")


@pytest.mark.parametrize("axial_sign", [1.0, -1.0])
def test_printed_equations_lift_the_tip_to_22_mm_at_2_n_with_either_sign(
    paper_arm: Scene, axial_sign: float
) -> None:
    shape = PrintedArm(paper_arm, axial_sign).solve(2.0)
    assert shape.tip[1] == pytest.approx(22.27 * MM, abs=0.01 * MM)
    np.testing.assert_allclose(shape.curvature, [9.17, 6.32, 4.69, 3.96], atol=0.006)


@pytest.mark.slow
def test_exact_rod_sides_with_the_program(found: Rone2012) -> None:
    assert found.figure_4[-1].tension == 2.0
    tip_y = found.figure_4[-1].tip_y
    assert tip_y["exact rod"] == pytest.approx(11.60 * MM, abs=0.005 * MM)
    assert tip_y["program"] == pytest.approx(11.61 * MM, abs=0.005 * MM)
    for shapes in (found.unactuated, *found.figure_4):
        assert abs(shapes.tip_y["program"] - shapes.tip_y["exact rod"]) < 12.1 * UM


def test_laws_differ_in_sign_at_a_tenth_of_a_newton_and_nowhere_else(found: Rone2012) -> None:
    (shapes,) = found.of_opposite_sign
    assert shapes.tension == 0.1
    for law, height in (("printed", 7.3), ("program", -8.4), ("exact rod", -20.5)):
        assert shapes.tip_y[law] == pytest.approx(height * UM, abs=0.1 * UM)


def test_tip_is_level_near_a_tenth_of_a_newton_by_every_law(found: Rone2012, paper_arm: Scene) -> None:
    level = found.level_tension
    assert 0.098 < level["printed"] < 0.1 < level["program"] < level["exact rod"] < 0.104
    assert abs(equilibrium(paper_arm, level["program"]).tip[1]) < 1e-9


def test_only_the_printed_equations_bend_the_base_most_as_the_paper_says(found: Rone2012) -> None:
    """Section IV: "a greater increase seen in segments closest to the base"."""
    highest = found.figure_4[-1]
    printed = highest.printed.curvature - found.unactuated.printed.curvature
    assert np.all(np.diff(printed) < -0.5)
    program = highest.program.curvature - found.unactuated.program.curvature
    assert np.ptp(program) < 0.01


@pytest.mark.parametrize("law", ["printed", "program"])
def test_both_laws_give_table_2_and_the_rest_is_rounding(found: Rone2012, law: str) -> None:
    below = 1 - found.unactuated.by_law[law].disk_y / TABLE_2_VIRTUAL_WORK[:, 1]
    assert np.all((below > 1.4e-4) & (below < 1.9e-4))


def test_unrounded_core_has_table_2s_digits(found: Rone2012) -> None:
    gap = found.unrounded.disk_y - TABLE_2_VIRTUAL_WORK[:, 1]
    assert np.abs(gap / TABLE_2_VIRTUAL_WORK[:, 1]).max() < 5e-5
    assert np.abs(gap).max() < 0.02 * UM


def test_core_with_a_mass_of_its_own_is_nearer_to_the_finite_elements(found: Rone2012) -> None:
    """The paper puts the difference down to the place of the masses: that is half of the rod's 5.7 %."""

    def excess(shape: Equilibrium | RodShape) -> np.ndarray:
        return 100 * (shape.disk_y / TABLE_2_FINITE_ELEMENTS[:, 1] - 1)

    lumped, spread = found.unactuated, found.core_spread
    assert excess(lumped.program) == pytest.approx([-1.91, 1.28, 2.75, 3.68], abs=0.006)
    assert excess(spread.program) == pytest.approx([-4.19, -1.18, 0.12, 0.92], abs=0.006)
    assert excess(lumped.rod) == pytest.approx([6.27, 5.42, 5.53, 5.72], abs=0.006)
    assert excess(spread.rod) == pytest.approx([3.88, 2.90, 2.85, 2.91], abs=0.006)
    assert np.ptp(excess(spread.rod)[1:]) < np.ptp(excess(lumped.rod)[1:]) / 4


def test_spreading_the_core_leaves_the_arms_mass(paper_arm: Scene) -> None:
    spread = with_core_spread(paper_arm).arm
    assert spread.total_mass == pytest.approx(4 * 7.782e-4, rel=1e-12)
    assert spread.disk_mass == pytest.approx(7.782e-4 - 7850 * 5.027e-7 * 0.02, rel=1e-12)


def test_printed_equations_are_solved_better_than_the_paper_did(found: Rone2012) -> None:
    assert max(shapes.printed.residual for shapes in (*found.ramp, *found.figure_4)) < 1e-10


# ---- what is refused ----


def test_tension_without_a_solution_says_so(paper_arm: Scene) -> None:
    with pytest.raises(PrintedError, match=r"not solved under \[1000\.0\] N"):
        PrintedArm(paper_arm).solve(1000.0)


def test_scenes_that_the_paper_does_not_describe_are_refused(paper_arm: Scene) -> None:
    rigid = (effect for effect in paper_arm.effects if not isinstance(effect, Extension))
    with pytest.raises(InputError, match="bending, cables, extension, gravity"):
        PrintedArm(Scene(paper_arm.arm, rigid))
    finer = Arm.preset("rone2012", subsegments=2, cables=(UPPER,))
    with pytest.raises(InputError, match="one segment from disk to disk"):
        PrintedArm(Scene(finer, paper_arm.effects))


def test_unknown_paper_is_refused_with_the_nearest_one(tmp_path: Path) -> None:
    result = runner.invoke(app, ["reproduce", "rone2013", "--out", str(tmp_path / "out")])
    assert result.exit_code == 2
    assert "unknown paper 'rone2013'. Did you mean 'rone2012'?" in result.stderr
    assert not (tmp_path / "out").exists()


# ---- what is shown ----


def test_command_prints_and_writes_the_papers_numbers(tmp_path: Path) -> None:
    result = runner.invoke(app, ["reproduce", "rone2012", "--out", str(tmp_path)])
    assert result.exit_code == 0, result.output
    for words in ("-614.590", "-614.690", "-592.760", "22.2722", "At 0.1 N the results differ in sign"):
        assert words in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 80 + len(str(tmp_path))
    with (tmp_path / "rone2012_table_2.csv").open() as file:
        tip = list(csv.DictReader(file))[-1]
    assert float(tip["disk_y_program"]) == pytest.approx(float(tip["disk_y_paper"]), rel=2e-4)
    with (tmp_path / "rone2012_shapes.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if (row["tension"], row["disk"]) == ("2.0", "4")]
    assert {row["law"]: round(float(row["disk_y"]) / MM, 2) for row in rows} == {
        "printed": 22.27,
        "program": 11.61,
        "exact rod": 11.60,
    }
    assert (tmp_path / "rone2012.png").stat().st_size > 10_000


def test_picture_shows_every_tension_by_every_law(found: Rone2012) -> None:
    high, tip, low = plots.rone2012(found).axes
    for axes, tensions in ((high, 3), (low, 3)):
        labels = [str(line.get_label()) for line in axes.lines]
        for law in ("equations as printed", "the program", "exact rod"):
            assert labels.count(law) == tensions
    assert np.shape(tip.lines[0].get_ydata()) == (len(found.ramp),)


# ---- the list of equations ----


def test_documentation_names_an_existing_place_and_test_for_each_of_25_equations() -> None:
    root = Path(__file__).parents[2]
    lines = (root / "docs" / "theory" / "rone2012.md").read_text().splitlines()
    rows = [line.split("|")[1:-1] for line in lines if re.match(r"\| \d+ \|", line)]
    assert [int(row[0]) for row in rows] == list(range(1, 26))
    for _, _, place, test in rows:
        for path, names in re.findall(r"`([\w/]+\.py)` ((?:`\w+`(?:, )?)+)", place + ";" + test):
            for name in re.findall(r"\w+", names):
                assert re.search(rf"(def|class) {name}\b", (root / path).read_text()), (path, name)
        assert "`statics/" in place
        assert "`test_" in test
