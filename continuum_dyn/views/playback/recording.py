"""Logs as a recording for rerun.

Positions become float32 and long motions are thinned out, so the log stays the truth.
"""

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import rerun as rr

from continuum_dyn.record import Log
from continuum_dyn.views.playback import heat_map, plots
from continuum_dyn.views.playback.about import about, ending
from continuum_dyn.views.playback.arm import moving_parts, still_parts
from continuum_dyn.views.playback.blueprint import blueprint, words_alone
from continuum_dyn.views.playback.drawing import send, when
from continuum_dyn.views.playback.legend import legend
from continuum_dyn.views.playback.measures import Measures, measures_of
from continuum_dyn.views.playback.story import Story, names_of, story_of
from statics.errors import InputError, LogError
from statics.interruption import held

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


def _send_stories(recording: rr.RecordingStream, stories: Sequence[Story]) -> None:
    measures = measures_of(stories)
    drawn, plotted = {}, {}
    for story in stories:
        moving = moving_parts(story, story.frames, measures)
        for entity, part in moving.items():
            send(recording, entity, part, when(story, story.frames))
        drawn |= moving | still_parts(story)
        for name, plot in plots.plots_of(story).items():
            plotted.setdefault(name, []).append(plot)
            entity = f"series/{name}/{story.name}".rstrip("/")
            plots.send_style(recording, entity, story, plot)
            plots.send_values(recording, entity, story, plot, story.samples)
        _send_beside(recording, story, measures)
    drawn |= legend(drawn, stories, measures)
    for entity, part in drawn.items():
        if getattr(part, "counts", 0) is None:
            send(recording, entity, part, when(stories[0], stories[0].frames[:1]))
    # It becomes the active layout: bounds and ranges of the logs before would not fit these.
    recording.send_blueprint(blueprint(stories, drawn, plotted))


def _send_beside(recording: rr.RecordingStream, story: Story, measures: Measures) -> None:
    """The picture of the curvature, and the words."""
    at = when(story, story.frames)
    heat_map.send_picture(recording, story.at("curvature", "picture"), heat_map.picture(story, measures))
    for name, part in heat_map.axes(story).items():
        send(recording, story.at("curvature", name), part, at)
    send(recording, story.at("curvature", "now"), heat_map.cursor(story, story.frames), at)
    recording.log(story.at("about"), rr.TextDocument(about(story), media_type="text/markdown"), static=True)
