"""Figures of results without a log: cost, modes, a paper's reproduction."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from continuum_dyn.experiments.cost import PATIENCE, Cost, Price
from continuum_dyn.experiments.reproduce import Rone2012, Shapes
from continuum_dyn.modes import Mode, RestModes
from continuum_dyn.views.figures.backbone import backbone
from continuum_dyn.views.figures.heading import add_note, set_heading
from continuum_dyn.views.figures.looks import BLUE, COLORS, VERMILION
from statics.equilibria import shape_of
from statics.quantities import QUANTITIES

ARC_POINTS = 12
MOST_SHAPES = 6
"""Largest number of modes that are drawn."""
SHAPE_REACH = 0.12
"""Largest displacement of a disk in the picture of a mode, in the arm's length."""
SMALL_PART = 1e-9
"""Displacement (m) by which the core's points are differenced: a mode is drawn magnified, not bent double."""
DISK_HEIGHT = 0.09
"""Height of the disks in the picture of a mode, in arm lengths."""
STYLES = [("-", "o"), ("--", "s"), ("-.", "^"), (":", "D"), ("--", "v"), ("-.", "x"), (":", "+"), ("-", "*")]
"""Lines and markers that differ in black and white."""
LAWS = {
    "printed": {"ls": "--", "color": VERMILION, "lw": 1.6, "label": "equations as printed"},
    "program": {"ls": "-", "color": "k", "lw": 1.2, "label": "the program"},
    "exact rod": {"ls": "", "marker": "o", "mfc": "none", "color": BLUE, "ms": 7, "label": "exact rod"},
}
"""Line style of each law in a paper's reproduction."""
LIFTS_CLEARLY = 0.5
"""N; below it the paper's arm stays within a millimetre of the base's height."""
PARTS_CLEARLY = 1.0
"""N; from here on the printed equations' tip stands clear of the others."""


def cost(measured: Cost) -> Figure:
    """Tip error against time and work for every method that ran, and against work for every mesh.

    Settings that no other beats in both error and work are ringed: work is the same on every computer.
    """
    panels = ("time", "work", "mesh") if measured.meshes else ("time", "work")
    figure = Figure(figsize=(4.0 * len(panels), 4.4), layout="constrained")
    axes: dict[str, Any] = dict(zip(panels, figure.subplots(1, len(panels)), strict=True))
    for number, method in enumerate(dict.fromkeys(price.method for price in measured.prices)):
        line, marker = STYLES[number % len(STYLES)]
        look = {"color": COLORS[number % len(COLORS)], "ls": line, "marker": marker, "ms": 5, "label": method}
        _draw_prices(axes, [p for p in measured.prices if p.method == method], look)
    rings = {"color": "0.3", "ls": "", "marker": "o", "ms": 10, "mfc": "none", "label": "least work"}
    _draw_prices(axes, _least_work(measured.prices), rings)
    axes["time"].set(xlabel="time (ms)", ylabel="largest tip error (um)", title="Methods, by time")
    axes["work"].set(xlabel="segment evaluations", ylabel="largest tip error (um)", title="Methods, by work")
    axes["work"].legend()
    if measured.meshes:
        _draw_meshes(axes["mesh"], measured)
    for each in axes.values():
        each.grid(visible=True, which="major", lw=0.4, color="0.8")
        each.yaxis.set_major_formatter("{x:g}")
    set_heading(figure, f"{measured.scenario.title}: what accuracy costs")
    if measured.over_budget:
        late = (f"{method} at rtol {rtol:.0e}" for method, rtol in measured.over_budget.items())
        add_note(figure, f"Given up after {PATIENCE:g} s: {', '.join(late)}, and all that is tighter.")
    return figure


def _draw_prices(axes: Mapping[str, Any], prices: Sequence[Price], look: Mapping[str, Any]) -> None:
    errors = [1e6 * price.error for price in prices]
    axes["time"].loglog([1e3 * price.seconds for price in prices], errors, lw=1.4, **look)
    axes["work"].loglog([price.segment_evaluations for price in prices], errors, lw=1.4, **look)


