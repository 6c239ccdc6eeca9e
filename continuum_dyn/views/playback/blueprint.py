"""The layout of a playback, which is stored in its recording."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from continuum_dyn.views.playback import heat_map
from continuum_dyn.views.playback.colors import WHITE
from continuum_dyn.views.playback.drawing import Drawn, flip_y
from continuum_dyn.views.playback.legend import extent, is_tall
from continuum_dyn.views.playback.playback import SHORTEST_PLAYBACK, Playback
from continuum_dyn.views.playback.plots import Plot, value_range
from continuum_dyn.views.rerun_core.layout import (
    COLLAPSED,
    FOLLOWING,
    HIDDEN,
    RIGHT_TOP,
    SOLID,
    Container,
    Layout,
    View,
)

ROOM_FOR_LEGENDS = 0.3, 0.5
"""Room for the legend after the time line, in parts of it: for one run, and for several with names."""

MARGIN, ROOM_TO_GROW = 0.08, 0.4
"""Room around the arm, in parts of its larger side: for a complete log, and for one that is written."""


def blueprint(
    playbacks: Sequence[Playback],
    drawn: Mapping[str, Drawn],
    plots: Mapping[str, Sequence[Plot]],
    growing: bool = False,
) -> Layout:
    """The arm above or, if it is tall, beside its curvature and the text about it, plots beside them.

    Bounds and ranges are those of all that is shown. Of what is ``growing`` the latest moment is shown, the
    arm with room around it, and ranges are the viewer's to choose.
    """
    arm = _arm(playbacks, drawn, ROOM_TO_GROW if growing else MARGIN)
    curvature = _plot(playbacks, "curvature", plots["curvature"], growing)
    below = Container("tabs", [*_heat_maps(playbacks), *_words(playbacks), curvature])
    left = (
        Container("horizontal", [arm, below], [2, 3])
        if is_tall(drawn)
        else Container("vertical", [arm, below], [3, 2])
    )
    others = {name: each for name, each in plots.items() if name != "curvature"}
    beside = [_plot(playbacks, name, each, growing) for name, each in others.items()]
    right = Container("vertical", beside, [*map(_height, others.values())])
    duration = max(playback.duration for playback in playbacks)
    time = {
        "timeline": [playbacks[0].timeline],
        "playback_speed": [1.0 if growing else min(1.0, duration / SHORTEST_PLAYBACK) or 1.0],
        "fps": [2.0],
        "play_state": [FOLLOWING] if growing else None,
    }
    return Layout(Container("horizontal", [left, right], [1, 1]), HIDDEN, time)


def words_alone(entity: str) -> Layout:
    """The layout of a run without a pose: its text alone."""
    return Layout(Container("tabs", [View("TextDocument", entity)]), COLLAPSED, {})


def _arm(playbacks: Sequence[Playback], drawn: Mapping[str, Drawn], room: float) -> View:
    name = (
        f"{playbacks[0].log.title}: {playbacks[0].log.outcome.replace('_', ' ')}".removeprefix(": ")
        if len(playbacks) == 1
        else " and ".join(playback.name for playback in playbacks)
    )
    low, high = extent(drawn)
    margin = room * float((high - low).max())
    (left, bottom), (right, top) = flip_y(low - margin), flip_y(high + margin)
    return View("2D", "arm", name, _plane((left, right), (top, bottom)))


def _plane(x_range: tuple[float, float], y_range: tuple[float, float]) -> dict[str, dict[str, Any]]:
    """The look of a view of a plane: these ranges, on white."""
    return {
        "Background": {"kind": [SOLID], "color": [WHITE]},
        "VisualBounds2D": {"range": {"x_range": [x_range], "y_range": [y_range]}},
    }


def _heat_maps(playbacks: Sequence[Playback]) -> list[View]:
    (left, right), (bottom, top) = heat_map.SHOWN
    look = _plane((left, right), (-top, -bottom))
    return [
        View(
            "2D",
            playback.at("curvature"),
            _tab(playback, f"curvature over {'time' if playback.moves else 'points'}"),
            look,
        )
        for playback in playbacks
    ]


def _words(playbacks: Sequence[Playback]) -> list[View]:
    return [View("TextDocument", playback.at("about"), _tab(playback, "about")) for playback in playbacks]


def _tab(playback: Playback, name: str) -> str:
    return f"{playback.name}: {name}" if playback.name else name


def _plot(playbacks: Sequence[Playback], name: str, each: Sequence[Plot], growing: bool) -> View:
    several = sum(len(plot.series) for plot in each) > 1
    ranges = {
        "TimeAxis": {"view_range": _time_range(playbacks)},
        "ScalarAxis": {"range": [value_range(each)]},
    }
    look = {
        **({} if growing else ranges),
        "PlotLegend": {"corner": [RIGHT_TOP], "visible": [several]},
        "PlotBackground": {"color": [WHITE], "show_grid": [False]},
    }
    return View("TimeSeries", f"series/{name}", each[0].title, look)


def _height(each: Sequence[Plot]) -> int:
    """Share of a plot: the more series, the higher its legend."""
    return 3 + sum(len(plot.series) for plot in each)


def _time_range(playbacks: Sequence[Playback]) -> dict[str, list[int]]:
    """The whole time line, and room for the legend after it."""
    # A number in a sequence is an integer for rerun, just as a count of ns is.
    unit = 1e9 if playbacks[0].moves else 1
    times = np.array([playback.times[row] for playback in playbacks for row in (0, -1)])
    first, last = round(unit * float(times.min())), round(unit * float(times.max()))
    end = last + round(ROOM_FOR_LEGENDS[len(playbacks) > 1] * (last - first))
    return {"start": [first], "end": [end]}
