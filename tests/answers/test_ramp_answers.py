"""What a ramp's log says, against first-order lags, the energy ledger, and runs at other rates."""

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENARIOS, edited
from typer.testing import CliRunner

from continuum_dyn import simulate
from continuum_dyn.answers.lag import delay, gap, rate_within
from continuum_dyn.answers.pace import at_pace
from continuum_dyn.answers.ramp import FIGURES, RampAnswers, ramp_answers
from continuum_dyn.answers.ramp_rates import measure_at_other_rates
from continuum_dyn.cli import app
from continuum_dyn.record import Log, read_log, write_log
from continuum_dyn.record.logged_scenario import logged_scenario
from continuum_dyn.views.figures import ramp_plot
from statics import InputError
from statics.quantities import QUANTITIES

SLOW = SCENARIOS / "slow_ramp.toml"
RETARDATION = 1.2e-3
"""Of the arm of the slow ramp, s."""
ERROR = 1e-4
"""m."""
runner = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1"})


def log_of(file: Path, folder: Path, *changes: tuple[str, str]) -> Path:
    path = folder / f"{file.stem}.h5"
    write_log(simulate(edited(file, folder, *changes)), path)
    return path


@pytest.fixture(scope="module")
def slow_log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """There to 0.4 N and half the way back, with a sample every 5 ms: nine in a period of the arm."""
    folder = tmp_path_factory.mktemp("ramp")
    (folder / "slow_ramp.csv").write_text("time,tension\n0.1,0.0\n1.1,0.4\n1.4,0.4\n1.9,0.2\n")
    return log_of(SLOW, folder, ("samples = 1001", "samples = 401"), ("duration = 10.0", "duration = 2.0"))


@pytest.fixture(scope="module")
def slow(slow_log: Path) -> RampAnswers:
    return ramp_answers(read_log(slow_log), ERROR)


# ---- closed forms ----


def test_delay_of_a_first_order_lag_is_its_time_constant() -> None:
    """T x' + x = r for a ramp r: x = r(t - T) once the start has died away."""
    time = np.linspace(0.0, 1.0, 1001)
    rest = np.column_stack([3.0 * time, -time])
    tip = rest - 0.01 * np.array([3.0, -1.0]) * (1.0 - np.exp(-time / 0.01))[:, None]
    late = time > 0.3
    assert delay(time[late], tip[late], rest[late]) == pytest.approx(0.01, rel=1e-9)
    np.testing.assert_allclose(gap(tip, rest)[late], 0.01 * np.sqrt(10.0), rtol=1e-9)
    assert delay(time, rest, np.ones_like(rest)) is None


def test_rate_within_an_error_is_read_off_a_power_law() -> None:
    rates = np.array([4.0, 1.0, 2.0, 0.5])
    lags = 1e-5 * rates**1.5
    assert rate_within(1e-5 * 3.0**1.5, rates, lags) == pytest.approx(3.0, rel=1e-12)
    assert rate_within(1e-9, rates, lags) is None
    assert rate_within(1.0, rates, lags) is None


# ---- a slow ramp ----


def test_every_figure_is_in_the_glossary(slow: RampAnswers) -> None:
    assert tuple(slow.figures) == FIGURES
    assert set(FIGURES) <= set(QUANTITIES)
    assert set(slow.missing) == {"measured_quasistatic_rate"}


def test_arm_is_late_by_the_retardation_time_of_its_core(slow: RampAnswers) -> None:
    """Kelvin-Voigt: damping over stiffness, where gravity and the cable change the stiffness little.

    On so short a ramp the swings that its corners set off do not quite average out.
    """
    assert slow.figures["delay"] == pytest.approx(RETARDATION, rel=0.06)
    assert [way.delay for way in slow.lags] == pytest.approx([RETARDATION] * 2, rel=0.08)


def test_ways_and_rates_are_those_of_the_table(slow: RampAnswers) -> None:
    assert [(way.start, way.end) for way in slow.lags] == [(0.1, 1.1), pytest.approx((1.4, 1.9))]
    assert [way.ramp_rate for way in slow.lags] == pytest.approx([0.4, 0.4], rel=1e-9)
    assert slow.figures["ramp_rate"] == pytest.approx(0.4, rel=1e-9)


def test_work_around_the_loop_is_what_the_ledger_dissipates(slow: RampAnswers, slow_log: Path) -> None:
    motion = read_log(slow_log).trajectory
    passes = np.searchsorted(motion["time"], [0.6, 1.9])  # s, both at 0.2 N
    lost = np.diff(motion["dissipated_energy"][passes])[0]
    assert slow.figures["hysteresis_area"] == pytest.approx(lost, rel=0.03)
    assert slow.figures["static_hysteresis_area"] == pytest.approx(0.0, abs=1e-3 * lost)
    assert slow.figures["static_tip_hysteresis"] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.slow
