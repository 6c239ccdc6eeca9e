"""The scenario that `init` writes."""

import json
import re
from pathlib import Path

from typer.testing import CliRunner

from continuum_dyn import load_scenario
from continuum_dyn.cli import app
from continuum_dyn.commands.init import TEMPLATE

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
    for profile in re.findall(r"^# or (tension = .*)$", text, re.MULTILINE):
        file.write_text(re.sub(r"^tension = \{.*$", profile, text, flags=re.MULTILINE))
        load_scenario(file)


def test_a_file_that_is_there_is_not_touched(tmp_path: Path) -> None:
    file = tmp_path / "arm.toml"
    file.write_text("mine")
    result = runner.invoke(app, ["init", str(file)])
    assert result.exit_code == 2
    assert "left as it is" in result.stderr
    assert file.read_text() == "mine"


def test_only_toml_files_in_folders_that_are_there_are_written(tmp_path: Path) -> None:
    result = runner.invoke(app, ["init", str(tmp_path / "arm.txt")])
    assert result.exit_code == 2
    assert "Try arm.toml" in result.stderr
    result = runner.invoke(app, ["init", str(tmp_path / "none" / "arm.toml")])
    assert result.exit_code == 2
    assert "cannot write" in result.stderr
