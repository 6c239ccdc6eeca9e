"""What a run leaves that is killed at a random moment, or whose disk is full: all that was flushed."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from random import Random

import numpy as np
import pytest
from conftest import SCENARIOS

from continuum_dyn import Run, load_scenario, simulate
from continuum_dyn.record import Log, StreamedLog, read_log
from continuum_dyn.record.log_format import GROUPS, UNFINISHED
from continuum_dyn.scenario.profiles import Sine
from continuum_dyn.scenario.studies import MotionStudy
from statics.errors import LogError

pytestmark = pytest.mark.skipif(os.name != "posix", reason="sends SIGKILL")

MOMENTS = 100


@pytest.fixture(scope="module")
def run() -> Run:
    given = load_scenario(SCENARIOS / "step_response.toml")
    return simulate(replace(given, drives=(Sine(1.0, 0.9, 20.0),), study=MotionStudy(1.0, samples=6001)))


def write(run: Run, path: Path, rng: Random, told: int) -> None:
    """Log a run in blocks of random sizes, and tell after each how many samples are flushed."""
    assert run.trajectory is not None
    with StreamedLog(path) as sink:
        sink.begin(replace(run, trajectory=None))
        done = 0
        while done < run.trajectory.time.size - 100:
            size = rng.choice([1, 50, 300, 512, 1000])
            sink.add(run.trajectory.first(done + size).after(done))
            done = min(done + size, run.trajectory.time.size)
            os.write(told, f"{done}\n".encode())
        sink.finish(run)


def writing_child(run: Run, path: Path, rng: Random) -> tuple[int, int]:
    """Process that writes, and the file descriptor on which it tells; it ends without a word to pytest."""
    read, told = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.close(read)
            write(run, path, rng, told)
        finally:
            os._exit(0)
    os.close(told)
    return child, read


def last_told(read: int) -> int:
    """Samples that were flushed for certain."""
    with os.fdopen(read) as told:
        lines = told.read().split("\n")
    return int(lines[-2]) if len(lines) > 1 else 0


def left(path: Path) -> Log | None:
    """The log, or the unfinished one, or None where there is neither."""
    for each in (path, path.with_name(path.name + UNFINISHED)):
        if each.exists():
            return read_log(each)
    return None


def assert_intact(found: Log, run: Run, rows: int) -> None:
    """It has that many samples at least, and all that it has are the run's."""
    assert run.trajectory is not None
    count = found.trajectory["time"].size
    assert count >= rows
    for name, values in found.trajectory.items():
        if GROUPS["trajectory"][name].dimensions[0] == "time":
            expected = getattr(run.trajectory, name, run.trajectory.ledger.get(name))
            assert expected is not None
            np.testing.assert_array_equal(values, expected[:count], err_msg=name)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_all_that_was_flushed_is_there_after_kill_at_100_random_moments(run: Run, tmp_path: Path) -> None:
    started = time.monotonic()
    child, read = writing_child(run, tmp_path / "whole.h5", Random(0))
    os.waitpid(child, 0)
    assert last_told(read) > 5000
    longest = time.monotonic() - started
    ended = []
    for number in range(MOMENTS):
        rng, path = Random(number), tmp_path / f"{number}.h5"
        child, read = writing_child(run, path, rng)
        time.sleep(rng.uniform(0.0, longest))
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        flushed, found = last_told(read), left(path)
        ended.append("nothing" if found is None else "complete" if found.complete else "unfinished")
        if found is None:
            assert flushed == 0
        else:
            assert_intact(found, run, flushed)
    assert ended.count("unfinished") > MOMENTS / 10


def long_motion(folder: Path) -> Path:
    """A motion that takes some seconds to compute."""
    text = (SCENARIOS / "step_response.toml").read_text()
    drive = '"sine", mean = 1.0, amplitude = 0.9, frequency = 20.0'
    text = text.replace('"step", before = 0.0, after = 1.0', drive).replace(
        "samples = 1001", "samples = 10001"
    )
    path = folder / "long.toml"
    path.write_text(text.replace("duration = 1.0", "duration = 1000.0"))
    return path


