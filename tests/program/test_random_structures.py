"""Random structures, through the commands: named outcomes that their logs bear out, and no traceback."""

import subprocess
import sys
from pathlib import Path

import pytest
from random_structures import ALIKE, scenario


def test_scenarios_differ_and_follow_from_their_seed() -> None:
    first, again = ([scenario(0, number) for number in range(50)] for _ in range(2))
    assert first == again
    assert len({drawn.text for drawn in first}) == 50


@pytest.mark.slow
def test_hundred_random_structures_go_through_every_command() -> None:
    script = Path(__file__).parents[1] / "tools" / "random_runs.py"
    numbers = ["--seed", "12", "--count", "100", "--step", str(ALIKE + 5)]  # all commands take their turns
    result = subprocess.run([sys.executable, script, *numbers], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    for command in ("run: completed", "plot", "settle", "modes", "play", "compared with another method"):
        assert f"  {command} " in result.stdout
