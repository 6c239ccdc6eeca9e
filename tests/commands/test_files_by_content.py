"""A file is told by its first bytes: a scenario is none of the logs, and a log is no scenario."""

from pathlib import Path

import pytest
from conftest import SCENARIOS
from typer.testing import CliRunner

from continuum_dyn import load_scenario
from continuum_dyn.cli import app
from continuum_dyn.record import read_log
from continuum_dyn.views.playback import viewer
from continuum_dyn.views.playback.viewer import _why_no_window
from statics.errors import InputError, LogError

SCENARIO = (SCENARIOS / "tension_ramp.toml").read_bytes()
LOG = b"\x89HDF\r\n\x1a\n" + bytes(2000)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("arm.toml", SCENARIO, "a scenario, not a log. Run it first: continuum-dyn run"),
        ("arm.h5", SCENARIO, "a scenario, not a log. Run it first"),
        ("data.csv", b"time,tension\n0,1\n", "not a log of continuum-dyn. Logs are written by"),
        ("empty.h5", b"", "an empty file, not a log"),
        ("cut.h5", LOG, "damaged. If it is a log, run its scenario again"),
    ],
)
def test_what_is_no_log_is_named(tmp_path: Path, name: str, content: bytes, said: str) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(LogError, match=said):
        read_log(tmp_path / name)


def test_folder_is_no_log(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"a folder\. Give a log in it"):
        read_log(tmp_path)


@pytest.mark.parametrize("name", ["arm.toml", "arm.h5"])
def test_log_in_place_of_a_scenario_tells_how_to_get_its_own(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(LOG)
    with pytest.raises(InputError, match=r"--scenario > NAME\.toml"):
        load_scenario(tmp_path / name)


def test_few_neighbours_of_a_missing_file_are_named(tmp_path: Path) -> None:
    for number in range(30):
        (tmp_path / f"arm_{number}.toml").touch()
    with pytest.raises(InputError, match="Did you mean 'arm_") as caught:
        load_scenario(tmp_path / "arm_x.toml")
    assert str(caught.value).count(".toml") < 12


def test_run_takes_logs_and_scenarios_of_any_name(tmp_path: Path) -> None:
    runner = CliRunner()
    (tmp_path / "arm.txt").write_bytes(SCENARIO)
    assert runner.invoke(app, ["run", str(tmp_path / "arm.txt"), "--out", str(tmp_path)]).exit_code == 0
    (tmp_path / "arm.h5").rename(tmp_path / "arm.data")
    again = runner.invoke(app, ["run", str(tmp_path / "arm.data"), "--out", str(tmp_path)])
    assert again.exit_code == 0
    assert "same as" in again.stdout


def test_play_without_a_display_names_what_to_do_instead() -> None:
    words = "Error: winit EventLoopError: neither WAYLAND_DISPLAY nor DISPLAY is set."
    assert _why_no_window(words, 1) == "no display is available for the rerun viewer."
    assert (
        _why_no_window("no such wgpu adapter.", 1) == "the rerun viewer cannot start: no such wgpu adapter."
    )
    assert "--web" in viewer.INSTEAD
    assert "--save" in viewer.INSTEAD
