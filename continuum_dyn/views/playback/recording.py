"""Logs as a recording for rerun.

Positions become float32 and long motions are thinned out, so the log stays the truth.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
import rerun as rr

from continuum_dyn.record import Log
from continuum_dyn.views.playback import heat_map, plots
from continuum_dyn.views.playback.about import about, ending
from continuum_dyn.views.playback.arm import moving_parts, still_parts
from continuum_dyn.views.playback.blueprint import blueprint, words_alone
from continuum_dyn.views.playback.drawing import Drawn, send, when
from continuum_dyn.views.playback.legend import legend
from continuum_dyn.views.playback.measures import Measures, measures_of
from continuum_dyn.views.playback.story import Story, names_of, story_of
from statics.errors import InputError, LogError
from statics.support.interruption import held

APPLICATION = "continuum-dyn"


def save(logs: Sequence[Log], path: Path) -> None:
    """Write logs as one recording (.rrd): several are shown in one view, aligned in time.

    The recording of a log without any pose says how the run ended. Raises ``LogError`` if the file cannot
    be written, and then nothing is left behind; ``InputError`` for logs that cannot be shown together.
    """
    content = recorded(logs)
    part = path.with_name(path.name + ".part")
    with held():
        try:
            part.write_bytes(content)
            part.replace(path)
        except OSError as error:
            raise LogError(f"cannot write the recording {path}: {error.strerror or error}.") from error
        finally:
            with suppress(OSError):
                part.unlink()


def recorded(logs: Sequence[Log]) -> bytes:
    """The recording's content. Raises ``InputError`` for logs that cannot be shown together."""
    rr.set_strict_mode(True)  # otherwise bad data only warns, and leaves an empty column
    recording = rr.RecordingStream(APPLICATION)
    memory = recording.memory_recording()  # its file sink waits for ever on a full disk (0.41)
    recording.send_recording_name(" and ".join(log.title or log.path.stem for log in logs))
    told = [
        story_of(log, name, rank) for rank, (log, name) in enumerate(zip(logs, names_of(logs), strict=True))
    ]
    stories = [story for story in told if story is not None]
    if len(stories) == len(logs):
        _check_alike(stories)
        _send_stories(recording, stories)
    else:
        words = "\n\n".join(ending(log) for log, story in zip(logs, told, strict=True) if story is None)
        recording.log("outcome", rr.TextDocument(words), static=True)
        recording.send_blueprint(words_alone("outcome"))
    return memory.drain_as_bytes()


def _check_alike(stories: Sequence[Story]) -> None:
    for story in stories[1:]:
        if story.timeline != stories[0].timeline:
            moving, still = (story, stories[0]) if story.moves else (stories[0], story)
            raise InputError(
                f"{moving.log.path} is a motion and {still.log.path} a sequence of equilibria: they have no "
                "time in common. Give logs of one kind."
            )


def send_story(recording: rr.RecordingStream, story: Story) -> None:
    """Send all that is told of one run, with its layout."""
    _send_stories(recording, [story])


def _send_stories(recording: rr.RecordingStream, stories: Sequence[Story]) -> None:
    measures = measures_of(stories)
    drawn, plotted = {}, {}
    for story in stories:
        drawn |= send_rows(recording, story, measures, story.frames, story.samples)
        for name, plot in plots.plots_of(story).items():
            plotted.setdefault(name, []).append(plot)
    drawn |= send_beside(recording, stories, measures, drawn)
    # It becomes the active layout: bounds and ranges of the logs before would not fit these.
    recording.send_blueprint(blueprint(stories, drawn, plotted))


def send_rows(
    recording: rr.RecordingStream, story: Story, measures: Measures, frames: np.ndarray, samples: np.ndarray
) -> dict[str, Drawn]:
    """Send what changes with time: drawn at the rows ``frames``, plotted at ``samples``; what is drawn."""
    moving = moving_parts(story, frames, measures)
    for entity, part in (moving | {story.at("curvature", "now"): heat_map.cursor(story, frames)}).items():
        send(recording, entity, part, when(story, frames))
    for name, plot in plots.plots_of(story).items():
        entity = "/".join(filter(None, ("series", name, story.name)))
        plots.send_style(recording, entity, story, plot)
        plots.send_values(recording, entity, story, plot, samples)
    return moving


def send_beside(
    recording: rr.RecordingStream, stories: Sequence[Story], measures: Measures, drawn: Mapping[str, Drawn]
) -> dict[str, Drawn]:
    """Send what stays beside it, with the legend of what is drawn; what is drawn of it."""
    still: dict[str, Drawn] = {}
    for story in stories:
        still |= still_parts(story)
        picture = heat_map.picture(story, measures)
        heat_map.send_picture(recording, story.at("curvature", "picture"), picture)
        for name, part in heat_map.axes(story).items():
            send(recording, story.at("curvature", name), part)
        words = rr.TextDocument(about(story), media_type="text/markdown")
        recording.log(story.at("about"), words, static=True)
    still |= legend({**drawn, **still}, stories, measures)
    for entity, part in still.items():
        send(recording, entity, part)
    return still
