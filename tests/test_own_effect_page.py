"""The walk-through of docs/how_to/own_effect.md, performed on a copy of the program."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

REPOSITORY = Path(__file__).parents[1]
PAGE = (REPOSITORY / "docs" / "how_to" / "own_effect.md").read_text(encoding="utf-8")
PACKAGES = "statics", "continuum_dyn"

SWINGING = """
[arm]
preset = "rone2012"
disk_mass = [8.0e-4, 8.0e-4, 8.0e-4, 4.0e-4]

[effects]
bending = {}
inertia = {}
elastic_foundation = { foundation_modulus = MODULUS }

[study]
kind = "motion"
duration = 1.0
"""
"""Masses as the lengths of core that disks stand for: then all are held alike for their mass."""

FREQUENCIES = """
import json, sys
from continuum_dyn import load_scenario
from continuum_dyn.modes import modes_at_rest
print(json.dumps([[mode.frequency for mode in modes_at_rest(load_scenario(f)).modes] for f in sys.argv[1:]]))
"""

QUANTITIES = """
from statics import Arm
from statics.effects import ElasticFoundation
print(set(ElasticFoundation(6.0e3).columns(Arm(4, 0.02))), set(ElasticFoundation.quantities))
"""


class Block(NamedTuple):
    """A block of the page: a whole file, or a ``diff`` of lines to add to one."""

    path: str
    kind: str
    text: str


def blocks() -> list[Block]:
    """In the page's order; a block's file is the one named where its step begins, in bold."""
    steps = re.findall(r"^\*\*\d\. .*?`(\S+?)`.*?^```(\w+)\n(.*?)^```$", PAGE, flags=re.DOTALL | re.MULTILINE)
    return [Block(*step) for step in steps]


def perform(block: Block, root: Path) -> None:
    """Write the block's file, or add its lines below the one line that it shows of the file."""
    file = root / block.path
    if block.kind != "diff":
        assert not file.exists(), f"{block.path} is to be new"
        file.parent.mkdir(exist_ok=True)
        file.write_text(block.text, encoding="utf-8")
        return
    lines = block.text.splitlines(keepends=True)
    before = "".join(line[1:] for line in lines if line[0] == " ")
    after = "".join(line[1:] for line in lines if line[0] in " +")
    text = file.read_text(encoding="utf-8")
    assert text.count(before) == 1, f"{block.path} does not have, once: {before}"
    file.write_text(text.replace(before, after), encoding="utf-8")


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the program in which the walk-through has been performed."""
    root = tmp_path_factory.mktemp("program")
    for package in PACKAGES:
        shutil.copytree(REPOSITORY / package, root / package, ignore=shutil.ignore_patterns("__pycache__"))
    for block in blocks():
        perform(block, root)
    return root


def run(program: Path, *arguments: str) -> str:
    """What Python prints in the copy, its kernels interpreted and kept apart."""
    own = {
        "PYTHONPATH": str(program),
        "CONTINUUM_DYN_CACHE": str(program / "kernels"),
        "NUMBA_DISABLE_JIT": "1",
    }
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=program,
        env=os.environ | own,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def command_line(program: Path, *arguments: str) -> str:
    return run(program, "-c", "from continuum_dyn.cli import main; main()", *arguments)


def said(pattern: str) -> str:
    """What the page says where the pattern's group stands; wherever its lines break."""
    found = re.search(pattern, " ".join(PAGE.split()))
    assert found, f"the page does not say: {pattern}"
    return found.group(1)


def test_effect_takes_one_file_one_registry_line_and_its_glossary_entries() -> None:
    touched = [block for block in blocks() if block.path.startswith(PACKAGES)]
    file, registry, glossary = touched
    assert file.kind != "diff"
    assert registry.path == "statics/effects/__init__.py"
    assert glossary.path == "statics/quantities.py"
    assert [line[0] for line in registry.text.splitlines()] == [" ", "+"]


def test_scenario_of_the_walk_through_rests_where_the_page_says(program: Path) -> None:
    scenario = said(r"`continuum-dyn run (\S+)` brings the tip")
    answer = json.loads(command_line(program, "run", "--json", scenario))
    deflection = said(r"to rest at y = (\S+) mm")
    assert answer["outcome"] == "completed"
    assert f"{1e3 * answer['tip'][1]:.4f}" == deflection


def test_deflection_without_the_tissue_is_what_the_page_says() -> None:
    """F L^3 / 3EJ, the limit of no foundation, which only the numbers of Table 1 enter."""
    open_air = 1e3 * 0.01 * 0.08**3 / (3 * 2.10e11 * 2.011e-14)
    assert f"{open_air:.4f}" == said(r"\$FL\^3/3EJ\$ = (\S+) mm")


def test_checks_of_the_walk_through_pass(program: Path) -> None:
    (check,) = (block.path for block in blocks() if block.path.startswith("tests/"))
    assert "2 passed" in run(program, "-m", "pytest", "-q", "-W", "error", "-p", "no:cacheprovider", check)


def test_new_effect_is_explained_as_any_other(program: Path) -> None:
    text = command_line(program, "explain", said(r"`continuum-dyn run (\S+)` brings the tip"))
    assert "elastic_foundation on each disk" in text
    assert said(r"shows the pair, (P = \S+) along y") in text
    assert "foundation_stiffness (N/m): force of an elastic foundation on a node" in text


def test_new_effect_has_a_value_for_each_of_its_quantities(program: Path) -> None:
    assert run(program, "-c", QUANTITIES).split() == ["{'foundation_stiffness'}"] * 2


def test_new_effect_raises_the_squares_of_all_frequencies_by_its_stiffness_over_mass(program: Path) -> None:
    """M w'' + (K + k l / m M) w = 0: the modes stay, omega^2 grows by k l / m."""
    moduli = {"without.toml": 0.0, "within.toml": 6.0e3}
    for name, modulus in moduli.items():
        (program / name).write_text(SWINGING.replace("MODULUS", str(modulus)), encoding="utf-8")
    without, within = np.array(json.loads(run(program, "-c", FREQUENCIES, *moduli)))
    found = (2.0 * np.pi * within) ** 2 - (2.0 * np.pi * without) ** 2
    np.testing.assert_allclose(found, 6.0e3 * 0.02 / 8.0e-4, rtol=1e-6)
