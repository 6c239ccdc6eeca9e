"""The figure of a motion that settles."""

from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from continuum_dyn.answers.settling import BANDS, Settling
from continuum_dyn.views.figures.axis_units import Axis, axis
from continuum_dyn.views.figures.heading import set_heading
from continuum_dyn.views.figures.looks import BLUE, LETTERS, VERMILION

SHADES = ("0.90", "0.80", "0.68")
"""Greys of the bands, widest first."""
DEEPEST = 1e-5
"""Smallest distance from rest that is drawn, in parts of the travel."""
CURVE_POINTS = 2000
ENOUGH = 3.0
"""Largest time that is drawn, in longest settling times."""


def settling(title: str, found: Settling) -> Figure:
    """The tip along its travel with its bands, and its distance from rest on a logarithmic axis.

    In the latter an exponential decay is a straight line: the envelope of the fitted ring-down.
    """
    with rc_context(LETTERS):
        figure = Figure(figsize=(7.0, 6.4), layout="constrained")
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(1.2, 1.0))
        clock = axis("time", found.time, "time since the last change of the inputs")
        place = axis("travel", found.along, "tip along its travel")
        _draw_tip(above, found, clock, place)
        _draw_distance(below, found, clock, place)
        set_heading(figure, title)
    return figure


def _since(found: Settling, clock: Axis) -> np.ndarray:
    return clock.per_si * (found.time - found.change.begin)


def _draw_tip(axes: Any, found: Settling, clock: Axis, place: Axis) -> None:
    travel = place.per_si * found.travel
    for (name, band), shade, height in zip(BANDS.items(), SHADES, (0.98, 0.92, 0.86), strict=True):
        axes.axhspan(
            (1 - band) * travel, (1 + band) * travel, color=shade, lw=0, label=f"{100 * band:g} % band"
        )
        settled = found.figures[name]
        if settled is not None:
            axes.axvline(clock.per_si * settled, color="0.4", lw=0.8, ls=(0, (1, 2)))
            axes.annotate(
                f"{100 * band:g} %",
                (clock.per_si * settled, height),
                xycoords=("data", "axes fraction"),
                xytext=(3, 0),
                textcoords="offset points",
                fontsize=8,
                va="top",
            )
    axes.axhline(travel, color=VERMILION, lw=1.2, ls="--", label="static equilibrium")
    axes.plot(_since(found, clock), place.per_si * found.along, "k-", lw=1.2, label="motion")
    if found.ring_down is not None:
        time, envelope = _envelope(found)
        for side in (-1.0, 1.0):
            ends = place.per_si * (found.ring_down.rest + side * envelope)
            axes.plot(
                clock.per_si * time,
                ends,
                "-.",
                color=BLUE,
                lw=1.0,
                label="fitted envelope" if side > 0 else None,
            )
    axes.set(ylabel=place.label, xlim=(_since(found, clock)[0], clock.per_si * _until(found)))
    axes.legend(loc="lower right", ncols=2, fontsize=8)


def _until(found: Settling) -> float:
    """Time since the change began (s) at which the picture ends."""
    end, slowest = float(found.time[-1]) - found.change.begin, found.figures["settling_time_1"]
    return end if slowest is None else min(end, ENOUGH * slowest)


def _envelope(found: Settling) -> tuple[np.ndarray, np.ndarray]:
    """Times since the change began (s), and the envelope of the fitted ring-down (m)."""
    assert found.ring_down is not None
    time = np.linspace(found.ring_down.start, found.time[-1], CURVE_POINTS)
    return time - found.change.begin, np.abs(found.ring_down.envelope(time))


def _draw_distance(axes: Any, found: Settling, clock: Axis, place: Axis) -> None:
    travel = place.per_si * found.travel
    away = np.abs(place.per_si * found.along - travel)
    axes.semilogy(_since(found, clock), np.where(away > 0.0, away, np.nan), "k-", lw=1.0, label="motion")
    for (_, band), line in zip(BANDS.items(), ("--", "-.", ":"), strict=True):
        axes.axhline(band * travel, color="0.4", lw=1.0, ls=line)
        beside = {
            "xycoords": ("axes fraction", "data"),
            "textcoords": "offset points",
            "annotation_clip": False,
        }
        axes.annotate(f"{100 * band:g} %", (1.0, band * travel), (3, 0), va="center", fontsize=8, **beside)
    if found.ring_down is not None:
        time, envelope = _envelope(found)
        axes.semilogy(
            clock.per_si * time, place.per_si * envelope, "-.", color=BLUE, lw=1.4, label="fitted envelope"
        )
    least = max(DEEPEST * travel, 0.5 * float(away[away > 0.0].min(initial=travel)))
    axes.set(xlabel=clock.label, ylabel=place.label.replace("tip along its travel", "distance from rest"))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.set_ylim(least, 2.0 * float(away.max()))
    axes.legend(loc="upper right", fontsize=8)
