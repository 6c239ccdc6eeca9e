"""Recordings: where they may be written, what they leave in memory, and what the viewer sends elsewhere."""

import sys
from pathlib import Path

import pytest
from conftest import SCENARIOS, logged
from typer.testing import CliRunner

from continuum_dyn.cli import app
from continuum_dyn.record import read_log
from continuum_dyn.views.playback.recording import record_logs
from continuum_dyn.views.playback.viewer import environment

runner = CliRunner()


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return logged("step_response", tmp_path_factory.mktemp("log")).path


def test_recording_replaces_no_log_and_no_scenario(log: Path, tmp_path: Path) -> None:
    scenario, renamed = tmp_path / "arm.toml", tmp_path / "log.rrd"
    scenario.write_text("title = 'kept'")
    renamed.write_bytes(log.read_bytes())
    for path, said in ((scenario, "ends in .rrd"), (log, "ends in .rrd"), (renamed, "is no recording")):
        before = path.read_bytes()
        result = runner.invoke(app, ["play", str(log), "--save", str(path)])
        assert result.exit_code == 2
        assert said in result.output
        assert path.read_bytes() == before


def test_log_is_told_by_its_first_bytes(log: Path, tmp_path: Path) -> None:
    renamed = tmp_path / "arm.log"
    renamed.write_bytes(log.read_bytes())
    result = runner.invoke(app, ["run", str(renamed), "--out", str(tmp_path)])
    assert "same as" in result.stdout
    scenario = tmp_path / "arm.h5"
    scenario.write_bytes((SCENARIOS / "tension_ramp.toml").read_bytes())
    elsewhere = tmp_path / "logs"
    assert runner.invoke(app, ["run", str(scenario), "--out", str(elsewhere)]).exit_code == 0
    refused = runner.invoke(app, ["run", str(scenario), "--out", str(tmp_path)])
    assert refused.exit_code == 2
    assert "its log would replace it" in refused.output


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_recordings_leave_nothing_in_memory(log: Path) -> None:
    def pages() -> int:
        return int(Path("/proc/self/statm").read_text().split()[1])

    read = read_log(log)
    for _ in range(10):
        record_logs([read])
    before = pages()
    for _ in range(20):
        record_logs([read])
    assert 4096 * (pages() - before) < 20e6  # each is 1 MB, and took 6


def test_viewer_sends_no_statistics(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FORCE_RERUN_ANALYTICS", "1")
    found = environment()
    assert "FORCE_RERUN_ANALYTICS" not in found
    assert (found["CI"], found["TELEMETRY_ENABLED"]) == ("1", "false")
