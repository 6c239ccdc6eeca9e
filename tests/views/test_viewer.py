"""Rerun's viewer, in a window and in a browser, draws what it is given, or why it cannot is told."""

import io
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import logged
from logs_by_hand import motion_log
from matplotlib.image import imread
from rerun.chunk import RrdReader
from viewers import Chromium, ended_after, headless_viewer, needs_chromium, needs_vulkan, until, web_playback

from continuum_dyn.views.playback import viewer
from continuum_dyn.views.playback.recording import save
from statics.errors import LogError

SCENES = ("length_driven", "shaken_base", "shaken_tip", "tension_ramp")
"""With slack cables, a base that moves, loads, and equilibria alone."""
MOMENTS = (0.1, 0.6, 1.0)
"""Parts of the time line that are looked at."""


def is_drawn(picture: bytes) -> bool:
    """Whether a picture has white grounds, and the colours of a curvature on them."""
    pixels = np.round(255.0 * imread(io.BytesIO(picture))[..., :3]).astype(int)
    red = (pixels[..., 0] - pixels[..., 2] > 60) & (pixels[..., 0] > 150)
    white = (pixels == 255).all(axis=-1)
    return bool(white.mean() > 0.3 and red.mean() > 0.005)


def test_the_viewer_is_given_the_recording(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    copy = tmp_path / "copy.rrd"
    program = f"import shutil, sys; shutil.copy(sys.argv[-1], {str(copy)!r})"
    monkeypatch.setattr(viewer, "VIEWER", (sys.executable, "-c", program))
    viewer.show([motion_log()])
    assert RrdReader(copy).recordings()


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        ((sys.executable, "-c", "import sys; sys.exit('no display')"), "no display"),
        (("/no/viewer",), "start"),
    ],
)
def test_a_viewer_that_cannot_run_is_an_error(
    monkeypatch: pytest.MonkeyPatch, command: tuple[str, ...], reason: str
) -> None:
    monkeypatch.setattr(viewer, "VIEWER", command)
    with pytest.raises(LogError, match=reason):
        viewer.show([motion_log()])
    with pytest.raises(LogError, match=reason):
        viewer.serve([motion_log()], print)


def test_the_viewer_of_this_environment_answers() -> None:
    answer = subprocess.run([*viewer.VIEWER, "--version"], capture_output=True, text=True, check=True)
    assert "0.41" in answer.stdout


@pytest.mark.slow
@needs_vulkan
@pytest.mark.parametrize(
    "names", [*((name,) for name in SCENES), ("step_response", "step_response_in_water")], ids="_and_".join
)
def test_rerun_draws_every_view_without_trouble(names: tuple[str, ...], tmp_path: Path) -> None:
    recording = tmp_path / "playback.rrd"
    save([logged(name, tmp_path) for name in names], recording)
    with headless_viewer(recording, tmp_path) as client:
        line = next(t for t in client.get_state().recordings[0].timelines if t.name in ("sim_time", "point"))
        assert line.start is not None
        assert line.end is not None
        for part in MOMENTS:
            moment = round(line.start + part * (line.end - line.start))
            place: dict[str, Any] = (
                {"sequence": moment} if line.name == "point" else {"duration": moment / 1e9}
            )
            client.set_time(line.name, **place)
            until(lambda: is_drawn(client.take_screenshot()), "picture")
            views = client.get_state().views
            assert len(views) >= 5
            assert [(view.name, report) for view in views for report in view.reports] == []
        troubles = [entry for entry in client.get_logs() if entry.level != "INFO"]
        assert [entry.message for entry in troubles if "oftware rasterizer" not in entry.message] == []


@pytest.mark.slow
@needs_chromium
def test_chromium_draws_what_play_web_serves_to_this_computer_alone(tmp_path: Path) -> None:
    with web_playback(logged("step_response", tmp_path).path, tmp_path) as (address, listening):
        assert address.startswith("http://127.0.0.1:")
        assert listening == {"127.0.0.1"}
        browser = Chromium(tmp_path)
        with ended_after(browser.process), closing(browser):
            browser.open(address)
            until(lambda: is_drawn(browser.picture()), "picture")
            time.sleep(1.0)
            assert is_drawn(browser.picture())
            assert browser.complaints == []
