"""The scenario that `init` writes."""

import json
import re
from pathlib import Path

from typer.testing import CliRunner

from continuum_dyn import load_scenario
from continuum_dyn.cli import app
from continuum_dyn.effects import EFFECTS
from continuum_dyn.scenario.profiles import PROFILES
from continuum_dyn.scenario.studies import STUDIES
from continuum_dyn.scenario_files.keys import key_tables
from continuum_dyn.scenario_files.shipped import SHORT_NAMES, shipped, shipped_scenario
from continuum_dyn.scenario_files.tables import NAMED_ELSEWHERE

TEMPLATE = shipped_scenario("first")
REPOSITORY = Path(__file__).parents[2]
runner = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1"})


def test_it_runs_as_it_is_written(tmp_path: Path) -> None:
    file = tmp_path / "arm.toml"
    written = runner.invoke(app, ["init", str(file)])
    assert written.exit_code == 0
    assert f"continuum-dyn run {file}" in written.stdout
    result = runner.invoke(app, ["run", str(file), "--json", "--out", str(tmp_path)])
    assert json.loads(result.stdout)["outcome"] == "settled"


def test_all_of_its_comments_together_make_a_scenario(tmp_path: Path) -> None:
    text = TEMPLATE.read_text(encoding="utf-8")
    every = re.sub(r"^# (\w+ = .*|\[.*\])$", r"\1", text, flags=re.MULTILINE)
    file = tmp_path / "arm.toml"
    file.write_text(every)
    scenario = load_scenario(file)
    assert (scenario.scene.arm.segments, scenario.scene.cables) == (32, 2)
    assert scenario.accuracy is not None
    (tmp_path / "tension.csv").write_text("time,tension\n0,0\n0.1,1\n")
    for profile in re.findall(r"^# or (tension = .*)$", text, re.MULTILINE):
        file.write_text(re.sub(r"^tension = \{.*$", profile, text, flags=re.MULTILINE))
        load_scenario(file)


def test_every_key_but_those_of_expectations_is_in_it() -> None:
    text = TEMPLATE.read_text(encoding="utf-8")
    tables = [table for table in key_tables() if table.heading not in ("[expect]", "materials")]
    assert [key.name for table in tables for key in table.keys if not mentions(text, key.name)] == []
    assert [name for name in EFFECTS if name not in NAMED_ELSEWHERE and f"{name} = {{" not in text] == []
    assert [name for name in STUDIES if f'kind = "{name}"' not in text] == []
    assert [name for name in PROFILES if f'profile = "{name}"' not in text] == []


def mentions(text: str, key: str) -> bool:
    return re.search(rf"\b{key} = |\[{key}\]", text) is not None


def test_an_existing_file_is_not_changed(tmp_path: Path) -> None:
    file = tmp_path / "arm.toml"
    file.write_text("mine")
    result = runner.invoke(app, ["init", str(file)])
    assert result.exit_code == 2
    assert "already exists and was not changed" in " ".join(result.stderr.split())
    assert file.read_text() == "mine"


def test_a_scenario_is_copied_by_its_short_name_or_its_files(tmp_path: Path) -> None:
    for number, name in enumerate(("ramp", "tension_ramp")):
        file = tmp_path / f"{number}.toml"
        assert runner.invoke(app, ["init", str(file), "--from", name]).exit_code == 0
        assert file.read_text() == (REPOSITORY / "scenarios" / "tension_ramp.toml").read_text()


def test_a_scenario_is_copied_with_the_tables_it_reads(tmp_path: Path) -> None:
    command = ["init", str(tmp_path / "mine.toml"), "--from", "slow_ramp"]
    assert runner.invoke(app, command).exit_code == 0
    assert load_scenario(tmp_path / "mine.toml").tables.keys() == {"slow_ramp.csv"}
    (tmp_path / "mine.toml").unlink()
    assert runner.invoke(app, command).exit_code == 2  # the table is there already
    assert not (tmp_path / "mine.toml").exists()


def test_all_scenarios_are_listed_and_another_name_is_refused_with_the_nearest(tmp_path: Path) -> None:
    listed = runner.invoke(app, ["init", "--list"]).stdout
    scenarios = {file.stem for file in (REPOSITORY / "scenarios").glob("*.toml")}
    assert {file.stem for file in shipped().values()} == {*scenarios, "first_scenario"}
    assert [line.split()[0] for line in listed.splitlines()] == list(shipped())
    assert {*SHORT_NAMES} <= {*shipped()}
    result = runner.invoke(app, ["init", str(tmp_path / "arm.toml"), "--from", "fricton"])
    assert result.exit_code == 2
    assert "Did you mean 'friction'?" in result.stderr


def test_only_toml_files_in_folders_that_are_there_are_written(tmp_path: Path) -> None:
    result = runner.invoke(app, ["init", str(tmp_path / "arm.txt")])
    assert result.exit_code == 2
    assert "Try arm.toml" in result.stderr
    result = runner.invoke(app, ["init", str(tmp_path / "none" / "arm.toml")])
    assert result.exit_code == 2
    assert "cannot write" in result.stderr
