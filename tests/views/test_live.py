"""A log is followed while it grows: from what is on disk, and whole in the end."""

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import rerun as rr
from logs_by_hand import motion_log
from playback_entities import entities_of

from continuum_dyn.record import Log
from continuum_dyn.views.playback import live
from continuum_dyn.views.playback.live import Follower, follow

SAMPLES = 40


def grown(rows: int, complete: bool = False) -> Log:
    """The log of a motion after so many samples."""
    log = motion_log(SAMPLES, tension=np.linspace(0.0, 1.0, SAMPLES)[:, None])
    trajectory = {name: values[:rows] for name, values in log.trajectory.items()}
    return replace(log, trajectory=trajectory, complete=complete)


def shown(folder: Path, *logs: Log) -> dict[str, dict[str, list]]:
    recording = rr.RecordingStream("test")
    memory = recording.memory_recording()
    follower = Follower(recording)
    for log in logs:
        follower.show(log)
    assert follower.complete == logs[-1].complete
    (folder / "live.rrd").write_bytes(memory.drain_as_bytes())
    return entities_of(folder / "live.rrd")


def test_each_sample_is_sent_once_while_the_log_grows(tmp_path: Path) -> None:
    entities = shown(tmp_path, grown(0), grown(3), grown(3), grown(10))
    tension = np.ravel(entities["/series/tension"]["Scalars:scalars"])
    np.testing.assert_array_equal(tension, grown(10).trajectory["tension"][:, 0])
    assert len(entities["/arm/rim"]["LineStrips2D:strips"]) == 10


def test_a_complete_log_is_sent_whole(tmp_path: Path) -> None:
    entities = shown(tmp_path, grown(10), grown(SAMPLES, complete=True))
    time = np.array(entities["/series/tension"]["sim_time"], dtype="timedelta64[ns]").astype(float) * 1e-9
    found = dict(zip(time.round(5), np.ravel(entities["/series/tension"]["Scalars:scalars"]), strict=True))
    whole = grown(SAMPLES).trajectory
    assert found == dict(zip(whole["time"].round(5), whole["tension"][:, 0], strict=True))


def test_log_is_followed_until_it_is_complete(monkeypatch: pytest.MonkeyPatch) -> None:
    found = iter([None, grown(5), grown(20), grown(SAMPLES, complete=True), grown(0)])
    seen: list[Log] = []
    monkeypatch.setattr(live, "_latest", lambda _path, _since: next(found))
    monkeypatch.setattr(live, "_pause", lambda *_: None)
    monkeypatch.setattr(Follower, "show", lambda self, log: (seen.append(log), _note(self, log)))
    follow(Path("log.h5"), 0.0, Follower(rr.RecordingStream("test")), lambda: True)
    assert [log.trajectory["time"].size for log in seen] == [5, 20, SAMPLES]


def _note(follower: Follower, log: Log) -> None:
    follower.complete = log.complete


def test_log_of_a_run_that_ended_otherwise_is_looked_at_once_more(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[Log] = []
    monkeypatch.setattr(live, "_latest", lambda _path, _since: grown(5))
    monkeypatch.setattr(Follower, "show", lambda _self, log: seen.append(log))
    follow(Path("log.h5"), 0.0, Follower(rr.RecordingStream("test")), lambda: False)
    assert len(seen) == 1


def test_log_of_an_earlier_run_is_not_shown(tmp_path: Path) -> None:
    (tmp_path / "log.h5").touch()
    assert live._latest(tmp_path / "log.h5", time.time() + 60.0) is None
