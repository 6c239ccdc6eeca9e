"""The static solver ends in a stable equilibrium, or says that it did not."""

import numpy as np
import pytest
from conftest import rone2012, weightless_core
from hypothesis import given, settings
from hypothesis import strategies as st

from statics import (
    Arm,
    Bending,
    Cable,
    Cables,
    DiskLoads,
    Extension,
    Gravity,
    InputError,
    Outcome,
    Scene,
    disk_loads,
    equilibrium,
    tension_ramp,
)
from statics.errors import NotFoundError


def test_upright_arm_leaves_the_straight_branch_where_it_is_unstable() -> None:
    soft = Arm.preset("rone2012", disks=16, disk_spacing=0.005, youngs_modulus=2.1e7, disk_mass=2e-4)
    rest = equilibrium(Scene(soft, (Bending(), Extension(), Gravity((-9.81, 0.0)))))
    assert rest.stable
    assert abs(rest.tip[2]) > 1.0


def test_upright_arm_stays_straight_where_that_is_stable() -> None:
    rest = equilibrium(rone2012(gravity=(-9.81, 0.0)), 0.0)
    assert rest.stable
    assert rest.tip[1] == 0.0


def test_ramp_reuses_the_last_solution(paper_arm: Scene) -> None:
    tensions = np.linspace(0.0, 40.0, 81)
    ramp = tension_ramp(paper_arm, tensions)
    alone = [equilibrium(paper_arm, tension) for tension in tensions]
    np.testing.assert_allclose([p.tip for p in ramp], [p.tip for p in alone], atol=1e-12)
    assert sum(p.iterations for p in ramp) < sum(p.iterations for p in alone)


def test_ramp_beyond_the_limit_says_so_and_finds_its_way_back(paper_arm: Scene) -> None:
    ramp = tension_ramp(paper_arm, [50.0, 90.0, 50.0])
    assert [point.outcome for point in ramp] == [Outcome.COMPLETED, Outcome.GEOMETRY_LIMIT, Outcome.COMPLETED]
    np.testing.assert_allclose(ramp[2].tip, ramp[0].tip, atol=1e-12)


def test_tip_of_an_equilibrium_that_was_not_found_is_no_number(paper_arm: Scene) -> None:
    beyond = equilibrium(paper_arm, 90.0)
    assert not beyond.found
    with pytest.raises(NotFoundError, match=r"no equilibrium was found at tension 90 N \(geometry_limit\)"):
        _ = beyond.tip
    assert np.isfinite(beyond.disk_x).all()


def test_mirrored_cables_and_gravity_mirror_the_arm() -> None:
    up = Arm.preset("rone2012", cables=(Cable("a", 0.008, anchor=2), Cable("b", 0.006)))
    down = Arm.preset("rone2012", cables=(Cable("a", -0.008, anchor=2), Cable("b", -0.006)))
    one = equilibrium(Scene(up, (Bending(), Gravity((0.0, -9.81)), Cables())), [1.0, 0.5])
    other = equilibrium(Scene(down, (Bending(), Gravity((0.0, 9.81)), Cables())), [1.0, 0.5])
    np.testing.assert_allclose(other.tip, np.array(one.tip) * [1, -1, -1], atol=1e-15)


def test_cable_loads_segments_up_to_its_anchor_only() -> None:
    arm = Arm.preset("rone2012", cables=(Cable("a", 0.008, anchor=2), Cable("b", 0.006)))
    rest = equilibrium(Scene(arm, (Bending(), Gravity((0.0, 0.0)), Cables())), [1.0, 0.0])
    assert np.all(rest.curvature[:2] > 0.1)
    np.testing.assert_array_equal(rest.curvature[2:], 0.0)


def test_reference_curvature_is_the_unloaded_shape() -> None:
    arm = Arm(10, 0.1, youngs_modulus=1.0, second_moment=1.0, reference_curvature=-0.7)
    rest = equilibrium(Scene(arm, (Bending(), DiskLoads())))
    np.testing.assert_allclose(rest.curvature, -0.7, rtol=1e-14)


def test_force_and_moment_of_the_cables_balance_over_the_arm(paper_arm: Scene) -> None:
    rest = equilibrium(paper_arm, 2.0)
    force, moment = disk_loads(paper_arm.arm, rest.tension, rest.disk_x, rest.disk_y, rest.disk_theta)
    at_base = np.array([rest.disk_x[0], rest.disk_y[0]]) + 0.008 * np.array(
        [-np.sin(rest.disk_theta[0]), np.cos(rest.disk_theta[0]) - 1]
    )
    pull = -2.0 * at_base / np.linalg.norm(at_base)  # the cable enters at the base's hole
    np.testing.assert_allclose(force.sum(axis=0), pull, atol=1e-14)
    about_base = moment + rest.disk_x * force[:, 1] - rest.disk_y * force[:, 0]
    assert about_base.sum() == pytest.approx(-0.008 * pull[0], abs=1e-14)


@pytest.mark.parametrize("tension", [-1.0, np.nan, np.inf, [1.0, 2.0], None])
def test_tensions_that_do_not_fit_are_refused(paper_arm: Scene, tension: object) -> None:
    with pytest.raises(InputError, match="tension"):
        equilibrium(paper_arm, tension)


@settings(max_examples=60, deadline=None)
@given(
    disks=st.integers(1, 40),
    log_stiffness=st.floats(-6.0, 0.0),
    direction=st.floats(0.0, 2 * np.pi),
    tension=st.floats(0.0, 100.0),
)
def test_every_scene_ends_in_a_stable_equilibrium_or_at_the_named_limit(
    disks: int, log_stiffness: float, direction: float, tension: float
) -> None:
    gravity = (9.81 * np.cos(direction), 9.81 * np.sin(direction))
    rest = equilibrium(rone2012(disks=disks, stiffness=10**log_stiffness, gravity=gravity), tension)
    assert rest.outcome in (Outcome.COMPLETED, Outcome.GEOMETRY_LIMIT)
    if rest.stable:
        assert rest.residual < 1e-10


def test_dead_force_beyond_eulers_load_buckles_a_straight_core() -> None:
    euler = np.pi**2 / 4  # E J / L^2 = 1
    below = equilibrium(weightless_core(disks=64, force=(-0.99 * euler, 0.0)))
    above = equilibrium(weightless_core(disks=64, force=(-1.02 * euler, 0.0)))
    assert below.tip[1] == 0.0
    assert above.stable
    assert abs(above.tip[1]) > 0.1
