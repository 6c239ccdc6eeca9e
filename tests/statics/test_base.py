"""Where an arm is mounted: the base's place and angle, at rest; and what an arm without a base has of it."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from conftest import MOTION as IN_MOTION
from conftest import UPPER, rone2012
from hypothesis import given, settings
from hypothesis import strategies as st

from continuum_dyn.passes.accelerations import acceleration
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.passes.motion_passes import MOTION
from statics import (
    Arm,
    Base,
    Bending,
    Cables,
    DiskLoad,
    DiskLoads,
    Extension,
    Gravity,
    InputError,
    Scene,
    StaticSolver,
    disk_loads,
)
from statics.equilibria import Equilibrium
from statics.judges.exact_rod import exact_rod
from statics.judges.rone2012 import PrintedArm
from statics.kernels.slots import SCALARS
from statics.passes.rest_passes import REST

ANGLES, PLACES = st.floats(-7.0, 7.0), st.floats(-1.0, 1.0)


def mounted(scene: Scene, base: Base | None) -> Scene:
    return Scene(replace(scene.arm, base=base), scene.effects)


def turned(vector: np.ndarray, angle: float) -> np.ndarray:
    """Vectors, shape (..., 2), turned counter-clockwise."""
    return vector @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def at_rest(scene: Scene, tension: float = 1.0) -> Equilibrium:
    inputs = scene.check_tension([tension] * scene.cables)
    return StaticSolver(scene).solve(inputs)


def pushed(angle: float, disks: int = 3) -> Scene:
    """Gravity and a dead load on an arm with a cable, both turned by ``angle``."""
    g, force = turned(np.array([[1.7, -9.6], [0.4, -0.7]]), angle)
    loads = DiskLoads((DiskLoad(2, (force[0], force[1]), 0.01),))
    arm = Arm.preset("rone2012", disks=disks, cables=(UPPER,))
    return Scene(arm, (Bending(), Extension(), Gravity((g[0], g[1])), Cables(), loads))


@settings(deadline=None, max_examples=20)
@given(angle=ANGLES, x=PLACES, y=PLACES)
def test_base_and_loads_turned_together_turn_the_arm(angle: float, x: float, y: float) -> None:
    plain, found = at_rest(pushed(0.0)), at_rest(mounted(pushed(angle), Base(x, y, angle)))
    np.testing.assert_allclose(found.bend_angle, plain.bend_angle, atol=1e-11)
    np.testing.assert_allclose(found.disk_theta, plain.disk_theta + angle, atol=1e-11)
    place = turned(np.column_stack([plain.disk_x, plain.disk_y]), angle) + np.array([x, y])
    np.testing.assert_allclose(np.column_stack([found.disk_x, found.disk_y]), place, atol=1e-12)
    assert (found.base_x, found.base_y, found.base_theta) == (x, y, angle)


def test_exact_rod_stands_where_the_base_is() -> None:
    """The judge knows nothing of the chain: one arc to a span is 12 um off it, on any base."""
    base = Base(0.3, -0.2, 2.0)
    for scene in (rone2012(), mounted(rone2012(), base)):
        tip, rod = at_rest(scene).tip, exact_rod(scene, 1.0).tip
        assert np.hypot(tip[0] - rod[0], tip[1] - rod[1]) < 13e-6
    leaning = mounted(rone2012(gravity=(0.0, 0.0)), base)
    assert exact_rod(leaning, 0.0).tip == pytest.approx((0.3 + 0.08 * np.cos(2), -0.2 + 0.08 * np.sin(2), 2))


@pytest.mark.parametrize(("load", "stands"), [(0.98, True), (1.02, False)])
def test_upright_arm_stands_up_to_its_critical_weight(load: float, stands: bool) -> None:
    """Q L^3 / EJ = 7.8373 / (1 + 1.59 / n), the heavy column (Greenhill 1881) in n disks."""
    plain = rone2012(disks=16)
    weight = 4 * 7.782e-4 * 9.81 * 0.08**2 / (2.10e11 * 2.011e-14)
    soft = rone2012(disks=16, stiffness=weight / (load * 7.8373 / (1 + 1.59 / 16)))
    upright = mounted(Scene(soft.arm, (Bending(), Gravity())), Base(angle=pi / 2))
    found = at_rest(upright)
    assert found.stable
    assert (np.abs(found.disk_theta - pi / 2).max() < 1e-6) == stands
    hanging = at_rest(mounted(Scene(plain.arm, (Bending(), Gravity())), Base(angle=-pi / 2)))
    assert hanging.tip == pytest.approx((0.0, -0.08, -pi / 2), abs=1e-12)


def test_gravity_energy_is_zero_at_the_origin() -> None:
    low, high = (at_rest(mounted(rone2012(), Base(y=height))) for height in (0.0, 0.5))
    assert high.gravity_energy - low.gravity_energy == pytest.approx(4 * 7.782e-4 * 9.81 * 0.5, rel=1e-12)


def test_loads_of_the_cables_turn_with_the_base() -> None:
    """Of hole-to-hole forces the base's hole is one end."""
    plain, leaning = at_rest(pushed(0.0)), at_rest(mounted(pushed(0.7), Base(0.1, 0.2, 0.7)))
    arms = (pushed(0.0).arm, replace(pushed(0.7).arm, base=Base(0.1, 0.2, 0.7)))
    found = [
        disk_loads(arm, rest.tension, rest.disk_x, rest.disk_y, rest.disk_theta)
        for arm, rest in zip(arms, (plain, leaning), strict=True)
    ]
    np.testing.assert_allclose(found[1][0], turned(found[0][0], 0.7), atol=1e-11)
    np.testing.assert_allclose(found[1][1], found[0][1], atol=1e-12)


