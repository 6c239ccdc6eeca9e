"""The walk-through of docs/how_to/own_effect.md, performed on a copy of the program."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
import walk_through
from walk_through import COMMAND_LINE, PACKAGES, Block, perform

PAGE = walk_through.page("own_effect.md")

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


def blocks() -> list[Block]:
    """In the page's order; a block's file is the one named where its step begins, in bold."""
    steps = re.findall(r"^\*\*\d\. .*?`(\S+?)`.*?^```(\w+)\n(.*?)^```$", PAGE, flags=re.DOTALL | re.MULTILINE)
    return [Block(*step) for step in steps]


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the program in which the walk-through has been performed."""
    root = walk_through.copy_of_program(tmp_path_factory.mktemp("program"))
    for block in blocks():
        perform(block, root)
    return root


def run(program: Path, *arguments: str) -> str:
    """What Python prints in the copy, its kernels kept apart."""
    kernels = str(program / "kernels")
    return walk_through.run(program, *arguments, CONTINUUM_DYN_CACHE=kernels)


def command_line(program: Path, *arguments: str) -> str:
    return run(program, *COMMAND_LINE, *arguments)


def said(pattern: str) -> str:
    return walk_through.said(PAGE, pattern)


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
