"""The walk-through of docs/how_to/own_integrator.md, performed on a copy of the program."""

import json
import re
import shlex
from pathlib import Path

import pytest
import walk_through
from conftest import SCENARIOS
from walk_through import COMMAND_LINE, Block, perform

PAGE = walk_through.page("own_integrator.md")
FILE = "continuum_dyn/integrators/rosenbrock.py"


def blocks() -> list[Block]:
    """The class in its file, and the changes to the file that is named last before each."""
    first = re.search(r"^```python\n(.*?)^```$", PAGE, flags=re.DOTALL | re.MULTILINE)
    assert first
    assert f"`{FILE}`" in PAGE
    made = [Block(FILE, "python", first[1])]
    for change in re.finditer(r"^```diff\n(.*?)^```$", PAGE, flags=re.DOTALL | re.MULTILINE):
        path = re.findall(r"`(continuum_dyn/\S+\.py)`", PAGE[: change.start()])[-1]
        made.append(Block(path, "diff", change[1]))
    return made


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the program in which the walk-through has been performed."""
    root = walk_through.copy_of_program(tmp_path_factory.mktemp("program"))
    for block in blocks():
        perform(block, root)
    return root


def test_integrator_takes_a_file_and_changes_to_two() -> None:
    assert len({block.path for block in blocks()}) == 3


@pytest.mark.slow
def test_named_integrator_settles_the_step_response_with_an_error_that_follows_its_tolerance(
    program: Path,
) -> None:
    (command,) = re.findall(r"^    continuum-dyn (run .*)$", PAGE, flags=re.MULTILINE)
    words = [str(SCENARIOS.parent / w) if w.endswith(".toml") else w for w in shlex.split(command)]
    answer = json.loads(walk_through.run(program, *COMMAND_LINE, *words, "--json"))
    assert answer["outcome"] == "settled"
    assert answer["method"] == "Rosenbrock"
    assert answer["static_gap"] < 1e-6
    assert answer["steps"] > 1000  # of second order: "chain" takes a tenth of that
