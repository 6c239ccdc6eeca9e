"""A damping ratio is that of the first mode of the unloaded arm, and logs hold the time that it leads to."""

from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest
import whole_arm
from conftest import MOTION

from continuum_dyn import load_scenario
from continuum_dyn.effects import Inertia, RotaryInertia
from continuum_dyn.scenario.first_mode import first_frequency, retardation_time
from statics import Arm, Bending, Cable, Cables, Extension, Gravity, InputError, Payload, Scene

REST = (Bending(), Extension(), Gravity(), Cables())
ARMS = {
    "straight": Arm.preset("rone2012"),
    "curved, with a heavy core": Arm.preset("rone2012", reference_curvature=20.0, core_density=7.8e4),
    "with segments and a payload": Arm.preset(
        "rone2012", disks=2, subsegments=2, payloads=(Payload(2, 2e-3, 1e-7, (0.006, 0.003)),)
    ),
}


@pytest.mark.parametrize("arm", ARMS.values(), ids=ARMS)
def test_first_frequency_is_that_of_the_whole_arm_as_it_is_made(arm: Arm) -> None:
    """The mass matrix by the partial velocities of every body, the stiffness that of the core."""
    scene = Scene(replace(arm, cables=(Cable("upper", 0.008),)), (*REST, *MOTION))
    whole = whole_arm.whole_arm(scene)
    q = np.zeros((whole.n, 2))
    q[:, 0] = np.where(whole.k0 == 0.0, 1e-4, whole.k0 * whole.L0)  # it divides by the bend angle
    mass, _ = whole_arm.free_mass_and_forcing(whole, q, np.zeros_like(q), np.zeros(1))
    flexibility = np.concatenate([whole.L0 / whole.EJ, whole.L0 / whole.EA])
    largest = np.linalg.eigvals(flexibility[:, None] * mass).real.max()
    assert first_frequency(scene) == pytest.approx(1 / np.sqrt(largest), rel=2e-5)


def test_one_disk_on_a_massless_core_swings_as_in_the_handbook() -> None:
    """A point mass at the end of one arc of stiffness EJ/L moves by L/2 per bend angle."""
    arm = Arm(1, 0.1, youngs_modulus=2e11, second_moment=2e-14, disk_mass=1e-3)
    by_hand = np.sqrt(2e11 * 2e-14 / 0.1 / (1e-3 * 0.05**2))
    assert first_frequency(Scene(arm, (Bending(), Inertia()))) == pytest.approx(by_hand, rel=1e-12)


SCENARIO = """
[arm]
preset = "rone2012"
{arm}
[effects]
bending = {{}}
{effects}
material_damping = {{ {damping} }}
[study]
kind = "motion"
duration = 1.0
"""
INERTIA = "inertia = {}\nrotary_inertia = {}"


def written(folder: Path, damping: str, arm: str = "", effects: str = INERTIA) -> Path:
    file = folder / "arm.toml"
    file.write_text(SCENARIO.format(damping=damping, arm=arm, effects=effects))
    return file


def test_the_text_of_a_scenario_holds_the_time_that_a_ratio_leads_to(tmp_path: Path) -> None:
    scenario = load_scenario(written(tmp_path, "damping_ratio = 0.05", 'core_material = "nitinol"'))
    assert "# material_damping = { damping_ratio = 0.05 }" in scenario.text
    assert '# core_material = "nitinol"' in scenario.text
    again = tmp_path / "again.toml"
    again.write_text(scenario.text)
    replayed = load_scenario(again)
    assert replayed.scene == scenario.scene
    assert replayed.text == scenario.text
    time = retardation_time(Scene(scenario.scene.arm, (Bending(), Inertia(), RotaryInertia())), 0.05)
    assert f"retardation_time = {time}" in scenario.text
    plain = written(tmp_path, "retardation_time = 1.2e-3")
    assert load_scenario(plain).text == plain.read_text()


@pytest.mark.parametrize(
    ("damping", "arm", "effects", "said"),
    [
        (
            "damping_ratio = 0.1, retardation_time = 1e-3",
            "",
            INERTIA,
            "retardation_time (s) or damping_ratio",
        ),
        ("", "", INERTIA, "retardation_time (s) or damping_ratio"),
        ("damping_ratio = 0.1", "", "", "needs inertia"),
        ("damping_ratio = 0.1", "disks = 400\nsubsegments = 2", INERTIA, "800 segments are too many"),
        ("damping_ratio = 0.1", "disk_inertia = 0.0", "rotary_inertia = {}", "nothing has mass"),
    ],
)
def test_ratios_that_lead_to_no_time_are_refused(
    tmp_path: Path, damping: str, arm: str, effects: str, said: str
) -> None:
    with pytest.raises(InputError, match="material_damping: ") as refused:
        load_scenario(written(tmp_path, damping, arm, effects))
    assert said in str(refused.value)


@pytest.mark.slow
def test_modes_at_rest_have_the_ratio_without_weight(tmp_path: Path) -> None:
    from continuum_dyn.modes import modes_at_rest

    scenario = load_scenario(written(tmp_path, "damping_ratio = 0.05"))
    first = modes_at_rest(scenario).modes[0]
    assert first.damping_ratio == pytest.approx(0.05, rel=1e-6)
    assert 2 * pi * first.frequency == pytest.approx(first_frequency(scenario.scene), rel=1e-6)
