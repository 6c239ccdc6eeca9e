"""Logs of variants stand beside each other, and nothing is replaced without a word."""

import json
from pathlib import Path

import h5py
import pytest
from conftest import SCENARIOS
from typer.testing import CliRunner

from continuum_dyn.cli import app
from continuum_dyn.commands.terminal.log_names import hold_log, named_log
from continuum_dyn.record import StreamedLog, read_log
from statics.errors import InputError, LogError

runner = CliRunner(env={"COLUMNS": "200"})
RAMP = str(SCENARIOS / "tension_ramp.toml")


def write(path: Path, scenario: str) -> None:
    with h5py.File(path, "w") as file:
        file.attrs["scenario"] = scenario


def test_variant_takes_the_first_log_that_holds_no_other_scenario(tmp_path: Path) -> None:
    path = tmp_path / "arm.h5"
    for number, scenario in (("", "one"), ("_2", "two"), ("_3", "three")):
        with hold_log(path, scenario, numbered=True) as (log, replaces):
            assert (log.path.name, replaces) == (f"arm{number}.h5", False)
            write(log.path, scenario)
    with hold_log(path, "two", numbered=True) as (log, replaces):
        assert (log.path.name, replaces) == ("arm_2.h5", False)
    (tmp_path / "arm_4.h5").write_text("no log")
    with hold_log(path, "four", numbered=True) as (log, _):
        assert log.path.name == "arm_5.h5"
    assert {each.name for each in tmp_path.iterdir()} == {f"arm{end}.h5" for end in ("", "_2", "_3", "_4")}


def test_log_that_is_being_written_is_passed_over_by_variants_alone(tmp_path: Path) -> None:
    path = tmp_path / "arm.h5"
    with StreamedLog(path):
        with hold_log(path, "one", numbered=True) as (log, _):
            assert log.path.name == "arm_2.h5"
        with pytest.raises(LogError, match="--name"), hold_log(path, "one", numbered=False):
            pass


def test_another_scenario_of_the_same_name_is_said_to_be_replaced(tmp_path: Path) -> None:
    path = tmp_path / "arm.h5"
    write(path, "one")
    for scenario, replaced in (("one", False), ("two", True)):
        with hold_log(path, scenario, numbered=False) as (log, replaces):
            assert (log.path, replaces) == (path, replaced)


@pytest.mark.parametrize("name", ["../x", "a/b", "", ".", ".hidden"])
def test_name_of_a_log_leads_nowhere_else(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="--out"):
        named_log(tmp_path, name)


def test_run_numbers_variants_and_takes_a_name(tmp_path: Path) -> None:
    asked = ["run", RAMP, "--out", str(tmp_path), "--json"]
    logs = []
    for changes in ([], ["--set", "title=other"], ["--set", "title=third", "--name", "third.h5"], []):
        told = json.loads(runner.invoke(app, [*asked, *changes]).stdout)
        assert told["replaced"] is False
        assert Path(told["recording"]) == Path(told["log"]).with_suffix(".rrd")
        logs.append(Path(told["log"]).name)
    assert logs == ["tension_ramp.h5", "tension_ramp_2.h5", "third.h5", "tension_ramp.h5"]
    assert read_log(tmp_path / "tension_ramp_2.h5").title == "other"
    shown = runner.invoke(app, ["run", RAMP, "--out", str(tmp_path), "--name", "third"])
    assert "third.h5, replaces the log of another scenario" in shown.stdout
    refused = runner.invoke(app, ["run", RAMP, str(SCENARIOS / "unactuated.toml"), "--name", "x"])
    assert refused.exit_code == 2


def test_answers_are_written_beside_their_log(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    log = str(tmp_path / "tension_ramp.h5")
    assert runner.invoke(app, ["run", RAMP, "--out", str(tmp_path)]).exit_code == 0
    for command in ("plot", "ramp"):
        assert runner.invoke(app, [command, log]).exit_code == 0
    pictures = {each.name for each in tmp_path.glob("*.png")}
    assert pictures == {"tension_ramp_plot.png", "tension_ramp_ramp.png"}
    assert not list((tmp_path / "elsewhere").iterdir())


def test_recording_replaces_recordings_alone(tmp_path: Path) -> None:
    assert runner.invoke(app, ["run", RAMP, "--out", str(tmp_path)]).exit_code == 0
    log = tmp_path / "tension_ramp.h5"
    for name, content in (("scenario.rrd", b'title = "x"'), ("log.rrd", log.read_bytes())):
        (tmp_path / name).write_bytes(content)
        refused = runner.invoke(app, ["play", str(log), "--save", str(tmp_path / name)])
        assert refused.exit_code == 2
        assert "no recording and is kept" in refused.stderr
        assert (tmp_path / name).read_bytes() == content
    assert runner.invoke(app, ["play", str(log), "--save", str(log.with_suffix(".rrd"))]).exit_code == 0
