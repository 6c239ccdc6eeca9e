"""Plots over time: series by name, with the unit of their axis."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from continuum_dyn.views.figures.log_series import Input, inputs_of
from continuum_dyn.views.playback.colors import GREY, PALETTE, distinct_colors, shades
from continuum_dyn.views.playback.drawing import moments
from continuum_dyn.views.playback.playback import Playback, spread
from continuum_dyn.views.playback.targets import resting_rows
from continuum_dyn.views.rerun_core.stream import Stream
from statics.quantities import QUANTITIES

MOST_SERIES = 8
MILLI = 1e3
"""Number of mm in a m, and of mJ in a J: fixed, so that a log that grows keeps its units."""
STORED = ("kinetic_energy", "elastic_energy", "gravity_energy")
LEDGER = ("input_work", "dissipated_energy")
POWERS = ("input_power", "dissipated_power")
LINE_WIDTH, THIN = 1.5, 0.8
MIN_AND_MAX = 5
"""Aggregation of samples finer than a pixel: the mean of fast oscillations would look like rest."""


@dataclass(frozen=True)
class Series:
    """Values at the rows of a playback, shape (rows,); one that is not a number leaves a gap.

    ``is_bound`` is drawn thin and grey.
    """

    name: str
    values: np.ndarray
    is_bound: bool = False


@dataclass(frozen=True)
class Plot:
    """Series that share their axis; the title has its unit."""

    title: str
    series: Sequence[Series]


@np.errstate(over="ignore")  # a log may hold any finite numbers, and some have no mm
def plots_of(playback: Playback) -> dict[str, Plot]:
    """Plots by the last part of their entity, without those that the log has no data for."""
    columns = playback.columns
    inputs = inputs_of(playback.log, columns)
    tension = [Series(*each) for each in zip(playback.log.cables, columns["tension"].T, strict=True)]
    plots = {
        "tension": Plot(QUANTITIES["tension"].label, tension),
        "cable_displacement": Plot("cable displacement (mm)", _lengths(inputs, "cable_displacement")),
        "load_factor": Plot(QUANTITIES["load_factor"].label, _load_factors(columns)),
        "base": Plot(_base_title(inputs), _lengths(inputs, "base_x")),
        "base_theta": Plot(QUANTITIES["base_theta"].label, _angles(inputs)),
        "tip_x": Plot("tip x (mm)", _tip(playback, "disk_x")),
        "tip_y": Plot("tip y (mm)", _tip(playback, "disk_y")),
        "energy": Plot("energy since the start (mJ)", _since_start(playback)),
        "power": Plot(
            "power (W)", [Series(_words(name), columns[name]) for name in POWERS if name in columns]
        ),
        "step_size": Plot("log10 of the solver's step (s)", _steps(columns)),
        "curvature": Plot(QUANTITIES["curvature"].label, _curvature(columns)),
    }
    return {name: plot for name, plot in plots.items() if plot.series}


def _words(name: str) -> str:
    return name.replace("_", " ")


def _load_factors(columns: Mapping[str, np.ndarray]) -> list[Series]:
    factors = columns.get("load_factor", np.empty((0, 0))).T
    return [Series(f"load {number}", values) for number, values in enumerate(factors, start=1)]


def _lengths(inputs: Mapping[str, Input], name: str) -> list[Series]:
    """Inputs that are lengths, mm."""
    lines = inputs[name].lines if name in inputs else {}
    return [Series(words, MILLI * values) for words, values in lines.items()]


def _base_title(inputs: Mapping[str, Input]) -> str:
    return f"{inputs['base_x'].words if 'base_x' in inputs else 'base'} (mm)"


def _angles(inputs: Mapping[str, Input]) -> list[Series]:
    lines = inputs["base_theta"].lines if "base_theta" in inputs else {}
    return [Series(words, values) for words, values in lines.items()]


def _curvature(columns: Mapping[str, np.ndarray]) -> list[Series]:
    curvature = columns["curvature"].T
    return [Series(f"segment {n + 1}", curvature[n]) for n in spread(len(curvature), MOST_SERIES)]


def _since_start(playback: Playback) -> list[Series]:
    """Changes (mJ), so that the ledger can be read: input work is what is stored and dissipated.

    Beside other runs, what is stored is shown as a whole.
    """
    columns = {name: playback.columns[name] for name in (*STORED, *LEDGER) if name in playback.columns}
    stored = [columns[name] for name in STORED if name in columns]
    if playback.name and stored:
        ledger = {name: columns[name] for name in LEDGER if name in columns}
        columns = {"stored_energy": np.sum(stored, axis=0), **ledger}
    return [Series(_words(name), MILLI * (values - values[0])) for name, values in columns.items()]


def _steps(columns: Mapping[str, np.ndarray]) -> list[Series]:
    if not columns.get("step_size", np.zeros(1)).any():
        return []
    taken = np.where(columns["step_size"] > 0.0, columns["step_size"], np.nan)
    return [Series("step", np.log10(taken))]


def _tip(playback: Playback, name: str) -> list[Series]:
    """The tip (mm), its equilibrium under the moment's inputs and, for a single run, the band of settling."""
    series = [Series("tip", MILLI * playback.columns[name][:, -1])]
    resting = resting_rows(playback.log) if playback.moves else np.array([-1])
    if not (resting >= 0).any():
        return series
    target = MILLI * np.where(resting >= 0, playback.log.equilibria[name][resting, -1], np.nan)
    series.append(Series("static target", target))
    if not playback.name and playback.scenario is not None and playback.scenario.study.settles:
        within = MILLI * playback.scenario.settled_within
        series += [Series("settled band", target + way, is_bound=True) for way in (-within, within)]
    return series


def value_range(plots: Sequence[Plot]) -> tuple[float, float]:
    """All values with a margin of a tenth; for a constant, from zero to twice of it."""
    values = np.concatenate([series.values for plot in plots for series in plot.series])
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    margin = 0.1 * (high - low) or abs(high) or 1.0
    return low - margin, high + margin


def send_style(recording: Stream, entity: str, playback: Playback, plot: Plot) -> None:
    """Names, colours and widths of the series."""
    count = len(plot.series)
    bounds = np.array([series.is_bound for series in plot.series])
    colors = shades(int(PALETTE[playback.rank]), count) if playback.name else distinct_colors(count)
    prefix = f"{playback.name}: " if playback.name else ""
    style = {
        "names": [prefix + series.name for series in plot.series],
        "colors": np.where(bounds, np.uint32(GREY), colors),
    }
    look = {"widths": np.where(bounds, THIN, LINE_WIDTH), "aggregation_policy": [MIN_AND_MAX]}
    recording.log(entity, "archetypes.SeriesLines", **style, **look)
    if not playback.moves:
        recording.log(entity, "archetypes.SeriesPoints", **style, marker_sizes=[3.0] * count)


def send_values(recording: Stream, entity: str, playback: Playback, plot: Plot, rows: np.ndarray) -> None:
    """The series at those rows."""
    values = np.column_stack([series.values[rows] for series in plot.series])
    counts = np.full(len(rows), len(plot.series))
    recording.send(entity, moments(playback, rows), "archetypes.Scalars", counts, scalars=values.ravel())
