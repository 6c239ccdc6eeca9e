"""Logs from elsewhere: spoiled at random they are refused, or read as the data that they are."""

import os
import subprocess
import sys
from pathlib import Path

import log_mutants
import pytest
from log_mutants import originals, try_mutant

pytestmark = [
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads each in a process with bounds"),
    pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning"),
]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[list[bytes], Path]:
    folder = tmp_path_factory.mktemp("mutants")
    return originals(folder), folder


def test_spoiled_logs_are_read_or_refused_and_nothing_else_happens(made: tuple[list[bytes], Path]) -> None:
    logs, folder = made
    for number in range(20):
        assert try_mutant(logs, folder, f"0 {number}") in ("read", "refused"), f"seed '0 {number}'"


@pytest.mark.slow
def test_many_spoiled_logs_are_read_or_refused_and_nothing_else_happens() -> None:
    """In a process that holds little else: each is read in a copy of it."""
    command = [sys.executable, log_mutants.__file__, "--first", "20", "--count", "1980"]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "1980 mutants" in done.stdout
