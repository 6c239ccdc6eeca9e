"""The figure of a ramp: the motion on its static path, its lag, and the hysteresis loop."""

from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from continuum_dyn.answers.loops import on_both_branches
from continuum_dyn.answers.ramp import RampAnswers, TipPath
from continuum_dyn.views.figures.axis_units import Axis, axis
from continuum_dyn.views.figures.branches import directions
from continuum_dyn.views.figures.heading import set_heading
from continuum_dyn.views.figures.looks import BLUE, LETTERS, VERMILION, without_math
from statics.quantities import QUANTITIES

MARKS = 8
"""Number of marks on a line in each direction."""
MOST_POINTS = 60
"""Largest number of equilibria that are marked one by one."""
MOTION, REST = {"color": "k", "ls": "-", "lw": 1.2}, {"color": VERMILION, "ls": "--", "lw": 1.4}
"""Looks of what moves and of what rests."""


def ramp(title: str, found: RampAnswers) -> Figure:
    """The tip against the drive; if there are any, its hysteresis loop and its lag, over time and rate."""
    with rc_context(LETTERS):
        panels = {"paths": _draw_paths, "loop": _draw_loop, "lag": _draw_lag, "rates": _draw_rates}
        above = ["paths", "loop"] if found.loop is not None else ["paths"]
        below = ["lag", "rates"] if found.motion is not None else []
        size = 5.0 if len(above + below) == 1 else 8.6, 3.4 if not below else 6.4
        figure = Figure(figsize=size, layout="constrained")
        rows: list[Any] = [row * (2 // len(row)) for row in (above, below) if row]
        axes: dict[str, Any] = figure.subplot_mosaic(rows)
        for name in above + below:
            panels[name](axes[name], found)
        set_heading(figure, title)
    return figure


def _along(found: RampAnswers, path: TipPath) -> np.ndarray:
    """The tip along the straight line between its equilibria at the least and the largest drive, m."""
    ends = found.static.tip[[np.argmin(found.drive.values), np.argmax(found.drive.values)]]
    line = ends[1] - ends[0]
    return (path.tip - ends[0]) @ line / (np.hypot(*line) or 1.0)


def _drive_axis(found: RampAnswers) -> Axis:
    words = f"{found.drive.quantity.replace('_', ' ')} of {without_math(found.drive.of)}"
    return axis(found.drive.quantity, found.drive.values, words)


def _draw_paths(axes: Any, found: RampAnswers) -> None:
    drive, rest = _drive_axis(found), _along(found, found.static)
    place = axis("travel", rest, "tip along its path")
    values = drive.per_si * found.drive.values
    if found.motion is not None:
        axes.plot(values, place.per_si * _along(found, found.motion), label="motion", **MOTION)
    points = {"marker": "."} if len(rest) <= MOST_POINTS else {}
    axes.plot(values, place.per_si * rest, label="static equilibria", **REST, **points)
    _mark_directions(axes, values, place.per_si * rest, REST["color"])
    axes.set(xlabel=drive.label, ylabel=place.label)
    axes.set_title(f"Tip against {found.drive.quantity.replace('_', ' ')}")
    axes.legend()


def _mark_directions(axes: Any, drive: np.ndarray, values: np.ndarray, color: Any) -> None:
    """Mark where the drive rises, and where it falls; nothing if it only rises."""
    ways = directions(drive)
    for direction, marker, label in ((1.0, "^", "rising"), (-1.0, "v", "falling")):
        rows = np.flatnonzero(ways == direction)
        if rows.size and rows.size < len(drive):
            # Evenly along the drive, and off its ends, where both directions meet.
            places = np.linspace(drive[rows].min(), drive[rows].max(), MARKS + 2)[1:-1]
            shown = np.unique([rows[np.argmin(np.abs(drive[rows] - place))] for place in places])
            axes.plot(
                drive[shown], values[shown], ls="", marker=marker, ms=5, mfc="w", color=color, label=label
            )


def _draw_loop(axes: Any, found: RampAnswers) -> None:
    """Draw each branch of the tip less the mean of both: the loop is thin beside its length."""
    assert found.loop is not None
    drive = _drive_axis(found)
    paths = [(found.motion, "motion", MOTION)] if found.motion is not None else []
    paths.append((found.static, "static equilibria", REST))
    halves = []
    for path, _, _ in paths:
        there, back = on_both_branches(found.loop, found.drive.values, _along(found, path))
        halves.append(0.5 * (back - there))
    place = axis("travel", np.concatenate(halves), "tip from the mean")
    at = drive.per_si * np.concatenate([found.loop.drive, found.loop.drive[::-1]])
    for (_, label, look), half in zip(paths, halves, strict=True):
        around = place.per_si * np.concatenate([-half, half[::-1]])
        axes.plot(at, around, label=label, **look)
        if label == paths[0][1]:
            _mark_directions(axes, at, around, look["color"])
    axes.set(xlabel=drive.label, ylabel=place.label, title="Hysteresis: both ways about their mean")
    axes.legend()


def _draw_lag(axes: Any, found: RampAnswers) -> None:
    assert found.time is not None
    assert found.gaps is not None
    clock, lag = axis("time", found.time), axis("tip_lag", found.gaps, "lag of the tip")
    time, late = clock.per_si * found.time, found.figures["delay"] or 0.0
    speed = np.hypot(*np.gradient(found.static.tip, found.time, axis=0).T)
    axes.plot(time, lag.per_si * found.gaps, "k-", lw=0.8, label="motion")
    axes.plot(time, lag.per_si * abs(late) * speed, label=f"delay of {1e3 * late:.3g} ms", **REST)
    axes.set(xlabel=clock.label, ylabel=lag.label, title="Distance from the static path")
    axes.legend()


def _draw_rates(axes: Any, found: RampAnswers) -> None:
    """Draw the lag of each branch and run against its rate, and where a proportional one meets the error."""
    rate, within, error = (found.figures[n] for n in ("ramp_rate", "quasistatic_rate", "quasistatic_error"))
    assert rate is not None
    assert error is not None
    runs = np.array([(branch.ramp_rate, branch.tip_lag) for branch in found.lags])
    others = np.array(found.measured).reshape(-1, 2)
    lag = axis("tip_lag", [error, *others[:, 1]], "largest lag")
    if within is not None:
        ends = np.array([0.5 * min(rate, within), 2.0 * max(rate, within, *others[:, 0])])
        axes.loglog(ends, lag.per_si * error * ends / within, "-", color=BLUE, lw=1.0, label="proportional")
        axes.axvline(within, color="0.5", lw=0.8, ls=(0, (1, 2)))
    axes.loglog(*(runs * [1.0, lag.per_si]).T, "ko", mfc="w", label="ramps of this log")
    if len(others):
        axes.loglog(
            *(others * [1.0, lag.per_si]).T, "s--", color=VERMILION, ms=5, label="runs at other rates"
        )
    axes.axhline(lag.per_si * error, color="0.3", lw=1.0, ls="-.", label="requested error")
    axes.set(ylabel=lag.label, title="Lag against rate")
    words = QUANTITIES["ramp_rate"].name.replace("_", " ")
    for scale in (axes.xaxis, axes.yaxis):
        scale.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        scale.set_major_formatter("{x:g}")
        scale.set_minor_formatter(NullFormatter())
    axes.set_xlabel(f"{words} of {without_math(found.drive.of)} ({found.drive.rate_unit})")
    axes.legend()
