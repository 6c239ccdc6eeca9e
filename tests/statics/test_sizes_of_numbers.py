"""Numbers of scenarios: those of no arm are refused, those of the smallest arms are not."""

from pathlib import Path

import numpy as np
import pytest
from conftest import SCENARIOS, edited, motion

from continuum_dyn import load_scenario
from continuum_dyn.scenario_files.reading import LARGEST, SMALLEST
from statics import InputError
from statics.arm import RONE2012

STEP = SCENARIOS / "step_response.toml"
SCALE = 1e-6
"""Of lengths and times; masses go with volumes, so stresses, angles and speeds stay as they are."""
POWERS = {"disk_spacing": 1, "area": 2, "second_moment": 4, "disk_mass": 3, "disk_inertia": 5}


def test_an_arm_of_80_nanometres_moves_as_that_of_80_millimetres(tmp_path: Path) -> None:
    """Its disks' inertia is of 1e-38 kg m^2."""
    numbers = {name: number * SCALE ** POWERS.get(name, 0) for name, number in RONE2012.items()}
    numbers["disks"] = RONE2012["disks"]
    small = edited(
        STEP,
        tmp_path,
        ('preset = "rone2012"', "\n".join(f"{name} = {number!r}" for name, number in numbers.items())),
        ("[0.0, -9.81]", f"[0.0, {-9.81 / SCALE!r}]"),
        ("retardation_time = 1.2e-3", f"retardation_time = {1.2e-3 * SCALE!r}"),
        ("hole_offset = 0.008", f"hole_offset = {0.008 * SCALE!r}"),
        ("after = 1.0", f"after = {SCALE**2!r}"),
        ("duration = 1.0", f"duration = {SCALE!r}"),
    )
    moved, expected = motion(small), motion(load_scenario(STEP))
    gap = np.abs(moved.disk_y[:, -1] / SCALE - expected.disk_y[:, -1])
    assert gap.max() < 1e-7  # m, of 6e-3


@pytest.mark.parametrize("number", [SMALLEST / 10, 10 * LARGEST, -10 * LARGEST, 1e-300, 1e300, 10**400])
def test_numbers_of_no_arm_are_refused_with_what_is_allowed(tmp_path: Path, number: float) -> None:
    with pytest.raises(InputError, match=r"number to compute with.*1e-60 to 1e\+30, in SI units"):
        edited(STEP, tmp_path, ("hole_offset = 0.008", f"hole_offset = {number!r}"))
