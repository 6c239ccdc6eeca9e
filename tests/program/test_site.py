"""The pages of docs/: generated parts are whole and current, and a site is built without a warning."""

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from continuum_dyn.cli import app
from continuum_dyn.effects import EFFECTS
from continuum_dyn.scenario_files.schema import json_schema
from statics.outcome import Outcome
from statics.quantities import QUANTITIES

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def reference() -> Any:
    """The module that writes the generated parts."""
    sys.path.insert(0, str(DOCS))
    try:
        import generated_reference  # pyright: ignore[reportMissingImports]
    finally:
        sys.path.remove(str(DOCS))
    return generated_reference


@pytest.fixture(scope="module")
def parts(reference: Any) -> dict[str, str]:
    """What the program tells of itself, in Markdown, by part."""
    return {name: part() for name, part in reference.PARTS.items()}


def headings(text: str) -> list[str]:
    return re.findall(r"^#+ (.*)$", text, flags=re.MULTILINE)


PAGES = sorted((DOCS / "reference").glob("*.md"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_generated_parts_of_a_page_are_current(page: Path, reference: Any) -> None:
    text = page.read_text(encoding="utf-8")
    assert reference.renewed(text) == text, "the page is stale: make reference"


def test_every_part_is_on_a_page(parts: dict[str, str]) -> None:
    pages = "".join(page.read_text(encoding="utf-8") for page in PAGES)
    assert set(re.findall(r"^<!-- generated: (\w+) -->$", pages, flags=re.MULTILINE)) == set(parts)


def test_public_names_are_in_the_reference_with_their_docstrings(parts: dict[str, str]) -> None:
    assert "The answer to a scenario." in parts["python_names"]  # the docstring of Run
    assert "- `preset(name, **changes)`: An arm from the literature;" in parts["python_names"]


def test_reference_has_every_command_with_its_options(parts: dict[str, str]) -> None:
    text = parts["commands"]
    assert {command.callback.__name__ for command in app.registered_commands if command.callback} <= set(
        headings(text)
    )
    for option in ("--set", "--assert", "--save", "--quiet", "--version"):
        assert f"| `{option}`" in text


def test_reference_has_every_key_of_every_table_with_its_meaning(parts: dict[str, str]) -> None:
    schema = json_schema()
    rows = dict(re.findall(r"^\| `(\w+)` \|.*\| (.*) \| .* \|$", parts["scenario_keys"], flags=re.MULTILINE))
    for table in (schema, *schema["$defs"].values()):
        for name, key in keys_of(table):
            if name not in EFFECTS:
                assert rows.get(name), f"{name} {key}"


def keys_of(table: dict[str, Any]) -> list[tuple[str, Any]]:
    return [(name, key) for name, key in table.get("properties", {}).items() if "const" not in key]


def test_reference_has_every_effect_and_where_it_is_from(parts: dict[str, str]) -> None:
    found = set(headings(parts["scenario_keys"]))
    for name, effect in EFFECTS.items():
        assert f"`{name}`" in found
        assert effect.source in parts["scenario_keys"]


def test_reference_has_every_outcome_and_quantity(parts: dict[str, str]) -> None:
    assert all(f"| `{outcome}` | {outcome.exit_status} |" in parts["exit_statuses"] for outcome in Outcome)
    assert all(f"| `{name}` |" in parts["glossary"] for name in QUANTITIES)


@pytest.mark.slow
def test_site_is_built_without_a_warning(tmp_path: Path) -> None:
    options = ["-W", "--keep-going", "-q", "-d", str(tmp_path / "doctrees")]
    command = [sys.executable, "-m", "sphinx", *options, str(DOCS), str(tmp_path / "site")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    page = (tmp_path / "site" / "reference" / "python.html").read_text(encoding="utf-8")
    assert "The answer to a scenario." in page  # the docstring of Run