def _least_work(prices: Sequence[Price]) -> list[Price]:
    """Prices whose error no other reaches with the same work or less."""
    found: list[Price] = []
    for price in sorted(prices, key=lambda p: (p.segment_evaluations, p.error)):
        if not found or price.error < found[-1].error:
            found.append(price)
    return found


def modes(found: RestModes) -> Figure:
    """The arm at rest in grey and the shapes of its lowest modes: one extreme solid, the other dashed."""
    shown = found.modes[:MOST_SHAPES]
    columns = min(3, len(shown))
    rows = -(-len(shown) // columns)
    figure = Figure(layout="constrained")
    grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axes in grid.flat[len(shown) :]:
        axes.set_axis_off()
    for number, (axes, mode) in enumerate(zip(grid.flat, shown, strict=False), start=1):
        _draw_mode(axes, found, mode)
        ending = "" if mode.kind == "swings" else f", {mode.kind}"
        title = f"{number}: {mode.frequency:.5g} Hz, damping ratio {mode.damping_ratio:.2g}{ending}"
        axes.set_title(title, fontsize=9)
    for axes in grid[-1]:
        axes.set_xlabel("x (mm)")
    for axes in grid[:, 0]:
        axes.set_ylabel("y (mm)")
    box = grid[0, 0].dataLim
    figure.set_size_inches(3.8 * columns, rows * (0.8 + 3.4 * box.height / max(box.width, box.height)) + 0.4)
    set_heading(figure, f"{found.scenario.title}: modes at rest")
    return figure


def _draw_mode(axes: Any, found: RestModes, mode: Mode) -> None:
    arm = found.scenario.scene.arm
    rest = _core(found, 0.0 * mode.coordinates)
    change = (_core(found, SMALL_PART * mode.coordinates) - rest) / SMALL_PART
    reach = SHAPE_REACH * arm.total_length
    disks = slice(None, None, ARC_POINTS * arm.subsegments)
    theta = np.append(arm.base_pose[2], found.rest.disk_theta)
    turn = np.append(0.0, mode.shape[:, 2])
    for part, line, color, width in (
        (0.0, "-", "0.7", 1.2),
        (-reach, "--", "0.35", 1.0),
        (reach, "-", "k", 1.6),
    ):
        points = 1e3 * (rest + part * change)
        axes.plot(*points.T, ls=line, color=color, lw=width)
        if part >= 0.0:
            _draw_disks(
                axes,
                points[disks],
                theta + np.arctan(part * turn),
                1e3 * DISK_HEIGHT * arm.total_length,
                color,
            )
    axes.set_aspect("equal")
    axes.grid(visible=True, lw=0.3, color="0.85")


def _core(found: RestModes, change: np.ndarray) -> np.ndarray:
    """Points of the core, shape (points, 2), m, by a change of the coordinates from those at rest."""
    q = found.rest.coordinates + change
    arm = found.scenario.scene.arm
    shape = shape_of(arm, q[None, :, 0], q[None, :, 1] if q.shape[1] == 2 else None)
    base = zip(("base_x", "base_y", "base_theta"), np.array(arm.base_pose)[:, None], strict=True)
    return backbone(shape | dict(base), np.array([0]), ARC_POINTS)[0]


def _draw_disks(axes: Any, centres: np.ndarray, theta: np.ndarray, height: float, color: str) -> None:
    """Each disk as a bar, so that modes along the arm can be seen."""
    half = 0.5 * height * np.column_stack([-np.sin(theta), np.cos(theta)])
    for centre, way in zip(centres, half, strict=True):
        axes.plot(*np.array([centre - way, centre + way]).T, color=color, lw=1.6)


def _draw_meshes(axes: Any, measured: Cost) -> None:
    """The tip at rest against the exact rod's, on one mesh and extrapolated from two."""
    axes.set(xlabel="segment evaluations of an equilibrium", ylabel="tip error at rest (um)", title="Meshes")
    work = [mesh.segment_evaluations for mesh in measured.meshes]
    plain = [1e6 * mesh.tip_error for mesh in measured.meshes]
    axes.loglog(work, plain, "-o", color="k", ms=5, lw=1.6, label="segments from disk to disk")
    for mesh, place in zip(measured.meshes, zip(work, plain, strict=True), strict=True):
        axes.annotate(str(mesh.subsegments), place, xytext=(5, 4), textcoords="offset points", fontsize=8)
    both = [before + after for before, after in pairwise(work)]
    limits = [1e6 * (mesh.limit_error or 0.0) for mesh in measured.meshes[1:]]
    axes.loglog(both, limits, "--s", color=BLUE, ms=5, lw=1.2, label="extrapolated from two meshes")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.legend(fontsize=8)


def rone2012(found: Rone2012) -> Figure:
    """The shapes of Fig. 3 and 4 by all three laws, and the tip's height against the tension."""
    figure = Figure(figsize=(11.0, 5.6), layout="constrained")
    axes: dict[str, Any] = figure.subplot_mosaic(
        [["high", "tip"], ["low", "tip"]], width_ratios=[1.25, 1.0], height_ratios=[0.75, 1.0]
    )
    low = [found.unactuated, *(shapes for shapes in found.figure_4 if shapes.tension < LIFTS_CLEARLY)]
    high = [shapes for shapes in found.figure_4 if shapes.tension >= LIFTS_CLEARLY]
    _draw_laws(axes["high"], high, 1e3)
    axes["high"].set(ylabel="y (mm)", title="Shapes of Fig. 4")
    axes["high"].set_aspect("equal", adjustable="datalim")
    _draw_laws(axes["low"], low, 1e6)
    axes["low"].set(xlabel="x (mm)", ylabel="y (um)", title="Shapes of Fig. 3 and 4 (y stretched)")
    _draw_tip_heights(axes["tip"], found)
    set_heading(figure, "Rone and Ben-Tzvi 2012: the equations as printed, the program's, and the exact rod")
    return figure


def _draw_laws(axes: Any, drawn: list[Shapes], per_metre: float) -> None:
    """Arcs of the printed and the program's segments, and the exact rod's disks."""
    for shapes in drawn:
        for law, shape in (("printed", shapes.printed), ("program", shapes.program)):
            arcs = {"curvature": shape.curvature[None], "length": shape.length[None]}
            x, y = backbone(arcs, np.array([0]), ARC_POINTS)[0].T
            axes.plot(1e3 * x, per_metre * y, **LAWS[law])
            if law == "program" or shapes.tension >= PARTS_CLEARLY:
                place, text = (1e3 * x[-1], per_metre * y[-1]), f"{shapes.tension:g} N"
                axes.annotate(text, place, xytext=(9, 0), textcoords="offset points", fontsize=8, va="center")
        axes.plot(1e3 * shapes.rod.disk_x, per_metre * shapes.rod.disk_y, **LAWS["exact rod"])
    axes.axhline(0.0, color="0.7", lw=0.8)
    axes.margins(x=0.12, y=0.1)


def _draw_tip_heights(axes: Any, found: Rone2012) -> None:
    """The tip against the tension, and enlarged where it passes the base's height."""
    near = axes.inset_axes((0.12, 0.48, 0.34, 0.26))
    tension = [shapes.tension for shapes in found.ramp]
    for law, look in LAWS.items():
        height = np.array([shapes.tip_y[law] for shapes in found.ramp])
        axes.plot(tension, 1e3 * height, **look)
        near.plot(tension, 1e6 * height, **{**look, "ls": look["ls"] or ":"})
    near.axhline(0.0, color="0.7", lw=0.8)
    near.set(xlim=(0.09, 0.11), ylim=(-90, 90))
    near.set_title("near 0.1 N (y in um)", fontsize=9)
    axes.set(xlabel=QUANTITIES["tension"].label, ylabel="tip y (mm)", title="Tip against tension")
    axes.legend(loc="upper left")
