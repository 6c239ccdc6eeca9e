"""Lines and arrows in a plane, as data, and how they are sent to a recording."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import rerun as rr

from continuum_dyn.views.playback.playback import Playback


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
        return np.array([drawn.strips.min(axis=(0, 1)), drawn.strips.max(axis=(0, 1))])
    ends = np.concatenate([drawn.place, drawn.place + drawn.vector])
    return np.array([ends.min(axis=0), ends.max(axis=0)])


def time_column(playback: Playback, rows: np.ndarray) -> rr.TimeColumn:
    """The positions of those rows on the time line."""
    times = playback.times[rows]
    if playback.moves:
        # rerun truncates seconds given as floats, so they are rounded to ns here.
        return rr.TimeColumn(playback.timeline, duration=np.round(1e9 * times).astype("timedelta64[ns]"))
    return rr.TimeColumn(playback.timeline, sequence=times)


def flip_y(points: np.ndarray) -> np.ndarray:
    """Negate y: a 2D view of rerun has y pointing down and cannot flip it (0.41)."""
    return points * np.array([1.0, -1.0])


def send(recording: rr.RecordingStream, entity: str, drawn: Drawn, at: rr.TimeColumn | None = None) -> None:
    """Send a drawing, each frame at its time; without times it never changes."""
    if at is None:
        assert isinstance(drawn, Lines)
        recording.log(entity, rr.LineStrips2D.from_fields(**_style(drawn), **_strips(drawn)), static=True)
    elif isinstance(drawn, Arrows):
        _send_arrows(recording, entity, drawn, at)
    else:
        assert drawn.counts is not None
        recording.log(entity, rr.LineStrips2D.from_fields(**_style(drawn)), static=True)
        columns = rr.LineStrips2D.columns(**_strips(drawn)).partition(drawn.counts)
        recording.send_columns(entity, [at], columns)


def _style(lines: Lines) -> dict[str, Any]:
    """The style that all strips share."""
    style: dict[str, Any] = {"draw_order": lines.order}
    if lines.labels is not None:
        style["show_labels"] = True
    if np.ndim(lines.color) == 0:
        style["colors"] = np.array([lines.color], dtype=np.uint32)
    if np.ndim(lines.width) == 0:
        style["radii"] = rr.Radius.ui_points(0.5 * float(lines.width))
    return style


def _strips(lines: Lines) -> dict[str, Any]:
    """The strips, with their own colours, widths and labels."""
    strips: dict[str, Any] = {"strips": flip_y(lines.strips)}
    if np.ndim(lines.color):
        strips["colors"] = np.asarray(lines.color, dtype=np.uint32)
    if np.ndim(lines.width):
        strips["radii"] = -0.5 * np.asarray(lines.width)  # negative radii are points of the screen
    if lines.labels is not None:
        strips["labels"] = list(lines.labels)
    return strips


def _send_arrows(recording: rr.RecordingStream, entity: str, arrows: Arrows, at: rr.TimeColumn) -> None:
    style = rr.Arrows2D.from_fields(
        radii=rr.Radius.ui_points(0.5 * arrows.width),
        colors=np.array([arrows.color], dtype=np.uint32),
        draw_order=arrows.order,
    )
    recording.log(entity, style, static=True)
    columns = rr.Arrows2D.columns(origins=flip_y(arrows.place), vectors=flip_y(arrows.vector))
    recording.send_columns(entity, [at], columns)
