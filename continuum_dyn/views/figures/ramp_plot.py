"""The figure of a ramp: the motion on its static path, its lag, and the hysteresis loop."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from continuum_dyn.answers.loops import on_both_branches
from continuum_dyn.answers.ramp import RampAnswers, TipPath
from continuum_dyn.views.figures.axis_units import Axis, axis
from continuum_dyn.views.figures.heading import set_heading
from statics.quantities import QUANTITIES

MARKS = 12
"""Number of marks on the static path."""


def ramp(title: str, found: RampAnswers) -> Figure:
    """The tip's path against the drive, the loop opened up, the lag over time and against the rate."""
    moves = found.motion is not None
    figure = Figure(figsize=(8.6, 6.4) if moves else (8.6, 3.6), layout="constrained")
    grid = figure.subplots(2 if moves else 1, 2, squeeze=False)
    _draw_paths(grid[0, 0], found)
    _draw_loop(grid[0, 1], found)
    if moves:
        _draw_lag(grid[1, 0], found)
        _draw_rates(grid[1, 1], found)
    set_heading(figure, title)
    return figure


def _along(found: RampAnswers, path: TipPath) -> np.ndarray:
    """The tip along the straight line between its equilibria at the least and the largest drive, m."""
    ends = found.static.tip[[np.argmin(found.drive.values), np.argmax(found.drive.values)]]
    line = ends[1] - ends[0]
    return (path.tip - ends[0]) @ line / (np.hypot(*line) or 1.0)


def _drive_axis(found: RampAnswers) -> Axis:
    words = f"{found.drive.quantity.replace('_', ' ')} of {found.drive.of}"
    return axis(found.drive.quantity, found.drive.values, words)


def _draw_paths(axes: Any, found: RampAnswers) -> None:
    drive, rest = _drive_axis(found), _along(found, found.static)
    place = axis("travel", rest, "tip along its branch")
    values = drive.per_si * found.drive.values
    every = max(1, len(values) // MARKS) if found.motion is not None else 1
    axes.plot(
        *(values, place.per_si * rest),
        *("C3--o",),
        lw=1.4,
        ms=4,
        mfc="w",
        markevery=every,
        label="static equilibria",
    )
    if found.motion is not None:
        axes.plot(values, place.per_si * _along(found, found.motion), "k-", lw=1.0, label="motion")
    axes.set(xlabel=drive.label, ylabel=place.label, title="TipPath")
    axes.legend(fontsize=8)


def _draw_loop(axes: Any, found: RampAnswers) -> None:
    """Draw each branch of the tip less the mean of both: the loop is thin beside its length."""
    drive = _drive_axis(found)
    axes.set(xlabel=drive.label, title="There and back")
    if found.loop is None:
        axes.text(0.5, 0.5, "no way back", ha="center", transform=axes.transAxes)
        return
    paths = [(found.static, "at rest", "C3--")]
    if found.motion is not None:
        paths.insert(0, (found.motion, "in motion", "k-"))
    halves = []
    for path, _, _ in paths:
        there, back = on_both_branches(found.loop, found.drive.values, _along(found, path))
        halves.append(0.5 * (back - there))
    place = axis("travel", np.concatenate(halves), "tip, less the mean of both ways")
    for (_, label, look), half in zip(paths, halves, strict=True):
        around = place.per_si * np.concatenate([-half, half[::-1]])
        at = drive.per_si * np.concatenate([found.loop.drive, found.loop.drive[::-1]])
        axes.plot(at, around, look, lw=1.2, label=label)
    axes.set(ylabel=place.label)
    axes.legend(fontsize=8)


def _draw_lag(axes: Any, found: RampAnswers) -> None:
    assert found.time is not None
    assert found.gaps is not None
    clock, lag = axis("time", found.time), axis("tip_lag", found.gaps, "distance from the static path")
    time, late = clock.per_si * found.time, found.figures["delay"] or 0.0
    speed = np.hypot(*np.gradient(found.static.tip, found.time, axis=0).T)
    axes.plot(time, lag.per_si * found.gaps, "k-", lw=0.8, label="motion")
    axes.plot(time, lag.per_si * abs(late) * speed, "C3--", lw=1.4, label=f"late by {1e3 * late:.3g} ms")
    axes.set(xlabel=clock.label, ylabel=lag.label, title="Lag")
    axes.legend(fontsize=8)


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
        axes.loglog(ends, lag.per_si * error * ends / within, "C0-", lw=1.0, label="proportional")
        axes.axvline(within, color="0.5", lw=0.8, ls=(0, (1, 2)))
    axes.loglog(*(runs * [1.0, lag.per_si]).T, "ko", mfc="w", label="ways of this log")
    if len(others):
        axes.loglog(*(others * [1.0, lag.per_si]).T, "C3s--", ms=5, label="runs at other rates")
    axes.axhline(lag.per_si * error, color="0.3", lw=1.0, ls="-.", label="error asked for")
    axes.set(ylabel=lag.label, title="Lag against rate")
    words = QUANTITIES["ramp_rate"].name.replace("_", " ")
    for scale in (axes.xaxis, axes.yaxis):
        scale.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        scale.set_major_formatter("{x:g}")
        scale.set_minor_formatter(NullFormatter())
    axes.set_xlabel(f"{words} of {found.drive.of} ({found.drive.rate_unit})")
    axes.legend(fontsize=8)