def program(*arguments: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", "from continuum_dyn.cli import main; main()", *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.fixture(scope="module")
def unbroken(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """The same, never broken off."""
    return simulate(load_scenario(long_motion(tmp_path_factory.mktemp("unbroken"))))


@pytest.mark.slow
@pytest.mark.parametrize("number", range(2))
def test_killed_run_is_resumed_to_the_answer_of_an_unbroken_one(
    number: int, unbroken: Run, tmp_path: Path
) -> None:
    scenario, part = long_motion(tmp_path), tmp_path / "long.h5.part"
    process = program("run", str(scenario), "--json", "--out", str(tmp_path))
    while not part.exists():
        assert process.poll() is None
        time.sleep(0.01)
    time.sleep(Random(number).uniform(0.0, 0.5))
    process.kill()
    process.communicate()
    assert not (tmp_path / "long.h5").exists()
    rows = read_log(part).trajectory["time"].size
    assert 1 <= rows < 10001
    resumed = program("resume", str(part), "--json")
    _, errors = resumed.communicate(timeout=300)
    assert errors == ""
    assert not part.exists()
    found = read_log(tmp_path / "long.h5")
    assert unbroken.trajectory is not None
    assert found.outcome is unbroken.outcome
    np.testing.assert_array_equal(found.trajectory["time"], unbroken.trajectory.time)
    apart = np.hypot(
        *(
            found.trajectory[name][:, -1] - getattr(unbroken.trajectory, name)[:, -1]
            for name in ("disk_x", "disk_y")
        )
    )
    assert apart.max() < 5e-7  # m, of 0.08; about the error of either


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system of 1 MB."""
    folder = tmp_path / "small"
    folder.mkdir()
    if not sys.platform.startswith("linux") or os.geteuid() != 0 or shutil.which("mount") is None:
        pytest.skip("needs root on Linux to mount a small file system")
    mount = ["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", str(folder)]
    if subprocess.run(mount, capture_output=True, check=False).returncode != 0:
        pytest.skip("a tmpfs cannot be mounted here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


@pytest.mark.parametrize("size", [1, 100, 512, 700])
def test_full_disk_is_told_and_what_was_flushed_is_there(run: Run, small_disk: Path, size: int) -> None:
    assert run.trajectory is not None
    done = 0
    with StreamedLog(small_disk / "log.h5") as sink:
        sink.begin(replace(run, trajectory=None))
        sink.add(run.trajectory.first(1500))
        done = 1500
        with pytest.raises(LogError, match=r"No space left on device.*resume .*log\.h5\.part"):  # noqa: PT012
            while True:
                sink.add(run.trajectory.first(done + size).after(done))
                done += size
    assert [path.name for path in small_disk.iterdir()] == ["log.h5.part"]
    found = read_log(small_disk / "log.h5.part")
    assert_intact(found, run, done)


def test_disk_that_is_full_at_the_end_keeps_the_unfinished_log(run: Run, small_disk: Path) -> None:
    assert run.trajectory is not None
    with StreamedLog(small_disk / "log.h5") as sink:
        sink.begin(replace(run, trajectory=None))
        sink.add(run.trajectory.first(1500))
        with pytest.raises(LogError, match="No space left on device"):
            sink.finish(run)
    assert [path.name for path in small_disk.iterdir()] == ["log.h5.part"]
    assert_intact(read_log(small_disk / "log.h5.part"), run, 1500)


def test_disk_that_is_full_at_first_is_told(run: Run, small_disk: Path) -> None:
    (small_disk / "other").write_bytes(bytes(1_000_000))
    with StreamedLog(small_disk / "log.h5") as sink:
        sink.begin(replace(run, trajectory=None))
        with pytest.raises(LogError, match="No space left on device"):
            sink.add(run.trajectory)  # pyright: ignore[reportArgumentType]
    assert [path.name for path in small_disk.iterdir()] == ["other"]


@pytest.mark.parametrize("size", ["300k", "500k"])
def test_disk_that_is_full_before_a_short_run_is_logged_is_told(small_disk: Path, size: str) -> None:
    """Not even room for the log, or room for it but not for its recording."""
    subprocess.run(["mount", "-o", f"remount,size={size}", str(small_disk)], check=True)
    command = [sys.executable, "-m", "continuum_dyn", "run", str(SCENARIOS / "step_response.toml")]
    result = subprocess.run([*command, "--out", str(small_disk)], capture_output=True, text=True, check=False)
    assert result.returncode == 2, result.stderr
    assert "No space left on device" in result.stderr
    assert len(result.stderr.splitlines()) == 1
    assert [path.name for path in small_disk.iterdir()] == ([] if size == "300k" else ["step_response.h5"])
