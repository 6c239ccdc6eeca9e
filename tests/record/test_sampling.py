"""Samples too far apart for what moves are named."""

from pathlib import Path

import numpy as np
import pytest
from conftest import SCENARIOS
from logs_by_hand import motion_log
from typer.testing import CliRunner

from continuum_dyn.cli import app
from continuum_dyn.warnings.sampling import describe_coarse_samples

FREQUENCY = 7.0


@pytest.mark.parametrize(("per_period", "coarse"), [(2.5, True), (3.5, True), (4.0, False), (20.0, False)])
def test_sine_is_shown_by_more_than_three_samples_per_period(per_period: float, coarse: bool) -> None:
    samples = round(10.0 * FREQUENCY * per_period) + 1
    time = np.linspace(0.0, 10.0, samples)
    speed = 2 * np.pi * FREQUENCY
    angle, rate = np.sin(speed * time), speed * np.cos(speed * time)
    half = np.full((1, 2), 0.5)
    log = motion_log(
        samples, duration=10.0, bend_angle=angle[:, None] * half, bend_angle_rate=rate[:, None] * half
    )
    message = describe_coarse_samples(log.trajectory)
    assert bool(message) == coarse
    if coarse:
        assert f"{per_period:.2g} per period of a motion at about 7" in message
        assert "try samples = 70" in message


def test_arm_at_rest_is_shown_by_any_samples() -> None:
    log = motion_log(5, bend_angle=np.ones((5, 2)), bend_angle_rate=np.zeros((5, 2)))
    assert not describe_coarse_samples(log.trajectory)


def test_run_and_plot_warn_of_too_few_samples(tmp_path: Path) -> None:
    runner = CliRunner(env={"COLUMNS": "200"})
    scenario = str(SCENARIOS / "step_response_light_damping.toml")
    arguments = ["run", scenario, "--out", str(tmp_path), "--set"]
    few = runner.invoke(app, [*arguments, "study.samples=30"])
    assert "too few: 30 in" in few.stdout
    log = str(tmp_path / "step_response_light_damping.h5")
    plotted = runner.invoke(app, ["plot", log, "--out", str(tmp_path / "x.png")])
    assert plotted.exit_code == 0
    assert "too few: 30 in" in plotted.output
    enough = runner.invoke(app, [*arguments, "study.samples=1001"])
    assert "too few" not in enough.stdout
