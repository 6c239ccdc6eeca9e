"""Accuracy asked for in metres: the true error is below it, and not far below."""

from dataclasses import replace
from itertools import product
from pathlib import Path

import pytest
from conftest import SCENARIOS, motion

from continuum_dyn import load_scenario, simulate
from continuum_dyn.integrators import Budget
from continuum_dyn.scenario.solver import Accuracy, Method, Solver
from continuum_dyn.scenario.studies import MotionStudy
from continuum_dyn.simulation.accuracy import LOOSEST, tip_distance
from statics import InputError, Outcome

TIGHT = Solver("chain", rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize(
    ("name", "tip"),
    [
        *product(("step_response", "step_response_light_damping"), (1e-4, 1e-6, 1e-8)),
        ("slow_ramp", 1e-6),
        *(pytest.param("slow_ramp", tip, marks=pytest.mark.slow) for tip in (1e-4, 1e-8)),
        *(pytest.param("antagonistic", tip, marks=pytest.mark.slow) for tip in (1e-4, 1e-6, 1e-8)),
    ],
)
def test_true_error_is_below_what_was_asked_and_not_far_below(name: str, tip: float) -> None:
    scenario = load_scenario(SCENARIOS / f"{name}.toml")
    run = simulate(replace(scenario, accuracy=Accuracy(tip)))
    assert run.trajectory is not None
    assert run.solver is not None
    true_error = tip_distance(run.trajectory, motion(replace(scenario, solver=TIGHT)))
    assert true_error < tip
    assert true_error > tip / 30 or run.solver.rtol == LOOSEST
    assert run.tip_error == pytest.approx(true_error, rel=0.5)


@pytest.mark.parametrize("method", ["LSODA", "Radau"])
def test_scipys_methods_are_held_to_the_accuracy_as_well(method: Method) -> None:
    scenario = load_scenario(SCENARIOS / "step_response.toml")
    scenario = replace(scenario, study=MotionStudy(0.2, samples=201))
    run = simulate(replace(scenario, solver=Solver(method), accuracy=Accuracy(1e-6)))
    assert run.trajectory is not None
    assert tip_distance(run.trajectory, motion(replace(scenario, solver=TIGHT))) < 1e-6


def test_accuracy_below_rounding_ends_with_what_was_reached() -> None:
    scenario = load_scenario(SCENARIOS / "step_response.toml")
    run = simulate(replace(scenario, accuracy=Accuracy(1e-16)))
    assert run.outcome is Outcome.SETTLED
    assert "not reached" in run.message
    assert run.tip_error is not None
    assert 1e-16 < run.tip_error < 1e-10


def test_tolerances_beside_an_accuracy_are_refused(tmp_path: Path) -> None:
    text = (SCENARIOS / "step_response.toml").read_text()
    path = tmp_path / "scenario.toml"
    path.write_text(text + "\n[accuracy]\ntip = 1e-6\n")
    assert load_scenario(path).accuracy == Accuracy(1e-6)
    path.write_text(text + "\n[accuracy]\ntip = 1e-6\n[solver]\nrtol = 1e-6\n")
    with pytest.raises(InputError, match="rtol beside"):
        load_scenario(path)


def test_accuracy_of_an_equilibrium_is_refused() -> None:
    scenario = load_scenario(SCENARIOS / "unactuated.toml")
    with pytest.raises(InputError, match="study of motion"):
        replace(scenario, accuracy=Accuracy(1e-6))


def test_estimate_is_the_distance_of_two_solutions() -> None:
    scenario = load_scenario(SCENARIOS / "step_response.toml")
    first = motion(scenario)
    shifted = replace(first, disk_x=first.disk_x + 3e-9, disk_y=first.disk_y + 4e-9)
    assert tip_distance(first, shifted) == pytest.approx(5e-9, rel=1e-6)


def test_counters_are_those_of_the_run_that_was_kept() -> None:
    scenario = load_scenario(SCENARIOS / "step_response.toml")
    run = simulate(replace(scenario, accuracy=Accuracy(1e-6)))
    assert run.trajectory is not None
    assert run.solver is not None
    assert run.trajectory.counters == motion(replace(scenario, solver=run.solver)).counters


def test_accuracy_that_the_budget_does_not_allow_ends_with_what_was_reached() -> None:
    """The first pair of runs fits into the budget and is not enough; the second does not fit."""
    scenario = replace(load_scenario(SCENARIOS / "step_response.toml"), accuracy=Accuracy(3e-8))
    run = simulate(scenario, budget=Budget(steps=450))
    assert run.outcome is Outcome.BUDGET_EXCEEDED
    assert "not reached" in run.message
    assert "max_steps = " in run.message
    assert run.trajectory is not None
    assert run.trajectory.time[-1] == 1.0
    assert run.tip_error is not None
    true_error = tip_distance(run.trajectory, motion(replace(scenario, accuracy=None, solver=TIGHT)))
    assert run.tip_error == pytest.approx(true_error, rel=0.5)
    assert run.tip_error > 3e-8
