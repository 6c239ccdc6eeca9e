"""The walk-through of docs/how_to/own_effect.md, performed on a copy of the program."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import walk_through
from walk_through import PACKAGES, Block, perform

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

ANSWERS = """
import json, sys
from typer.testing import CliRunner
from continuum_dyn import load_scenario
from continuum_dyn.cli import app
from continuum_dyn.modes import modes_at_rest
from statics import Arm
from statics.effects import ElasticFoundation

def printed(*arguments):
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    return result.stdout

scenario, *swinging = sys.argv[1:]
print(json.dumps({
    "run": json.loads(printed("run", "--json", scenario)),
    "explain": printed("explain", scenario),
    "frequencies": [[mode.frequency for mode in modes_at_rest(load_scenario(f)).modes] for f in swinging],
    "quantities": [list(ElasticFoundation(6.0e3).columns(Arm(4, 0.02))), list(ElasticFoundation.quantities)],
}))
"""
"""All that is asked of the program in the copy, in one process."""


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


def said(pattern: str) -> str:
    return walk_through.said(PAGE, pattern)


@pytest.fixture(scope="module")
def answers(program: Path) -> dict[str, Any]:
    moduli = {"without.toml": 0.0, "within.toml": 6.0e3}
    for name, modulus in moduli.items():
        (program / name).write_text(SWINGING.replace("MODULUS", str(modulus)), encoding="utf-8")
    return json.loads(run(program, "-c", ANSWERS, said(r"`continuum-dyn run (\S+)` brings the tip"), *moduli))


def test_effect_takes_one_file_one_registry_line_and_its_glossary_entries() -> None:
    touched = [block for block in blocks() if block.path.startswith(PACKAGES)]
    file, registry, glossary = touched
    assert file.kind != "diff"
    assert registry.path == "statics/effects/__init__.py"
    assert glossary.path == "statics/quantities.py"
    assert [line[0] for line in registry.text.splitlines()] == [" ", "+"]


@pytest.mark.slow
def test_scenario_of_the_walk_through_rests_where_the_page_says(answers: dict[str, Any]) -> None:
    answer = answers["run"]
    deflection = said(r"to rest at y = (\S+) mm")
    assert answer["outcome"] == "completed"
    assert f"{1e3 * answer['tip'][1]:.4f}" == deflection


def test_deflection_without_the_tissue_is_what_the_page_says() -> None:
    """F L^3 / 3EJ, the limit of no foundation, which only the numbers of Table 1 enter."""
    open_air = 1e3 * 0.01 * 0.08**3 / (3 * 2.10e11 * 2.011e-14)
    assert f"{open_air:.4f}" == said(r"\$FL\^3/3EJ\$ = (\S+) mm")


@pytest.mark.slow
def test_checks_of_the_walk_through_pass(program: Path) -> None:
    (check,) = (block.path for block in blocks() if block.path.startswith("tests/"))
    assert "2 passed" in run(program, "-m", "pytest", "-q", "-W", "error", "-p", "no:cacheprovider", check)


@pytest.mark.slow
def test_new_effect_is_explained_as_any_other(answers: dict[str, Any]) -> None:
    text = answers["explain"]
    assert "elastic_foundation on each disk" in text
    assert said(r"shows the pair, (P = \S+) along y") in text
    assert "foundation_stiffness (N/m): force of an elastic foundation on a node" in text


@pytest.mark.slow
def test_new_effect_has_a_value_for_each_of_its_quantities(answers: dict[str, Any]) -> None:
    assert answers["quantities"] == [["foundation_stiffness"]] * 2


@pytest.mark.slow
def test_new_effect_raises_the_squares_of_all_frequencies_by_its_stiffness_over_mass(
    answers: dict[str, Any],
) -> None:
    """M w'' + (K + k l / m M) w = 0: the modes stay, omega^2 grows by k l / m."""
    without, within = np.array(answers["frequencies"])
    found = (2.0 * np.pi * within) ** 2 - (2.0 * np.pi * without) ** 2
    np.testing.assert_allclose(found, 6.0e3 * 0.02 / 8.0e-4, rtol=1e-6)
