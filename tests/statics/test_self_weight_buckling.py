"""An upright arm under its own weight: critical loads, and the two equilibria above them."""

from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import bisect

from continuum_dyn import load_scenario, simulate
from continuum_dyn.record import read_log, write_log
from statics import Arm, Bending, Critical, Gravity, Scene, StaticSolver

GREENHILL = 7.8373
"""Critical weight per length q of an upright column, q L^3 / EJ (Greenhill 1881)."""
BUCKLING = Path(__file__).parents[2] / "scenarios" / "self_weight_buckling.toml"


def upright(disks: int, load: float) -> StaticSolver:
    """E J = 1, length 1, and weights at the segments' ends that add up to ``load`` (N)."""
    arm = Arm(disks, 1.0 / disks, youngs_modulus=1.0, second_moment=1.0, disk_mass=1.0 / disks)
    return StaticSolver(Scene(arm, (Bending(), Gravity((-load, 0.0)))))


def stands_straight(disks: int, load: float) -> bool:
    rest = upright(disks, load).solve(np.empty(0))
    assert rest.stable
    return not rest.left


def found(disks: int) -> float:
    """Critical load by bisection, N."""
    return bisect(lambda load: stands_straight(disks, load) - 0.5, 1.0, 9.0, xtol=1e-5)  # pyright: ignore[reportReturnType]


def of_discrete_arm(disks: int) -> float:
    """Lowest eigenvalue of its linear stability, K phi = load G phi."""
    drop = lowered(np.arange(disks, 0, -1) / disks) / disks
    return 1.0 / float(eigh(drop, disks * np.eye(disks), eigvals_only=True)[-1])


def lowered(carried: np.ndarray) -> np.ndarray:
    """Second derivatives by bend angles of what weights lose in height, over L0; segments carry so much (N).

    An arc whose angle goes linearly from a to b is lower by L0 (a^2 + a b + b^2) / 6 than a straight one, and
    lowers all weights from its end on.
    """
    below = np.tril(np.ones((carried.size, carried.size)))  # theta of each end, from bend angles
    near, far = below - np.eye(carried.size), below
    parts = (
        weight * (np.outer(a, a) + (np.outer(a, b) + np.outer(b, a)) / 2 + np.outer(b, b)) / 3
        for a, b, weight in zip(near, far, carried, strict=True)
    )
    return np.sum(list(parts), axis=0)


@pytest.mark.parametrize("disks", [1, 4, 16])
def test_critical_load_is_that_of_the_discrete_arm(disks: int) -> None:
    assert found(disks) == pytest.approx(of_discrete_arm(disks), rel=1e-5)


def test_critical_load_converges_to_greenhills() -> None:
    loads = {disks: of_discrete_arm(disks) for disks in (16, 32, 64, 128)}
    for disks, load in loads.items():
        assert load == pytest.approx(GREENHILL / (1 + 1.59 / disks), rel=5e-3)
    assert 2 * loads[128] - loads[64] == pytest.approx(GREENHILL, rel=1e-3)
    assert found(32) == pytest.approx(loads[32], rel=1e-5)


def test_above_the_critical_load_both_equilibria_are_reported() -> None:
    rest = upright(16, 1.05 * of_discrete_arm(16)).solve(np.empty(0))
    (straight,) = rest.left
    assert straight.stable is False
    assert straight.unstable_directions == 1
    assert straight.tip == (1.0, 0.0, 0.0)
    assert straight.residual == 0.0
    assert rest.stable
    assert abs(rest.tip[2]) > 0.5  # rad


def test_number_of_unstable_directions_is_that_of_the_eigenvalues_passed() -> None:
    rest = upright(16, 60.0).solve(np.empty(0))
    assert rest.left[0].unstable_directions == 2  # Bessel's zeros: 7.84 and 55.98


def test_ramp_goes_on_without_a_jump_where_a_path_branches_off_and_logs_both(tmp_path: Path) -> None:
    run = simulate(load_scenario(BUCKLING))
    numbered = enumerate(run.equilibria, start=1)
    number, bent = next((number, point) for number, point in numbered if point.lost_at is not None)
    assert bent.lost_at is not None
    assert bent.lost_at.critical is Critical.BRANCHING
    own, tip = lowered(0.02 * 9.81 * np.arange(16, 0, -1)), lowered(np.ones(16))
    stiffness = 2.10e11 * 2.011e-14 / 0.005**2 * np.eye(16)
    critical = 1.0 / float(eigh(tip, stiffness - own, eigvals_only=True)[-1])
    assert bent.lost_at.load_factor == pytest.approx(critical, rel=1e-6)
    assert 1.0 / float(eigh(own, stiffness, eigvals_only=True)[-1]) == pytest.approx(1.5, abs=0.01)
    assert not any(point.jumped for point in run.equilibria)
    assert "continues on another path between load factor 0.4 and load factor 0.6" in run.message
    assert "another path branches off at load factor 0.56" in run.message
    write_log(run, tmp_path / "buckling.h5")
    points = read_log(tmp_path / "buckling.h5").equilibria
    there = points["point"] == number
    assert points["stable"][there].tolist() == [False, True]
    assert points["jumped"][there].tolist() == [False, False]
