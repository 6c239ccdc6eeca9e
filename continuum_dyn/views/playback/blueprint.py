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

ROOM_FOR_LEGENDS = 0.3
"""Of the time line, after it."""


def blueprint(
    stories: Sequence[Story], drawn: Mapping[str, Drawn], plots: Mapping[str, Sequence[Plot]]
) -> rrb.Blueprint:
    """The arm above its curvature and what is said of it, plots beside them."""
    left = rrb.Vertical(_arm(stories, drawn), rrb.Tabs(*_below(stories, plots)), row_shares=[3, 2])
    over_time = {name: each for name, each in plots.items() if name != "curvature"}
    right = rrb.Vertical(
        *(_plot(stories, *named) for named in over_time.items()),
        row_shares=[*map(_height, over_time.values())],
    )
    duration = max(story.duration for story in stories)
    speed = min(1.0, duration / SHORTEST_PLAYBACK) or 1.0
    return rrb.Blueprint(
        rrb.Horizontal(left, right, column_shares=[1, 1]),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        rrb.TimePanel(state="collapsed", timeline=stories[0].timeline, playback_speed=speed, fps=2.0),
        auto_views=False,
    )


def words_alone(entity: str) -> rrb.Blueprint:
    """The layout of a run that has nothing but an end."""
    return rrb.Blueprint(rrb.TextDocumentView(origin=entity), collapse_panels=True)


def _arm(stories: Sequence[Story], drawn: Mapping[str, Drawn]) -> rrb.View:
    name = ending(stories[0].log) if len(stories) == 1 else " and ".join(story.name for story in stories)
    low, high = extent(drawn)
    margin = 0.08 * float((high - low).max())
    (left, bottom), (right, top) = on_screen(low - margin), on_screen(high + margin)
    bounds = rrb.VisualBounds2D(x_range=(left, right), y_range=(top, bottom))
    return rrb.Spatial2DView(origin="arm", name=name, background=WHITE, visual_bounds=bounds)


def _below(stories: Sequence[Story], plots: Mapping[str, Sequence[Plot]]) -> list[rrb.View]:
    """Tabs: curvature as a picture, what is said of the run, curvature as lines."""
    (left, right), (bottom, top) = heat_map.SHOWN
    bounds = rrb.VisualBounds2D(x_range=(left, right), y_range=(-top, -bottom))
    views: list[rrb.View] = [
        rrb.Spatial2DView(
            origin=story.at("curvature"),
            name=" ".join(filter(None, ("curvature over time", story.name))),
            background=WHITE,
            visual_bounds=bounds,
        )
        for story in stories
    ]
    views += [
        rrb.TextDocumentView(origin=story.at("about"), name=" ".join(filter(None, ("about", story.name))))
        for story in stories
    ]
    return [*views, _plot(stories, "curvature", plots["curvature"])]


def _plot(stories: Sequence[Story], name: str, each: Sequence[Plot]) -> rrb.View:
    several = sum(len(plot.series) for plot in each) > 1
    return rrb.TimeSeriesView(
        origin=f"series/{name}",
        name=each[0].title,
        axis_x=rrb.TimeAxis(view_range=_time_range(stories)),
        axis_y=rrb.ScalarAxis(range=value_range(each)),
        plot_legend=rrb.PlotLegend(corner="RightTop", visible=several),
        background=rrb.archetypes.PlotBackground(color=WHITE, show_grid=False),
    )


def _height(each: Sequence[Plot]) -> int:
    """Share of a plot: the more series, the higher its legend."""
    return 3 + sum(len(plot.series) for plot in each)


def _time_range(stories: Sequence[Story]) -> rrb.TimeRange:
    """The whole time line, and room for the legend after it."""
    unit = (
        1e9 if stories[0].moves else 1
    )  # a number in a sequence is an integer for rerun, as a count of ns is
    times = np.array([story.times[row] for story in stories for row in (0, -1)])
    first, last = round(unit * float(times.min())), round(unit * float(times.max()))
    end = last + round(ROOM_FOR_LEGENDS * (last - first))
    start, end = (rrb.TimeRangeBoundary.absolute(nanos=n) for n in (first, end))
    return rrb.TimeRange(start=start, end=end)
