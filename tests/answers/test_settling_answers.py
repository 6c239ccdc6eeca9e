"""How the motion of a log settles, against its modes, its statics and closed forms."""

import json
from math import exp, pi, sqrt
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENARIOS, edited
from typer.testing import CliRunner

from continuum_dyn import Scenario, load_scenario, simulate
from continuum_dyn.answers.last_change import last_change
from continuum_dyn.answers.settling import FIGURES, Settling, settling
from continuum_dyn.cli import app
from continuum_dyn.record import read_log, write_log
from continuum_dyn.views.figures import settling_plot
from statics import InputError
from statics.quantities import QUANTITIES

STEP = SCENARIOS / "step_response.toml"
LIGHT = SCENARIOS / "step_response_light_damping.toml"
runner = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1"})


def log_of(scenario: Scenario, folder: Path) -> Path:
    path = folder / "log.h5"
    write_log(simulate(scenario), path)
    return path


def settled(scenario: Scenario, folder: Path) -> Settling:
    return settling(read_log(log_of(scenario, folder)))


@pytest.fixture(scope="module")
def step_log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return log_of(load_scenario(STEP), tmp_path_factory.mktemp("step"))


@pytest.fixture(scope="module")
def step(step_log: Path) -> Settling:
    return settling(read_log(step_log))


# ---- figures ----


def test_every_figure_is_in_the_glossary(step: Settling) -> None:
    assert tuple(step.figures) == FIGURES
    assert set(FIGURES) <= set(QUANTITIES)
    assert step.missing == {}


def test_log_with_a_spacing_for_each_disk_settles_as_that_with_one(step: Settling, tmp_path: Path) -> None:
    lists = ('preset = "rone2012"', 'preset = "rone2012"\ndisk_spacing = [0.02, 0.02, 0.02, 0.02]')
    assert settled(edited(STEP, tmp_path, lists), tmp_path).figures == step.figures


@pytest.mark.parametrize("file", [STEP, LIGHT])
def test_ring_down_is_that_of_the_lowest_mode_at_the_last_equilibrium(file: Path, tmp_path: Path) -> None:
    """Of the motion and of its linearization: the two share no formula of the fit."""
    figures = settled(load_scenario(file), tmp_path).figures
    assert figures["frequency"] == pytest.approx(figures["mode_frequency"], rel=2e-4)
    assert figures["damping_ratio"] == pytest.approx(figures["mode_damping_ratio"], rel=2e-3)
    assert figures["ring_down_misfit"] == pytest.approx(0.0, abs=2e-3)


def test_step_settles_as_its_damping_ratio_says(step: Settling) -> None:
    """Overshoot and settling time of a system of second order, which the arm nearly is: its lowest mode."""
    figures = step.figures
    ratio, speed = figures["mode_damping_ratio"], 2 * pi * (figures["mode_frequency"] or 0.0)
    assert ratio is not None
    assert figures["overshoot"] == pytest.approx(exp(-pi * ratio / sqrt(1 - ratio**2)), rel=0.06)
    half_period = pi / (speed * sqrt(1 - ratio**2))
    for percent in (5, 2, 1):
        by_envelope = -np.log(percent / 100) / (ratio * speed)
        assert figures[f"settling_time_{percent}"] == pytest.approx(by_envelope, abs=half_period)


def test_times_do_not_depend_on_when_the_step_comes(step: Settling, tmp_path: Path) -> None:
    later = settled(edited(STEP, tmp_path, ("after = 1.0", "after = 1.0, at = 0.1234")), tmp_path)
    assert later.change == (0.1234, 0.1234)
    for name in ("rise_time", "settling_time_5", "settling_time_1"):
        assert later.figures[name] == pytest.approx(step.figures[name], abs=1e-4)  # s, of samples 1e-3 apart
    assert later.figures["frequency"] == pytest.approx(step.figures["frequency"], rel=1e-4)


def test_gap_is_that_of_the_run(step_log: Path, step: Settling) -> None:
    assert step.figures["static_gap"] == read_log(step_log).attributes["static_gap"]
    assert step.along[-1] == pytest.approx(step.travel, abs=1e-7)


# ---- what is not there ----


def test_arm_that_creeps_has_no_frequency_and_says_why(tmp_path: Path) -> None:
    found = settled(edited(STEP, tmp_path, ("1.2e-3", "3e-2")), tmp_path)
    assert found.figures["frequency"] is None
    assert "without oscillating" in found.missing["damping_ratio"]
    assert found.figures["mode_damping_ratio"] == pytest.approx(2.184, abs=1e-3)
    assert found.figures["settling_time_1"] is not None
    assert settling_plot.settling("creeps", found).axes


