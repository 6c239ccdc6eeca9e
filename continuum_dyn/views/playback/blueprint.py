"""The layout of a playback, which is stored in its recording."""

from collections.abc import Mapping, Sequence

import numpy as np
import rerun.blueprint as rrb

from continuum_dyn.views.playback import heat_map
from continuum_dyn.views.playback.about import ending
from continuum_dyn.views.playback.colors import WHITE
from continuum_dyn.views.playback.drawing import Drawn, flip_y
from continuum_dyn.views.playback.legend import extent
from continuum_dyn.views.playback.playback import SHORTEST_PLAYBACK, Playback
from continuum_dyn.views.playback.plots import Plot, value_range

ROOM_FOR_LEGENDS = 0.3, 0.5
"""Room for the legend after the time line, in parts of it: for one run, and for several with names."""

MARGIN, ROOM_TO_GROW = 0.08, 0.4
"""Room around the arm, in parts of its larger side: for a complete log, and for one that is written."""


def blueprint(
    playbacks: Sequence[Playback],
    drawn: Mapping[str, Drawn],
    plots: Mapping[str, Sequence[Plot]],
    growing: bool = False,
) -> rrb.Blueprint:
    """The arm above its curvature and the text about it, plots beside them.

    Bounds and ranges are those of all that is shown. Of what is ``growing`` the latest moment is shown, the
    arm with room around it, and ranges are the viewer's to choose.
    """
    arm = _arm(playbacks, drawn, ROOM_TO_GROW if growing else MARGIN)
    curvature = _plot(playbacks, "curvature", plots["curvature"], growing)
    left = rrb.Vertical(
        arm, rrb.Tabs(*_heat_maps(playbacks), *_words(playbacks), curvature), row_shares=[3, 2]
    )
    others = {name: each for name, each in plots.items() if name != "curvature"}
    right = rrb.Vertical(
        *(_plot(playbacks, name, each, growing) for name, each in others.items()),
        row_shares=[*map(_height, others.values())],
    )
    duration = max(playback.duration for playback in playbacks)
    time = rrb.TimePanel(
        state="collapsed",
        timeline=playbacks[0].timeline,
        playback_speed=1.0 if growing else min(1.0, duration / SHORTEST_PLAYBACK) or 1.0,
        fps=2.0,
        play_state="following" if growing else None,
    )
    return rrb.Blueprint(
        rrb.Horizontal(left, right, column_shares=[1, 1]),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        time,
        auto_views=False,
    )


def words_alone(entity: str) -> rrb.Blueprint:
    """The layout of a run without a pose: its text alone."""
    return rrb.Blueprint(rrb.TextDocumentView(origin=entity), collapse_panels=True)


def _arm(playbacks: Sequence[Playback], drawn: Mapping[str, Drawn], room: float) -> rrb.View:
    name = (
        ending(playbacks[0].log)
        if len(playbacks) == 1
        else " and ".join(playback.name for playback in playbacks)
    )
    low, high = extent(drawn)
    margin = room * float((high - low).max())
    (left, bottom), (right, top) = flip_y(low - margin), flip_y(high + margin)
    bounds = rrb.VisualBounds2D(x_range=(left, right), y_range=(top, bottom))
    return rrb.Spatial2DView(origin="arm", name=name, background=WHITE, visual_bounds=bounds)


def _heat_maps(playbacks: Sequence[Playback]) -> list[rrb.View]:
    (left, right), (bottom, top) = heat_map.SHOWN
    bounds = rrb.VisualBounds2D(x_range=(left, right), y_range=(-top, -bottom))
    look = {"background": WHITE, "visual_bounds": bounds}
    return [
        rrb.Spatial2DView(origin=playback.at("curvature"), name=_tab(playback, "curvature over time"), **look)
        for playback in playbacks
    ]


def _words(playbacks: Sequence[Playback]) -> list[rrb.View]:
    return [
        rrb.TextDocumentView(origin=playback.at("about"), name=_tab(playback, "about"))
        for playback in playbacks
    ]


def _tab(playback: Playback, name: str) -> str:
    return f"{playback.name}: {name}" if playback.name else name


def _plot(playbacks: Sequence[Playback], name: str, each: Sequence[Plot], growing: bool) -> rrb.View:
    several = sum(len(plot.series) for plot in each) > 1
    return rrb.TimeSeriesView(
        origin=f"series/{name}",
        name=each[0].title,
        axis_x=None if growing else rrb.TimeAxis(view_range=_time_range(playbacks)),
        axis_y=None if growing else rrb.ScalarAxis(range=value_range(each)),
        plot_legend=rrb.PlotLegend(corner="RightTop", visible=several),
        background=rrb.archetypes.PlotBackground(color=WHITE, show_grid=False),
    )


def _height(each: Sequence[Plot]) -> int:
    """Share of a plot: the more series, the higher its legend."""
    return 3 + sum(len(plot.series) for plot in each)


def _time_range(playbacks: Sequence[Playback]) -> rrb.TimeRange:
    """The whole time line, and room for the legend after it."""
    # A number in a sequence is an integer for rerun, just as a count of ns is.
    unit = 1e9 if playbacks[0].moves else 1
    times = np.array([playback.times[row] for playback in playbacks for row in (0, -1)])
    first, last = round(unit * float(times.min())), round(unit * float(times.max()))
    end = last + round(ROOM_FOR_LEGENDS[len(playbacks) > 1] * (last - first))
    start, end = (rrb.TimeRangeBoundary.absolute(nanos=n) for n in (first, end))
    return rrb.TimeRange(start=start, end=end)
