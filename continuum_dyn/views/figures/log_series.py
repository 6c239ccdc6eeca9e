"""The columns of a log that its figure draws, and what they are drawn over: time, or the drive of a ramp."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from continuum_dyn.record import Log
from continuum_dyn.views.figures.axis_units import Axis, axis
from continuum_dyn.views.figures.looks import without_math
from statics.errors import InputError

LARGEST = 1e100
"""Largest size of a number that is drawn: squares of larger ones overflow."""
DRIVES = ("tension", "cable_displacement", "load_factor")


class LogSeries(NamedTuple):
    """The columns of a log that are drawn, and the ``values`` they are drawn over.

    ``quantity`` is their name: "time" in a motion, in a ramp the input that changes. ``of`` names the cable
    or load whose input it is, if there are several.
    """

    columns: Mapping[str, np.ndarray]
    quantity: str
    values: np.ndarray
    rest: bool
    of: str = ""

    @property
    def axis(self) -> Axis:
        """The axis of ``values``."""
        words = self.quantity.replace("_", " ")
        return axis(self.quantity, self.values, f"{words} of {without_math(self.of)}" if self.of else words)

    @property
    def tip(self) -> np.ndarray:
        """Coordinates x and y of the tip, shape (rows, 2), m."""
        return np.stack([self.columns["disk_x"][:, -1], self.columns["disk_y"][:, -1]], axis=-1)


class Input(NamedTuple):
    """Inputs that share an axis: their quantity, the words on it, the title above it, and all by name."""

    quantity: str
    words: str
    title: str
    lines: dict[str, np.ndarray]


def series_of(log: Log) -> LogSeries:
    """Columns of a log to draw, with their axis.

    Raises ``InputError`` if the log holds nothing, or numbers too large to draw.
    """
    series = _series(log)
    for name, values in series.columns.items():
        if np.abs(values).max(initial=0.0) > LARGEST:
            raise InputError(f"{log.path}: {name} holds numbers beyond {LARGEST:g}, which are not drawn.")
    return series


def _series(log: Log) -> LogSeries:
    if log.trajectory:
        return LogSeries(log.trajectory, "time", log.trajectory["time"], rest=False)
    if not log.equilibria:
        raise InputError(f"{log.path}: nothing was found in this run; there is nothing to draw.")
    for name in DRIVES:
        columns = log.equilibria.get(name, np.empty((1, 0))).T
        for number, values in enumerate(columns):
            if np.ptp(values) > 0.0:
                of = _names(log, name)[number] if len(columns) > 1 else ""
                return LogSeries(log.equilibria, name, values, rest=True, of=of)
    return LogSeries(log.equilibria, "point", log.equilibria["point"], rest=True)


def _names(log: Log, quantity: str) -> list[str]:
    """Names of the cables, or numbers of the loads, that have this quantity."""
    if quantity != "load_factor":
        return list(log.cables)
    loads = log.trajectory or log.equilibria
    return [f"load {number}" for number in range(1, loads[quantity].shape[1] + 1)]


def inputs_of(log: Log, columns: Mapping[str, np.ndarray]) -> dict[str, Input]:
    """Inputs that act, by quantity: tensions, lengths drawn in, load factors, the base's place and angle.

    The tensions of cables that are driven by their length are among them.
    """
    lengths = _driven_lengths(log, columns)
    base = _changing(columns, {"base x": "base_x", "base y": "base_y"})
    found = [
        Input(
            "tension", "tension", "Tension" if lengths else "Input: tension", _each(log, columns, "tension")
        ),
        Input("cable_displacement", "displacement", "Input: cable displacement", lengths),
        Input("load_factor", "load factor", "Input: load factor", _each(log, columns, "load_factor")),
        Input("base_x", "base" if len(base) > 1 else next(iter(base), ""), "Input: base", base),
        Input(
            "base_theta",
            "base theta",
            "Input: angle of the base",
            _changing(columns, {"base theta": "base_theta"}),
        ),
    ]
    return {each.quantity: each for each in found if each.lines}


def _each(log: Log, columns: Mapping[str, np.ndarray], quantity: str) -> dict[str, np.ndarray]:
    """Each cable's or load's values, unless all are zero."""
    values = columns.get(quantity, np.empty((0, 0)))
    return dict(zip(_names(log, quantity), values.T, strict=True)) if values.any() else {}


def _driven_lengths(log: Log, columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    stiffness = np.asarray(log.arm["cable_stiffness"])
    lines = _each(log, columns, "cable_displacement")
    names = zip(log.cables, stiffness > 0.0, strict=True)
    return {name: lines[name] for name, driven in names if driven and name in lines}


def _changing(columns: Mapping[str, np.ndarray], names: Mapping[str, str]) -> dict[str, np.ndarray]:
    """Columns that change, by their words."""
    found = {words: columns[name] for words, name in names.items() if name in columns}
    return {words: values for words, values in found.items() if np.ptp(values) > 0.0}
