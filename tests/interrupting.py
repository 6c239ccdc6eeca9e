"""Runs in a process of their own, interrupted after some time as by Ctrl-C."""

import os
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from continuum_dyn.record import Log, read_log

PROGRAM = "from continuum_dyn.cli import main; print('started', flush=True); main()"


@dataclass(frozen=True)
class Interrupted:
    """What an interrupted run left: ``log`` is None where there is none."""

    status: int
    errors: str
    log: Log | None
    left_over: list[str]


def interrupted(scenario: Path, folder: Path, after: float, *options: str) -> Interrupted:
    """Run a scenario into a new folder, and interrupt it ``after`` s from the start of the program."""
    temporary = folder / "temporary"
    temporary.mkdir(parents=True)
    command = [sys.executable, "-c", PROGRAM, *options, "run", str(scenario), "--json", "--out", str(folder)]
    process = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "TMPDIR": str(temporary)},
    )
    assert process.stdout is not None
    process.stdout.readline()
    time.sleep(after)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=120)
    path = folder / f"{scenario.stem}.h5"
    expected = {path.name, f"{scenario.stem}.rrd", temporary.name}
    left = [each.name for each in folder.iterdir() if each.name not in expected]
    left += [each.name for each in temporary.iterdir()]
    return Interrupted(process.returncode, errors, read_log(path) if path.exists() else None, left)
