"""The arm at one row of a log, to scale: disks, cables, base and loads."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from continuum_dyn.record import Log
from continuum_dyn.views.figures.backbone import disk_reach, poses
from continuum_dyn.views.figures.loads import ActingLoad
from continuum_dyn.views.figures.looks import COLORS, GREEN, legend_labels

MOST_DISKS = 60
"""Largest number of disks that are drawn."""
FORCE_REACH = 0.2
"""Length of the largest force's arrow, in the arm's length."""
MOMENT_RADIUS = 0.07
"""Radius of a moment's arrow, in the arm's length."""
MOMENT_SWEEP = 1.5 * np.pi
"""Angle of a moment's arrow."""


def draw_disks(
    axes: Any, log: Log, columns: Mapping[str, np.ndarray], row: int, per_si: float, grey: str
) -> None:
    """Draw each disk as a bar across the core, and the base as a thick one."""
    centre, across = (each[0] for each in poses(columns, np.array([row])))
    reach = disk_reach(log.arm, columns) * across
    bars = per_si * np.stack([centre - reach, centre + reach], axis=1)
    shown = np.unique(np.linspace(1, len(bars) - 1, min(MOST_DISKS, len(bars) - 1)).round().astype(int))
    gap = np.full((1, 2), np.nan)
    strips = np.concatenate([part for bar in bars[shown] for part in (bar, gap)])
    axes.plot(*strips.T, color=grey, lw=1.2, solid_capstyle="butt", gid="disks")
    axes.plot(*bars[0].T, color="k", lw=4.0, solid_capstyle="butt", gid="base", zorder=3)


def draw_cables(
    axes: Any, log: Log, columns: Mapping[str, np.ndarray], rows: Sequence[int], per_si: float
) -> None:
    """Draw each cable from its start to its anchor at these rows: dotted while slack."""
    centre, across = poses(columns, np.array(rows))
    names = legend_labels([f"cable {name}" for name in log.cables])
    each = zip(names, log.arm["hole_offset"], log.bare_disks, strict=True)
    for number, (name, offset, bare) in enumerate(each):
        slack = columns["tension"][rows, number] <= 0.0
        look = {"color": COLORS[1 + number % (len(COLORS) - 1)], "lw": 1.1, "zorder": 2.5, "gid": "cables"}
        label = f"{name}\n(dotted: slack)" if slack.any() else name
        holes = per_si * (centre + offset[:, None] * across)[:, bare]
        for points, dotted in zip(holes, slack, strict=True):
            axes.plot(*points.T, ls=":" if dotted else "-", **look)
        axes.plot([], [], label=label, **look)


def draw_loads(axes: Any, loads: Sequence[ActingLoad], row: int, per_si: float, length: float) -> None:
    """Draw forces as straight arrows whose length is their size, moments as round ones; with their sizes."""
    largest = max((float(np.hypot(*load.force.T).max()) for load in loads), default=0.0)
    for load in loads:
        place = per_si * load.place[row]
        if load.force[row].any():
            vector = per_si * FORCE_REACH * length * load.force[row] / largest
            _arrow(axes, place, place + vector)
            _write(axes, f"{np.hypot(*load.force[row]):.3g} N", place + vector, vector)
        if load.moment[row] != 0.0:
            angle = np.sign(load.moment[row]) * np.linspace(0.0, MOMENT_SWEEP, 24)
            radius = per_si * MOMENT_RADIUS * length
            arc = place + radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
            axes.plot(*arc[:-1].T, color=GREEN, lw=1.4, gid="loads")
            _arrow(axes, arc[-2], arc[-1])
            up = np.array([0.0, radius])
            _write(axes, f"{abs(load.moment[row]):.3g} N m", place + up, up)


def _arrow(axes: Any, start: np.ndarray, end: np.ndarray) -> None:
    look = {"arrowstyle": "-|>", "color": GREEN, "lw": 1.4, "shrinkA": 0.0, "shrinkB": 0.0}
    axes.annotate("", end, start, arrowprops=look, zorder=4, gid="loads")
    axes.update_datalim([start, end])


def _write(axes: Any, text: str, place: np.ndarray, way: np.ndarray) -> None:
    """Write a text beyond a place, in that direction from it."""
    offset = 11.0 * way / np.hypot(*way)
    axes.update_datalim([place + 0.5 * way])
    look = {"textcoords": "offset points", "fontsize": 8, "color": GREEN, "ha": "center", "va": "center"}
    ground = {"facecolor": "w", "edgecolor": "none", "pad": 0.8, "alpha": 0.8}
    axes.annotate(text, place, offset, bbox=ground, zorder=4, **look)
