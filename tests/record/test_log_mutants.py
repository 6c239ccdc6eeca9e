"""Logs from elsewhere: spoiled at random they are refused, or read as the data that they are."""

import sys
from pathlib import Path

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


@pytest.mark.parametrize("tens", [0, *(pytest.param(n, marks=pytest.mark.slow) for n in range(1, 100))])
def test_spoiled_logs_are_read_or_refused_and_nothing_else_happens(
    made: tuple[list[bytes], Path], tens: int
) -> None:
    logs, folder = made
    for number in range(20 * tens, 20 * tens + 20):
        assert try_mutant(logs, folder, f"0 {number}") in ("read", "refused"), f"seed '0 {number}'"
