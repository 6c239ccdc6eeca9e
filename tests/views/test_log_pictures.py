"""Pictures of logs made by hand: to scale, complete, and without anything empty."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from conftest import SCENARIOS
from logs_by_hand import LENGTH, motion_log, ramp_log
from matplotlib.figure import Figure

from continuum_dyn import load_scenario
from continuum_dyn.experiments.cost import Cost, Price
from continuum_dyn.record import Log
from continuum_dyn.views.figures import log_plots, plots
from continuum_dyn.views.figures.branches import branches, directions
from continuum_dyn.views.figures.heading import HEADING_LINES
from continuum_dyn.views.figures.log_layout import layout_of
from continuum_dyn.views.figures.looks import legend_labels
from continuum_dyn.views.figures.shape_plot import value_labels
from continuum_dyn.views.playback.arm import moving_parts
from continuum_dyn.views.playback.blueprint import blueprint
from continuum_dyn.views.playback.legend import is_tall
from continuum_dyn.views.playback.measures import measures_of
from continuum_dyn.views.playback.playback import playback_of
from continuum_dyn.views.playback.plots import plots_of
from continuum_dyn.views.rerun_core.layout import Container
from statics import InputError

PUSHED = """
[[loads]]
disk = 2
force = [0.0, 2.0]
moment = -0.1
"""
UP_AND_DOWN = (0.0, 1.0, 2.0, 1.0, 0.0)


def axes_of(figure: Figure, label: str) -> Any:
    """The axes with that label at their y axis."""
    return next(axes for axes in figure.axes if axes.get_ylabel() == label)


def drawn(axes: Any, part: str) -> list[np.ndarray]:
    """Points of the lines that are that part of the arm."""
    return [line.get_xydata() for line in axes.lines if line.get_gid() == part and len(line.get_xydata())]


def swinging(**columns: Any) -> Log:
    """A tip that goes up by half the arm's length."""
    heights: Any = np.linspace(0.0, 0.5 * LENGTH, 11)[:, None] * np.array([0.5, 1.0])
    return motion_log(**({"disk_y": heights} | columns))


# ---- shapes ----


def test_shapes_are_to_scale_unless_stretching_is_asked_for_and_then_it_is_said() -> None:
    (plain,) = log_plots.picture(motion_log(), ["shapes"]).axes
    (stretched,) = log_plots.picture(motion_log(), ["shapes"], stretch=True).axes
    assert plain.get_aspect() == 1.0
    assert plain.get_title(loc="left") == "Shapes"
    assert stretched.get_aspect() == "auto"
    assert "not to scale" in stretched.get_title(loc="left")


def test_disks_base_and_cables_are_drawn_where_the_log_has_them() -> None:
    (axes,) = log_plots.picture(motion_log(), ["shapes"]).axes
    (disks,), (base,), (cable,) = (drawn(axes, part) for part in ("disks", "base", "cables"))
    centres = np.nanmean(disks.reshape(2, 3, 2), axis=1)
    np.testing.assert_allclose(centres, [[20.0, 0.0], [40.0, 0.0]], atol=1e-9)
    np.testing.assert_allclose(base, [[0.0, -9.6], [0.0, 9.6]])
    np.testing.assert_allclose(cable, [[0.0, 8.0], [20.0, 8.0], [40.0, 8.0]])


def test_slack_cable_is_dotted_and_said_to_be() -> None:
    (axes,) = log_plots.picture(motion_log(tension=np.zeros((11, 1))), ["shapes"]).axes
    looks = {
        line.get_linestyle()
        for line in axes.lines
        if line.get_gid() == "cables" and np.size(line.get_xdata())
    }
    assert looks == {":"}
    assert "cable upper\n(dotted: slack)" in axes.get_legend_handles_labels()[1]


def test_loads_are_arrows_with_their_size() -> None:
    (axes,) = log_plots.picture(motion_log(loads=PUSHED), ["shapes"]).axes
    words = {text.get_text() for text in axes.texts} - {""}
    assert words == {"2 N", "0.1 N m"}
    assert sum(text.get_gid() == "loads" for text in axes.texts) == 2
    assert not log_plots.picture(motion_log(), ["shapes"]).axes[0].texts


@pytest.mark.parametrize(("box", "columns"), [((1.0, 0.2), "below"), ((0.2, 1.0), "beside")])
def test_wide_arms_stand_above_the_rest_and_tall_ones_beside_it(box: Any, columns: str) -> None:
    layout = layout_of(["shapes", "tension", "tip_x", "tip_y", "energies"], box)
    beside = all(row[0] == "shapes" for row in layout.mosaic)
    assert beside == (columns == "beside")
    assert ["tip_x", "tip_y"] in [list(dict.fromkeys(row)) for row in layout.mosaic] or beside


