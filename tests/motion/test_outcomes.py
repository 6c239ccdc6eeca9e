"""Every run ends in a named outcome and keeps what it had."""

import os
import signal
from dataclasses import replace
from typing import Any, Literal

import numpy as np
import pytest
from conftest import ANY_METHOD, MOTION, moving, rone2012

from continuum_dyn import Run, Scenario, simulate
from continuum_dyn.effects import MaterialDamping
from continuum_dyn.integrators import METHODS, Budget, Monitor
from continuum_dyn.passes.dynamics import Dynamics, Observation
from continuum_dyn.scenario.intervals import Interval
from continuum_dyn.scenario.profiles import Constant, Profile, Step
from continuum_dyn.scenario.solver import Method, Solver
from continuum_dyn.scenario.studies import MotionStudy, RampStudy, StepResponseStudy
from statics import InputError, Outcome, Scene


def step_to(tension: float, duration: float = 0.05, method: Method = "LSODA") -> Scenario:
    study = StepResponseStudy(duration, samples=51)
    scene = moving(rone2012(), damping=method != "midpoint")
    return Scenario(scene, (Step(before=0.0, after=tension),), study, Solver(method))


def assert_kept(run: Run, until: float) -> None:
    """What was computed before the end is there, finite, and in order."""
    assert run.trajectory is not None
    time = run.trajectory.time
    assert time[0] == 0.0
    assert 0.0 <= time[-1] <= until
    assert np.all(np.diff(time) > 0)
    assert np.isfinite(run.trajectory.disk_y).all()
    assert np.isfinite(np.array(list(run.trajectory.ledger.values()))).all()
    assert run.message


@pytest.mark.parametrize("method", ANY_METHOD)
def test_step_into_the_hole_limit_says_when_and_where(method: Method) -> None:
    scenario = step_to(50.0, method=method)
    if method in ("RK23", "RK45", "DOP853"):  # with extension explicit methods crawl: 6e6 1/s
        scenario = replace(scenario, scene=without_extension())
    run = simulate(scenario)
    assert run.outcome is Outcome.GEOMETRY_LIMIT
    assert "disk" in run.message
    assert "t = 0.0" in run.message
    assert_kept(run, 0.05)


def test_motion_whose_energies_do_not_add_up_is_no_answer() -> None:
    """An L-stable method damps what nothing damps; at a loose tolerance it comes to rest, which is wrong."""
    free = moving(rone2012(), damping=False)
    release, study = (Step(before=2.0, after=0.0),), MotionStudy(0.1, samples=11)
    run = simulate(Scenario(free, release, study, Solver("chain", rtol=1e-4)))
    assert run.outcome is Outcome.DIVERGED
    assert "energies do not balance" in run.message
    assert run.trajectory is not None
    assert run.trajectory.time[-1] == 0.1
    kept = simulate(Scenario(free, release, study, Solver("chain", rtol=1e-8)))
    assert kept.outcome is Outcome.COMPLETED


def without_extension() -> Scene:
    plain = rone2012()
    return moving(Scene(plain.arm, (effect for effect in plain.effects if effect.name != "extension")))


def test_static_tension_beyond_the_limit_leaves_nothing_to_move_from() -> None:
    run = simulate(Scenario(moving(rone2012()), (Constant(100.0),), MotionStudy(0.1)))
    assert run.outcome is Outcome.GEOMETRY_LIMIT
    assert run.trajectory is None
    assert run.tip is None


def test_ramp_that_leaves_the_equilibria_says_at_which_tension() -> None:
    run = simulate(Scenario(rone2012(), ((10.0, 80.0, 95.0),), RampStudy()))
    assert run.outcome is Outcome.GEOMETRY_LIMIT
    assert "95 N" in run.message
    assert [point.found for point in run.equilibria] == [True, True, False]


def test_budget_of_steps_ends_the_run() -> None:
    run = simulate(step_to(1.0), budget=Budget(steps=20))
    assert run.outcome is Outcome.BUDGET_EXCEEDED
    assert "max_steps = 20 reached" in run.message
    assert_kept(run, 0.05)


@pytest.mark.parametrize(
    ("bound", "told"),
    [({"max_steps": 20}, "max_steps = 20 "), ({"max_seconds": 1e-9}, "max_seconds = 1e-09 ")],
)
def test_budgets_of_the_scenario_end_the_run(bound: dict[str, Any], told: str) -> None:
    scenario = replace(step_to(1.0), solver=Solver("LSODA", **bound))
    run = simulate(scenario)
    assert run.outcome is Outcome.BUDGET_EXCEEDED
    assert told in run.message
    assert_kept(run, 0.05)


def test_run_that_is_stopped_keeps_every_sample_up_to_there() -> None:
    """All of its steps are one batch, which the budget ends."""
    run = simulate(step_to(1.0, method="chain"), budget=Budget(steps=20))
    assert run.trajectory is not None
    end = run.trajectory.time[-1]
    expected = np.linspace(0.0, 0.05, 51)
    np.testing.assert_array_equal(run.trajectory.time[:-1], expected[expected < end])
    assert run.trajectory.time.size > 2


@pytest.mark.parametrize(("tension", "side"), [(0.10, 1.0), (0.16, -1.0)])
def test_upright_arm_settles_on_the_side_that_it_falls_to_and_says_which(tension: float, side: float) -> None:
    """Beyond its buckling load it rests on either; let go from far enough it swings over to the other one."""
    plain = rone2012(stiffness=1 / 250, gravity=(-9.81, 0.0)).without("extension")
    scene = Scene(plain.arm, (*plain.effects, *MOTION[:2], MaterialDamping(retardation_time=1e-2)))
    study = StepResponseStudy(20.0, samples=201)
    run = simulate(Scenario(scene, (Step(before=tension, after=0.0),), study, Solver("chain")))
    assert run.outcome is Outcome.SETTLED
    assert run.tip is not None
    assert run.tip[1] == pytest.approx(side * 62.948e-3, abs=1e-5)
    assert ("another equilibrium" in run.message) == (side < 0)


