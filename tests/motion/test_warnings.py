"""Warnings: of what is legal but odd, with what was read; and none of what is ordinary."""

import json
from pathlib import Path

import pytest
from conftest import SCENARIOS
from typer.testing import CliRunner

from continuum_dyn import Run, load_scenario, simulate
from continuum_dyn.cli import app
from continuum_dyn.record import read_log, write_log
from continuum_dyn.record.writing import attributes_of

STEP = SCENARIOS / "step_response.toml"
RAMP = SCENARIOS / "tension_ramp.toml"


def run(scenario: Path, *changes: str) -> Run:
    return simulate(load_scenario(scenario, changes))


ODD = {
    "a radius in mm": (RAMP, ["arm.area=0.5", "arm.second_moment=0.02"], "0.4 mm are 0.0004 m"),
    "a core like a thread": (RAMP, ["arm.area=1e-12", "arm.second_moment=8e-26"], "below 0.0001 of"),
    "a hole in mm": (STEP, ["cables.upper.hole_offset=8"], "8 mm are 0.008 m"),
    "degrees of a sine": (
        STEP,
        ['cables.upper.tension={profile="sine",mean=1,amplitude=0.5,frequency=5,phase=90}'],
        "90 degrees are 1.5708 rad",
    ),
    "degrees of the base": (RAMP, ["base.angle=90"], "90 degrees are 1.5708 rad"),
    "a modulus in GPa": (RAMP, ["arm.youngs_modulus=210"], "210 GPa are 2.1e+11 Pa"),
    "a modulus in GPa, of the weight": (
        SCENARIOS / "unactuated.toml",
        ["arm.youngs_modulus=0.21"],
        "0.21 GPa are 2.1e+08 Pa",
    ),
    "a chain": (
        SCENARIOS / "unactuated.toml",
        ["effects={gravity={},extension={}}"],
        "nothing resists bending",
    ),
    "nothing takes energy": (
        STEP,
        ["effects.material_damping.retardation_time=0.0", "study.duration=0.01"],
        "without damping the motion cannot settle",
    ),
    "a change cut short": (
        STEP,
        ['cables.upper.tension={profile="ramp",before=0,after=1,start=0.5,end=2}'],
        "changes until 2 s, after the end of the run at 1 s",
    ),
    "an accuracy in mm": (
        STEP,
        ["accuracy.tip=0.5", "study.duration=0.1"],
        "[accuracy] tip = 0.5 m is longer than the whole motion",
    ),
    "milliseconds": (
        STEP,
        ["effects.material_damping.retardation_time=1.2"],
        "1.2 ms are 0.0012 s",
    ),
    "a change after the end": (
        STEP,
        ["cables.upper.tension.at=5"],
        "changes at 5 s, after the end of the run at 1 s",
    ),
    "nothing steps": (STEP, ["cables.upper.tension=1.0"], "with constant inputs"),
    "a disk's mass in vain": (
        SCENARIOS / "unactuated.toml",
        ["arm.disk_inertia=1e-8"],
        "disk_inertia has no effect",
    ),
    "a payload's mass in vain": (
        RAMP,
        ["effects={bending={}}", "payloads=[{disk=4,mass=0.002}]"],
        "[[payloads]] mass has no effect: only gravity, inertia and mass_damping use it",
    ),
    "nothing drives": (STEP, ["cables=[]", "study.duration=0.01"], "with constant inputs"),
    "the core's mass twice": (STEP, ["arm.core_density=8000.0"], "counts twice"),
    "settled from the start": (STEP, ["study.settled_within=0.5"], "longer than the whole motion"),
    "a core that yields": (SCENARIOS / "follower_tip.toml", [], "a strain of 2.03 %"),
    "samples too far apart": (STEP, ["study.samples=30"], "too few: 30 in 1 s"),
    "explicit steps of a stiff arm": (
        STEP,
        ["solver.method=RK23", "study.duration=2e-4", "study.samples=20"],
        'Try method = "chain"',
    ),
}


@pytest.mark.parametrize(("scenario", "changes", "told"), ODD.values(), ids=list(ODD))
def test_what_is_odd_is_told_with_what_it_may_have_been(
    scenario: Path, changes: list[str], told: str
) -> None:
    found = run(scenario, *changes)
    assert [warning for warning in found.warnings if told in warning]
    assert attributes_of(found)["warnings"].splitlines() == list(found.warnings)


@pytest.mark.parametrize(
    "name", ["step_response", "tension_ramp", "antagonistic", "friction_ramp", "unactuated"]
)
def test_what_is_ordinary_is_not_warned_of(name: str) -> None:
    assert run(SCENARIOS / f"{name}.toml").warnings == ()


def test_numbers_that_follow_from_a_description_are_not_called_useless() -> None:
    described = (
        "{disks=4,length=0.08,core_radius=4e-4,core_material='steel',"
        "disk_radius=0.01,disk_thickness=0.003,disk_material='pla'}"
    )
    assert run(RAMP, f"arm={described}", "effects={bending={}}", "cables.upper.tension=[0.5]").warnings == ()


def test_ramp_that_ends_with_the_run_is_ordinary() -> None:
    ramp = 'cables.upper.tension={profile="ramp",before=0,after=1,start=0,end=1}'
    assert not [text for text in run(STEP, ramp).warnings if "changes" in text]


def test_warnings_are_in_the_log_the_json_and_the_terminal(tmp_path: Path) -> None:
    found = run(STEP, "study.samples=30")
    write_log(found, str(tmp_path / "coarse.h5"))
    log = read_log(str(tmp_path / "coarse.h5"))
    assert log.attributes["warnings"].splitlines() == list(found.warnings)
    radius, curvatures = 4.0e-4, (log.trajectory["curvature"], log.equilibria["curvature"])
    strain = radius * max(abs(curvature).max() for curvature in curvatures)
    assert log.attributes["bending_strain"] == found.bending_strain == pytest.approx(strain, rel=1e-3)
    asked = ["run", str(STEP), "--set", "study.samples=30", "--out", str(tmp_path)]
    told = json.loads(CliRunner().invoke(app, [*asked, "--json"]).stdout)
    assert told["warnings"] == list(found.warnings)
    shown = CliRunner().invoke(app, asked)
    assert shown.exit_code == 0
    assert "warning" in shown.stdout
    assert "warning" in CliRunner().invoke(app, ["info", str(tmp_path / "coarse.h5")]).stdout
