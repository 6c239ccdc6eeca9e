"""Figures of logs: what is drawn where, its units, and that it can be told apart in black and white."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import logged
from typer.testing import CliRunner

from continuum_dyn.cli import app
from continuum_dyn.record import Log
from continuum_dyn.views.figures import log_plots
from continuum_dyn.views.figures.axis_units import axis
from statics import InputError

runner = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1"})


@pytest.fixture(scope="module")
def step(tmp_path_factory: pytest.TempPathFactory) -> Log:
    return logged("step_response", tmp_path_factory.mktemp("step"))


@pytest.fixture(scope="module")
def ramp(tmp_path_factory: pytest.TempPathFactory) -> Log:
    return logged("tension_ramp", tmp_path_factory.mktemp("ramp"))


def test_motion_is_drawn_over_time_with_units_on_every_axis(step: Log) -> None:
    drawn_axes = log_plots.picture(step).axes
    labels = {(axes.get_xlabel(), axes.get_ylabel()) for axes in drawn_axes}
    assert labels == {
        ("x (mm)", "y (mm)"),
        ("time (s)", "tension (N)"),
        ("time (s)", "tip x (mm)"),
        ("time (s)", "tip y (mm)"),
        ("time (s)", "energy (mJ)"),
    }
    tip = next(axes for axes in drawn_axes if axes.get_ylabel() == "tip y (mm)")
    drawn = np.asarray(tip.lines[0].get_ydata())
    np.testing.assert_allclose(drawn, 1e3 * step.trajectory["disk_y"][:, -1], rtol=1e-12)


def test_ramp_is_drawn_over_what_is_ramped(ramp: Log) -> None:
    (shapes,) = log_plots.picture(ramp, ["shapes"]).axes
    assert log_plots.picture(ramp, ["tip"]).axes[0].get_xlabel() == "tension (N)"
    lines: list[Any]
    lines, labels = shapes.get_legend_handles_labels()
    assert labels[:6] == ["0 N", "0.05 N", "0.1 N", "0.5 N", "1 N", "2 N"]
    ends = np.array([line.get_xydata()[-1] for line in lines[:6]])
    np.testing.assert_allclose(ends[:, 1], 1e3 * ramp.equilibria["disk_y"][:, -1], atol=1e-9)


@pytest.mark.parametrize("part", ["shapes", "energies"])
def test_no_two_lines_of_a_part_look_the_same_in_black_and_white(part: str, step: Log, ramp: Log) -> None:
    for log in (step, ramp):
        (axes,) = log_plots.picture(log, [part]).axes
        lines: list[Any] = axes.get_legend_handles_labels()[0]
        looks = {(str(line._dash_pattern), str(line.get_marker()), line.get_linewidth()) for line in lines}
        assert len(looks) == len(lines) > 1


def test_shapes_are_those_at_the_times_asked_for(step: Log) -> None:
    (axes,) = log_plots.picture(step, ["shapes"], [0.0, 0.05]).axes
    place = step.trajectory["disk_y"][50, -1]
    (shape,) = (line for line in axes.lines if line.get_label() == "50 ms")
    assert np.asarray(shape.get_xydata())[-1, 1] == pytest.approx(1e3 * place, rel=1e-9)
    with pytest.raises(InputError, match="no time of 2 in this log; it has 0 to 1"):
        log_plots.picture(step, ["shapes"], [2.0])


def test_single_equilibrium_is_its_shape_alone(tmp_path: Path) -> None:
    assert len(log_plots.picture(logged("unactuated", tmp_path)).axes) == 1


def test_axes_are_in_the_unit_that_reads_best() -> None:
    assert axis("disk_y", [0.0, -4e-5], "tip y") == (pytest.approx(1e6), "tip y (um)")
    assert axis("time", [0.0, 1.0]) == (1.0, "time (s)")
    assert axis("disk_theta", [1e-4]) == (1.0, "disk theta (rad)")
    assert axis("overshoot", [0.1]) == (1.0, "overshoot")
    assert axis("tension", [0.0]) == (1.0, "tension (N)")


@pytest.mark.parametrize(("suffix", "magic"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("PDF", b"%PDF")])
def test_command_writes_what_the_suffix_says(suffix: str, magic: bytes, ramp: Log, tmp_path: Path) -> None:
    picture = tmp_path / "figures" / f"ramp.{suffix}"
    result = runner.invoke(app, ["plot", str(ramp.path), "tip", "--out", str(picture)])
    assert result.exit_code == 0, result.output
    assert picture.read_bytes().startswith(magic)


def test_picture_that_cannot_be_written_is_told_without_a_traceback(ramp: Log, tmp_path: Path) -> None:
    (tmp_path / "taken.png").mkdir()
    result = runner.invoke(app, ["plot", str(ramp.path), "--out", str(tmp_path / "taken.png")])
    assert result.exit_code == 2
    assert "cannot write" in result.output
    assert "Is a directory" in result.output


def test_command_names_what_it_knows(ramp: Log) -> None:
    result = runner.invoke(app, ["plot", str(ramp.path), "shape"])
    assert result.exit_code == 2
    assert "Did you mean 'shapes'?" in result.output
    result = runner.invoke(app, ["plot", str(ramp.path), "--out", "ramp.jpg"])
    assert result.exit_code == 2
    assert ".png, .svg, .pdf" in result.output
