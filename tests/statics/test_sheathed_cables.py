"""A cable that leaves its sheath at a disk acts beyond it alone."""

from typing import Any

import numpy as np
import pytest
import whole_arm
from whole_arm import gradient

from statics import Arm, Bending, Cable, CableFriction, Cables, Extension, Gravity, InputError, Scene
from statics import disk_loads as loads_of_cables
from statics.equilibria import Equilibrium, StaticSolver
from statics.judges.exact_rod import exact_rod


def rest(cable: Cable, *more: Any, disks: int = 4, drive: float = 1.5) -> Equilibrium:
    arm = Arm.preset("rone2012", disks=disks, cables=(cable,))
    scene = Scene(arm, (Bending(), Extension(), Cables(), *more))
    return StaticSolver(scene).solve(np.pad([drive], (0, len(scene.inputs) - 1)))


KINDS = {
    "pulled": ({}, (), 1.5),
    "driven by length": ({"cable_stiffness": 2000.0}, (), 1e-3),
    "that rubs": ({"friction": 0.2}, (CableFriction(),), 1.5),
}


@pytest.mark.parametrize(("numbers", "more", "drive"), KINDS.values(), ids=KINDS)
def test_without_weight_the_arm_is_straight_up_to_the_start_and_bends_as_a_shorter_arm_beyond(
    numbers: dict[str, Any], more: tuple[Any, ...], drive: float
) -> None:
    sheathed = rest(Cable("upper", 0.008, start=2, **numbers), *more, drive=drive)
    shorter = rest(Cable("upper", 0.008, **numbers), *more, disks=2, drive=drive)
    assert np.abs(sheathed.bend_angle[:2]).max() < 1e-12
    np.testing.assert_allclose(sheathed.bend_angle[2:], shorter.bend_angle, rtol=1e-9)
    assert sheathed.tension[0] == pytest.approx(shorter.tension[0], rel=1e-9)
    assert sheathed.cable_displacement[0] == pytest.approx(shorter.cable_displacement[0], abs=1e-12)
    if (
        sheathed.elongation is not None and not more
    ):  # the disk at the start presses the core by as much as the cable pulls there
        assert np.abs(sheathed.elongation[:2]).max() < 1e-16


def test_at_rest_the_energy_has_no_slope() -> None:
    arm = Arm.preset("rone2012", cables=(Cable("upper", (0.009, 0.008, 0.007, 0.006, 0.006), start=1),))
    scene = Scene(arm, (Bending(), Extension(), Gravity(), Cables()))
    found, tension = StaticSolver(scene).solve(np.array([1.5])), np.array([1.5])
    whole = whole_arm.whole_arm(scene)
    slope = gradient(lambda q: whole_arm.potential_energy(whole, q, tension), found.coordinates)
    assert np.abs(slope).max() < 1e-11
    unsheathed = whole_arm.whole_arm(
        Scene(Arm.preset("rone2012", cables=(Cable("upper", 0.008),)), scene.effects)
    )
    slope = gradient(lambda q: whole_arm.potential_energy(unsheathed, q, tension), found.coordinates)
    assert np.abs(slope).max() > 1e-3


def test_loads_on_disks_add_up_to_nothing_and_spare_those_before_the_start() -> None:
    """The sheath's end presses on the disk at the start, so the arm as a whole feels no force."""
    found = rest(Cable("upper", 0.008, start=2))
    arm = Arm.preset("rone2012", cables=(Cable("upper", 0.008, start=2),))
    poses = found.disk_x, found.disk_y, found.disk_theta
    force, moment = loads_of_cables(arm, np.array([1.5]), *poses)
    assert not force[0].any()
    assert moment[0] == 0.0
    np.testing.assert_allclose(force.sum(axis=0), 0.0, atol=1e-14)
    about_origin = np.sum(moment + found.disk_x * force[:, 1] - found.disk_y * force[:, 0])
    assert about_origin == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize(("start", "anchor"), [(4, None), (2, 2), (3, 2)])
def test_a_start_that_is_not_before_the_anchor_is_refused(start: int, anchor: int | None) -> None:
    with pytest.raises(InputError, match=f"start {start} is not before its anchor"):
        Arm.preset("rone2012", cables=(Cable("upper", 0.008, anchor, start=start),))


def test_the_exact_rod_refuses_a_start_by_name() -> None:
    scene = Scene(Arm.preset("rone2012", cables=(Cable("upper", 0.008, start=2),)), (Bending(), Cables()))
    with pytest.raises(InputError, match="start at the base"):
        exact_rod(scene, 1.0)
