"""Arms whose disks, cores and holes differ: against closed forms, and against arms of equal ones."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENARIOS, rone2012
from whole_arm import gradient, potential_energy, tapered_scene, whole_arm

from continuum_dyn import load_scenario, simulate
from continuum_dyn.record import read_log, write_log
from statics import (
    Arm,
    Bending,
    Cable,
    DiskLoad,
    DiskLoads,
    InputError,
    Outcome,
    PerDisk,
    Scene,
    equilibrium,
)
from statics.judges.exact_rod import exact_rod


def stepped(moments: tuple[float, ...], stiffness: tuple[float, ...], spacing: tuple[float, ...]) -> Scene:
    """An inextensible arm without weight, with a moment on each disk."""
    each = PerDisk(disk_spacing=spacing, second_moment=stiffness)
    arm = Arm(len(spacing), disk_spacing=1.0, youngs_modulus=1.0, each=each)
    loads = tuple(DiskLoad(number, moment=moment) for number, moment in enumerate(moments, start=1))
    return Scene(arm, (Bending(), DiskLoads(loads)))


def test_moments_bend_each_segment_by_its_own_stiffness_and_length() -> None:
    """phi_i = L_i / EJ_i times all moments from disk i on."""
    found = equilibrium(stepped((0.1, -0.3, 0.25), (1.0, 0.5, 0.2), (0.4, 0.7, 0.3)))
    expected = np.array([0.4 / 1.0 * 0.05, 0.7 / 0.5 * -0.05, 0.3 / 0.2 * 0.25])
    np.testing.assert_allclose(found.bend_angle, expected, rtol=1e-13)
    np.testing.assert_allclose(found.length, [0.4, 0.7, 0.3], rtol=1e-15)


def test_lists_of_equal_numbers_are_one_number() -> None:
    plain = rone2012()
    arm = plain.arm
    names = ("disk_spacing", "youngs_modulus", "area", "second_moment", "disk_mass")
    each = PerDisk(**{name: (getattr(arm, name),) * 4 for name in names})
    same = Scene(replace(arm, disk_mass=None, each=each), plain.effects)
    assert equilibrium(same, 1.0).tip == equilibrium(plain, 1.0).tip


@pytest.mark.slow
def test_rest_is_where_the_potential_energy_of_the_whole_arm_is_level() -> None:
    scene = tapered_scene(4)
    arm, tension = whole_arm(scene), np.array([1.5, 0.5])
    found = equilibrium(scene, tension)
    assert found.outcome is Outcome.COMPLETED
    slope = gradient(lambda q: potential_energy(arm, q, tension), found.coordinates)
    scale = gradient(lambda q: potential_energy(arm, q, tension), np.full_like(found.coordinates, 0.01))
    assert np.abs(slope).max() < 1e-9 * np.abs(scale).max()


@pytest.mark.slow
def test_tapered_arm_runs_and_its_log_says_what_differs(tmp_path: Path) -> None:
    run = simulate(load_scenario(SCENARIOS / "tapered_arm.toml"))
    assert run.outcome is Outcome.SETTLED
    write_log(run, tmp_path / "log.h5")
    log = read_log(tmp_path / "log.h5")
    assert log.arm["disk_mass"].shape == (4,)
    np.testing.assert_allclose(log.arm["hole_offset"][0], [0.010, 0.009, 0.008, 0.007, 0.006])
    assert (log.arm["hole_offset"][1] == -0.008).all()
    np.testing.assert_allclose(log.trajectory["length"][0], [0.03, 0.025, 0.02, 0.015], rtol=1e-4)


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ("0.02, 0.015]", "0.02]", "3 numbers for 4 disks"),
        ("disk_mass = [1e-3, 8e-4, 6e-4, 4e-4]", "disk_mass = []", "at least 1 value"),
        ("0.007, 0.006]", "0.007]", "4 hole_offsets"),
        ("6e-4, 4e-4]", "6e-4, -4e-4]", r"\[arm\] disk_mass number 4"),
        ("6e-4, 4e-4]", '6e-4, "heavy"]', r"\[arm\] disk_mass number 4"),
    ],
)
def test_lists_that_do_not_fit_are_refused(tmp_path: Path, before: str, after: str, told: str) -> None:
    text = (SCENARIOS / "tapered_arm.toml").read_text()
    assert before in text
    path = tmp_path / "scenario.toml"
    path.write_text(text.replace(before, after, 1))
    with pytest.raises(InputError, match=told):
        load_scenario(path)


def test_exact_rod_refuses_what_it_does_not_know() -> None:
    with pytest.raises(InputError, match="equal segments"):
        exact_rod(tapered_scene(3), np.array([1.0, 0.0]))


def test_cable_whose_holes_meet_in_the_unloaded_arm_is_refused() -> None:
    with pytest.raises(InputError, match="holes meet"):
        Arm(2, 0.1, each=PerDisk(reference_curvature=(1.0, 120.0)), cables=(Cable("upper", 0.01),))
