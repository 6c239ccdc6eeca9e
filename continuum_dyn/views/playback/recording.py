"""Logs as a recording for rerun.

Positions become float32 and long motions are thinned out, so the log stays the truth.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from uuid import uuid4

import numpy as np
import rerun_bindings as core

from continuum_dyn.record import Log
from continuum_dyn.record.sole_writer import temporary_name
from continuum_dyn.views.playback import heat_map, plots
from continuum_dyn.views.playback.about import about, ending
from continuum_dyn.views.playback.arm import moving_parts, still_parts
from continuum_dyn.views.playback.blueprint import blueprint, words_alone
from continuum_dyn.views.playback.drawing import Drawn, moments, send
from continuum_dyn.views.playback.legend import legend
from continuum_dyn.views.playback.measures import Measures, measures_of
from continuum_dyn.views.playback.playback import Playback, names_of, playback_of
from continuum_dyn.views.rerun_core.stream import Stream, content
from statics.errors import InputError, LogError
from statics.support.interruption import defer_interruption
from statics.support.plain_text import plain_line

APPLICATION = "continuum-dyn"


def save(logs: Sequence[Log], path: Path) -> None:
    """Write logs as one recording (.rrd): several are shown in one view, aligned in time.

    The recording of a log without any pose says how the run ended. Raises ``LogError`` if the file cannot
    be written, and then nothing is left behind; ``InputError`` for logs that cannot be shown together.
    """
    recorded = record_logs(logs)
    part = temporary_name(path)
    with defer_interruption():
        try:
            part.write_bytes(recorded)
            part.replace(path)
        except OSError as error:
            raise LogError(f"cannot write the recording {path}: {error.strerror or error}.") from error
        finally:
            with suppress(OSError):
                part.unlink()


def record_logs(logs: Sequence[Log]) -> bytes:
    """The recording's content. Raises ``InputError`` for logs that cannot be shown together."""
    recording = Stream(core.new_recording(APPLICATION, uuid4().hex, False, False))
    try:
        return _content(recording, logs)
    finally:
        core.disconnect(recording.native)  # rerun keeps what was sent for as long as anything may take it
        del recording
        core.flush_and_cleanup_orphaned_recordings()


def _content(recording: Stream, logs: Sequence[Log]) -> bytes:
    memory = content(recording)  # its file sink waits for ever on a full disk (0.41)
    core.send_recording_name(
        plain_line(" and ".join(log.title or log.path.stem for log in logs)), recording.native
    )
    told = [
        playback_of(log, name, rank)
        for rank, (log, name) in enumerate(zip(logs, names_of(logs), strict=True))
    ]
    playbacks = [playback for playback in told if playback is not None]
    if len(playbacks) == len(logs):
        _check_alike(playbacks)
        _send_playbacks(recording, playbacks)
    else:
        words = "\n\n".join(ending(log) for log, playback in zip(logs, told, strict=True) if playback is None)
        recording.log("outcome", "archetypes.TextDocument", text=[words])
        words_alone("outcome").send(recording)
    return memory.drain_as_bytes()


def _check_alike(playbacks: Sequence[Playback]) -> None:
    for playback in playbacks[1:]:
        if playback.timeline != playbacks[0].timeline:
            moving, still = (playback, playbacks[0]) if playback.moves else (playbacks[0], playback)
            raise InputError(
                f"{moving.log.path} is a motion and {still.log.path} a sequence of equilibria: they have no "
                "time in common. Give logs of one kind."
            )


def send_playback(recording: Stream, playback: Playback) -> None:
    """Send the playback of one run, with its layout."""
    _send_playbacks(recording, [playback])


def _send_playbacks(recording: Stream, playbacks: Sequence[Playback]) -> None:
    measures = measures_of(playbacks)
    drawn, plotted = {}, {}
    for playback in playbacks:
        drawn |= send_rows(recording, playback, measures, playback.frames, playback.samples)
        for name, plot in plots.plots_of(playback).items():
            plotted.setdefault(name, []).append(plot)
    drawn |= send_beside(recording, playbacks, measures, drawn)
    # It becomes the active layout: bounds and ranges of the logs before would not fit these.
    blueprint(playbacks, drawn, plotted).send(recording)


def send_rows(
    recording: Stream,
    playback: Playback,
    measures: Measures,
    frames: np.ndarray,
    samples: np.ndarray,
) -> dict[str, Drawn]:
    """Send what changes with time, drawn at rows ``frames``, plotted at ``samples``; return the drawn."""
    moving = moving_parts(playback, frames, measures)
    for entity, part in (
        moving | {playback.at("curvature", "now"): heat_map.cursor(playback, frames)}
    ).items():
        send(recording, entity, part, moments(playback, frames))
    for name, plot in plots.plots_of(playback).items():
        entity = "/".join(filter(None, ("series", name, playback.name)))
        plots.send_style(recording, entity, playback, plot)
        plots.send_values(recording, entity, playback, plot, samples)
    return moving


def send_beside(
    recording: Stream,
    playbacks: Sequence[Playback],
    measures: Measures,
    drawn: Mapping[str, Drawn],
) -> dict[str, Drawn]:
    """Send parts that do not change, with the legend of all that is drawn; return the drawn."""
    still: dict[str, Drawn] = {}
    for playback in playbacks:
        still |= still_parts(playback)
        picture = heat_map.picture(playback, measures)
        heat_map.send_picture(recording, playback.at("curvature", "picture"), picture)
        for name, part in heat_map.axes(playback).items():
            send(recording, playback.at("curvature", name), part)
        words, kind = [about(playback)], ["text/markdown"]
        recording.log(playback.at("about"), "archetypes.TextDocument", text=words, media_type=kind)
    still |= legend({**drawn, **still}, playbacks, measures)
    for entity, part in still.items():
        send(recording, entity, part)
    return still
