"""Table of a ramp: every point, or which of them it leaves out."""

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from continuum_dyn.commands.terminal.output import console, say
from continuum_dyn.commands.terminal.show import plain_table

if TYPE_CHECKING:
    from continuum_dyn.scenario.scenario import Scenario
    from statics.equilibria import Equilibrium

MAX_ROWS = 50
"""Largest number of points that are printed without leaving any out."""
FEW_ROWS = 25
"""Number of ordinary points that are printed of more."""
MOST_RANGES = 3
"""Largest number of ranges of points left out that are named."""
WIDEST = 10_000
"""Largest width of a table, characters."""
GAP = 2
"""Characters between two columns."""
MARKS = ("", "fold", "branching")
"""Words for ``Critical``."""
STABLE = {True: "yes", False: "no", None: "unknown"}


def print_ramp(scenario: "Scenario", points: "Sequence[Equilibrium]") -> None:
    """Print the table of a ramp, and which points it leaves out."""
    screen = console()
    table = ramp_table(scenario, points, screen.width)
    screen.width = max(screen.width, WIDEST)  # lines may be wider: numbers cut short would mislead
    screen.print(table)
    if left_out(points):
        say(left_out(points))


def ramp_table(scenario: "Scenario", points: "Sequence[Equilibrium]", width: int) -> Any:
    """Table of the equilibria: drives, tip and stability of each, and what happens there.

    Drives that never change have no column. If points are left out, each is numbered as in the log. Headings
    are broken at words where the table would be wider than ``width`` characters; numbers are whole.
    """
    shown = rows_shown(points)
    columns = _changing(_drives(scenario, points)) | _poses(points)
    if len(shown) < len(points):
        columns = {"point": [str(number) for number in range(1, len(points) + 1)]} | columns
    table = plain_table("", *columns)
    table.title = None
    cell_widths = [max(len(cells[number]) for number in shown) for cells in columns.values()]
    natural = sum(max(len(name), cell) + GAP for name, cell in zip(columns, cell_widths, strict=True))
    for column, name, cell in zip(table.columns, columns, cell_widths, strict=True):
        column.justify = "right"
        if natural > width:
            column.width = max(cell, *map(len, name.split()), 1)
    for number in shown:
        table.add_row(*(cells[number] for cells in columns.values()))
    return table


def left_out(points: "Sequence[Equilibrium]") -> str:
    """Text that says which points the table leaves out; empty if none."""
    shown = rows_shown(points)
    ranges = [
        f"{before + 2}-{after}" if after > before + 2 else f"{after}"
        for before, after in pairwise(shown)
        if after > before + 1
    ]
    if not ranges:
        return ""
    more = ", ..." if len(ranges) > MOST_RANGES else ""
    return (
        f"points {', '.join(ranges[:MOST_RANGES])}{more} are left out, {len(points) - len(shown)} of "
        f"{len(points)}; all are in the log"
    )


def rows_shown(points: "Sequence[Equilibrium]") -> list[int]:
    """Numbers from 0 of the points that the table shows: of many the ends, each event, and some between."""
    count = len(points)
    if count <= MAX_ROWS:
        return list(range(count))
    stride = -(-count // FEW_ROWS)
    lost = [number for number in range(1, count) if points[number].found != points[number - 1].found]
    events = [number for number, point in enumerate(points) if point.found and mark(point)]
    return sorted({*range(0, count, stride), *events, *lost, count - 1})


def mark(point: "Equilibrium") -> str:
    """Event at a point, in words: not found, a jump, a fold or a branching; empty for none."""
    if not point.found:
        return "not found"
    if point.jumped:
        return "jumped"
    return "branching" if point.lost_at is not None else MARKS[point.critical]


def _drives(scenario: "Scenario", points: "Sequence[Equilibrium]") -> dict[str, list[str]]:
    """Tensions, displacements of the cables that are driven by these, and load factors, by heading."""
    scene, names = scenario.scene, scenario.scene.arm.cable_names
    found = {
        f"{names[number]} (N)": [f"{point.tension[number]:g}" for point in points]
        for number in range(scene.cables)
    }
    for number in scene.driven_by_length:
        drawn_in = (1e3 * point.cable_displacement[number] for point in points)
        found[f"{names[number]} (mm)"] = [f"{value:g}" for value in drawn_in]
    factors = [() if point.load_factor is None else point.load_factor for point in points]
    for number in range(scene.driven_loads):
        found[f"load factor {number + 1}"] = [f"{factor[number]:g}" for factor in factors]
    return found


def _changing(columns: dict[str, list[str]]) -> dict[str, list[str]]:
    """The columns whose cells differ; all of them if none does."""
    return {name: cells for name, cells in columns.items() if len(set(cells)) > 1} or columns


def _poses(points: "Sequence[Equilibrium]") -> dict[str, list[str]]:
    """Pose of the tip, stability and mark of each point, by heading."""
    rows = [(*_pose(point), mark(point)) for point in points]
    headings = ("tip x (mm)", "tip y (mm)", "theta (rad)", "stable", "")
    return {name: list(cells) for name, cells in zip(headings, zip(*rows, strict=True), strict=True)}


def _pose(point: "Equilibrium") -> tuple[str, ...]:
    if not point.found:
        return ("", "", "", "")
    x, y, theta = point.tip
    pose = (f"{1e3 * x:.4f}", f"{1e3 * y:.4f}", f"{theta:.5f}")
    return *map(unsigned_zero, pose), STABLE[point.stable]


def unsigned_zero(number: str) -> str:
    """A number without the sign that rounding has left before a zero."""
    return number.removeprefix("-") if float(number) == 0.0 else number
