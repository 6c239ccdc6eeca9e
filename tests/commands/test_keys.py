"""``keys`` tells every key that a scenario file may have, and where a word belongs."""

import pytest
from typer.testing import CliRunner, Result

from continuum_dyn.cli import app
from continuum_dyn.effects import EFFECTS
from continuum_dyn.scenario_files.keys import key_tables
from continuum_dyn.scenario_files.schema import json_schema


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


@pytest.mark.parametrize(
    ("table", "told"), [("arm", "core_radius"), ("ramp", "path"), ("gravity", "acceleration")]
)
def test_a_table_is_told_within_80_columns(table: str, told: str) -> None:
    result = keys(table)
    assert result.exit_code == 0
    assert told in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 80


@pytest.mark.parametrize(
    ("name", "told"), [("armm", "Did you mean 'arm'?"), ("core_radius", "It is a key of [arm].")]
)
def test_another_word_is_refused_with_where_it_belongs(name: str, told: str) -> None:
    result = keys(name)
    assert result.exit_code == 2
    assert told in " ".join(result.stderr.split())
