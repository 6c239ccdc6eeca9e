"""Places and sizes of the panels of a log's figure, from the shape of what is drawn to scale."""

from collections.abc import Sequence
from typing import Any, NamedTuple

WIDTH = 7.6
"""Width of a figure whose shapes are wide, inches."""
PANEL_WIDTH, PANEL_HEIGHT = 3.6, 1.75
"""Size of a panel with its labels, inches."""
LABELS = 0.8, 0.75
"""Width and height that ticks, labels and titles take beside the axes, inches."""
LEGEND = 1.5, 0.6
"""Width of a legend at the right of the shapes, and height of one below them, inches."""
HEADING = 0.35
WIDE, TALL = 0.5, 1.5
"""Height over width of the shapes, below which all panels are below them, and above which beside them."""
WIDEST, HIGHEST = 5.0, 7.5
"""Largest width and height of shapes that stand alone, inches."""


class Layout(NamedTuple):
    """A mosaic of panels by name, the ratios of its columns and rows, and the size of the figure, inches.

    The legend of the shapes is below them, or else at their right.
    """

    mosaic: list[Any]
    widths: list[float]
    heights: list[float]
    size: tuple[float, float]
    legend_below: bool = False


def layout_of(panels: Sequence[str], box: tuple[float, float]) -> Layout:
    """The layout of these panels; if shapes are among them, they take that width and height."""
    others = [name for name in panels if name != "shapes"]
    slope = box[1] / box[0]
    if "shapes" not in panels:
        return _without_shapes(_tips_together(others))
    if not others:
        return _alone(slope)
    if slope > TALL:
        return _beside(others, slope)
    if slope > WIDE and len(others) > 1:
        return _corner(others, slope)
    return _above(_tips_together(others), slope)


def _tips_together(names: Sequence[str]) -> list[str]:
    """The panels in the order of their rows of two, so that x and y of the tip share one."""
    alone = [name for name in names if not name.startswith("tip")]
    paired = len(alone) // 2 * 2
    return [*alone[:paired], *(name for name in names if name not in alone), *alone[paired:]]


def _in_twos(names: Sequence[str]) -> list[list[str]]:
    """Rows of two panels; a last single one is as wide as both."""
    return [[names[k], names[min(k + 1, len(names) - 1)]] for k in range(0, len(names), 2)]


def _without_shapes(names: Sequence[str]) -> Layout:
    rows = _in_twos(names)
    height = PANEL_HEIGHT if len(rows) > 1 else 1.6 * PANEL_HEIGHT
    return Layout(rows, [1.0, 1.0], [1.0] * len(rows), (WIDTH, HEADING + height * len(rows)))


def _above(names: Sequence[str], slope: float) -> Layout:
    """Shapes and room for their legend above rows of two panels."""
    height = min(max((WIDTH - LABELS[0] - LEGEND[0]) * slope, 1.2), 3.2) + LABELS[1]
    room, rows = LEGEND[0] / WIDTH, _in_twos(names)
    mosaic = [["shapes", "shapes", "."], *([left, right, right] for left, right in rows)]
    heights = [height] + [PANEL_HEIGHT] * len(rows)
    return Layout(mosaic, [0.5, 0.5 - room, room], heights, (WIDTH, HEADING + sum(heights)))


def _alone(slope: float) -> Layout:
    width = min(WIDEST, (HIGHEST - LABELS[1]) / slope)
    height = max(1.2, width * slope)
    size = width + LABELS[0] + LEGEND[0], height + LABELS[1] + HEADING
    return Layout([["shapes", "."]], [width + LABELS[0], LEGEND[0]], [1.0], size)


def _beside(others: Sequence[str], slope: float) -> Layout:
    """Shapes at the left, as high as the page, all else beside them."""
    height = max(5.6, PANEL_HEIGHT * len(others)) + LEGEND[1]
    width = min(max((height - LABELS[1] - LEGEND[1]) / slope, 2.0), 3.6) + LABELS[0]
    mosaic = [["shapes", name] for name in others]
    size = width + PANEL_WIDTH, HEADING + height
    return Layout(mosaic, [width, PANEL_WIDTH], [1.0] * len(others), size, legend_below=True)


def _corner(others: Sequence[str], slope: float) -> Layout:
    """Shapes in a corner, two panels beside them, all else below."""
    order = sorted(others, key=lambda name: not name.startswith("tip"))
    height = min(max((0.5 * WIDTH - LABELS[0]) * slope, 2.6), 4.6) + LABELS[1] + LEGEND[1]
    rows = [["shapes", name] for name in order[:2]] + _in_twos(order[2:])
    heights = [0.5 * height] * 2 + [PANEL_HEIGHT] * (len(rows) - 2)
    return Layout(rows, [1.0, 1.0], heights, (WIDTH, HEADING + sum(heights)), legend_below=True)
