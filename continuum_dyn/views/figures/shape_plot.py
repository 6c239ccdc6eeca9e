"""Shapes of the arm at some rows of a log, to scale."""

from collections.abc import Sequence
from itertools import cycle
from typing import Any

import numpy as np

from continuum_dyn.record import Log
from continuum_dyn.record.logged_scenario import logged_scenario
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.views.figures.arm_drawing import draw_cables, draw_disks, draw_loads
from continuum_dyn.views.figures.axis_units import axis
from continuum_dyn.views.figures.backbone import backbone, disk_reach, poses
from continuum_dyn.views.figures.branches import found_stable, rows_falling
from continuum_dyn.views.figures.loads import acting_loads
from continuum_dyn.views.figures.log_series import LogSeries
from continuum_dyn.views.figures.looks import MARKERS, VERMILION
from statics.errors import InputError, LogError

ARC_POINTS = 12
SHAPES = 6
"""Largest number of shapes that are drawn by default."""
QUARTERS = 4
"""Number of parts of a step response up to its first peak; shapes are drawn at their ends."""
LIGHTEST, DARKEST = 0.7, 0.0
"""Grey of the first and of the last shape."""


def rows_drawn(log: Log, series: LogSeries, at: Sequence[float]) -> list[int]:
    """Rows nearest to the values ``at``, or those that are drawn by default.

    Raises ``InputError`` for values that are not in the log.
    """
    return _rows_at(log, series, at) if at else _rows_shown(log, series)


def box(log: Log, series: LogSeries, rows: Sequence[int]) -> tuple[float, float]:
    """Width and height that the shapes take with their disks, m."""
    cores = backbone(series.columns, np.array(rows), ARC_POINTS).reshape(-1, 2)
    centre, across = poses(series.columns, np.array(rows))
    reach = disk_reach(log.arm, series.columns) * across
    ends = [cores, (centre - reach).reshape(-1, 2), (centre + reach).reshape(-1, 2)]
    width, height = np.ptp(np.concatenate(ends), axis=0)
    return float(width), float(height)


def draw_shapes(axes: Any, log: Log, series: LogSeries, rows: Sequence[int], stretch: bool) -> None:
    """Draw the arm at these rows, in full at the first and at the one farthest from it; else its core."""
    shapes = backbone(series.columns, np.array(rows), ARC_POINTS)
    place = axis("disk_x", shapes, "x")
    full = _farthest(series, rows)
    greys = np.linspace(LIGHTEST, DARKEST, len(rows)) if len(rows) > 1 else [DARKEST]
    span = ARC_POINTS * (series.columns["length"].shape[1] // series.columns["disk_x"].shape[1])
    each = zip(rows, shapes, value_labels(series, rows), greys, cycle(MARKERS), strict=False)
    for row, shape, label, grey, marker in each:
        look = {"color": str(grey), "marker": marker, "markevery": span, "ms": 4.0, "lw": 1.4}
        axes.plot(*(place.per_si * shape).T, label=label, zorder=3, **look)
        if row in full:
            draw_disks(axes, log, series.columns, row, place.per_si, str(grey))
    if rests_at_the_end(log, series):
        final = place.per_si * backbone(log.equilibria, np.array([-1]), ARC_POINTS)[0]
        axes.plot(*final.T, color=VERMILION, lw=1.6, ls="--", label="static equilibrium", zorder=3.5)
    draw_cables(axes, log, series.columns, full, place.per_si)
    loads = acting_loads(_scenario(log), series.columns, np.arange(len(series.values)))
    draw_loads(axes, loads, full[-1], place.per_si, float(series.columns["length"][0].sum()))
    if not stretch:
        axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.08)
    axes.set(xlabel=place.label, ylabel=f"y{place.label.removeprefix('x')}")
    axes.set_title("Shapes (stretched: not to scale)" if stretch else "Shapes")


def add_legend(axes: Any, below: bool) -> None:
    """Add a legend outside the axes, below or at the right, if there is more than one thing to tell apart."""
    if len(axes.get_legend_handles_labels()[1]) < 2:
        return
    if below:
        place = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0), "borderaxespad": 4.5, "ncols": 2}
    else:
        place = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.5}
    axes.legend(frameon=False, **place).set_in_layout(below)


def _scenario(log: Log) -> Scenario | None:
    try:
        return logged_scenario(log)
    except LogError:
        return None


def _farthest(series: LogSeries, rows: Sequence[int]) -> list[int]:
    """The first of the rows, and the one whose tip is farthest from it."""
    away = np.hypot(*(series.tip[list(rows)] - series.tip[rows[0]]).T)
    return sorted({rows[0], rows[int(np.argmax(away))]})


def rests_at_the_end(log: Log, series: LogSeries) -> bool:
    """Whether a step response has the equilibrium that it may settle to."""
    known = "time" in log.equilibria and log.equilibria["time"][-1] >= series.values[-1]
    return bool(known) and log.attributes["study"] == "step_response"


def value_labels(series: LogSeries, rows: Sequence[int]) -> list[str]:
    """Labels of these rows' values, in the unit that reads best; in a ramp, said if falling or unstable."""
    per_si, label = axis(series.quantity, series.values[rows])
    unit = label.partition("(")[2].rstrip(")")
    labels = [
        f"{value:.4g} {unit}" if unit else f"{label} {value:g}" for value in per_si * series.values[rows]
    ]
    if not series.rest:
        return labels
    falling, stable = rows_falling(series.columns, series.values), found_stable(series.columns)
    endings = ["" if stable[row] else ", unstable" for row in rows]
    endings = [", falling" if row in falling else end for row, end in zip(rows, endings, strict=True)]
    return [label + ending for label, ending in zip(labels, endings, strict=True)]


def _rows_at(log: Log, series: LogSeries, at: Sequence[float]) -> list[int]:
    least, most = float(series.values.min()), float(series.values.max())
    for value in at:
        if not least <= value <= most:
            name = series.quantity.replace("_", " ")
            raise InputError(f"{log.path}: no {name} of {value:g} in this log; it has {least:g} to {most:g}.")
    return [int(np.argmin(np.abs(series.values - value))) for value in at]


def _rows_shown(log: Log, series: LogSeries) -> list[int]:
    """Rows spread evenly; for a step response, up to its first peak."""
    if log.attributes["study"] == "step_response" and not series.rest:
        return _on_the_way_up(series.tip)
    return sorted({round(row) for row in np.linspace(0, len(series.values) - 1, SHAPES)})


def _on_the_way_up(tip: np.ndarray) -> list[int]:
    """Samples at which the tip has done 0, 1, ... 4 quarters of its travel to the first peak."""
    way = np.abs(tip - tip[0])[:, int(np.argmax(np.ptp(tip, axis=0)))]
    peak = int(np.argmax(way))
    parts = np.linspace(0.0, 1.0, QUARTERS + 1)
    return sorted({int(np.argmax(way[: peak + 1] >= part * way[peak])) for part in parts})