def test_arm_without_a_base_has_no_trace_of_it_in_its_kernels() -> None:
    scene = Scene(rone2012().arm, (*rone2012().effects, *IN_MOTION))
    for source in (MOTION.write(scene.structure), REST.write(scene.at_rest.structure)):
        assert not [word for word in ("base_", "transport") if word in source]


def test_base_that_stays_has_no_trace_of_motion_in_its_kernel() -> None:
    scene = mounted(Scene(rone2012().arm, (*rone2012().effects, *IN_MOTION)), Base(angle=1.0))
    source = MOTION.write(scene.structure)
    assert "base_theta" in source
    assert not [word for word in ("base_velocity", "base_acceleration", "transport") if word in source]
    moving = mounted(scene, Base(angle=1.0, moves=True))
    assert "base_acceleration" not in REST.write(moving.at_rest.structure)
    assert "base_acceleration_x" in MOTION.write(moving.structure)


def accelerations(scene: Scene, inputs: np.ndarray) -> np.ndarray:
    """Of one state that moves."""
    kernel, segments, disks = Dynamics(scene).linearized
    q, u = np.random.default_rng(1).uniform(-0.5, 0.5, (2, scene.arm.segments, 2)) * (1.0, 1e-4)
    chain, work, w = np.empty((len(q), kernel.widths["chain"])), np.empty((2, *q.shape)), np.empty_like(q)
    scalars = np.empty(SCALARS)
    acceleration(kernel.passes, q, 30.0 * u, inputs, segments, disks, chain, work, w, scalars)
    return w


@pytest.mark.parametrize("base", [Base(), Base(moves=True)])
def test_base_at_the_origin_along_x_is_no_base(base: Base) -> None:
    without = Scene(rone2012().arm, (*rone2012().effects, *IN_MOTION))
    there = mounted(without, base)
    inputs = there.check_tension(1.0)
    assert len(inputs) == len(there.inputs) == (10 if base.moves else 4)
    expected = accelerations(without, without.check_tension(1.0))
    np.testing.assert_allclose(accelerations(there, inputs), expected, rtol=1e-11)


def test_printed_equations_and_exact_rod_say_which_bases_they_do_not_know() -> None:
    with pytest.raises(InputError, match="leave out base"):
        PrintedArm(mounted(rone2012(), Base(angle=1.0)))
    with pytest.raises(InputError, match="has a fixed base"):
        exact_rod(mounted(rone2012(), Base(moves=True)), 1.0)
