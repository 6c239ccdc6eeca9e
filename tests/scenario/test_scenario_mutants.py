"""Scenario files mutated at random: refused with words, or run to a named outcome."""

import subprocess
import sys
import tomllib
from pathlib import Path
from random import Random

import pytest
from conftest import SCENARIOS
from scenario_mutants import mutant, written

from continuum_dyn import load_scenario

TEXTS = [path.read_text() for path in sorted(SCENARIOS.glob("*.toml"))]


def fuzz(count: int) -> subprocess.CompletedProcess[str]:
    """In a process of its own, whose memory is bounded."""
    script = Path(__file__).parents[1] / "tools" / "fuzz.py"
    command = [sys.executable, script, "--count", str(count), "--seed", "7"]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("count", [50, pytest.param(10_000, marks=pytest.mark.slow)])
def test_mutants_are_refused_with_words_or_run_to_a_named_outcome(count: int) -> None:
    result = fuzz(count)
    assert result.returncode == 0, result.stdout + result.stderr
    assert "refused" in result.stdout
    assert "run: " in result.stdout


def test_mutants_differ_and_follow_from_their_seed() -> None:
    first, again = ([mutant(Random(f"0 {n}"), TEXTS) for n in range(50)] for _ in range(2))
    assert first == again
    assert len(set(first)) > 45


def test_unchanged_tables_load_as_their_text_does(tmp_path: Path) -> None:
    """So a mutant is refused for what was changed, not for how it was written."""
    path = tmp_path / "scenario.toml"
    path.write_text(written(tomllib.loads((SCENARIOS / "step_response.toml").read_text())))
    assert load_scenario(path).scene == load_scenario(SCENARIOS / "step_response.toml").scene
