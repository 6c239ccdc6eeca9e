"""Inputs, tip and energies of a log, over time or over the drive of a ramp."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from continuum_dyn.record import Log
from continuum_dyn.views.figures.axis_units import axis
from continuum_dyn.views.figures.branches import branches, found_stable, rows_falling
from continuum_dyn.views.figures.log_series import Input, LogSeries
from continuum_dyn.views.figures.looks import (
    BLUE,
    GREEN,
    LINES,
    ORANGE,
    PURPLE,
    VERMILION,
    legend_labels,
    style,
)
from continuum_dyn.views.figures.shape_plot import rests_at_the_end

ROOM_OF_A_LINE = 0.27
"""Room for each line of the legend, in parts of the axis' range."""
SHORT = 12
"""Largest number of letters in labels of which three fit side by side."""
MOST_MARKS = 60
"""Largest number of equilibria that are marked one by one."""
SMALLEST_RANGE = 1e-6
"""Smallest range of an axis, in its largest value: what changes less is rounding."""
ENERGIES = {
    "input_work": ("-", "k"),
    "dissipated_energy": ("--", ORANGE),
    "elastic_energy": ("-.", BLUE),
    "gravity_energy": (LINES[4], PURPLE),
    "kinetic_energy": (":", GREEN),
}
"""Line style and colour of each energy."""


def draw_input(axes: Any, series: LogSeries, shown: Input) -> None:
    """Draw inputs over time, or over the number of the equilibrium."""
    name = "point" if series.rest else "time"
    values = np.stack(list(shown.lines.values()))
    along, unit = axis(name, series.columns[name]), axis(shown.quantity, values, shown.words)
    marks = {"marker": "o", "ms": 3} if series.rest and values.shape[1] <= MOST_MARKS else {}
    for number, (label, each) in enumerate(zip(legend_labels(list(shown.lines)), values, strict=True)):
        look = style(number) | marks
        axes.plot(along.per_si * series.columns[name], unit.per_si * each, lw=1.2, label=label, **look)
    axes.set(xlabel=along.label, ylabel=unit.label, title=shown.title)
    if series.rest:
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    if np.ptp(values) == 0.0:
        axes.set_ylim(*sorted((0.0, 1.3 * unit.per_si * values[0, 0])))
    _finish(axes)


def draw_tip(axes: Any, log: Log, series: LogSeries, coordinate: str) -> None:
    """Draw x or y of the tip: a motion's with that of its equilibria, or a ramp's branches."""
    tip = series.columns[f"disk_{coordinate}"][:, -1]
    place, along = axis(f"disk_{coordinate}", tip, f"tip {coordinate}"), series.axis
    axes.set(xlabel=along.label, ylabel=place.label, title=f"Tip {coordinate}")
    if series.rest:
        _draw_branches(axes, series, along.per_si * series.values, place.per_si * tip)
    else:
        axes.plot(along.per_si * series.values, place.per_si * tip, "k-", lw=1.2, label="motion")
        _draw_rests(axes, log, series, coordinate, place.per_si)
    _finish(axes)


def _draw_rests(axes: Any, log: Log, series: LogSeries, coordinate: str, per_si: float) -> None:
    """Draw the tip of a motion's static path, or of the equilibrium that it may settle to."""
    rests = log.equilibria.get(f"disk_{coordinate}", np.empty((0, 1)))[:, -1]
    look = {"color": VERMILION, "ls": "--", "lw": 1.2}
    if len(rests) > 2:
        times = series.axis.per_si * log.equilibria["time"]
        axes.plot(times, per_si * rests, label="static path", **look)
    elif rests_at_the_end(log, series):
        axes.axhline(per_si * rests[-1], label="static equilibrium", **look)


def energies_of(series: LogSeries) -> dict[str, np.ndarray]:
    """Changes of the energies since the start, J, without those that are zero throughout."""
    changes = {n: series.columns[n] - series.columns[n][0] for n in ENERGIES if n in series.columns}
    return {name: change for name, change in changes.items() if change.any()}


def draw_energies(axes: Any, series: LogSeries) -> None:
    """Draw the energies since the start; on a ramp's way back, with marks."""
    changes, along = energies_of(series), series.axis
    unit = axis("elastic_energy", list(changes.values()), "energy")
    back = rows_falling(series.columns, series.values) if series.rest else np.empty(0, dtype=int)
    for name, change in changes.items():
        look, color = ENERGIES[name]
        marks = {"marker": "v", "ms": 3.5, "markevery": back.tolist()} if back.size else {}
        values = along.per_si * series.values, unit.per_si * change
        axes.plot(*values, ls=look, color=color, lw=1.2, label=_short(name), **marks)
    axes.set(xlabel=along.label, ylabel=unit.label, title="Energies since the start")
    _finish(axes)


def _short(name: str) -> str:
    return name.replace("_", " ").removesuffix(" energy")


def _finish(axes: Any) -> None:
    """Set the range, and add a legend above the lines, unless there is a single one."""
    _keep_range(axes)
    labels = axes.get_legend_handles_labels()[1]
    if len(labels) < 2:
        return
    columns = 3 if max(map(len, labels)) <= SHORT else 2
    least, most = axes.get_ylim()
    axes.set_ylim(least, most + ROOM_OF_A_LINE * -(-len(labels) // columns) * (most - least))
    axes.legend(loc="upper right", ncols=columns, frameon=False, columnspacing=1.0, handlelength=1.8)


def _keep_range(axes: Any) -> None:
    """Keep rounding errors from being blown up, and tick labels whole."""
    least, most = axes.get_ylim()
    missing = SMALLEST_RANGE * max(abs(least), abs(most)) - (most - least)
    if missing > 0.0:
        axes.set_ylim(least - missing, most + missing)
    axes.ticklabel_format(useOffset=False)


def _draw_branches(axes: Any, series: LogSeries, drive: np.ndarray, tip: np.ndarray) -> None:
    """Draw equilibria: solid if stable, else dashed; those of a falling drive in blue; folds marked."""
    points = series.columns
    for start, end, steady, falling in branches(points, drive):
        rows = slice(start, end + 1)
        look = {"color": BLUE if falling else "k", "ls": "-" if steady else "--"}
        axes.plot(drive[rows], tip[rows], lw=1.2, **look)
    for rows, label, marker, look in _marks(points, drive):
        if rows.any():
            axes.plot(drive[rows], tip[rows], ls="", marker=marker, label=label, **look)


def _marks(
    points: Mapping[str, np.ndarray], drive: np.ndarray
) -> list[tuple[np.ndarray, str, str, dict[str, Any]]]:
    """Which equilibria are marked: their label, marker and look."""
    stable, back = found_stable(points), np.zeros(len(drive), dtype=bool)
    back[rows_falling(points, drive)] = True
    word = "stable" if "stable" in points else "equilibrium"
    rising = f"{word}, rising" if back.any() else word
    return [
        (stable & ~back, rising, "o", {"color": "k", "ms": 4}),
        (stable & back, f"{word}, falling", "v", {"color": BLUE, "ms": 5}),
        (~stable, "unstable", "o", {"color": "k", "mfc": "w", "ms": 4}),
        (points["critical"] == 1, "fold", "s", {"color": VERMILION, "ms": 6}),
        (points["critical"] == 2, "branching", "D", {"color": VERMILION, "ms": 6}),
    ]