def test_budget_of_seconds_ends_the_run() -> None:
    run = simulate(step_to(1.0), budget=Budget(seconds=0.0))
    assert run.outcome is Outcome.BUDGET_EXCEEDED
    assert_kept(run, 0.05)


@pytest.mark.parametrize("method", ["RK45", "Radau", "BDF", "LSODA"])
def test_budget_of_seconds_ends_a_step_that_goes_on(method: Method) -> None:
    """One step of a large arm by a method with dense matrices takes minutes."""
    run = simulate(step_to(1.0, method=method), budget=Budget(seconds=0.0))
    assert run.outcome is Outcome.BUDGET_EXCEEDED
    assert "used up at t = 0 s" in run.message
    assert run.trajectory is not None
    assert run.trajectory.counters["steps"] == 0


@pytest.mark.parametrize("path", ["stable", "arc_length"])
def test_budget_of_seconds_ends_a_ramp(path: Literal["stable", "arc_length"]) -> None:
    ramp = Scenario(rone2012(), (tuple(np.linspace(0.0, 2.0, 20)),), RampStudy(path=path))
    run = simulate(ramp, budget=Budget(seconds=0.0))
    assert run.outcome is Outcome.BUDGET_EXCEEDED
    assert "max_seconds = 0 used up" in run.message
    assert len(run.equilibria) < 20


def test_budget_of_seconds_counts_the_static_path_of_a_motion(monkeypatch: pytest.MonkeyPatch) -> None:
    """Here the motion leaves nothing of it."""
    monkeypatch.setattr(Budget, "spent_on", lambda *_: iter(()))
    scenario = Scenario(moving(rone2012()), (Constant(1.0),), MotionStudy(0.01, samples=9, static_path=True))
    run = simulate(scenario)
    assert run.outcome is Outcome.BUDGET_EXCEEDED
    assert "after the motion, with 0 of " in run.message
    assert_kept(run, 0.01)


@pytest.mark.parametrize("method", ["LSODA", "Radau", "BDF"])
def test_forces_that_are_not_numbers_end_as_diverged(monkeypatch: pytest.MonkeyPatch, method: Method) -> None:
    plain_rate = Dynamics.rate

    def broken(self: Dynamics, t: float, y: np.ndarray, interval: Interval) -> np.ndarray:
        return plain_rate(self, t, y, interval) * (np.nan if t > 0.01 else 1.0)

    monkeypatch.setattr(Dynamics, "rate", broken)
    run = simulate(step_to(1.0, method=method), budget=Budget(seconds=20.0))
    assert run.outcome is Outcome.DIVERGED
    assert_kept(run, 0.02)


def test_energies_beyond_floating_point_end_as_diverged(monkeypatch: pytest.MonkeyPatch) -> None:
    plain_observe = Dynamics.observe

    def overflowing(self: Dynamics, states: np.ndarray, tension: np.ndarray) -> Observation:
        seen = plain_observe(self, states, tension)
        if len(states) > 10:
            seen.ledger["kinetic_energy"][10] = np.inf
        return seen

    monkeypatch.setattr(Dynamics, "observe", overflowing)
    run = simulate(step_to(1.0))
    assert run.outcome is Outcome.DIVERGED
    assert_kept(run, 0.0091)


def test_interrupt_ends_the_run_and_keeps_it() -> None:
    pressed = []

    def press_at(fraction: float) -> None:
        if fraction > 0.5 and not pressed:
            pressed.append(fraction)
            os.kill(os.getpid(), signal.SIGINT)

    before = signal.getsignal(signal.SIGINT)
    run = simulate(step_to(1.0), press_at)
    assert run.outcome is Outcome.INTERRUPTED
    assert run.trajectory is not None
    assert run.trajectory.time[-1] > 0.025
    assert_kept(run, 0.05)
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize(
    ("outcome", "status"),
    [
        ("completed", 0),
        ("settled", 0),
        ("not_settled", 0),
        ("geometry_limit", 1),
        ("diverged", 1),
        ("interrupted", 130),
    ],
)
def test_exit_status_follows_the_outcome(outcome: str, status: int) -> None:
    assert Outcome(outcome).exit_status == status


@pytest.mark.parametrize("tension", [(), (Constant(1.0), Constant(1.0))])
def test_scenario_needs_a_tension_for_each_cable(tension: tuple[Profile, ...]) -> None:
    with pytest.raises(InputError, match="tensions or displacements given for 1 cable"):
        Scenario(rone2012(), tension, MotionStudy(1.0))


def test_step_that_was_taken_is_sampled_even_if_the_run_must_end_by_then() -> None:
    """DOP853 asks for the motion's rate again to interpolate."""
    monitor = Monitor(inspect=lambda _t, _y: None)
    stepper: Any = METHODS["DOP853"].stepper(lambda _t, y: -y, 0.0, np.ones(1), 1.0, monitor=monitor)
    stepper.step()
    monitor.interruption.asked = True
    middle = (stepper.t_old + stepper.t) / 2
    assert stepper.dense_output()(middle) == pytest.approx(np.exp(-middle), rel=1e-6)


def test_motion_without_inertia_is_refused_by_name() -> None:
    with pytest.raises(InputError, match="inertia"):
        Scenario(rone2012(), (Constant(1.0),), MotionStudy(1.0))