# ---- inputs and the tip ----


def test_inputs_are_drawn_over_time_each_kind_in_its_unit() -> None:
    base = {name: np.zeros(11) for name in ("base_x", "base_theta")}
    log = swinging(**base, base_y=np.linspace(0.0, 1e-3, 11), load_factor=np.linspace(0.0, 1.0, 11)[:, None])
    log = replace(log, arm={**log.arm, "cable_stiffness": np.ones(1)})
    log.trajectory["cable_displacement"][:, 0] = 2e-3
    figure = log_plots.picture(log, ["inputs"])
    labels = ["tension (N)", "displacement (mm)", "load factor", "base y (mm)"]
    assert [axes.get_ylabel() for axes in figure.axes] == labels
    assert {axes.get_xlabel() for axes in figure.axes} == {"time (s)"}


def test_inputs_of_a_ramp_are_drawn_over_its_points() -> None:
    (axes,) = log_plots.picture(ramp_log(UP_AND_DOWN), ["inputs"]).axes
    np.testing.assert_array_equal(np.asarray(axes.lines[0].get_ydata()), UP_AND_DOWN)
    assert axes.get_xlabel() == "point"


def test_both_coordinates_of_the_tip_are_drawn() -> None:
    figure = log_plots.picture(swinging(), ["tip"])
    np.testing.assert_allclose(axes_of(figure, "tip y (mm)").lines[0].get_ydata()[-1], 20.0)
    np.testing.assert_allclose(axes_of(figure, "tip x (mm)").lines[0].get_ydata(), 40.0)


def test_rounding_errors_do_not_fill_an_axis() -> None:
    wobbling = LENGTH * (1.0 + 1e-15 * (-1.0) ** np.arange(11))[:, None] * np.array([0.5, 1.0])
    axes = axes_of(log_plots.picture(swinging(disk_x=wobbling), ["tip"]), "tip x (mm)")
    assert np.ptp(axes.get_ylim()) > 1e-5


def test_way_up_and_way_down_of_a_ramp_are_told_apart() -> None:
    log = ramp_log(UP_AND_DOWN)
    axes = axes_of(log_plots.picture(log, ["tip"]), "tip x (mm)")
    marks = {line.get_label(): line for line in axes.lines if not line.get_label().startswith("_")}
    assert set(marks) == {"stable, rising", "stable, falling"}
    assert marks["stable, falling"].get_marker() != marks["stable, rising"].get_marker()
    np.testing.assert_array_equal(marks["stable, falling"].get_xdata(), [1.0, 0.0])
    (shapes,) = log_plots.picture(log, ["shapes"]).axes
    assert "1 N, falling" in shapes.get_legend_handles_labels()[1]


def test_ramp_that_only_rises_is_not_said_to() -> None:
    axes = log_plots.picture(ramp_log((0.0, 1.0, 2.0)), ["tip"]).axes[0]
    assert axes.get_legend_handles_labels()[1] == ["stable"]
    assert axes.get_legend() is None


def test_unstable_equilibria_are_not_said_to_fall() -> None:
    stable = np.array([True, True, False, False, True])
    log = ramp_log((0.0, 2.0, 1.5, 1.0, 3.0), stable=stable)
    found = branches(log.equilibria, log.equilibria["tension"][:, 0])
    assert not any(branch.falling for branch in found)
    series = log_plots.series_of(log)
    assert value_labels(series, [1, 2]) == ["2 N", "1.5 N, unstable"]


def test_equilibria_of_unknown_stability_are_not_called_stable() -> None:
    log = ramp_log((0.0, 1.0, 2.0))
    known = {name: values for name, values in log.equilibria.items() if name != "stable"}
    axes = log_plots.picture(replace(log, equilibria=known), ["tip"]).axes[0]
    assert axes.get_legend_handles_labels()[1] == ["equilibrium"]


def test_pause_has_the_direction_before_it() -> None:
    np.testing.assert_array_equal(directions(np.array([0.0, 0.0, 1.0, 1.0, 0.5])), [1, 1, 1, 1, -1])
    np.testing.assert_array_equal(directions(np.ones(3)), 1.0)


# ---- nothing empty, nothing that overflows ----


@pytest.mark.parametrize("log", [motion_log(), swinging(), ramp_log(UP_AND_DOWN), ramp_log((1.0,))])
def test_no_axes_are_empty(log: Log) -> None:
    for axes in log_plots.picture(log).axes:
        assert any(np.size(line.get_xdata()) for line in axes.lines)
        assert axes.get_xlabel()
        assert axes.get_ylabel()


