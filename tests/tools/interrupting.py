"""Runs in a process of their own, interrupted as by Ctrl-C: after some time, or at some place."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

from continuum_dyn.record import Log, read_log

PROGRAM = """
import signal
from continuum_dyn import __main__

def first(*arguments):
    signal.signal = set_handler
    set_handler(*arguments)
    print("started", flush=True)

set_handler, signal.signal = signal.signal, first
__main__.main()
"""
PROGRAM_THAT_TELLS = """
import sys
from interrupting import at_call
at_call(sys.argv.pop(1), int(sys.argv.pop(1)), lambda: print("started", flush=True), setattr)
from continuum_dyn import __main__
__main__.main()
"""


@dataclass(frozen=True)
class Interrupted:
    """What an interrupted run left: ``log`` is None where there is none; ``seconds`` from its start on."""

    status: int
    errors: str
    log: Log | None
    left_over: list[str]
    seconds: float


def interrupted(
    scenario: Path, folder: Path, *options: str, after: float = 0.0, place: str | None = None, call: int = 1
) -> Interrupted:
    """Run a scenario into a new folder, and interrupt it ``after`` s (``inf``: never).

    The seconds count from where the program first heeds Ctrl-C, or from where the ``call`` of that number
    begins of the function at ``place``, ``module:name``.
    """
    temporary = folder / "temporary"
    temporary.mkdir(parents=True)
    program = ["-c", PROGRAM] if place is None else ["-c", PROGRAM_THAT_TELLS, place, str(call)]
    process = subprocess.Popen(
        [sys.executable, *program, *options, "run", str(scenario), "--json", "--out", str(folder)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "TMPDIR": str(temporary), "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert process.stdout is not None
    process.stdout.readline()
    started = time.monotonic()
    if after < float("inf"):
        time.sleep(after)
        process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=300)
    seconds = time.monotonic() - started
    path = folder / f"{scenario.stem}.h5"
    log = read_log(path) if path.exists() else None
    return Interrupted(process.returncode, errors, log, left_over(folder, scenario), seconds)


def left_over(folder: Path, scenario: Path) -> list[str]:
    """What is in the folder of the logs beside those, and in its folder of temporary files."""
    expected = {f"{scenario.stem}.h5", f"{scenario.stem}.rrd", "temporary"}
    left = [path.name for path in folder.iterdir() if path.name not in expected]
    temporary = folder / "temporary"
    return left + ([path.name for path in temporary.iterdir()] if temporary.exists() else [])


def at_call(
    place: str, number: int, do: Callable[[], None], replace: Callable[[Any, str, Any], None]
) -> None:
    """Let a function or method, ``module:name``, ``do`` something as its call of that number begins."""
    module, _, name = place.partition(":")
    owner, _, attribute = name.rpartition(".")
    owner = resolve_name(f"{module}:{owner}" if owner else module)
    original, calls = getattr(owner, attribute), 0

    def watched(*arguments: Any, **options: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls == number:
            do()
        return original(*arguments, **options)

    replace(owner, attribute, watched)
