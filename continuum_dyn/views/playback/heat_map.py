"""Curvature over segment and time as a picture in the colours of the arm, with its axes."""

import numpy as np

from continuum_dyn.views.playback.colors import BLACK, GREY, diverging
from continuum_dyn.views.playback.drawing import Drawn, Lines, every_frame
from continuum_dyn.views.playback.measures import Measures
from continuum_dyn.views.playback.playback import Playback
from continuum_dyn.views.rerun_core.stream import Stream

WIDTH, HEIGHT = 900, 300
"""Width and height of the picture, pixels."""
BOTTOM, TOP = -float(HEIGHT), 0.0
"""Rerun draws pictures downwards from the origin."""
SHOWN = ((-150.0, WIDTH + 50.0), (BOTTOM - 60.0, TOP + 20.0))
"""Ranges of the view: from left to right, from bottom to top."""
MOST_TICKS = 5
RED_GREEN_BLUE, BYTES = 2, 6
"""A pixel's format, by rerun's number."""


def picture(playback: Playback, measures: Measures) -> np.ndarray:
    """Red, green, blue of each pixel, shape (HEIGHT, WIDTH, 3): time to the right, segments upwards."""
    segments = playback.columns["curvature"].shape[1]
    halfway = 0.5 * (playback.times[1:] + playback.times[:-1])
    rows = np.searchsorted(halfway, _time_at(playback, np.arange(WIDTH) + 0.5))
    shown, segment = np.unique((np.arange(HEIGHT)[::-1] * segments) // HEIGHT, return_inverse=True)
    colors = diverging(playback.columns["curvature"][np.ix_(rows, shown)].T, measures.curvature)
    return colors[segment]


def axes(playback: Playback) -> dict[str, Drawn]:
    """Ticks and their labels."""
    frame = np.array([[[0.0, BOTTOM], [WIDTH, BOTTOM], [WIDTH, TOP], [0.0, TOP], [0.0, BOTTOM]]])
    return {
        "time_axis": _time_axis(playback),
        "segment_axis": _segment_axis(playback.columns["curvature"].shape[1]),
        "frame": Lines(frame, GREY, 1.0, 3.0),
    }


def _time_axis(playback: Playback) -> Lines:
    marks = playback.times[0] + np.ptp(playback.times) * np.linspace(0.0, 1.0, MOST_TICKS)
    marks = marks if playback.moves else np.unique(marks.round())
    labels = [f"{mark:.4g} s" if playback.moves else f"{mark:.0f}" for mark in marks]
    labels[0] = ("time " if playback.moves else "point ") + labels[0]
    x = _place_of(playback, marks)
    strips = np.stack(
        [np.stack([x, x], axis=-1), np.tile([BOTTOM - 10.0, BOTTOM - 50.0], (len(x), 1))], axis=-1
    )
    return Lines(strips, BLACK, 0.0, 2.0, labels=labels)


def _segment_axis(segments: int) -> Lines:
    numbers = np.arange(1, segments + 1, -(-segments // MOST_TICKS))
    labels = [f"segment {numbers[0]}", *map(str, numbers[1:])]
    y = BOTTOM + (numbers - 0.5) * HEIGHT / segments
    strips = np.stack([np.tile([-140.0, 0.0], (len(y), 1)), np.stack([y, y], axis=-1)], axis=-1)
    return Lines(strips, BLACK, 0.0, 2.0, labels=labels)


def cursor(playback: Playback, rows: np.ndarray) -> Lines:
    """A line at the moment that the arm is shown at."""
    x = _place_of(playback, playback.times[rows])
    strips = np.stack([np.stack([x, x], axis=-1), np.tile([BOTTOM, TOP], (len(x), 1))], axis=-1)
    return Lines(**every_frame(strips[:, None]), color=BLACK, width=1.5, order=5.0)


def send_picture(recording: Stream, entity: str, pixels: np.ndarray) -> None:
    """Put the picture behind its axes."""
    height, width, _ = pixels.shape
    form = {"width": [width], "height": [height], "pixel_format": None}
    form |= {"color_model": [RED_GREEN_BLUE], "channel_datatype": [BYTES]}
    recording.log(entity, "archetypes.Image", buffer=pixels.reshape(1, -1), format=form, draw_order=[1.0])


def _time_at(playback: Playback, x: np.ndarray) -> np.ndarray:
    return playback.times[0] + np.ptp(playback.times) * x / WIDTH


def _place_of(playback: Playback, times: np.ndarray) -> np.ndarray:
    return WIDTH * (times - playback.times[0]) / (np.ptp(playback.times) or 1.0)
