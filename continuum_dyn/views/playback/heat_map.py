"""Curvature over segment and time as a picture in the colours of the arm, with its axes."""

import numpy as np
import rerun as rr

from continuum_dyn.views.playback.colors import BLACK, GREY, diverging
from continuum_dyn.views.playback.drawing import Drawn, Lines, every_frame
from continuum_dyn.views.playback.measures import Measures
from continuum_dyn.views.playback.story import Story

WIDTH, HEIGHT = 900, 300
"""Of the picture, pixels."""
BOTTOM, TOP = -float(HEIGHT), 0.0
"""Rerun's pictures hang down from the origin."""
SHOWN = ((-110.0, WIDTH + 50.0), (BOTTOM - 60.0, TOP + 20.0))
"""What the view shows: from left to right, from bottom to top."""
MOST_TICKS = 5


def picture(story: Story, measures: Measures) -> np.ndarray:
    """Red, green, blue of each pixel, shape (HEIGHT, WIDTH, 3): time to the right, segments upwards."""
    segments = story.columns["curvature"].shape[1]
    halfway = 0.5 * (story.times[1:] + story.times[:-1])
    rows = np.searchsorted(halfway, _time_at(story, np.arange(WIDTH) + 0.5))
    segment = (np.arange(HEIGHT)[::-1] * segments) // HEIGHT
    return diverging(story.columns["curvature"][np.ix_(rows, segment)].swapaxes(0, 1), measures.curvature)


def axes(story: Story) -> dict[str, Drawn]:
    """Ticks with what they stand for."""
    frame = np.array([[[0.0, BOTTOM], [WIDTH, BOTTOM], [WIDTH, TOP], [0.0, TOP], [0.0, BOTTOM]]])
    return {
        "time_axis": _time_axis(story),
        "segment_axis": _segment_axis(story.columns["curvature"].shape[1]),
        "frame": Lines(frame, GREY, 1.0, 3.0),
    }


def _time_axis(story: Story) -> Lines:
    marks = story.times[0] + np.ptp(story.times) * np.linspace(0.0, 1.0, MOST_TICKS)
    marks = marks if story.moves else np.unique(marks.round())
    labels = [f"{mark:.4g} s" if story.moves else f"{mark:.0f}" for mark in marks]
    labels[0] = ("time " if story.moves else "point ") + labels[0]
    x = _place_of(story, marks)
    strips = np.stack(
        [np.stack([x, x], axis=-1), np.tile([BOTTOM - 10.0, BOTTOM - 50.0], (len(x), 1))], axis=-1
    )
    return Lines(strips, BLACK, 0.0, 2.0, labels=labels)


def _segment_axis(segments: int) -> Lines:
    numbers = np.arange(1, segments + 1, -(-segments // MOST_TICKS))
    y = BOTTOM + (numbers - 0.5) * HEIGHT / segments
    strips = np.stack([np.tile([-100.0, 0.0], (len(y), 1)), np.stack([y, y], axis=-1)], axis=-1)
    return Lines(strips, BLACK, 0.0, 2.0, labels=[f"segment {number}" for number in numbers])


def cursor(story: Story, rows: np.ndarray) -> Lines:
    """The moment that is shown beside it."""
    x = _place_of(story, story.times[rows])
    strips = np.stack([np.stack([x, x], axis=-1), np.tile([BOTTOM, TOP], (len(x), 1))], axis=-1)
    return Lines(**every_frame(strips[:, None]), color=BLACK, width=1.5, order=5.0)


def send_picture(recording: rr.RecordingStream, entity: str, pixels: np.ndarray) -> None:
    """Put the picture behind its axes."""
    recording.log(entity, rr.Image(pixels, draw_order=1.0), static=True)


def _time_at(story: Story, x: np.ndarray) -> np.ndarray:
    return story.times[0] + np.ptp(story.times) * x / WIDTH


def _place_of(story: Story, times: np.ndarray) -> np.ndarray:
    return WIDTH * (times - story.times[0]) / (np.ptp(story.times) or 1.0)
