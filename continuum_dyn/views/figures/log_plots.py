"""The figure of a log: shapes, tip, energies; over time for a motion, over the drive for a ramp."""

from collections.abc import Callable, Mapping, Sequence
from itertools import cycle, pairwise
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from continuum_dyn.record import Log
from continuum_dyn.views.figures.axis_units import Axis, axis
from continuum_dyn.views.figures.backbone import backbone
from continuum_dyn.views.figures.heading import add_note, set_heading
from continuum_dyn.warnings.sampling import describe_coarse_samples
from statics.errors import InputError

ARC_POINTS = 12
LARGEST = 1e100
"""Largest size of a number that is drawn: squares of larger ones overflow."""
SHAPES = 6
"""Largest number of shapes that are drawn by default."""
QUARTERS = 4
"""Number of parts of a step response up to its first peak; shapes are drawn at their ends."""
LOOKS = ("-", "--", "-.", ":", (0, (6, 1, 1, 1, 1, 1)), (0, (8, 3)))
"""Lines that can be told apart in black and white."""
MARKERS = ("o", "s", "^", "D", "v", "x")
LIGHTEST, DARKEST = 0.7, 0.0
"""Grey of the first and of the last shape."""
FLAT = 0.25
"""Smallest ratio of the shapes' sides that is drawn to scale; else the shorter side is stretched."""
ROOM_OF_A_LINE = 0.17
"""Room for each line of the legend, in parts of the axis' range."""
APART = 0.05
"""Smallest distance of labels at the tips, in parts of the picture's height; else there is a legend."""
ENERGIES = {
    "input_work": ("-", "k"),
    "dissipated_energy": ("--", "C1"),
    "elastic_energy": ("-.", "C0"),
    "gravity_energy": ((0, (6, 1, 1, 1, 1, 1)), "C4"),
    "kinetic_energy": (":", "C2"),
}
"""Line style and colour of each energy."""


class LogSeries(NamedTuple):
    """The columns of a log that are drawn, and the ``values`` they are drawn over: time (s), or the drive."""

    columns: Mapping[str, np.ndarray]
    quantity: str
    values: np.ndarray
    rest: bool

    @property
    def axis(self) -> Axis:
        """The axis of ``values``."""
        return axis(self.quantity, self.values)

    @property
    def tip(self) -> tuple[str, np.ndarray]:
        """The coordinate of the tip that changes most, "x" or "y", and its values, m."""
        both = [(name, self.columns[f"disk_{name}"][:, -1]) for name in ("y", "x")]
        return max(both, key=lambda named: float(np.ptp(named[1])))


def picture(log: Log, parts: Sequence[str] = (), at: Sequence[float] = ()) -> Figure:
    """The figure with these of ``PARTS``, by default all; shapes at these times (s) or values of the drive.

    Raises ``InputError`` if the log holds nothing to draw, or if the values are not in it.
    """
    series = _series(log)
    _check_sizes(log, series)
    shown = [part for part in PARTS if part in parts] or _worth_drawing(series)
    figure = Figure(figsize=(7.2, 5.6 if len(shown) > 1 else 3.8), layout="constrained")
    axes: dict[str, Any] = figure.subplot_mosaic(_places(shown, series))
    for part in shown:
        PARTS[part](axes[part], log, series, at)
    set_heading(figure, log.title)
    coarse = describe_coarse_samples(log.trajectory)
    if coarse and not series.rest:
        add_note(figure, f"Samples {coarse}")
    return figure


def _check_sizes(log: Log, series: LogSeries) -> None:
    for name, values in series.columns.items():
        if np.abs(values).max(initial=0.0) > LARGEST:
            raise InputError(f"{log.path}: {name} holds numbers beyond {LARGEST:g}, which are not drawn.")


def _series(log: Log) -> LogSeries:
    if log.trajectory:
        return LogSeries(log.trajectory, "time", log.trajectory["time"], rest=False)
    if not log.equilibria:
        raise InputError(f"{log.path}: nothing was found in this run; there is nothing to draw.")
    for name in ("tension", "cable_displacement", "load_factor"):
        for values in log.equilibria.get(name, np.empty((1, 0))).T:
            if np.ptp(values) > 0.0:
                return LogSeries(log.equilibria, name, values, rest=True)
    return LogSeries(log.equilibria, "point", log.equilibria["point"], rest=True)


