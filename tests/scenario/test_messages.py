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
from continuum_dyn.scenario_files.messages import _known
from continuum_dyn.scenario_files.reading import load_scenario
from continuum_dyn.scenario_files.synonyms import SYNONYMS, meant_by
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
