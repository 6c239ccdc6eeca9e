"""The layout of a playback, which is stored in its recording."""

from collections.abc import Mapping, Sequence

import numpy as np
import rerun.blueprint as rrb

from continuum_dyn.views.playback import heat_map
from continuum_dyn.views.playback.about import ending
from continuum_dyn.views.playback.colors import WHITE
from continuum_dyn.views.playback.drawing import Drawn, on_screen
from continuum_dyn.views.playback.legend import extent
from continuum_dyn.views.playback.plots import Plot, value_range
from continuum_dyn.views.playback.story import SHORTEST_PLAYBACK, Story

ROOM_FOR_LEGENDS = 0.3, 0.5
"""Of the time line, after it: for one run, and for several, whose names stand in it."""

MARGIN, ROOM_TO_GROW = 0.08, 0.4
"""Around the arm, in its larger side: where all that it will do is known, and where not."""


def blueprint(
    stories: Sequence[Story],
    drawn: Mapping[str, Drawn],
    plots: Mapping[str, Sequence[Plot]],
    growing: bool = False,
) -> rrb.Blueprint:
    """The arm above its curvature and what is said of it, plots beside them.

    Bounds and ranges are those of all that is shown. Of what is ``growing`` the latest moment is shown, the
    arm with room around it, and ranges are the viewer's to choose.
    """
    arm = _arm(stories, drawn, ROOM_TO_GROW if growing else MARGIN)
    curvature = _plot(stories, "curvature", plots["curvature"], growing)
    left = rrb.Vertical(arm, rrb.Tabs(*_heat_maps(stories), *_words(stories), curvature), row_shares=[3, 2])
    others = {name: each for name, each in plots.items() if name != "curvature"}
    right = rrb.Vertical(
        *(_plot(stories, name, each, growing) for name, each in others.items()),
        row_shares=[*map(_height, others.values())],
    )
    duration = max(story.duration for story in stories)
    time = rrb.TimePanel(
        state="collapsed",
        timeline=stories[0].timeline,
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
    """The layout of a run that has nothing but an end."""
    return rrb.Blueprint(rrb.TextDocumentView(origin=entity), collapse_panels=True)


def _arm(stories: Sequence[Story], drawn: Mapping[str, Drawn], room: float) -> rrb.View:
    name = ending(stories[0].log) if len(stories) == 1 else " and ".join(story.name for story in stories)
    low, high = extent(drawn)
    margin = room * float((high - low).max())
    (left, bottom), (right, top) = on_screen(low - margin), on_screen(high + margin)
    bounds = rrb.VisualBounds2D(x_range=(left, right), y_range=(top, bottom))
    return rrb.Spatial2DView(origin="arm", name=name, background=WHITE, visual_bounds=bounds)


def _heat_maps(stories: Sequence[Story]) -> list[rrb.View]:
    (left, right), (bottom, top) = heat_map.SHOWN
    bounds = rrb.VisualBounds2D(x_range=(left, right), y_range=(-top, -bottom))
    look = {"background": WHITE, "visual_bounds": bounds}
    return [
        rrb.Spatial2DView(origin=story.at("curvature"), name=_tab(story, "curvature over time"), **look)
        for story in stories
    ]


def _words(stories: Sequence[Story]) -> list[rrb.View]:
    return [rrb.TextDocumentView(origin=story.at("about"), name=_tab(story, "about")) for story in stories]


def _tab(story: Story, name: str) -> str:
    return f"{story.name}: {name}" if story.name else name


def _plot(stories: Sequence[Story], name: str, each: Sequence[Plot], growing: bool) -> rrb.View:
    several = sum(len(plot.series) for plot in each) > 1
    return rrb.TimeSeriesView(
        origin=f"series/{name}",
        name=each[0].title,
        axis_x=None if growing else rrb.TimeAxis(view_range=_time_range(stories)),
        axis_y=None if growing else rrb.ScalarAxis(range=value_range(each)),
        plot_legend=rrb.PlotLegend(corner="RightTop", visible=several),
        background=rrb.archetypes.PlotBackground(color=WHITE, show_grid=False),
    )


def _height(each: Sequence[Plot]) -> int:
    """Share of a plot: the more series, the higher its legend."""
    return 3 + sum(len(plot.series) for plot in each)


def _time_range(stories: Sequence[Story]) -> rrb.TimeRange:
    """The whole time line, and room for the legend after it."""
    # A number in a sequence is an integer for rerun, just as a count of ns is.
    unit = 1e9 if stories[0].moves else 1
    times = np.array([story.times[row] for story in stories for row in (0, -1)])
    first, last = round(unit * float(times.min())), round(unit * float(times.max()))
    end = last + round(ROOM_FOR_LEGENDS[len(stories) > 1] * (last - first))
    start, end = (rrb.TimeRangeBoundary.absolute(nanos=n) for n in (first, end))
    return rrb.TimeRange(start=start, end=end)
