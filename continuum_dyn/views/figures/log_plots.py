"""The figure of a log: shapes, inputs, tip, energies; over time for a motion, over the drive for a ramp."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

from continuum_dyn.record import Log
from continuum_dyn.views.figures.heading import add_note, set_heading
from continuum_dyn.views.figures.history_plots import draw_energies, draw_input, draw_tip, energies_of
from continuum_dyn.views.figures.log_layout import layout_of
from continuum_dyn.views.figures.log_series import LogSeries, inputs_of, series_of
from continuum_dyn.views.figures.looks import LETTERS
from continuum_dyn.views.figures.shape_plot import add_legend, box, draw_shapes, rows_drawn
from continuum_dyn.warnings.sampling import describe_coarse_samples
from statics.errors import InputError

PARTS = ("shapes", "inputs", "tip", "energies")
"""The parts of a log's figure, in the order in which they stand."""
STRETCHED_BOX = (2.0, 1.0)
"""Width and height, relative, that shapes take which are not drawn to scale."""

Panel = Callable[[Any], None]
"""Draws into its axes."""


def picture(log: Log, parts: Sequence[str] = (), at: Sequence[float] = (), stretch: bool = False) -> Figure:
    """The figure with these of ``PARTS``, by default all; shapes at these times (s) or values of the drive.

    Shapes are to scale unless ``stretch`` lets them fill their axes. Raises ``InputError`` if the log holds
    nothing to draw, or if the values are not in it.
    """
    with rc_context(LETTERS):
        series = series_of(log)
        rows = rows_drawn(log, series, at)
        shapes = {"shapes": partial(draw_shapes, log=log, series=series, rows=rows, stretch=stretch)}
        panels = _panels(log, series, shapes, parts)
        layout = layout_of(list(panels), STRETCHED_BOX if stretch else box(log, series, rows))
        figure = Figure(figsize=layout.size, layout="constrained")
        axes: dict[str, Any] = figure.subplot_mosaic(
            layout.mosaic, width_ratios=layout.widths, height_ratios=layout.heights
        )
        for name, draw in panels.items():
            draw(axes[name])
        if "shapes" in panels:
            add_legend(axes["shapes"], layout.legend_below)
        outcome = str(log.outcome).replace("_", " ")
        axes[next(iter(panels))].set_title(f"outcome: {outcome}", loc="right", fontsize=8, color="0.3")
        set_heading(figure, log.title)
        coarse = describe_coarse_samples(log.trajectory)
        if coarse and not series.rest:
            add_note(figure, f"Samples {coarse}")
    return figure


def _panels(log: Log, series: LogSeries, shapes: dict[str, Panel], parts: Sequence[str]) -> dict[str, Panel]:
    """Panels by the names of their axes. Raises ``InputError`` if a log has nothing of the ``parts``."""
    changes = _histories(log, series)
    by_part = {"shapes": shapes, **(changes if parts or len(series.values) > 1 else {})}
    panels = {
        n: draw for part, each in by_part.items() if not parts or part in parts for n, draw in each.items()
    }
    if not panels:
        raise InputError(f"{log.path}: nothing to draw of {', '.join(parts)} in this log: all of it is zero.")
    return panels


def _histories(log: Log, series: LogSeries) -> dict[str, dict[str, Panel]]:
    """Panels over time, or over the drive, by part."""
    inputs = inputs_of(log, series.columns)
    energies = {"energies": partial(draw_energies, series=series)} if energies_of(series) else {}
    return {
        "inputs": {n: partial(draw_input, series=series, shown=each) for n, each in inputs.items()},
        "tip": {f"tip_{c}": partial(draw_tip, log=log, series=series, coordinate=c) for c in "xy"},
        "energies": energies,
    }
