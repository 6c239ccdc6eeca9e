"""``keys`` tells every key that a scenario file may have, and where a word belongs."""

import json
import tomllib
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from continuum_dyn.cli import app
from continuum_dyn.effects import EFFECTS
from continuum_dyn.scenario.profiles import PROFILES
from continuum_dyn.scenario.studies import STUDIES
from continuum_dyn.scenario_files.examples import examples
from continuum_dyn.scenario_files.keys import key_tables
from continuum_dyn.scenario_files.schema import json_schema
from continuum_dyn.scenario_files.tables import ScenarioFile


def keys(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["keys", *arguments], env={"COLUMNS": "80"})


def test_every_key_of_the_schema_and_every_effect_stands_in_a_table() -> None:
    schema = json_schema()
    tables = [schema, *schema["$defs"].values()]
    known = {
        name for table in tables for name, key in table.get("properties", {}).items() if "const" not in key
    }
    effects = {table.heading.removeprefix("[effects] ") for table in key_tables()} & set(EFFECTS)
    told = {key.name for table in key_tables() for key in table.keys}
    of_effects_and_expectations = set(EFFECTS) | {"message", "outcome"}
    assert known - told <= of_effects_and_expectations | set(schema["$defs"]["Expected"]["properties"])
    assert effects == set(EFFECTS)


def test_every_key_of_every_table_has_an_example() -> None:
    for table in key_tables():
        if table.example:
            assert list(tomllib.loads(table.example)), table.example
        for key in table.keys if table.heading != "materials" else ():
            assert tomllib.loads(key.example).keys() == {key.name}


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("study", STUDIES)
def test_examples_are_what_a_file_may_hold(study: str, profile: str) -> None:
    given: dict[str, Any] = {
        place: {key: value_of(text) for key, text in keys.items()} for place, keys in examples().items()
    }
    lists = ("cables", "loads", "payloads")
    content: dict[str, Any] = given["file"] | {place: [given[place]] for place in lists}
    content |= {place: given[place] for place in ("arm", "base", "solver", "accuracy", "expect")}
    content["effects"] = {place[8:]: table for place, table in given.items() if place.startswith("effects.")}
    content["study"] = {"kind": study} | given.get(f"study.{study}", {})
    content["base"] |= {"x": {"profile": profile} | given[f"profile.{profile}"]}
    assert ScenarioFile.model_validate_json(json.dumps(content)).study.kind == study


def value_of(text: str) -> Any:
    return tomllib.loads(f"value = {text}")["value"]


def test_all_tables_are_told_within_80_columns_each_key_with_what_it_means() -> None:
    result = keys()
    assert result.exit_code == 0
    assert max(map(len, result.stdout.splitlines())) <= 80
    lines = result.stdout.splitlines()
    assert lines[(here := lines.index("disk_spacing = 0.02")) : here + 3] == [
        "disk_spacing = 0.02",
        "    undeformed distance between neighbouring disks, along the core, m",
        "    number > 0, or list of them",
    ]
    assert all(key.meaning for table in key_tables() for key in table.keys)


@pytest.mark.parametrize(
    ("table", "told"),
    [("arm", "core_radius"), ("ramp", "path"), ("gravity", "acceleration"), ("materials", "core_material")],
)
def test_a_table_is_told_by_its_name(table: str, told: str) -> None:
    result = keys(table)
    assert result.exit_code == 0
    assert f"\n{told} = " in result.stdout
    assert "disk_inertia" not in result.stdout or table == "arm"


@pytest.mark.parametrize(
    ("name", "told"), [("armm", "Did you mean 'arm'?"), ("core_radius", "It is a key of [arm].")]
)
def test_another_word_is_refused_with_where_it_belongs(name: str, told: str) -> None:
    result = keys(name)
    assert result.exit_code == 2
    assert told in " ".join(result.stderr.split())
