"""The legend below the arm: a scale of lengths, one of curvature, and the runs' names."""

from collections.abc import Mapping, Sequence

import numpy as np

from continuum_dyn.views.playback.arm import CORE_WIDTH, own_color
from continuum_dyn.views.playback.colors import BLACK, diverging, pack
from continuum_dyn.views.playback.drawing import Drawn, Lines, corners
from continuum_dyn.views.playback.measures import Measures
from continuum_dyn.views.playback.playback import Playback

TALL = 1.5
"""Height over width of a drawing from which on its legend takes two lines."""
SHADES = 41
"""Number of colours in the scale of curvature."""


def extent(drawn: Mapping[str, Drawn]) -> tuple[np.ndarray, np.ndarray]:
    """Lower left and upper right corner of all drawings over all times."""
    both = np.array([corners(each) for each in drawn.values()])
    return both[:, 0].min(axis=0), both[:, 1].max(axis=0)


def is_tall(drawn: Mapping[str, Drawn]) -> bool:
    """Whether what is drawn is much higher than wide."""
    (left, bottom), (right, top) = extent(drawn)
    return bool(top - bottom > TALL * (right - left))


def legend(drawn: Mapping[str, Drawn], playbacks: Sequence[Playback], measures: Measures) -> dict[str, Drawn]:
    """Entities below the drawing. The view has no axes: hence the scale of lengths."""
    (left, bottom), (right, top) = extent(drawn)
    size = max(right - left, top - bottom)
    y = bottom - 0.12 * size
    if is_tall(drawn):
        middle, width = 0.5 * (left + right), 0.4 * size
        left = middle - 0.5 * width
        parts: dict[str, Drawn] = {"arm/scale": _length_scale(left, y, size)}
        y -= 0.1 * size
        parts |= _curvature_scale(left, left + width, y, measures.curvature)
        y -= 0.04 * size
    else:
        right = left + size
        parts = {"arm/scale": _length_scale(left, y, size)}
        parts |= _curvature_scale(right - 0.45 * size, right, y, measures.curvature)
    for playback in playbacks if len(playbacks) > 1 else ():
        y -= 0.09 * size
        strip = np.array([[[left, y], [left + 0.2 * size, y]]])
        parts[playback.at("arm", "line")] = Lines(strip, own_color(playback, BLACK), 6.0, 5.0)
        parts[playback.at("arm", "name")] = Lines(strip, BLACK, 0.0, 4.0, labels=[playback.name])
    return parts


def _length_scale(left: float, y: float, size: float) -> Lines:
    """A bar of 1, 2 or 5 times a power of ten."""
    steps = np.array([1.0, 2.0, 5.0]) * 10.0 ** np.floor(np.log10(size / 3))
    length = steps[np.sum(steps[1:] <= size / 3)]
    bar = np.array([[[left, y], [left + length, y]]])
    return Lines(bar, BLACK, 2.0, 5.0, labels=[f"{1e3 * float(length):g} mm"])


def _curvature_scale(left: float, right: float, y: float, most: float) -> dict[str, Drawn]:
    """The colours from the most negative to the most positive curvature; labels at ends and middle."""
    edges = np.linspace(left, right, SHADES + 1)
    strips = np.stack([np.stack([edges[:-1], edges[1:]], axis=-1), np.full((SHADES, 2), y)], axis=-1)
    color = pack(diverging(np.linspace(-most, most, SHADES), most))
    tenth = 0.1 * (right - left)
    marks = np.array([left, 0.5 * (left + right), right])
    ticks = np.stack(
        [np.stack([marks - tenth, marks + tenth], axis=-1), np.full((3, 2), y - 0.07 * (right - left))],
        axis=-1,
    )
    labels = [f"-{most:.3g} 1/m", "curvature 0", f"{most:.3g} 1/m"]
    return {
        "arm/curvature_scale/marks": Lines(ticks, BLACK, 0.0, 4.0, labels=labels),
        "arm/curvature_scale/rim": Lines(
            np.array([[[left, y], [right, y]]]), BLACK, 3.0 * CORE_WIDTH + 2.0, 5.0
        ),
        "arm/curvature_scale/colors": Lines(strips, color, 3.0 * CORE_WIDTH, 6.0),
    }
