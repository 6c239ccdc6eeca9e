"""The command line: what it prints, what it writes, and how it exits."""

import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from conftest import SCENARIOS
from typer.testing import CliRunner

from continuum_dyn.cli import app
from continuum_dyn.commands.terminal.show import wrap
from continuum_dyn.experiments import cost

runner = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1"})
STEP = str(SCENARIOS / "step_response.toml")


def command(*arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """The installed command in a process of its own."""
    program = [sys.executable, "-c", "from continuum_dyn.cli import main; main()"]
    return subprocess.run([*program, *arguments], capture_output=True, text=True, cwd=cwd, check=False)


def test_run_prints_the_gap_to_the_static_equilibrium_and_writes_both_files(tmp_path: Path) -> None:
    result = runner.invoke(app, ["run", STEP, "--out", str(tmp_path)])
    assert result.exit_code == 0
    assert "settled" in result.stdout
    assert "from the final equilibrium" in result.stdout
    assert {path.name for path in tmp_path.iterdir()} == {"step_response.h5", "step_response.rrd"}
    assert max(map(len, result.stdout.splitlines())) <= 80


def test_json_is_one_object_per_line_and_file(tmp_path: Path) -> None:
    files = [STEP, str(SCENARIOS / "tension_ramp.toml"), str(SCENARIOS / "step_response_light_damping.toml")]
    result = runner.invoke(app, ["run", *files, "--json", "--out", str(tmp_path)])
    assert result.exit_code == 0
    step, ramp, light = map(json.loads, result.stdout.splitlines())
    assert (step["outcome"], ramp["outcome"], light["outcome"]) == ("settled", "completed", "not_settled")
    x, y, theta = step["tip"]
    assert (x, y, theta) == pytest.approx((79.743e-3, 5.4826e-3, 0.14183), rel=1e-4)
    assert step["static_gap"] < 1e-6
    assert 0 < step["solve_time"] < step["wall_time"]
    assert Path(step["log"]).exists()
    assert Path(step["recording"]).exists()
    assert [point["tip"][1] > 0 for point in ramp["equilibria"]] == [False, False, False, True, True, True]


def test_ramp_prints_its_tips(tmp_path: Path) -> None:
    result = runner.invoke(app, ["run", str(SCENARIOS / "tension_ramp.toml"), "--out", str(tmp_path)])
    assert "upper (N)" in result.stdout
    assert "11.6092" in result.stdout  # mm at 2 N


def test_bad_input_exits_with_2_before_anything_is_written(tmp_path: Path) -> None:
    bad = tmp_path / "bad.toml"
    bad.write_text(Path(STEP).read_text().replace("gravity =", "gravty ="))
    result = command("run", STEP, str(bad), "--out", str(tmp_path / "out"))
    assert result.returncode == 2
    assert "Did you mean 'gravity'?" in result.stderr
    assert "Traceback" not in result.stderr
    assert not (tmp_path / "out").exists()


def test_folder_that_cannot_be_written_exits_with_2(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    result = runner.invoke(app, ["run", STEP, "--out", str(tmp_path / "file" / "logs")])
    assert result.exit_code == 2
    assert "cannot write to the folder" in result.stderr


def test_two_files_of_one_name_are_refused(tmp_path: Path) -> None:
    other = tmp_path / "step_response.toml"
    other.write_text(Path(STEP).read_text())
    result = runner.invoke(app, ["run", STEP, str(other), "--out", str(tmp_path)])
    assert result.exit_code == 2
    assert "overwrite" in result.stderr


def test_outcome_without_an_answer_exits_with_1(tmp_path: Path) -> None:
    limit = tmp_path / "limit.toml"
    limit.write_text(Path(STEP).read_text().replace("after = 1.0", "after = 50.0"))
    result = runner.invoke(app, ["run", str(limit), "--json", "--out", str(tmp_path)])
    assert result.exit_code == 1
    record = json.loads(result.stdout)
    assert record["outcome"] == "geometry_limit"
    assert "disk" in record["message"]
    assert Path(record["log"]).exists()


@pytest.fixture(scope="module")
def explained() -> str:
    """What is said of the step response."""
    result = runner.invoke(app, ["explain", STEP])
    assert result.exit_code == 0
    return result.stdout


def test_explain_shows_effects_coordinates_and_equations(explained: str) -> None:
    assert "8 coordinates: bend_angle and elongation of each segment" in explained
    for words in (
        "gravity",
        "Rone 2012, Eq. 19",
        "P = -b_1*tau_1",
        "r = sigma_0(h)*(L_0 + e - phi*r_1)",
        "Q_phi",
    ):
        assert words in explained
    assert max(map(len, explained.splitlines())) <= 80


def test_explain_says_what_each_effect_adds_and_how_the_arm_at_rest_swings(explained: str) -> None:
    lines = explained.splitlines()
    (added,) = (line.split() for line in lines if line.startswith("  extension") and " to " in line)
    _, coordinate, operated, slowest, _, fastest = added
    assert (coordinate, slowest) == ("elongation", "145")
    assert int(operated) > 100
    assert float(fastest) < 1e5  # bending alone; with extension 2.87e7 1/s
    assert "  1            23.071 Hz          0.087          79.3 ms" in lines
    assert lines[-1].endswith("--measure.")


def test_explain_of_statics_counts_operations_and_says_why_there_are_no_modes() -> None:
    result = runner.invoke(app, ["explain", str(SCENARIOS / "tension_ramp.toml")])
    assert result.exit_code == 0
    assert "No modes: modes need the effect 'inertia'" in result.stdout
    assert "all of them" in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 80


def test_explain_names_what_can_be_left_out_at_the_accuracy_asked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    measured = [
        cost.LeftOut("bending"),
        cost.LeftOut("gravity", 6e-4, 1.1, 2.87e7, -1e-4),
        cost.LeftOut("extension", 8e-7, 0.7, 3.2e4, 1e-3),
    ]
    monkeypatch.setattr(cost, "effects", lambda *_: measured)
    loose = runner.invoke(app, ["explain", STEP, "--measure"]).stdout
    assert "Can be left out: extension. Allowed: 80 um" in loose
    assert "1 ms, 30%" in loose
    tight = runner.invoke(app, ["explain", STEP.replace(".toml", "_within_1_um.toml"), "--measure"]).stdout
    assert "Can be left out: extension. Allowed: 1 um, [accuracy] tip" in tight
    assert max(map(len, loose.splitlines())) <= 80


def test_explain_measures_motions_only() -> None:
    result = runner.invoke(app, ["explain", str(SCENARIOS / "tension_ramp.toml"), "--measure"])
    assert result.exit_code == 2
    assert '"ramp"' in result.stderr


def test_explain_writes_latex() -> None:
    result = runner.invoke(app, ["explain", STEP, "--latex"])
    assert r"P = - \frac{EA \dot{e} t_{r}}{L_{0}}" in result.stdout


def test_messages_are_broken_at_words_on_a_terminal_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    message = "error: a/long/path/to/a/scenario.toml: " + "no such word. " * 9 + "\nand another --set"
    assert wrap(message) == message
    monkeypatch.setenv("COLUMNS", "30")
    monkeypatch.setattr(sys, "stderr", SimpleNamespace(isatty=lambda: True))
    lines = wrap(message).splitlines()
    assert "  a/long/path/to/a/scenario.toml:" in lines
    assert lines[-1] == "and another --set"
    assert all(len(line) <= 30 for line in lines if "/" not in line)


def test_play_refuses_what_is_not_a_log(tmp_path: Path) -> None:
    result = runner.invoke(app, ["play", str(tmp_path / "none.h5")])
    assert result.exit_code == 2
    assert "no such file" in result.stderr


def test_warm_run_imports_no_sympy_and_derives_nothing(tmp_path: Path) -> None:
    code = (
        "import sys\n"
        "from typer.testing import CliRunner\n"
        "from continuum_dyn.cli import app\n"
        f"result = CliRunner().invoke(app, ['run', {STEP!r}, '--out', {str(tmp_path)!r}])\n"
        "assert result.exit_code == 0, result.output\n"
        "assert 'statics.derivation.steps.elimination' not in sys.modules\n"
        "assert 'sympy' not in sys.modules\n"
    )
    assert runner.invoke(app, ["run", STEP, "--out", str(tmp_path)]).exit_code == 0
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
