"""Random structures, through the commands: named outcomes that their logs bear out, and no traceback."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from random_structures import ALIKE, scenario

from continuum_dyn.scenario_files.tables import ArmTable, CableTable, MaterialDampingTable


def test_scenarios_differ_and_follow_from_their_seed() -> None:
    first, again = ([scenario(0, number) for number in range(50)] for _ in range(2))
    assert first == again
    assert len({drawn.text for drawn in first}) == 50


def test_every_description_of_an_arm_and_its_cables_is_drawn() -> None:
    drawn = [tomllib.loads(scenario(0, number).text) for number in range(0, 2000, ALIKE // 2)]
    arm_keys = {key for content in drawn for key in content["arm"]}
    cable_keys = {key for content in drawn for cable in content.get("cables", []) for key in cable}
    dampings = [content["effects"].get("material_damping", {}) for content in drawn]
    assert {*ArmTable.model_fields} - arm_keys == {"area", "second_moment"}
    assert {*CableTable.model_fields} == cable_keys
    assert {key for damping in dampings for key in damping} == {*MaterialDampingTable.model_fields}


@pytest.mark.slow
def test_hundred_random_structures_go_through_every_command() -> None:
    script = Path(__file__).parents[1] / "tools" / "random_runs.py"
    numbers = ["--seed", "12", "--count", "100", "--step", str(ALIKE + 5)]  # all commands take their turns
    result = subprocess.run([sys.executable, script, *numbers], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    for command in ("run: completed", "plot", "settle", "modes", "play", "compared with another method"):
        assert f"  {command} " in result.stdout
