"""What is heavy is an extra: without it the program runs, and says what is missing."""

import json
import sys
from pathlib import Path

import pytest
from conftest import SCENARIOS
from typer.testing import CliRunner

from continuum_dyn import views
from continuum_dyn.cli import app
from continuum_dyn.commands.terminal.extras import EXTRAS
from continuum_dyn.record import read_log

runner = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1"})
STILL = str(SCENARIOS / "unactuated.toml")
STEP = str(SCENARIOS / "step_response.toml")


def remove(package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make it as if a package were not installed, and the views not imported yet."""
    packages = (package, f"{package}_bindings")  # rerun's compiled core has a name of its own
    for name in [*packages, *(name for name in sys.modules if name.startswith(f"{package}."))]:
        monkeypatch.setitem(sys.modules, name, None)
    for name in [name for name in sys.modules if name.startswith("continuum_dyn.views.")]:
        monkeypatch.delitem(sys.modules, name)
        monkeypatch.delattr(views, name.rpartition(".")[2], raising=False)


def test_without_rerun_a_run_is_logged_and_says_so_in_a_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    remove("rerun", monkeypatch)
    result = runner.invoke(app, ["run", STEP, "--out", str(tmp_path)])
    assert result.exit_code == 0
    assert {path.name for path in tmp_path.iterdir()} == {"step_response.h5"}
    assert read_log(tmp_path / "step_response.h5").outcome == "settled"
    (line,) = (line for line in result.stdout.splitlines() if line.startswith("recording"))
    said = "none; rerun is not installed: pip install 'continuum-dyn[rerun]'"
    assert line.removeprefix("recording").strip() == said
    assert "continuum-dyn play" not in result.stdout


def test_without_rerun_json_has_no_recording(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    remove("rerun", monkeypatch)
    result = runner.invoke(app, ["run", STILL, "--json", "--out", str(tmp_path)])
    assert json.loads(result.stdout)["recording"] is None


@pytest.mark.parametrize(
    ("package", "words"),
    [
        ("rerun", ["play", "unactuated.h5"]),
        ("matplotlib", ["modes", STEP]),
        ("matplotlib", ["cost", STEP]),
        ("matplotlib", ["reproduce", "rone2012"]),
        ("matplotlib", ["settle", "none.h5"]),
        ("matplotlib", ["ramp", "none.h5"]),
    ],
)
def test_what_needs_an_extra_names_it_before_anything_is_computed(
    package: str, words: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    remove(package, monkeypatch)
    result = runner.invoke(app, words)
    assert result.exit_code == 2
    assert result.stderr == (
        f"error: {package} is not installed: pip install 'continuum-dyn[{EXTRAS[package]}]'\n"
    )
