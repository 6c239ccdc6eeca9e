"""Mistakes in scenario files are told in this program's words, all at once, with what to write."""

import re
from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest
from conftest import SCENARIOS
from scenario_mutants import mutant

from continuum_dyn.effects import EFFECTS
from continuum_dyn.scenario.profiles import PROFILES
from continuum_dyn.scenario.studies import STUDIES
from continuum_dyn.scenario_files.mistakes.messages import _known
from continuum_dyn.scenario_files.mistakes.synonyms import SYNONYMS, meant_by
from continuum_dyn.scenario_files.reading import load_scenario
from continuum_dyn.scenario_files.tables import ScenarioFile
from statics import InputError

LIBRARIES = re.compile(
    r"Input should|input should|valid (string|number|integer|array)|object|tuple|[Vv]alue error|validation|"
    r"something else|\bTrue\b|\bNone\b|tomllib|Traceback|at line"
)
"""Words of pydantic's, tomllib's and Python's own messages."""
GOOD = (SCENARIOS / "step_response.toml").read_text()


def refusal(folder: Path, text: str) -> str:
    path = folder / "scenario.toml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        load_scenario(path)
    return str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("bending = {}", "bending = true", "a table in { } is expected; read true. Write bending = {}."),
        (
            "material_damping = { retardation_time = 1.2e-3 }",
            "material_damping = 1e-3",
            "Write material_damping = { retardation_time = ... }.",
        ),
        ("[[cables]]", "[cables]", "[cables]: a list in [ ] is expected; read { name ="),
        ("[[cables]]", "[cables]", "Write [[cables]]."),
        ("[arm]", "[[arm]]", "Write [arm]."),
        ('[arm]\npreset = "rone2012"', 'arm = "rone2012"', "Write [arm], and its keys on lines below."),
        ("hole_offset", "radius", "unknown key 'radius'. Write hole_offset (m)."),
        ('preset = "rone2012"', "diameter = 1e-3", "core_outer_radius of a tube: half the diameter."),
        ('preset = "rone2012"', "g = 9.81", "Write gravity = { acceleration = [0.0, -9.81] } in [effects]."),
        ("gravity = { acceleration =", "gravity = { g =", "Write acceleration = [0.0, -9.81]."),
        ("inertia = {}", "friction = {}", "unknown effect 'friction'. Write friction of [[cables]]."),
        ("duration = 1.0", "t_end = 1.0", "Write duration (s)."),
        ('"step_response"', '"dynamic"', "unknown kind 'dynamic'. Write 'motion'. Known: equilibrium,"),
        ('"step", before', '"linear", before', "Write 'ramp'. Known: constant,"),
        ("before = 0.0", "from = 0.0", "unknown key 'from'. Write before."),
        ("hole_offset = 0.008", "hole_offset = 0.008\neffects = {}", "It is a table of its own: [effects]."),
        ("[study]", '[solver]\n"\u00b2" = 1e99\n[study]', "[solver] \u00b2: too large a number"),
        ("[0.0, -9.81]", "[-9.81]", "acceleration: a list of two numbers is expected; read [-9.81]."),
        ("name = ", "name = = ", "not a TOML file, line "),
        (
            "duration = 1.0",
            "duration = 1,0",
            "numbers have a decimal point, not a comma; read duration = 1,0",
        ),
        ("duration = 1.0", "duration = 1 s", "units are left out"),
        ("-9.81] }", "-9.81]", "a table in { } that does not end on its line"),
        ("[study]", "[arm]\n[study]", "a table defined before"),
    ],
)
def test_mistake_is_told_with_what_to_write(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert old in GOOD
    assert said in refusal(tmp_path, GOOD.replace(old, new, 1))


def test_mistakes_of_every_kind_are_told_together(tmp_path: Path) -> None:
    """Missing tables, unknown keys, numbers out of bounds or beyond floating point, crossed settings."""
    text = GOOD[: GOOD.index("[study]")].replace("gravity", "gravty").replace("0.008", "1e-90")
    text += '\n[solver]\nmethod = "midpoint"\nrtol = 2.0\n'
    told = refusal(tmp_path, text)
    assert len(told.splitlines()) == 5
    for said in ("unknown effect 'gravty'", "too small", "missing 'study'", "less than 1", "Give step (s)"):
        assert said in told


IN_EACH_PART = """
[solver]
mehtod = "chain"

[arm]
preset = "rone2012"

[effects]
bending = {}
material_damping = {}

[[cables]]
name = "far"
hole_offset = 0.008
tension = 1.0
anchor = 9

[[cables]]
name = "undriven"
hole_offset = 0.008

[[cables]]
name = "late"
hole_offset = 0.008
tension = { profile = "ramp", before = 0.0, after = 1.0, start = 1.0, end = 0.5 }

[[loads]]
disk = 7

[[payloads]]
disk = 8
mass = 1e-3

[study]
kind = "motion"
duration = -1.0
"""


def test_mistakes_of_all_parts_are_listed_in_the_order_of_the_file(tmp_path: Path) -> None:
    said = (
        " [solver]: unknown key 'mehtod'",
        ": [effects] material_damping: give retardation_time (s) or damping_ratio",
        ": cable 'far': anchor 9 is beyond the arm. Allowed: disks 1 to 4.",
        ": [[cables]] 'undriven': missing what drives it.",
        " [[cables]] number 3 tension: a ramp must end after it starts; start is 1 s, end 0.5 s",
        ": load on disk 7: beyond the arm. Allowed: disks 1 to 4.",
        ": payload on disk 8: beyond the arm. Allowed: disks 1 to 4.",
        " [study] duration: a number greater than 0 is expected",
    )
    lines = refusal(tmp_path, IN_EACH_PART).splitlines()
    assert len(lines) == len(said)
    for line, start in zip(lines, said, strict=True):
        assert line.startswith(f"{tmp_path / 'scenario.toml'}{start}")


def test_parts_that_depend_on_a_wrong_arm_are_not_listed(tmp_path: Path) -> None:
    arm = 'preset = "rone2012"\ncore_radius = 4e-4\narea = 5e-7'
    told = refusal(tmp_path, IN_EACH_PART.replace('preset = "rone2012"', arm))
    assert "[arm] core_radius already sets area" in told
    assert "beyond the arm" not in told
    assert len(told.splitlines()) == 6


def test_study_accuracy_and_solver_are_checked_beside_a_wrong_cable(tmp_path: Path) -> None:
    text = GOOD.replace("inertia = {}", "").replace("rotary_", "").replace("[study]", "anchor = 9\n[study]")
    text += '\n[accuracy]\ntip = 1e-6\n\n[solver]\nmethod = "midpoint"\n'
    told = refusal(tmp_path, text)
    assert len(told.splitlines()) == 4
    for said in ("anchor 9", "needs inertia", "damped by: material_damping", "chooses tolerances"):
        assert said in told


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "[study]",
            "anchor = 9\n[study]",
            ": cable 'upper': anchor 9 is beyond the arm. Allowed: disks 1 to 4.",
        ),
        (
            '"rone2012"',
            '"rone2012"\ncore_radius = 4e-4\narea = 5e-7',
            ": [arm] core_radius already sets area. Give one or the other.",
        ),
        (
            "[study]",
            '[[cables]]\nname = "upper"\nhole_offset = -0.008\ntension = 1.0\n[study]',
            ": 2 cables are named 'upper'. Give each its own name.",
        ),
        (
            "\ninertia = {}",
            "",
            ': a "step_response" study needs inertia. Add inertia = {} to [effects].',
        ),
        (
            "[study]",
            "[solver]\nstep = 1e-3\n[study]",
            ' [solver] step belongs to method = "midpoint"; "auto" chooses its steps by rtol and atol. Give '
            "those, or that method.",
        ),
    ],
)
def test_single_mistake_is_one_line(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert refusal(tmp_path, GOOD.replace(old, new, 1)) == f"{tmp_path / 'scenario.toml'}{said}"


def test_known_keys_of_a_table_are_listed_once(tmp_path: Path) -> None:
    told = refusal(tmp_path, GOOD.replace('preset = "rone2012"', "a1 = 1\nb2 = 1\nc3 = 1"))
    assert told.count("unknown key") == 3
    assert told.count("Known: preset,") == 1


def refusals(texts: list[str], path: Path) -> Iterator[str]:
    for text in texts:
        path.write_text(text, encoding="utf-8", errors="replace")
        try:
            load_scenario(path)
        except InputError as error:
            yield str(error)


@pytest.mark.parametrize("count", [150, pytest.param(5000, marks=pytest.mark.slow)])
def test_no_words_of_libraries_are_shown(tmp_path: Path, count: int) -> None:
    texts = [each.read_text() for each in sorted(SCENARIOS.glob("*.toml"))]
    mutants = [mutant(Random(f"words {seed}"), texts) for seed in range(count)]
    told = list(refusals(mutants, tmp_path / "scenario.toml"))
    assert len(told) > count / 3
    assert [text for text in told if LIBRARIES.search(text)] == []


@pytest.mark.parametrize("table", SYNONYMS)
def test_synonyms_lead_to_keys_and_are_none(table: str) -> None:
    everything = {*EFFECTS, *PROFILES, *STUDIES, "file", *ScenarioFile.model_fields}
    tables = (*ScenarioFile.model_fields, *(f"study.{kind}" for kind in STUDIES))
    profiles = [f"cables.tension.{profile}" for profile in PROFILES]
    keys = {key for name in (*tables, *profiles, *(f"effects.{e}" for e in EFFECTS)) for key in _known(name)}
    own = set(_known(table)) if table in {*tables} - {"study"} else set()
    for instead, words in SYNONYMS[table].items():
        assert set(re.findall(r"[a-z]+\w*", instead)) & (everything | keys)
        for word in words.split():
            assert word == word.lower()
            assert word not in own, f"{word} is a key of [{table}]"
            assert meant_by(word.upper(), table) == instead, f"{word} is listed twice for [{table}]"


@pytest.mark.parametrize("depth", [250, 400, 100_000])
def test_file_that_is_nested_too_deeply_is_refused_as_a_whole(depth: int, tmp_path: Path) -> None:
    path = tmp_path / "deep.toml"
    path.write_text(f"title = {'[' * depth}{']' * depth}\nunknown = 1\n")
    with pytest.raises(InputError, match=r"deep\.toml: nested too deeply to be a scenario\.$"):
        load_scenario(path)
