"""Messages about outcomes give numbers with their limits, and advice that fits the scene and the solver."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import SCENARIOS

from continuum_dyn import load_scenario, simulate
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.energy_balance import unbalanced_message
from continuum_dyn.simulation.messages import failure_message
from continuum_dyn.simulation.rest_gap import unsettled_message
from statics import Equilibrium
from statics.outcome import Outcome

TIME = np.linspace(0.0, 3.0, 301)
WITHIN = 1e-4


@pytest.fixture(scope="module")
def point() -> Equilibrium:
    return simulate(load_scenario(SCENARIOS / "tension_ramp.toml")).equilibria[-1]


@pytest.mark.parametrize(
    ("gap", "speed", "said"),
    [
        (
            2e-4,
            1e-6,
            "the tip moves at 0.001 mm/s (limit 0.1 mm/s), but is 0.2 mm from the final equilibrium",
        ),
        (1e-6, 2e-4, "0.001 mm from the final equilibrium (limit 0.1 mm), but still moves at 0.2 mm/s"),
        (
            3e-4,
            2e-4,
            "0.3 mm from the final equilibrium (limit 0.1 mm), and moves at 0.2 mm/s (limit 0.1 mm/s)",
        ),
    ],
)
def test_message_names_what_is_not_settled_with_its_limit(gap: float, speed: float, said: str) -> None:
    decay = np.exp(0.2 * (3.0 - TIME))
    message = unsettled_message(TIME, gap * decay, speed * decay, WITHIN, np.inf)
    assert said in message
    settled = 3.0 + np.log(max(gap, speed) / WITHIN) / 0.2
    assert f"settles after about {settled:.2g} s" in message
    assert "slip_speed" not in message
    constant = np.ones(TIME.size)
    assert "does not decay" in unsettled_message(TIME, gap * constant, speed * constant, WITHIN, np.inf)


def test_creep_of_cables_that_rub_is_named_where_it_alone_is_left() -> None:
    still, slow = np.full(TIME.size, 1e-6), np.full(TIME.size, 2e-4)
    assert "a slip_speed below 1e-05 m/s" in unsettled_message(TIME, still, slow, WITHIN, 1e-5)
    assert "slip_speed" not in unsettled_message(TIME, slow, slow, WITHIN, 1e-5)


@pytest.mark.parametrize("outcome", [Outcome.NO_EQUILIBRIUM, Outcome.GEOMETRY_LIMIT])
def test_advice_on_a_lost_equilibrium_fits_what_acts_there(point: Equilibrium, outcome: Outcome) -> None:
    lost = replace(point, outcome=outcome)
    assert "tension" in failure_message(lost).partition(";")[2]
    unloaded = failure_message(replace(lost, tension=np.zeros(1)))
    assert "youngs_modulus" in unloaded
    assert "less tension" not in unloaded
    assert "lower tension" not in unloaded
    by_load = replace(lost, tension=np.zeros(1), load_factor=np.ones(1))
    assert "load factor" in failure_message(by_load).partition(";")[2]


@pytest.mark.parametrize(
    ("solver", "chosen", "said", "not_said"),
    [
        (Solver("chain", rtol=1e-3), False, 'rtol below 0.001, or let method = "auto"', "step"),
        (Solver("chain", rtol=1e-3), True, "rtol below 0.001", "auto"),
        (Solver("midpoint", step=1e-3), False, "a [solver] step shorter than 0.001 s", "rtol"),
    ],
)
def test_advice_on_energies_fits_the_solver(solver: Solver, chosen: bool, said: str, not_said: str) -> None:
    found = simulate(load_scenario(SCENARIOS / "step_response.toml", ["study.duration=0.01"])).trajectory
    assert found is not None
    wrong = replace(found, ledger=found.ledger | {"input_work": found.ledger["input_work"] + 1.0})
    assert unbalanced_message(found, solver, 0.08, chosen) is None
    message = unbalanced_message(wrong, solver, 0.08, chosen) or ""
    assert said in message
    assert not_said not in message
