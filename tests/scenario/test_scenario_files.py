"""Scenario files: what is good runs, what is bad is named on one screen, and nothing is evaluated."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENARIOS

from continuum_dyn import load_scenario
from continuum_dyn.integrators import METHODS
from continuum_dyn.scenario.profiles import Table
from continuum_dyn.scenario.solver import Method
from continuum_dyn.scenario.studies import RampStudy
from statics import InputError

GOOD = (SCENARIOS / "step_response.toml").read_text()


def write(folder: Path, text: str) -> Path:
    path = folder / "scenario.toml"
    path.write_text(text)
    return path


def refusal(folder: Path, old: str, new: str) -> str:
    """What is said when ``old`` in the good scenario is replaced by ``new``."""
    assert old in GOOD
    path = write(folder, GOOD.replace(old, new))
    with pytest.raises(InputError) as caught:
        load_scenario(path)
    message = str(caught.value)
    assert str(path) in message
    assert len(message.splitlines()) < 20
    return message


@pytest.mark.parametrize("path", sorted(SCENARIOS.glob("*.toml")), ids=lambda path: path.stem)
def test_every_scenario_of_the_repository_loads_and_opens_with_what_it_shows(path: Path) -> None:
    scenario = load_scenario(path)
    assert scenario.title
    assert scenario.text.startswith("# ")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("gravity =", "gravty =", "unknown effect 'gravty'. Did you mean 'gravity'? Known: bending,"),
        ("acceleration =", "aceleration =", "Did you mean 'acceleration'?"),
        ("[arm]", "[amr]", "Did you mean 'arm'?"),
        ("name", "nam", "Did you mean 'name'?"),
        ("before", "befor", "Did you mean 'before'?"),
        ('"step"', '"stpe"', "Did you mean 'step'? Known: constant, step, ramp, smooth_ramp, sine, table"),
        ('"step_response"', '"step_respose"', "Did you mean 'step_response'?"),
        ('"rone2012"', '"rone2021"', "Did you mean 'rone2012'?"),
        (
            "hole_offset = 0.008",
            "",
            "missing 'hole_offset': position of a cable's hole along the disk's y axis, in m",
        ),
        ("duration = 1.0", "", "missing 'duration'"),
        ('kind = "step_response"', "", "missing 'kind'"),
        ('preset = "rone2012"', "disks = 4", "missing disk_spacing"),
        ('preset = "rone2012"', "disks = 4\ndisk_spacing = 0.02", "'bending' needs the arm's youngs_modulus"),
        ("\ninertia = {}", "", "needs inertia"),
        ("\ninertia =", "\nlinear_drg = {}\ninertia =", "Did you mean 'linear_drag'?"),
        ("\ninertia =", "\nlinear_drag = {}\ninertia =", "[effects] linear_drag: missing 'drag_per_speed'"),
        (
            "\ninertia =",
            "\nlinear_drag = { drag_per_speed = -1 }\ninertia =",
            "or equal to 0 is expected; read -1",
        ),
        ("\ninertia =", "\nquadratic_drag = { drag_per_speed = 1 }\ninertia =", "'drag_per_speed_squared'?"),
        (
            "\ninertia =",
            "\nmass_damping = { mass_damping_rate = -2 }\ninertia =",
            "or equal to 0 is expected; read -2",
        ),
        ("duration = 1.0", "duration = -1.0", "greater than 0 is expected; read -1.0"),
        ("after = 1.0", "after = -1.0", "a cable cannot push, and its tension falls to -1 N"),
        ("0.008", "nan", "finite number is expected; read nan"),
        ("1.2e-3", "inf", "finite number is expected; read inf"),
        ("0.008", '"0.008"', 'a number is expected, without quotes and unit; read "0.008"'),
        ("duration = 1.0", "duration = true", "a number is expected; read true"),
        ("samples = 1001", "samples = 1001.5", "a whole number is expected; read 1001.5"),
        ("samples = 1001", "samples = 1", "greater than or equal to 2"),
        ("samples = 1001", "samples = 1000000000", "Give fewer samples"),
        (
            '"rone2012"',
            '"rone2012"\ndisks = 1000000000',
            "less than or equal to 10000 is expected; read 1000000000",
        ),
        ('"rone2012"', '"rone2012"\ndisks = 0', "greater than or equal to 1"),
        ('"rone2012"', '"rone2012"\ndisk_mass = -1', "greater than or equal to 0"),
        ('"rone2012"', '"rone2012"\nyoungs_modulus = 0', "greater than 0"),
        ('"rone2012"', '"rone2012"\ncore_radius = 4e-4\narea = 5e-7', "core_radius already sets area"),
        ('"rone2012"', '"rone2012"\nreference_curvature = 125.0', "holes meet in the unloaded arm"),
        ("0.008", "0.008\nanchor = 5", "anchor 5 is beyond the arm. Allowed: disks 1 to 4"),
        ("[study]", "[[loads]]\ndisk = 9\n[study]", "load on disk 9: beyond the arm"),
        (
            "[study]",
            "[[payloads]]\ndisk = 9\nmass = 1\n[study]",
            "payload on disk 9: beyond the arm. Allowed:",
        ),
        (
            "[study]",
            "[[payloads]]\ndisk = 4\n[study]",
            "[[payloads]] number 1: missing 'mass': mass of a payload, in kg",
        ),
        ("[study]", "[[payloads]]\ndisk = 4\nmass = -1\n[study]", "number 1 mass: a number greater"),
        ("[study]", "[[payloads]]\ndisk = 4\nmass = 1\nofset = 1\n[study]", "Did you mean 'offset'?"),
        ("[study]", '[solver]\nmethod = "Radua"\n[study]', "Did you mean 'Radau'?"),
        ("[study]", "[solver]\nrtol = 0.0\n[study]", "read 0.0"),
        ('{ profile = "step", before = 0.0, after = 1.0 }', "[1.0, 2.0]", 'belongs to [study] kind = "ramp"'),
        (
            '"step", before = 0.0, after = 1.0',
            '"ramp", before = 0, after = 1, start = 1, end = 1',
            "must end after",
        ),
        (
            '"step", before = 0.0, after = 1.0',
            '"sine", mean = 1, amplitude = 2, frequency = 1',
            "cannot push",
        ),
        ('"step", before = 0.0, after = 1.0', '"table", file = "none.csv"', "no such file"),
        (
            '"step", before = 0.0, after = 1.0',
            '"table", file = "../none.csv"',
            "outside the scenario's folder",
        ),
        ("[study]", "[study", "not a TOML file"),
        ("1.0\nsamples", "1979-05-27\nsamples", "a number is expected"),
    ],
)
def test_bad_input_is_named_with_what_is_allowed(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert said in refusal(tmp_path, old, new)


def test_all_errors_of_a_file_are_told_at_once(tmp_path: Path) -> None:
    path = write(tmp_path, GOOD.replace("gravity =", "gravty =").replace("0.008", "nan"))
    with pytest.raises(InputError) as caught:
        load_scenario(path)
    assert len(str(caught.value).splitlines()) == 2


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("time,tension\n0,1\n1,2\n0.5,3\n", "row 3: time 0.5 s does not come after 1 s"),
        ("time,tension\n0,1\n1,-2\n", "row 2"),
        ("time,tension\n0,1\n1,nan\n", "row 2"),
        ("time,tension\n0,1\n1\n", "row 2: two numbers expected; read: 1"),
        ("time,tension\n0,__import__('os')\n", "row 1: two numbers expected"),
        ("time,tension\n", "no rows below the header"),
        ("t,F\n0,1\n", "the first line must be time,tension; read: t,F"),
        ("", "the first line must be time,tension; read: nothing"),
    ],
)
def test_table_that_cannot_be_is_refused_with_its_row(tmp_path: Path, rows: str, said: str) -> None:
    (tmp_path / "table.csv").write_text(rows)
    message = refusal(tmp_path, '"step", before = 0.0, after = 1.0', '"table", file = "table.csv"')
    assert said in message


def test_table_beside_the_scenario_is_read(tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text("time, tension\n0.0, 0.5\n\n1.0, 2.0\n")
    text = GOOD.replace('"step", before = 0.0, after = 1.0', '"table", file = "table.csv"')
    assert load_scenario(write(tmp_path, text)).drives == (Table((0.0, 1.0), (0.5, 2.0)),)


def test_what_is_given_beats_the_preset_and_core_radius_sets_the_section(tmp_path: Path) -> None:
    text = GOOD.replace('"rone2012"', '"rone2012"\ncore_radius = 4e-4\ndisks = 6\nreference_curvature = 2.0')
    arm = load_scenario(write(tmp_path, text)).scene.arm
    assert (arm.disks, arm.disk_spacing, arm.reference_curvature) == (6, 0.02, 2.0)
    # Table 1's A and J are those of a core of 0.4 mm, rounded to four digits.
    assert (arm.area, arm.second_moment) == pytest.approx((5.027e-7, 2.011e-14), rel=2.5e-4)


def test_scalars_are_repeated_along_a_ramp(tmp_path: Path) -> None:
    text = GOOD.replace('{ profile = "step", before = 0.0, after = 1.0 }', "[0.0, 1.0, 2.0]")
    text = text.replace("[study]", '[[cables]]\nhole_offset = -0.008\ntension = 0.5\n[study]\nkind = "ramp"')
    scenario = load_scenario(write(tmp_path, text[: text.index('kind = "step_response"')]))
    assert isinstance(scenario.study, RampStudy)
    assert scenario.ramps == ((0.0, 1.0, 2.0), (0.5, 0.5, 0.5))
    assert scenario.scene.arm.cable_names == ("upper", "cable_2")


def test_ramp_lists_of_unequal_length_are_refused(tmp_path: Path) -> None:
    text = GOOD.replace('{ profile = "step", before = 0.0, after = 1.0 }', "[0.0, 1.0, 2.0]")
    text = text.replace(
        "[study]", '[[cables]]\nhole_offset = -0.008\ntension = [0.5, 1.0]\n[study]\nkind = "ramp"'
    )
    with pytest.raises(InputError, match="equal length"):
        load_scenario(write(tmp_path, text[: text.index('kind = "step_response"')]))


@pytest.mark.parametrize("content", [b"\xff\xfe\x00", b"\x00" * 10, b"[" * 5000])
def test_files_that_are_not_toml_are_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "scenario.toml"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"scenario\.toml"):
        load_scenario(path)


def test_missing_file_names_the_nearest() -> None:
    with pytest.raises(InputError, match=r"Did you mean 'step_response\.toml'"):
        load_scenario(SCENARIOS / "step_responce.toml")


@pytest.mark.parametrize(
    ("rows", "starts", "values"),
    [
        ("0,1\n1,2\n2,1", [0.0, 0.0, 1.0, 2.0, 3.0, 4.0], [1, 1, 2, 1, 2, 1]),
        ("1,1\n2,3", [0.0, 1.0, 2.0, 3.0], [1, 1, 1, 3]),
    ],
    ids=["closed", "with a jump"],
)
def test_table_of_several_periods_repeats_its_rows(
    tmp_path: Path, rows: str, starts: list[float], values: list[float]
) -> None:
    (tmp_path / "table.csv").write_text(f"time,tension\n{rows}\n")
    text = GOOD.replace('"step", before = 0.0, after = 1.0', '"table", file = "table.csv", periods = 2')
    (profile,) = load_scenario(write(tmp_path, text)).drives
    assert isinstance(profile, Table)
    assert [piece[0] for piece in profile.pieces()] == starts
    assert [piece[1] for piece in profile.pieces()] == values


def test_corners_one_ulp_apart_stay_so_in_every_period(tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text(
        f"time,tension\n0,1\n0.3,1\n{float(np.nextafter(0.3, 1.0))!r},2\n0.7,1\n"
    )
    text = GOOD.replace('"step", before = 0.0, after = 1.0', '"table", file = "table.csv", periods = 300')
    (profile,) = load_scenario(write(tmp_path, text)).drives
    assert isinstance(profile, Table)
    starts = [piece[0] for piece in profile.pieces()[1:]]
    jumps = [(early, late) for early, late in pairwise(starts) if late - early < 0.1]
    assert len(jumps) == 300
    assert all(late - early <= 2 * np.spacing(late) for early, late in jumps)


def test_table_of_too_many_periods_is_refused(tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text("time,tension\n0,1\n1,2\n")
    good = '"step", before = 0.0, after = 1.0'
    message = refusal(tmp_path, good, '"table", file = "table.csv", periods = 600_000')
    assert "table 'table.csv': 600000 periods of 2 rows. Allowed: 1000000 rows." in message


def test_files_with_a_byte_order_mark_are_read_as_without(tmp_path: Path) -> None:
    """As Notepad writes them, and Excel its "CSV UTF-8"."""
    text = GOOD.replace('"step", before = 0.0, after = 1.0', '"table", file = "table.csv"')
    rows = "time,tension\n0,1\n1,2\n"
    found = []
    for encoding, newline in (("utf-8", "\n"), ("utf-8-sig", "\r\n")):
        (tmp_path / "table.csv").write_text(rows, encoding=encoding, newline=newline)
        (tmp_path / "scenario.toml").write_text(text, encoding=encoding, newline=newline)
        found.append(load_scenario(tmp_path / "scenario.toml"))
    assert found[0].text == found[1].text == text
    assert found[0].tables == found[1].tables == {"table.csv": rows}
    assert found[0].drives == found[1].drives


def test_solver_table_knows_every_integrator() -> None:
    assert {"auto", *METHODS} == set(Method.__args__)
