"""A log that is written while the motion is computed: what is on disk at any moment, and in the end."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import MOTION, SCENARIOS

from continuum_dyn import Run, Scenario, Trajectory, load_scenario, simulate
from continuum_dyn.integrators import Budget
from continuum_dyn.record import Log, StreamedLog, read_log, write_log
from continuum_dyn.record.reading import list_departures
from continuum_dyn.scenario.profiles import Sine, Step
from continuum_dyn.scenario.solver import Accuracy
from continuum_dyn.scenario.studies import MotionStudy
from continuum_dyn.simulation import samples
from statics import Arm, Bending, DiskLoad, DiskLoads, Outcome, Scene
from statics.errors import LogError


@pytest.fixture(autouse=True)
def _told_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every batch of steps is a block, which takes long runs otherwise."""
    monkeypatch.setattr(samples, "INTERVAL", 0.0)


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    """The arm of the step response, driven up and down all the time."""
    given = load_scenario(SCENARIOS / "step_response.toml")
    return replace(given, drives=(Sine(1.0, 0.9, 20.0),), study=MotionStudy(1.0, samples=1501))


class Watched(StreamedLog):
    """What a reader finds on disk after each block."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self.seen: list[Log] = []

    def add(self, block: Trajectory) -> None:
        """Append it, and read."""
        super().add(block)
        self.seen.append(read_log(self.part))


def streamed(scenario: Scenario, path: Path, budget: Budget | None = None) -> tuple[Run, list[Log]]:
    with Watched(path) as sink:
        run = simulate(scenario, budget=budget, sink=sink)
        sink.finish(run)
    return run, sink.seen


def assert_same(found: Log, expected: Log, rows: slice = slice(None)) -> None:
    assert found.trajectory.keys() == expected.trajectory.keys()
    for name, values in expected.trajectory.items():
        cut = values if name in ("segment", "disk", "load") else values[rows]
        np.testing.assert_array_equal(found.trajectory[name], cut, err_msg=name)


def test_every_block_can_be_read_while_the_run_goes_on(scenario: Scenario, tmp_path: Path) -> None:
    _, seen = streamed(scenario, tmp_path / "log.h5")
    whole = read_log(tmp_path / "log.h5")
    rows = [log.trajectory["time"].size for log in seen]
    assert len(rows) > 2
    assert rows == sorted(set(rows))
    for log, count in zip(seen, rows, strict=True):
        assert not log.complete
        assert log.outcome is Outcome.INTERRUPTED
        assert log.scenario == scenario.text
        assert_same(log, whole, slice(0, count))


def test_log_in_the_end_is_the_one_that_is_written_whole(scenario: Scenario, tmp_path: Path) -> None:
    run, _ = streamed(scenario, tmp_path / "log.h5")
    write_log(run, tmp_path / "whole.h5")
    found, whole = read_log(tmp_path / "log.h5"), read_log(tmp_path / "whole.h5")
    assert_same(found, whole)
    assert found.attributes == whole.attributes
    assert found.counters == whole.counters
    for name, values in whole.equilibria.items():
        np.testing.assert_array_equal(found.equilibria[name], values)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["log.h5", "whole.h5"]
    assert (tmp_path / "log.h5").stat().st_size < 2.0 * (tmp_path / "whole.h5").stat().st_size


def test_blocks_of_any_size_make_the_same_log(scenario: Scenario, tmp_path: Path) -> None:
    """Among them whole chunks, parts of one, several at once, and a row."""
    run = simulate(replace(scenario, study=MotionStudy(1.0, samples=3001)))
    assert run.trajectory is not None
    write_log(run, tmp_path / "whole.h5")
    with StreamedLog(tmp_path / "log.h5") as sink:
        sink.begin(replace(run, trajectory=None))
        edges = [0, 1, 511, 512, 1024, 1024 + 700, 1025 + 700, 3000]
        for first, last in pairwise(edges):
            sink.add(run.trajectory.first(last).after(first))
        sink.finish(run)
    assert_same(read_log(tmp_path / "log.h5"), read_log(tmp_path / "whole.h5"))


def test_run_that_is_over_at_once_is_written_whole(
    scenario: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(samples, "INTERVAL", 1e9)
    run, seen = streamed(scenario, tmp_path / "log.h5")
    assert not seen
    assert read_log(tmp_path / "log.h5").outcome is run.outcome


def test_log_is_kept_unfinished_where_the_run_was_left(scenario: Scenario, tmp_path: Path) -> None:
    with StreamedLog(tmp_path / "log.h5") as sink:
        simulate(scenario, sink=sink)
    assert [path.name for path in tmp_path.iterdir()] == ["log.h5.part"]
    assert read_log(tmp_path / "log.h5.part").trajectory["time"].size > 100


def test_trials_for_an_accuracy_end_in_the_log_of_the_one_that_answers(
    scenario: Scenario, tmp_path: Path
) -> None:
    run, _ = streamed(replace(scenario, accuracy=Accuracy(1e-6)), tmp_path / "log.h5")
    assert run.trajectory is not None
    assert run.solver is not None
    found = read_log(tmp_path / "log.h5")
    np.testing.assert_array_equal(found.trajectory["disk_y"], run.trajectory.disk_y)
    assert found.attributes["rtol"] == run.solver.rtol
    assert found.complete


def test_numbers_that_are_not_finite_reach_no_log(scenario: Scenario, tmp_path: Path) -> None:
    run = simulate(scenario)
    assert run.trajectory is not None
    with StreamedLog(tmp_path / "log.h5") as sink:
        sink.begin(run)
        sink.add(run.trajectory.first(100))
        with pytest.raises(LogError, match="disk_y"):
            sink.add(replace(run.trajectory, disk_y=np.nan * run.trajectory.disk_y).after(100))
    assert read_log(tmp_path / "log.h5.part").trajectory["time"].size == 100


def test_folder_that_is_gone_is_told(scenario: Scenario, tmp_path: Path) -> None:
    with StreamedLog(tmp_path / "none" / "log.h5") as sink, pytest.raises(LogError, match="No such file"):
        simulate(scenario, sink=sink)


def test_unfinished_log_opens_in_plain_h5py_as_one_that_is_written(
    scenario: Scenario, tmp_path: Path
) -> None:
    with StreamedLog(tmp_path / "log.h5") as sink:
        simulate(scenario, sink=sink)
    with h5py.File(tmp_path / "log.h5.part", "r") as file:
        assert file["trajectory/disk_y"].shape[1] == 4


@pytest.mark.parametrize("loads", [(), (Step(1.0, 0.0),)])
def test_motion_without_cables_is_logged_as_one_with_cables(loads: tuple[Step, ...], tmp_path: Path) -> None:
    """Its datasets have an axis of no cables, which no chunk may be larger than."""
    effects = (Bending(), DiskLoads((DiskLoad(4, (0.0, 0.02), driven=bool(loads)),)), *MOTION)
    scene = Scene(Arm.preset("rone2012"), effects)
    scenario = Scenario(scene, (), MotionStudy(0.5, samples=1501), load_factors=loads)
    run, seen = streamed(scenario, tmp_path / "log.h5")
    write_log(run, tmp_path / "whole.h5")
    assert seen
    assert seen[-1].trajectory["tension"].shape == (seen[-1].trajectory["time"].size, 0)
    assert_same(read_log(tmp_path / "log.h5"), read_log(tmp_path / "whole.h5"))
    assert list_departures(tmp_path / "log.h5") == []
