"""Pictures of a playback: rerun's viewer, without a window, asked for what it shows at some times.

It draws by software where there is no graphics card (Debian: mesa-vulkan-drivers, libgl1-mesa-dri and
libxkbcommon-x11-0).
"""

import io
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic, sleep

import matplotlib.image
import numpy as np
import psutil
from matplotlib.figure import Figure
from rerun.experimental import ViewerClient

from continuum_dyn.record import read_log
from continuum_dyn.views.playback import recording
from continuum_dyn.views.playback.viewer import LOOPBACK, VIEWER, free_ports

START_TIME = 30.0
"""Longest time until the viewer answers, s."""
NOTICE_TIME = 8.0
"""Time after which the viewer's notices about graphics are gone, s."""
SMALL, LARGE = "1000x700", "1920x1080"
"""Sizes of the window: letters can be read in a frame of the filmstrip, and the whole on a page."""
DRAWING_TIME = 1.0
"""What the viewer is given for drawing a moment, s."""


def playback_pictures(log: Path, times: Sequence[float]) -> tuple[Figure, Figure]:
    """The arm at those times (s) of a log as a filmstrip, and the viewer's whole window at the third."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "playback.rrd"
        recording.save([read_log(log)], path)
        with viewer_of(path, SMALL) as viewer:
            arm = next(view.view_id for view in viewer.get_state().views if view.origin == "/arm")
            frames = [picture(viewer, time, arm) for time in times]
        with viewer_of(path, LARGE) as viewer:
            sleep(NOTICE_TIME)
            window = picture(viewer, times[2], None)
    return filmstrip(frames, times), framed(window)


@contextmanager
def viewer_of(path: Path, size: str) -> Iterator[ViewerClient]:
    """A viewer without a window, of that size in pixels, that has the recording open."""
    (port,) = free_ports(1)
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    process = subprocess.Popen(
        [*VIEWER, "--headless", "--window-size", size, "--port", str(port), str(path)], **quiet
    )
    try:
        yield connected(port)
    finally:
        for each in (*psutil.Process(process.pid).children(recursive=True), process):
            each.terminate()
        process.wait()


def connected(port: int) -> ViewerClient:
    """The viewer on that port, once it has drawn its views."""
    until = monotonic() + START_TIME
    while monotonic() < until:
        try:
            viewer = ViewerClient.connect(f"rerun+http://{LOOPBACK}:{port}/proxy")
            if viewer.get_state().views:
                return viewer
        except Exception:  # whatever it raises while it starts
            sleep(0.2)
    raise RuntimeError(f"the viewer did not answer within {START_TIME:g} s")


def picture(viewer: ViewerClient, time: float, view: str | None) -> np.ndarray:
    """What the viewer shows at that time (s): one of its views, or all."""
    viewer.set_time(duration=time, play_state="paused")
    sleep(DRAWING_TIME)
    return matplotlib.image.imread(io.BytesIO(viewer.take_screenshot(view)))


def filmstrip(frames: Sequence[np.ndarray], times: Sequence[float]) -> Figure:
    """The frames in rows of three, each with its time above it."""
    height, width, _ = frames[0].shape
    rows = -(-len(frames) // 3)
    figure = Figure(figsize=(10.0, rows * (10.0 / 3.0 * height / width + 0.25)), layout="constrained")
    for axes, frame, time in zip(figure.subplots(rows, 3).flat, frames, times, strict=True):
        axes.imshow(frame)
        axes.set_title(f"{time:g} s", fontsize=9)
        axes.set_xticks([])
        axes.set_yticks([])
    return figure


def framed(window: np.ndarray) -> Figure:
    """The window alone, on a figure of its shape."""
    height, width, _ = window.shape
    figure = Figure(figsize=(10.0, 10.0 * height / width))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.imshow(window)
    axes.set_axis_off()
    return figure