def test_energies_that_are_zero_throughout_are_left_out() -> None:
    flat = {"elastic_energy": np.zeros(11), "kinetic_energy": np.zeros(11)}
    assert not [a for a in log_plots.picture(swinging(**flat)).axes if "energy" in a.get_ylabel()]
    with pytest.raises(InputError, match="nothing to draw of energies"):
        log_plots.picture(swinging(**flat), ["energies"])
    one = log_plots.picture(swinging(**flat | {"elastic_energy": np.linspace(0.0, 1.0, 11)}), ["energies"])
    assert [line.get_label() for line in one.axes[0].lines] == ["elastic"]


def test_long_title_takes_several_lines_within_the_figure() -> None:
    figure = log_plots.picture(replace(motion_log(), title="very long " * 80))
    lines = figure.get_suptitle().splitlines()
    assert len(lines) == HEADING_LINES
    assert max(map(len, lines)) <= 8 * figure.get_figwidth()


def test_legend_names_a_few_and_counts_the_rest() -> None:
    labels = legend_labels([f"cable number {n}" for n in range(20)])
    assert labels[4:6] == ["cable number 4", "15 more"]
    assert set(labels[6:]) == {"_"}
    assert len(labels) == 20
    assert legend_labels(["_hidden"]) == ["hidden"]


def test_dollar_signs_in_names_begin_no_formula() -> None:
    two = {"hole_offset": np.zeros((2, 3)), "anchor": np.full(2, 2), "cable_stiffness": np.zeros(2)}
    log = ramp_log((0.0, 1.0), tension=np.array([[0.0, 0.0], [1.0, 2.0]]))
    log = replace(log, cables=("$a_1$", "b"), arm=two)
    (axes,) = log_plots.picture(log, ["energies", "tip"]).axes[:1]
    assert axes.get_xlabel() == r"tension of \$a_1\$ (N)"
    (inputs,) = log_plots.picture(log, ["inputs"]).axes
    assert inputs.get_legend_handles_labels()[1] == [r"\$a_1\$", "b"]


# ---- playback ----


def test_playback_plots_lengths_in_mm_and_every_input() -> None:
    base = {"base_x": np.zeros(11), "base_y": np.linspace(0.0, 1e-3, 11), "base_theta": np.zeros(11)}
    log = swinging(**base)
    log = replace(log, arm={**log.arm, "cable_stiffness": np.ones(1)})
    log.trajectory["cable_displacement"][:, 0] = 2e-3
    playback = playback_of(log)
    assert playback is not None
    shown = plots_of(playback)
    assert shown["tip_y"].title == "tip y (mm)"
    assert shown["tip_y"].series[0].values[-1] == pytest.approx(1e3 * 0.5 * LENGTH)
    assert shown["base"].title == "base y (mm)"
    assert shown["base"].series[0].values[-1] == pytest.approx(1.0)
    assert shown["cable_displacement"].series[0].values[-1] == pytest.approx(2.0)


def test_tall_arm_has_its_own_side_of_the_view() -> None:
    down = np.tile([-0.5 * LENGTH, -LENGTH], (11, 1))
    base: dict[str, Any] = {name: np.zeros(11) for name in ("base_x", "base_y")} | {
        "base_theta": np.full(11, -np.pi / 2)
    }
    turned: dict[str, Any] = {
        "disk_x": np.zeros((11, 2)),
        "disk_y": down,
        "disk_theta": np.full((11, 2), -np.pi / 2),
    }
    for log, tall in ((motion_log(), False), (motion_log(**turned, **base), True)):
        playback = playback_of(log)
        assert playback is not None
        parts = moving_parts(playback, playback.frames, measures_of([playback]))
        assert is_tall(parts) == tall
        layout = blueprint([playback], parts, {name: [plot] for name, plot in plots_of(playback).items()})
        left = layout.root.contents[0]
        assert isinstance(left, Container)
        assert left.kind == ("horizontal" if tall else "vertical")


# ---- costs ----


def test_least_work_is_ringed_whatever_the_clock_said() -> None:
    prices = (
        Price("chain", 1e-4, error=1e-4, seconds=3.0, steps=1, segment_evaluations=100),
        Price("chain", 1e-6, error=1e-6, seconds=2.0, steps=1, segment_evaluations=300),
        Price("Radau", 1e-4, error=1e-5, seconds=0.1, steps=1, segment_evaluations=400),
    )
    scenario = load_scenario(SCENARIOS / "step_response.toml")
    found = Cost(scenario, prices, (), "no exact rod", (), 1.0, 0.0, {"RK23": 1e-3})
    figure = plots.cost(found)
    _, by_work = figure.axes  # no axes for meshes, as there are none
    rings = next(line for line in by_work.lines if line.get_label() == "least work")
    np.testing.assert_array_equal(rings.get_xdata(), [100, 300])
    assert [line.get_label() for line in by_work.lines] == ["chain", "Radau", "least work"]
    assert "RK23 at rtol 1e-03" in figure.get_supxlabel()
