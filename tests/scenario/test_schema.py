"""The JSON schema of scenario files against the models that check them."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import Any

import pytest
from conftest import SCENARIOS
from scenario_mutants import TABLE_CHANGES
from typer.testing import CliRunner

from continuum_dyn import load_scenario
from continuum_dyn.cli import app
from continuum_dyn.scenario_files.schema import json_schema
from continuum_dyn.scenario_files.toml_text import toml_text
from statics import InputError
from statics.arm import PRESETS
from statics.quantities import QUANTITIES

jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is not installed: pip install jsonschema")

SCHEMA = json_schema()
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
GOOD = (SCENARIOS / "step_response.toml").read_text()
EVERY = sorted(SCENARIOS.rglob("*.toml"))


def complaints(content: Any) -> list[str]:
    """What the schema has against a file's content."""
    return [f"{error.json_path}: {error.message}" for error in VALIDATOR.iter_errors(content)]


def keys() -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Each key of each table: the table's name, the key, its schema."""
    for table, schema in {"": SCHEMA, **SCHEMA["$defs"]}.items():
        for name, key in schema.get("properties", {}).items():
            yield table, name, key


def test_it_is_a_schema_and_the_command_prints_it() -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    assert json.loads(CliRunner().invoke(app, ["schema"]).stdout) == SCHEMA


@pytest.mark.parametrize("path", EVERY, ids=lambda path: path.stem)
def test_every_scenario_of_the_repository_is_valid(path: Path) -> None:
    assert not complaints(tomllib.loads(path.read_text()))


def test_every_key_is_described_and_every_quantity_has_its_unit() -> None:
    for table, name, key in keys():
        assert key.get("description"), f"{table}.{name}"
    told = {(table, name): key["description"] for table, name, key in keys()}
    assert told["ArmTable", "youngs_modulus"] == "Young's modulus E of the core, Pa"
    assert told["MotionStudy", "duration"].endswith(", s")
    for (table, name), description in told.items():
        unit = QUANTITIES[name].unit if name in QUANTITIES else "1"
        assert unit == "1" or table == "EffectsTable" or unit in description, f"{table}.{name}"


def test_words_are_enumerated() -> None:
    words = {(table, name): key for table, name, key in keys()}
    assert words["ArmTable", "preset"]["enum"] == list(PRESETS)
    assert "Radau" in words["Solver", "method"]["enum"]
    assert words["RampStudy", "path"]["enum"] == ["stable", "arc_length"]
    assert words["StepResponseStudy", "kind"]["const"] == "step_response"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("gravity =", "gravty ="),
        ("[arm]", "[amr]"),
        ("before", "befor"),
        ('"step",', '"stpe",'),
        ('profile = "step",', ""),
        ('"step_response"', '"step_respose"'),
        ('"rone2012"', '"rone2021"'),
        ('"rone2012"', '"rone2012"\nsubsegments = "atuo"'),
        ("hole_offset = 0.008", ""),
        ("duration = 1.0", ""),
        ("duration = 1.0", "duration = true"),
        ("duration = 1.0", "duration = -1.0"),
        ('kind = "step_response"', ""),
        ("0.008", '"0.008"'),
        ("samples = 1001", "samples = 1001.5"),
        ("samples = 1001", "samples = 1"),
        ("[0.0, -9.81]", "[0.0, -9.81, 0.0]"),
        ('{ profile = "step", before = 0.0, after = 1.0 }', "[]"),
        ('{ profile = "step", before = 0.0, after = 1.0 }', "-1.0"),
        ("[study]", '[solver]\nmethod = "Radua"\n[study]'),
        ("[study]", "[[payloads]]\ndisk = 4\n[study]"),
        ("[study]", '[expect]\noutcome = "setled"\nsteps = { chain = 3 }\n[study]'),
    ],
)
def test_what_is_wrong_in_itself_is_not_valid(old: str, new: str) -> None:
    assert old in GOOD
    assert complaints(tomllib.loads(GOOD.replace(old, new)))


@pytest.mark.parametrize("mutants", [200, pytest.param(5000, marks=pytest.mark.slow)])
def test_what_loads_is_valid_whatever_it_is(mutants: int, tmp_path: Path) -> None:
    """So an editor never marks what would run; and of what does not load, it marks a good part."""
    rng, path = Random(3), tmp_path / "mutant.toml"
    (tmp_path / "slow_ramp.csv").write_text((SCENARIOS / "slow_ramp.csv").read_text())
    texts = [path.read_text() for path in sorted(SCENARIOS.glob("*.toml"))]
    loaded, marked, refused = 0, 0, 0
    for _ in range(mutants):
        content = tomllib.loads(rng.choice(texts))
        rng.choice(TABLE_CHANGES)(rng, content)
        path.write_text(toml_text(content))
        try:
            load_scenario(path)
        except InputError:
            refused += 1
            marked += not VALIDATOR.is_valid(content)
        else:
            loaded += 1
            assert not complaints(content), content
    assert loaded > mutants / 5
    assert marked > refused / 2
