"""Shows a log while it is written, in a separate process that reads the file and never the run.

``python -m continuum_dyn.views.playback.live LOG.h5 SINCE`` follows the log that is written since then (s, as
of ``time.time``), in rerun's window, until it is complete or the process that started this one has ended.
"""

import os
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np
import rerun as rr

from continuum_dyn.record import Log, read_log
from continuum_dyn.record.log_format import UNFINISHED
from continuum_dyn.views.playback.blueprint import blueprint
from continuum_dyn.views.playback.drawing import Drawn
from continuum_dyn.views.playback.measures import measures_of
from continuum_dyn.views.playback.playback import MOST_FRAMES, Playback, playback_of
from continuum_dyn.views.playback.plots import plots_of
from continuum_dyn.views.playback.recording import APPLICATION, send_beside, send_playback, send_rows
from continuum_dyn.views.playback.viewer import LOOPBACK, VIEWER, environment, free_ports
from continuum_dyn.views.rerun_core.stream import Stream
from statics.errors import LogError
from statics.support.plain_text import plain_line

INTERVAL = 0.5
"""Shortest time between two readings of the log, s."""
FLUSH_TIME = 20.0
"""Longest time for sent data to arrive, s."""
SHARE = 0.03
"""Largest part of the time for reading and sending."""


class Follower:
    """Sends a log's new rows to a recording, and all of them again once it is complete."""

    def __init__(self, recording: rr.RecordingStream) -> None:
        self.recording = Stream(recording.to_native())
        self.rows = 0
        self.complete = False

    def show(self, log: Log) -> None:
        """A complete log is the last one: colours and ranges are then those of the whole."""
        playback = playback_of(log)
        self.complete = log.complete
        if playback is not None and log.complete:
            send_playback(self.recording, playback)
        elif playback is not None and len(playback.times) > self.rows:
            self._add(playback)

    def _add(self, playback: Playback) -> None:
        new = np.arange(self.rows, len(playback.times))
        measures = measures_of([playback])
        frames = new[new % _stride(playback) == 0]
        drawn: dict[str, Drawn] = {}
        if frames.size:
            drawn = send_rows(self.recording, playback, measures, frames, new)
        drawn |= send_beside(self.recording, [playback], measures, drawn)
        if self.rows == 0:
            plots = {name: [plot] for name, plot in plots_of(playback).items()}
            blueprint([playback], drawn, plots, growing=True).send(self.recording)
        self.rows = len(playback.times)


def _stride(playback: Playback) -> int:
    """Samples from one frame to the next, so that the whole motion has no more frames than are played."""
    samples = getattr(playback.scenario.study, "samples", 1) if playback.scenario is not None else 1
    return -(-samples // MOST_FRAMES)


def follow(path: Path, since: float, follower: Follower, goes_on: Callable[[], bool]) -> None:
    """Show the log at ``path`` as it grows until it is complete, or once more when nothing ``goes_on``."""
    while not follower.complete:
        last = not goes_on()
        started = time.perf_counter()
        log = _latest(path, since)
        if log is not None:
            follower.show(log)
        if last:
            return
        _pause((time.perf_counter() - started) / SHARE, lambda: goes_on() and not _is_new(path, since))


def _pause(seconds: float, may_last: Callable[[], bool]) -> None:
    """Wait for that time (s), but no longer than ``may_last`` holds."""
    until = time.monotonic() + seconds
    time.sleep(INTERVAL)
    while time.monotonic() < until and may_last():
        time.sleep(INTERVAL)


def _is_new(path: Path, since: float) -> bool:
    try:
        return path.stat().st_mtime >= since
    except OSError:
        return False


def _latest(path: Path, since: float) -> Log | None:
    """The log written since then, finished or not; None if none can be read yet."""
    for candidate in (path, path.with_name(path.name + UNFINISHED)):
        with suppress(LogError):  # just being made or moved: the next look finds it
            if _is_new(candidate, since):
                return read_log(candidate)
    return None


def start(path: Path) -> subprocess.Popen[bytes]:
    """Follow the log that is about to be written at ``path``, in a process that outlives this one."""
    command = [sys.executable, "-m", __name__, str(path), repr(time.time())]
    return subprocess.Popen(command, start_new_session=True)


def main() -> None:
    """Open the viewer, and follow."""
    path, since = Path(sys.argv[1]), float(sys.argv[2])
    parent, (port,) = os.getppid(), free_ports(1)
    viewer = subprocess.Popen(
        [*VIEWER, "--port", str(port)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=environment(),
    )
    recording = rr.RecordingStream(APPLICATION)
    recording.connect_grpc(f"rerun+http://{LOOPBACK}:{port}/proxy")
    recording.send_recording_name(plain_line(path.stem))
    follow(path, since, Follower(recording), lambda: os.getppid() == parent and viewer.poll() is None)
    if viewer.poll() is None:
        recording.flush(timeout_sec=FLUSH_TIME)
    elif viewer.returncode:
        sys.exit("the rerun viewer cannot start; the run continues without it.")


if __name__ == "__main__":
    main()