def test_arm_that_still_rings_has_not_settled_wherever_it_passes_when_the_log_ends(tmp_path: Path) -> None:
    changes = (("duration = 1.0", "duration = 0.4246"),)
    found = settled(edited(LIGHT, tmp_path, *changes), tmp_path)
    assert abs(found.along[-1] / found.travel - 1.0) < 0.05
    assert found.figures["settling_time_5"] is None
    assert "half a period" in found.missing["settling_time_5"]


def test_samples_too_far_apart_for_the_mode_are_no_frequency(tmp_path: Path) -> None:
    """Every 43.4 ms of a swing of 43.5 ms looks like another, far slower one."""
    changes = (("samples = 1001", "samples = 93"), ("duration = 1.0", "duration = 4.0"))
    found = settled(edited(LIGHT, tmp_path, *changes), tmp_path)
    assert found.figures["frequency"] is None
    assert "Increase [study] samples" in found.missing["frequency"]
    assert found.figures["rise_time"] is None
    assert found.figures["mode_frequency"] == pytest.approx(22.987, abs=1e-3)  # Hz


def test_logs_that_settle_to_nothing_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not a log of a motion"):
        settled(load_scenario(SCENARIOS / "tension_ramp.toml"), tmp_path)
    sine = 'profile = "sine", mean = 0.0, amplitude = 0.0, frequency = 2.0'
    with pytest.raises(InputError, match="no input changes before the motion ends"):
        settled(edited(STEP, tmp_path, ('profile = "step", before = 0.0, after = 1.0', sine)), tmp_path)
    sine = 'profile = "sine", mean = 1.0, amplitude = 0.1, frequency = 2.0'
    with pytest.raises(InputError, match="inputs still change when the motion ends, at 1 s"):
        settled(edited(STEP, tmp_path, ('profile = "step", before = 0.0, after = 1.0', sine)), tmp_path)


# ---- the last change ----


@pytest.mark.parametrize(
    ("profile", "change"),
    [
        ('"step", before = 0.0, after = 1.0', (0.0, 0.0)),
        ('"step", before = 0.0, after = 1.0, at = 0.3', (0.3, 0.3)),
        ('"ramp", before = 0.0, after = 1.0, start = 0.1, end = 0.3', (0.1, 0.3)),
        ('"smooth_ramp", before = 0.0, after = 1.0, start = 0.0, end = 0.3', (0.0, 0.3)),
        ('"table", file = "staircase.csv"', (0.4, 0.6)),
    ],
)
def test_last_change_begins_and_ends_where_the_profile_does(
    profile: str, change: tuple[float, float], tmp_path: Path
) -> None:
    (tmp_path / "staircase.csv").write_text("time,tension\n.1,0\n.2,1\n.4,1\n.5,2\n.6,.5\n.7,.5\n")
    text = '"step", before = 0.0, after = 1.0'
    assert last_change(edited(STEP, tmp_path, (text, profile)), 1.0) == pytest.approx(change, abs=1e-15)


# ---- the command ----


def test_command_prints_figures_and_draws_them(step_log: Path, tmp_path: Path) -> None:
    result = runner.invoke(app, ["settle", str(step_log), "--out", str(tmp_path)])
    assert result.exit_code == 0, result.output
    assert "22.986 Hz" in result.stdout
    assert max(map(len, result.stdout.splitlines()[:-1])) <= 80
    assert (tmp_path / "log_settle.png").stat().st_size > 10_000


def test_json_has_every_figure_and_why_one_is_missing(tmp_path: Path) -> None:
    log = str(log_of(load_scenario(LIGHT), tmp_path))
    result = runner.invoke(app, ["settle", log, "--json", "--out", str(tmp_path)])
    assert result.exit_code == 0, result.output
    record = json.loads(result.stdout)
    assert set(FIGURES) < set(record)
    assert record["settling_time_2"] is None
    assert "half a period" in record["missing"]["settling_time_2"]
    assert record["frequency"] == pytest.approx(22.987, abs=1e-3)  # Hz


@pytest.mark.parametrize(
    ("asked", "status", "told"),
    [
        (["settling_time_2 < 0.8", "damping_ratio > 0.08"], 0, "yes"),
        (["settling_time_2 < 0.8", "overshoot < 0.1"], 1, "no"),
        (["setling_time_2 < 0.8"], 2, "Did you mean 'settling_time_2'?"),
    ],
)
def test_assertions_set_the_exit_status(
    asked: list[str], status: int, told: str, step_log: Path, tmp_path: Path
) -> None:
    options = [word for text in asked for word in ("--assert", text)]
    result = runner.invoke(app, ["settle", str(step_log), "--out", str(tmp_path), *options])
    assert result.exit_code == status
    assert told in result.output