def test_lag_comes_to_the_error_at_the_rate_that_was_found_by_running(
    slow: RampAnswers, slow_log: Path
) -> None:
    scenario, error = logged_scenario(read_log(slow_log)), 3e-5
    found = measure_at_other_rates(ramp_answers(read_log(slow_log), error), scenario)
    rate = found.figures["measured_quasistatic_rate"]
    assert rate is not None
    rates, lags = np.array(found.measured).T
    np.testing.assert_allclose(lags[:2] / rates[:2], (slow.figures["tip_lag"] or 0.0) / 0.4, rtol=0.15)
    again = simulate(at_pace(scenario, rate / 0.4))
    assert again.tips is not None
    lag = gap(again.tips, np.array([point.tip[:2] for point in again.static_path])).max()
    assert lag == pytest.approx(error, rel=0.05)


@pytest.mark.slow
def test_loop_of_a_cable_that_rubs_is_what_the_ledger_dissipates(tmp_path: Path) -> None:
    log = read_log(log_of(SCENARIOS / "friction_motion.toml", tmp_path))
    motion = log.trajectory
    passes = np.searchsorted(motion["time"], [1.0, 5.0])  # s, both at 1.8 N
    lost = np.diff(motion["dissipated_energy"][passes])[0]
    found = ramp_answers(log, ERROR).figures
    assert found["hysteresis_area"] == pytest.approx(lost, rel=2e-3)
    assert found["static_hysteresis_area"] == pytest.approx(lost, rel=0.1)


# ---- what it refuses, and what is not there ----


def test_ramp_of_equilibria_has_no_lag_and_says_why(tmp_path: Path) -> None:
    found = ramp_answers(read_log(log_of(SCENARIOS / "tension_ramp.toml", tmp_path)), ERROR)
    assert found.figures["tip_lag"] is None
    assert "ramp of equilibria" in found.missing["tip_lag"]
    assert found.missing["static_hysteresis_area"] == "the input does not return"
    assert len(ramp_plot.ramp("up only", found).axes) == 1


def test_path_through_folds_is_no_way_there_and_back(tmp_path: Path) -> None:
    found = ramp_answers(read_log(log_of(SCENARIOS / "snap_through.toml", tmp_path)), ERROR)
    assert "unstable" in found.missing["static_hysteresis_area"]


def test_logs_that_ramp_nothing_are_refused(tmp_path: Path) -> None:
    step = SCENARIOS / "step_response.toml"
    few = ("samples = 1001", "samples = 11")

    def answers(*changes: tuple[str, str]) -> Log:
        return read_log(log_of(step, tmp_path, few, *changes))

    with pytest.raises(InputError, match="Add static_path = true"):
        ramp_answers(answers(), ERROR)
    path = ("samples = 11", "samples = 11\nstatic_path = true")
    with pytest.raises(InputError, match="not a log of a ramp"):
        ramp_answers(answers(path), ERROR)
    with pytest.raises(InputError, match=r"tension of upper jumps at 0.3 s.*use continuum-dyn settle"):
        ramp_answers(answers(path, ("after = 1.0", "after = 1.0, at = 0.35")), ERROR)


# ---- the command ----


def test_command_prints_figures_and_draws_them(slow_log: Path, tmp_path: Path) -> None:
    result = runner.invoke(app, ["ramp", str(slow_log), "--out", str(tmp_path)])
    assert result.exit_code == 0, result.output
    assert "1.26 ms" in result.stdout
    assert "0.1 to 1.1 s" in result.stdout
    assert max(map(len, result.stdout.splitlines()[:-1])) <= 80
    assert (tmp_path / "slow_ramp_ramp.png").stat().st_size > 10_000


def test_json_and_assertions(slow: RampAnswers, slow_log: Path, tmp_path: Path) -> None:
    asked = ["--assert", "tip_lag < 1e-4", "--assert", "measured_quasistatic_rate > 1"]
    result = runner.invoke(app, ["ramp", str(slow_log), "--json", "--out", str(tmp_path), *asked])
    assert result.exit_code == 1
    record = json.loads(result.stdout)
    assert record["tip_lag"] == slow.figures["tip_lag"]
    assert record["drive"] == {"quantity": "tension", "of": "upper", "rate_unit": "N/s"}
    assert [verdict["holds"] for verdict in record["assertions"]] == [True, False]
    assert len(record["ways"]) == 2


def test_error_that_is_no_length_is_refused(slow_log: Path) -> None:
    result = runner.invoke(app, ["ramp", str(slow_log), "--error", "0"])
    assert result.exit_code == 2
