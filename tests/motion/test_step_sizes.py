"""A motion tells at each sample how large a step its integrator took there."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import SCENARIOS, motion

from continuum_dyn import load_scenario
from continuum_dyn.scenario.studies import MotionStudy

INTERVALS = 4000
DURATION = 0.1


@pytest.mark.parametrize("method", ["chain", "Radau"])
def test_samples_of_one_step_size_fill_a_whole_number_of_such_steps(method: str) -> None:
    scenario = load_scenario(SCENARIOS / "step_response.toml")
    study = MotionStudy(DURATION, samples=INTERVALS + 1)
    solver = replace(scenario.solver, method=method, rtol=1e-3, atol=1e-6)
    found = motion(replace(scenario, study=study, solver=solver))
    assert found.step_size[0] == 0.0
    size, apart = found.step_size[1:], DURATION / INTERVALS
    starts = np.flatnonzero(np.append(True, size[1:] != size[:-1]))
    lasts = apart * np.diff(np.append(starts, INTERVALS))
    seen = size[starts] > 5.0 * apart  # of shorter ones too little is seen between samples
    steps = lasts[seen] / size[starts][seen]
    assert len(steps) > 10
    assert np.abs(steps - steps.round()).max() < 0.21
    assert round(steps.sum()) <= found.counters["steps"]
