"""The same scenario driven faster or slower."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENARIOS, edited

from continuum_dyn import load_scenario
from continuum_dyn.answers.pace import at_pace
from continuum_dyn.scenario.intervals import cut_into_intervals
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.studies import MotionStudy
from statics import InputError

TIMES = np.array([0.0, 0.013, 0.05, 0.1, 0.17, 0.31, 0.4999])


def inputs(scenario: Scenario, time: np.ndarray) -> np.ndarray:
    assert isinstance(scenario.study, MotionStudy)
    return cut_into_intervals(scenario.profiles, scenario.study.duration).inputs(time)


@pytest.mark.parametrize(
    "profile",
    [
        '"constant", value = 1.0',
        '"step", before = 0.0, after = 1.0, at = 0.15',
        '"ramp", before = 0.0, after = 1.0, start = 0.1, end = 0.3',
        '"smooth_ramp", before = 0.0, after = 1.0, start = 0.1, end = 0.3',
        '"sine", mean = 1.0, amplitude = 0.5, frequency = 3.0, phase = 0.2',
        '"table", file = "table.csv"',
    ],
)
def test_inputs_are_those_of_the_slower_one_at_a_later_time(profile: str, tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text("time,tension\n0.1,0\n0.3,2\n0.4,1\n")
    old = '"step", before = 0.0, after = 1.0'
    scenario = edited(SCENARIOS / "step_response.toml", tmp_path, (old, profile))
    np.testing.assert_allclose(
        inputs(at_pace(scenario, 2.0), TIMES), inputs(scenario, 2.0 * TIMES), atol=1e-12
    )


def test_base_moves_faster_too() -> None:
    scenario = load_scenario(SCENARIOS / "shaken_base.toml")
    faster = at_pace(scenario, 2.0)
    pose = [number for number, name in enumerate(scenario.scene.inputs) if name in ("base_x", "base_y")]
    times = 0.25 * TIMES
    np.testing.assert_allclose(
        inputs(faster, times)[:, pose], inputs(scenario, 2.0 * times)[:, pose], atol=1e-12
    )
    assert isinstance(faster.study, MotionStudy)
    assert replace(faster.study, duration=2.0 * faster.study.duration) == scenario.study


def test_ramp_of_equilibria_has_no_pace() -> None:
    with pytest.raises(InputError, match="only a motion can be run at other rates"):
        at_pace(load_scenario(SCENARIOS / "tension_ramp.toml"), 2.0)
