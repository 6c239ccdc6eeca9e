"""Options that every command takes, before its name and after it; help, versions, completion."""

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from conftest import SCENARIOS
from typer.testing import CliRunner

from continuum_dyn.cli import COMMANDS, app

runner = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1"})
STILL = str(SCENARIOS / "unactuated.toml")
NAMES = [command.__name__ for _, command in COMMANDS]


@pytest.mark.parametrize("words", [["--quiet", "run", STILL], ["run", STILL, "-q"]])
def test_quiet_says_nothing_but_errors(words: list[str], tmp_path: Path) -> None:
    result = runner.invoke(app, [*words, "--out", str(tmp_path)])
    assert (result.exit_code, result.output) == (0, "")
    assert (tmp_path / "unactuated.h5").exists()
    result = runner.invoke(app, [*words, "--out", str(tmp_path), "--set", "arm.disk=3"])
    assert result.exit_code == 2
    assert "Did you mean 'disks'?" in result.stderr


@pytest.mark.parametrize("words", [["--quiet", "run", STILL], ["run", STILL, "-q"]])
def test_quiet_still_prints_the_json_that_is_asked_for(words: list[str], tmp_path: Path) -> None:
    result = runner.invoke(app, [*words, "--json", "--out", str(tmp_path)])
    assert json.loads(result.stdout)["outcome"] == "completed"


@pytest.mark.parametrize("words", [["--verbose", "run", STILL], ["run", STILL, "-v"]])
def test_verbose_tells_where_kernels_are_kept_and_each_stage_on_standard_error(
    words: list[str], tmp_path: Path
) -> None:
    plain = runner.invoke(app, ["run", STILL, "--json", "--out", str(tmp_path)])
    result = runner.invoke(app, [*words, "--json", "--out", str(tmp_path)])
    for told in ("kernels are kept in ", "scenarios read: ", "equilibria: ", "log written: "):
        assert told in result.stderr
    assert json.loads(result.stdout)["tip"] == json.loads(plain.stdout)["tip"]
    assert "kernels" not in plain.stderr


@pytest.mark.slow
def test_without_cache_all_is_compiled_anew_to_the_same_answer_and_nothing_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = runner.invoke(app, ["run", STILL, "--json", "--out", str(tmp_path)])
    monkeypatch.setenv("CONTINUUM_DYN_CACHE", str(tmp_path / "kernels"))
    monkeypatch.setenv("TMPDIR", str(tmp_path / "temporary"))
    (tmp_path / "temporary").mkdir()
    command = ["run", STILL, "--no-cache", "-v", "--json", "--out", str(tmp_path)]
    program = [
        sys.executable,
        "-m",
        "continuum_dyn",
        *command,
    ]  # this process has its functions
    result = subprocess.run(program, capture_output=True, text=True, check=True)
    assert json.loads(result.stdout)["tip"] == json.loads(kept.stdout)["tip"]
    assert not (tmp_path / "kernels").exists()
    assert not list((tmp_path / "temporary").iterdir())
    told = result.stderr.splitlines()
    assert any(line.startswith("  derived rest, rest_") for line in told)
    assert any(line.startswith("  compiled passes of rest: ") for line in told)
    assert any(line.startswith("  compiled newton.") for line in told)


def test_quiet_and_verbose_exclude_each_other() -> None:
    result = runner.invoke(app, ["-v", "run", "-q", STILL])
    assert result.exit_code == 2
    assert "Give one or the other" in result.stderr


def test_version_is_that_of_the_project() -> None:
    project = tomllib.loads((SCENARIOS.parent / "pyproject.toml").read_text())["project"]
    assert runner.invoke(app, ["--version"]).stdout == f"continuum-dyn {project['version']}\n"


def test_help_lists_every_command_and_the_exit_statuses() -> None:
    told = runner.invoke(app, ["--help"]).stdout
    listed = [line.split()[1] for line in told.splitlines() if line.startswith("│ ")]
    assert [name for name in listed if name in NAMES] == NAMES
    for status in ("0: answered", "1: not answered", "2: bad input", "130: interrupted"):
        assert status in told


@pytest.mark.parametrize("name", [None, *NAMES])
def test_help_fits_80_columns_and_names_no_types_of_flags(name: str | None) -> None:
    result = runner.invoke(app, [name, "--help"] if name else ["--help"])
    assert result.exit_code == 0
    assert max(map(len, result.stdout.splitlines())) <= 80
    assert "bool" not in result.stdout
    assert "list[" not in result.stdout


def test_help_and_completion_load_no_solver() -> None:
    """They take a tenth of the time that the packages of numbers take to load."""
    program = "import sys; import continuum_dyn.cli; print(*sys.modules)"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    loaded = set(result.stdout.split())
    assert "typer" in loaded
    assert not loaded & {"numpy", "scipy", "sympy", "llvmlite", "h5py", "pydantic", "matplotlib", "rerun"}


def test_a_run_loads_no_library_that_it_can_do_without(tmp_path: Path) -> None:
    """They would take longer to load than the motion takes to compute."""
    step = str(SCENARIOS / "step_response.toml")
    program = (
        "import atexit, sys\n"
        "from continuum_dyn.cli import main\n"
        "atexit.register(lambda: print(*sys.modules))\n"
        f"sys.argv[1:] = ['run', '--quiet', {step!r}, '--out', {str(tmp_path)!r}]\n"
        "main()\n"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    loaded = set(result.stdout.split())
    assert {"h5py", "rerun_bindings"} <= loaded
    assert not loaded & {"jsonschema", "matplotlib", "pandas", "rerun", "rich.progress", "sympy", "xarray"}
    assert not loaded & {"scipy.interpolate", "scipy.signal"}


def completed(*words: str) -> list[str]:
    """What bash is offered for the last of these words."""
    program = "import sys; sys.argv[0] = 'continuum-dyn'; from continuum_dyn.cli import main; main()"
    line = {"COMP_WORDS": "\n".join(("continuum-dyn", *words)), "COMP_CWORD": str(len(words))}
    environment = os.environ | line | {"_CONTINUUM_DYN_COMPLETE": "complete_bash"}
    result = subprocess.run(
        [sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True
    )
    return result.stdout.splitlines()


def test_bash_completes_commands_and_options() -> None:
    assert completed("exp") == ["explain"]
    assert {"--set", "--out", "--json", "--no-cache"} <= set(completed("run", "--"))
