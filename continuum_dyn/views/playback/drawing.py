"""Lines and arrows in a plane, as data, and how they are sent to a recording."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from continuum_dyn.views.playback.playback import Playback
from continuum_dyn.views.rerun_core.stream import Moments, Stream

LINES, ARROWS = "archetypes.LineStrips2D", "archetypes.Arrows2D"


@dataclass(frozen=True)
class Lines:
    """Line strips, shape (strips, points, 2), y up; ``width`` in points of the screen.

    ``color`` and ``width`` are one for all or one for each strip; ``labels`` one for each strip. ``counts``
    has the number of strips in each frame; it is None for lines that never change.
    """

    strips: np.ndarray
    color: int | np.ndarray
    width: float | np.ndarray
    order: float
    counts: np.ndarray | None = None
    labels: Sequence[str] | None = None


@dataclass(frozen=True)
class Arrows:
    """Arrows, one for each frame: from ``place`` along ``vector``, shape (frames, 2), y up."""

    place: np.ndarray
    vector: np.ndarray
    color: int
    width: float
    order: float


Drawn = Lines | Arrows


def every_frame(strips: np.ndarray) -> dict[str, Any]:
    """``strips`` and ``counts`` of strips of shape (frames, strips, points, 2), as many in every frame."""
    return {"strips": strips.reshape(-1, *strips.shape[2:]), "counts": np.full(len(strips), strips.shape[1])}


def corners(drawn: Drawn) -> np.ndarray:
    """Lower left and upper right corner of a drawing over all times, shape (2, 2)."""
    if isinstance(drawn, Lines):
        ends = drawn.strips.reshape(-1, 2)
    else:
        ends = np.concatenate([drawn.place, drawn.place + drawn.vector])
    x_and_y = ends.T.copy()  # NumPy takes ten times as long for the least of what does not lie side by side
    return np.array([x_and_y.min(axis=1), x_and_y.max(axis=1)])


def moments(playback: Playback, rows: np.ndarray) -> Moments:
    """The places of those rows on the time line."""
    times = playback.times[rows]
    return Moments(playback.timeline, np.round(1e9 * times) if playback.moves else times, playback.moves)


def flip_y(points: np.ndarray) -> np.ndarray:
    """Negate y: a 2D view of rerun has y pointing down and cannot flip it (0.41)."""
    return points * np.array([1.0, -1.0])


def send(recording: Stream, entity: str, drawn: Drawn, at: Moments | None = None) -> None:
    """Send a drawing, each frame at its time; without times it never changes."""
    if at is None:
        assert isinstance(drawn, Lines)
        recording.log(entity, LINES, **_style(drawn), **_strips(drawn))
    elif isinstance(drawn, Arrows):
        _send_arrows(recording, entity, drawn, at)
    else:
        assert drawn.counts is not None
        recording.log(entity, LINES, **_style(drawn))
        recording.send(entity, at, LINES, drawn.counts, **_strips(drawn))


def _style(lines: Lines) -> dict[str, Any]:
    """The style that all strips share. Negative radii are points of the screen."""
    style: dict[str, Any] = {"draw_order": [lines.order]}
    if lines.labels is not None:
        style["show_labels"] = [True]
    if np.ndim(lines.color) == 0:
        style["colors"] = [lines.color]
    if np.ndim(lines.width) == 0:
        style["radii"] = [-0.5 * float(lines.width)]
    return style


def _strips(lines: Lines) -> dict[str, Any]:
    """The strips, with their own colours, widths and labels."""
    strips: dict[str, Any] = {"strips": flip_y(lines.strips)}
    if np.ndim(lines.color):
        strips["colors"] = lines.color
    if np.ndim(lines.width):
        strips["radii"] = -0.5 * np.asarray(lines.width)
    if lines.labels is not None:
        strips["labels"] = list(lines.labels)
    return strips


def _send_arrows(recording: Stream, entity: str, arrows: Arrows, at: Moments) -> None:
    style = {"radii": [-0.5 * arrows.width], "colors": [arrows.color], "draw_order": [arrows.order]}
    recording.log(entity, ARROWS, **style)
    recording.send(entity, at, ARROWS, origins=flip_y(arrows.place), vectors=flip_y(arrows.vector))