def _worth_drawing(series: LogSeries) -> list[str]:
    """All parts, or the shape alone of a single equilibrium."""
    return [part for part in PARTS if part == "shapes" or len(series.values) > 1]


def _places(shown: Sequence[str], series: LogSeries) -> list[Any]:
    """Shapes above the other parts, or to the left of them if they are tall."""
    others = [part for part in shown if part != "shapes"]
    if "shapes" not in shown or not others:
        return [list(shown)]
    if np.ptp(series.columns["disk_y"]) > np.ptp(series.columns["disk_x"]):
        return [["shapes", part] for part in others]
    return [["shapes"] * len(others), others]


# ---- shapes ----


def _draw_shapes(axes: Any, log: Log, series: LogSeries, at: Sequence[float]) -> None:
    rows = _rows_at(log, series, at) if at else _rows_shown(log, series)
    place = axis("disk_x", series.columns["disk_x"], "x")
    shapes = [place.per_si * backbone(series.columns, np.array([row]), ARC_POINTS)[0] for row in rows]
    greys = np.linspace(LIGHTEST, DARKEST, len(rows)) if len(rows) > 1 else [DARKEST]
    span = ARC_POINTS * (series.columns["length"].shape[1] // series.columns["disk_x"].shape[1])
    labels = _value_labels(series, rows)
    for label, shape, grey, look, marker in zip(
        labels, shapes, greys, cycle(LOOKS), cycle(MARKERS), strict=False
    ):
        style = {"color": str(grey), "marker": marker, "markevery": span, "ms": 3.5, "lw": 1.4}
        axes.plot(*shape.T, ls=look, label=label, **style)
    if _rests_at_the_end(log, series):
        final = place.per_si * backbone(log.equilibria, np.array([-1]), ARC_POINTS)[0]
        axes.plot(*final.T, color="C3", lw=2.0, ls="--", label="static equilibrium")
    width, height = np.ptp(np.concatenate(shapes), axis=0)
    stretched = "y" if height < FLAT * width else "x" if width < FLAT * height else ""
    if not stretched:
        axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel=place.label, ylabel=f"y{place.label.removeprefix('x')}")
    axes.set_title(f"Shapes ({stretched} stretched)" if stretched else "Shapes")
    _label(axes, labels, shapes, float(height))


def _rests_at_the_end(log: Log, series: LogSeries) -> bool:
    """Whether a step response has the equilibrium that it may settle to."""
    known = "time" in log.equilibria and log.equilibria["time"][-1] >= series.values[-1]
    return known and log.attributes["study"] == "step_response"


def _label(axes: Any, labels: Sequence[str], shapes: Sequence[np.ndarray], height: float) -> None:
    """Label the tips if they are apart; else add a legend."""
    tips = np.sort([shape[-1, 1] for shape in shapes])
    if len(tips) == 1:
        return
    if np.diff(tips).min() > APART * height:
        for label, shape in zip(labels, shapes, strict=True):
            axes.annotate(
                label, shape[-1], xytext=(7, 0), textcoords="offset points", fontsize=8, va="center"
            )
        axes.margins(x=0.1)
        kept = [line for line in axes.lines if line.get_label() not in labels]
        if kept:
            axes.legend(handles=kept, loc="upper left", fontsize=8)
    else:
        axes.legend(loc="best", fontsize=8, ncols=2)


def _value_labels(series: LogSeries, rows: Sequence[int]) -> list[str]:
    """Labels of these rows' values, in the unit that reads best."""
    per_si, label = axis(series.quantity, series.values[rows])
    unit = label.partition("(")[2].rstrip(")")
    values = per_si * series.values[rows]
    return [f"{value:.4g} {unit}" if unit else f"{label} {value:g}" for value in values]


def _rows_at(log: Log, series: LogSeries, at: Sequence[float]) -> list[int]:
    """The rows whose values are nearest to these."""
    least, most = float(series.values.min()), float(series.values.max())
    for value in at:
        if not least <= value <= most:
            name = series.quantity.replace("_", " ")
            raise InputError(f"{log.path}: no {name} of {value:g} in this log; it has {least:g} to {most:g}.")
    return [int(np.argmin(np.abs(series.values - value))) for value in at]


