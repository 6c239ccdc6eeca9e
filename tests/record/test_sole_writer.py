"""Runs beside each other into the same folder: a log is whole, and a second writer is refused at once."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import SCENARIOS

from continuum_dyn.record import StreamedLog, read_log
from continuum_dyn.record.datasets import whole_file
from continuum_dyn.record.sole_writer import sole_writer
from statics.errors import LogError

pytestmark = pytest.mark.skipif(os.name != "posix", reason="locks are of another kind there")
STEP = SCENARIOS / "step_response.toml"


def begin(folder: Path, *arguments: object) -> subprocess.Popen[str]:
    command = [
        sys.executable,
        "-m",
        "continuum_dyn",
        "run",
        str(STEP),
        "--out",
        str(folder),
        *map(str, arguments),
    ]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_second_writer_is_refused_at_once_and_the_next_one_is_not(tmp_path: Path) -> None:
    path = tmp_path / "log.h5"
    with StreamedLog(path):
        with (
            pytest.raises(LogError, match=r"log\.h5 is being written by another run.*--out"),
            StreamedLog(path),
        ):
            pass
        with sole_writer(tmp_path / "other.h5"):
            pass
    with StreamedLog(path):
        pass
    assert not list(tmp_path.iterdir())


def test_two_writers_of_a_whole_file_share_no_temporary_name(tmp_path: Path) -> None:
    path = tmp_path / "log.h5"
    with whole_file(path) as first, whole_file(path) as second:
        first["a"], second["b"] = 1, 2
    assert [each.name for each in tmp_path.iterdir()] == ["log.h5"]


def test_lock_of_a_killed_run_is_none(tmp_path: Path) -> None:
    code = "import sys, time; from pathlib import Path\n"
    code += "from continuum_dyn.record.sole_writer import sole_writer\n"
    code += "with sole_writer(Path(sys.argv[1])): print('held', flush=True); time.sleep(60)"
    holder = subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path / "log.h5")], stdout=subprocess.PIPE, text=True
    )
    assert holder.stdout is not None
    assert holder.stdout.readline() == "held\n"
    with pytest.raises(LogError), sole_writer(tmp_path / "log.h5"):
        pass
    holder.kill()
    holder.communicate()
    with sole_writer(tmp_path / "log.h5"):
        pass
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_variants_beside_each_other_leave_a_whole_log_each(tmp_path: Path) -> None:
    changes = [("--set", f"cables.upper.tension.after={tension}") for tension in (0.5, 1.0, 1.5)]
    started = time.monotonic()
    runs = [begin(tmp_path, *change) for change in changes]
    told = [run.communicate()[1] for run in runs]
    assert [run.returncode for run in runs] == [0, 0, 0], told
    logs = [read_log(tmp_path / f"step_response{number}.h5") for number in ("", "_2", "_3")]
    assert all(log.complete for log in logs)
    for _, change in changes:
        assert sum(change in log.title for log in logs) == 1
    assert len(list(tmp_path.iterdir())) == 2 * len(logs)
    assert time.monotonic() - started < 60.0