def _rows_shown(log: Log, series: LogSeries) -> list[int]:
    """Rows spread evenly; for a step response, up to its first peak."""
    if log.attributes["study"] == "step_response" and not series.rest:
        return _on_the_way_up(series.tip[1])
    return sorted({round(row) for row in np.linspace(0, len(series.values) - 1, SHAPES)})


def _on_the_way_up(tip: np.ndarray) -> list[int]:
    """Samples at which the tip has done 0, 1, ... 4 quarters of its travel to the first peak."""
    way = np.abs(tip - tip[0])
    peak = int(np.argmax(way))
    parts = np.linspace(0.0, 1.0, QUARTERS + 1)
    return sorted({int(np.argmax(way[: peak + 1] >= part * way[peak])) for part in parts})


# ---- the tip ----


def _draw_tip(axes: Any, log: Log, series: LogSeries, at: Sequence[float]) -> None:
    coordinate, tip = series.tip
    place = axis(f"disk_{coordinate}", tip, f"tip {coordinate}")
    along = series.axis
    axes.set(xlabel=along.label, ylabel=place.label, title="Tip")
    if series.rest:
        _draw_branches(axes, along.per_si * series.values, place.per_si * tip, series.columns)
        return
    axes.set_title(f"Tip: {str(log.outcome).replace('_', ' ')}")
    axes.plot(along.per_si * series.values, place.per_si * tip, "k-", lw=1.2, label="motion")
    rests = log.equilibria.get(f"disk_{coordinate}")
    if rests is not None and len(rests) > 2:
        times = along.per_si * log.equilibria["time"]
        axes.plot(times, place.per_si * rests[:, -1], "C3--", lw=1.2, label="static path")
    elif rests is not None and _rests_at_the_end(log, series):
        axes.axhline(place.per_si * rests[-1, -1], color="C3", ls="--", label="static equilibrium")
    _legend_above(axes)


def _legend_above(axes: Any) -> None:
    """Add a legend of two columns above the lines, unless there is a single line."""
    lines = -(-len(axes.lines) // 2) if len(axes.lines) > 1 else 0
    least, most = axes.get_ylim()
    axes.set_ylim(least, most + ROOM_OF_A_LINE * lines * (most - least))
    if lines:
        axes.legend(loc="upper right", ncols=2, fontsize=8)


def _draw_branches(axes: Any, drive: np.ndarray, tip: np.ndarray, points: Mapping[str, np.ndarray]) -> None:
    """Draw equilibria: solid if stable, else dashed, folds and branchings marked, jumps left open."""
    stable, critical = points["stable"].astype(bool), points["critical"]
    for start, end in pairwise(range(len(drive))):
        if not points["jumped"][end]:
            steady = (stable | (critical > 0))[[start, end]].all() and stable[[start, end]].any()
            axes.plot(drive[[start, end]], tip[[start, end]], "k-" if steady else "k--", lw=1.2)
    axes.plot(drive[stable], tip[stable], "ko", ms=4, label="stable")
    if not stable.all():
        axes.plot(drive[~stable], tip[~stable], "ko", mfc="w", ms=4, label="unstable")
    for kind, marker, label in ((1, "s", "fold"), (2, "D", "branching")):
        if (critical == kind).any():
            axes.plot(drive[critical == kind], tip[critical == kind], f"C3{marker}", ms=6, label=label)
    axes.legend(fontsize=8)


# ---- energies ----


def _draw_energies(axes: Any, log: Log, series: LogSeries, at: Sequence[float]) -> None:
    changes = {
        name: series.columns[name] - series.columns[name][0] for name in ENERGIES if name in series.columns
    }
    unit, along = axis("elastic_energy", list(changes.values()), "since the start"), series.axis
    for name, change in changes.items():
        look, color = ENERGIES[name]
        words = name.replace("_", " ")
        axes.plot(along.per_si * series.values, unit.per_si * change, ls=look, color=color, label=words)
    axes.set(xlabel=along.label, ylabel=unit.label, title="Where the work goes")
    _legend_above(axes)


Drawing = Callable[[Any, Log, LogSeries, Sequence[float]], None]
PARTS: dict[str, Drawing] = {"shapes": _draw_shapes, "tip": _draw_tip, "energies": _draw_energies}
"""The parts of a log's figure, in the order in which they stand."""
