"""A motion that was broken off goes on from its log to the answer of an unbroken one."""

import itertools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENARIOS, edited
from typer.testing import CliRunner

from continuum_dyn import Scenario, load_scenario, simulate
from continuum_dyn.cli import app
from continuum_dyn.integrators import Budget
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.record import Log, StreamedLog, read_log, write_log
from continuum_dyn.record.logged_scenario import logged_scenario
from continuum_dyn.record.resuming import resumption_of
from continuum_dyn.record.writing import columns_of
from continuum_dyn.scenario.intervals import cut_into_intervals
from continuum_dyn.scenario.profiles import Sine
from continuum_dyn.scenario.solver import Method, Solver
from continuum_dyn.scenario.studies import MotionStudy
from continuum_dyn.simulation import Run, samples
from continuum_dyn.simulation.resumption import Resumption
from continuum_dyn.simulation.trajectory import Trajectory, observe_trajectory
from statics import Outcome
from statics.errors import LogError

STEP = SCENARIOS / "step_response.toml"
SINE = ('"step", before = 0.0, after = 1.0', '"sine", mean = 1.0, amplitude = 0.9, frequency = 20.0')
SAME_TIP = 5e-7
"""m, of an arm of 0.08 m: about the error of either at the default tolerance."""

runner = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1"})


def broken_off(scenario: Scenario, path: Path, steps: int) -> Log:
    write_log(simulate(scenario, budget=Budget(steps=steps)), path)
    return read_log(path)


def resumed(path: Path, *options: str) -> Log:
    result = runner.invoke(app, ["resume", str(path), *options])
    assert result.exit_code == 0, result.output
    return read_log(path.with_name(path.name.removesuffix(".part")))


def tips_apart(found: Log, expected: Trajectory) -> float:
    np.testing.assert_array_equal(found.trajectory["time"], expected.time)
    x, y = (found.trajectory[name][:, -1] - getattr(expected, name)[:, -1] for name in ("disk_x", "disk_y"))
    return float(np.hypot(x, y).max())


@pytest.mark.parametrize("steps", [1, 40, 100])
def test_run_that_used_up_its_budget_goes_on_to_the_same_answer(tmp_path: Path, steps: int) -> None:
    unbroken = simulate(load_scenario(STEP))
    assert unbroken.trajectory is not None
    early = broken_off(load_scenario(STEP), tmp_path / "log.h5", steps)
    assert early.outcome is Outcome.BUDGET_EXCEEDED
    found = resumed(tmp_path / "log.h5")
    assert found.outcome is unbroken.outcome
    assert tips_apart(found, unbroken.trajectory) < SAME_TIP
    assert found.attributes["static_gap"] == pytest.approx(unbroken.static_gap, abs=SAME_TIP)
    assert found.counters["steps"] > early.counters["steps"] == steps
    for name in ("input_work", "dissipated_energy"):
        gap = found.trajectory[name] - unbroken.trajectory.ledger[name]
        assert abs(gap).max() < 1e-4 * unbroken.trajectory.ledger["input_work"].max()


def test_unfinished_log_goes_on_and_gives_way_to_the_whole_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(samples, "INTERVAL", 0.0)
    scenario = edited(STEP, tmp_path, SINE)
    unbroken = simulate(scenario)
    assert unbroken.trajectory is not None
    with StreamedLog(tmp_path / "log.h5") as sink:
        simulate(scenario, budget=Budget(steps=200), sink=sink)
    part = tmp_path / "log.h5.part"
    assert 1 < read_log(part).trajectory["time"].size < 1001
    found = resumed(tmp_path / "log.h5")  # the name that it would have had finds it, too
    assert tips_apart(found, unbroken.trajectory) < SAME_TIP
    assert not part.exists()


def test_it_may_be_broken_off_any_number_of_times(tmp_path: Path) -> None:
    scenario = edited(STEP, tmp_path, SINE)
    unbroken, log = simulate(scenario), broken_off(scenario, tmp_path / "log.h5", 50)
    assert unbroken.trajectory is not None
    for _ in range(3):
        resumption = resumption_of(log, logged_scenario(log))
        run = simulate(logged_scenario(log), budget=Budget(steps=50), resumption=resumption)
        assert run.outcome is Outcome.BUDGET_EXCEEDED
        write_log(run, tmp_path / "log.h5")
        log = read_log(tmp_path / "log.h5")
    assert log.counters["steps"] == 200
    assert tips_apart(resumed(tmp_path / "log.h5"), unbroken.trajectory) < SAME_TIP


def resumed_from(run: Run, kept: int) -> Trajectory:
    """The motion of a run resumed from its first samples."""
    assert run.trajectory is not None
    assert run.solver is not None
    start = Resumption(run.solver, {}, columns_of(run.trajectory.first(kept)))
    found = simulate(run.scenario, resumption=start).trajectory
    assert found is not None
    return found


def errors(found: Trajectory, exact: Trajectory) -> np.ndarray:
    """Largest errors of the tip (m), of the work and of what is dissipated (J)."""
    tip = np.hypot(*(getattr(found, x)[:, -1] - getattr(exact, x)[:, -1] for x in ("disk_x", "disk_y")))
    energies = [found.ledger[name] - exact.ledger[name] for name in ("input_work", "dissipated_energy")]
    return np.array([np.abs(error).max() for error in (tip, *energies)])


def brief(name: str, duration: float, without: str = "") -> Scenario:
    scenario = load_scenario(SCENARIOS / f"{name}.toml")
    scenario = scenario.without(without) if without else scenario
    return replace(scenario, study=MotionStudy(duration, 77))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scenario", "methods"),
    [
        (brief("step_response", 0.2), ("chain", "LSODA", "BDF")),
        (brief("step_response", 0.2, without="extension"), ("chain", "explicit", "RK45", "Radau")),
        (brief("step_response", 0.1, without="material_damping"), ("midpoint", "explicit")),
        (brief("friction_motion", 3.0), ("chain", "Radau")),
        (brief("shaken_base", 0.5), ("chain", "LSODA")),
        (brief("length_driven", 0.2), ("chain", "LSODA")),
    ],
    ids=lambda value: value.title if isinstance(value, Scenario) else "",
)
def test_resumed_motion_is_as_exact_as_the_unbroken_one_in_work_and_dissipation_too(
    scenario: Scenario, methods: tuple[Method, ...]
) -> None:
    exact = simulate(replace(scenario, solver=Solver("chain", rtol=1e-10, atol=1e-12))).trajectory
    assert exact is not None
    for method, rtol in itertools.product(methods, (1e-3, 1e-5, 1e-7)):
        tolerances = Solver(method, rtol=rtol, atol=1e-3 * rtol)
        solver = Solver(method) if method == "midpoint" else tolerances
        run = simulate(replace(scenario, solver=solver))
        assert run.trajectory is not None
        assert run.solver is not None
        step = run.solver.tolerance(scenario.scene.arm.total_length)
        room = np.array([step, *2 * (step / exact.travel * exact.largest_energy,)])
        for kept in (1, 2, 7, 40, 70):
            found = errors(resumed_from(run, kept), exact)
            assert (found <= 2.0 * errors(run.trajectory, exact) + 3.0 * room).all(), (
                f"{method} {rtol} {kept}"
            )


@pytest.mark.parametrize("frequency", [1.0, 5.0])
def test_work_of_a_slow_drive_is_right_within_steps_too(frequency: float) -> None:
    """A stiff arm follows a base that moves slowly without an error to see, whatever the step."""
    scenario = brief("shaken_base", 1.0 / frequency)
    motion = tuple(
        replace(profile, frequency=frequency) if isinstance(profile, Sine) else profile
        for profile in scenario.base_motion
    )
    found = simulate(
        replace(scenario, base_motion=motion, solver=Solver("chain", rtol=1e-2, atol=1e-5))
    ).trajectory
    assert found is not None
    assert np.abs(found.ledger_gap).max() < 1e-3 * found.largest_energy


def test_method_goes_on_that_had_begun_with_its_tolerances(tmp_path: Path) -> None:
    scenario = replace(load_scenario(STEP), solver=Solver("BDF", rtol=1e-5, atol=1e-8))
    log = broken_off(scenario, tmp_path / "log.h5", 300)
    found = resumed(tmp_path / "log.h5")
    assert log.attributes["method"] == "BDF"
    assert [found.attributes[name] for name in ("method", "rtol", "atol")] == ["BDF", 1e-5, 1e-8]


def test_run_that_was_over_but_for_its_static_path_needs_no_step(tmp_path: Path) -> None:
    study = ('kind = "step_response"', 'kind = "motion"\nstatic_path = true')
    scenario = edited(STEP, tmp_path, study, ("samples = 1001", "samples = 11"))
    whole = simulate(scenario)
    assert whole.trajectory is not None
    early = replace(whole, outcome=Outcome.INTERRUPTED, static_path=whole.static_path[:3])
    write_log(early, tmp_path / "log.h5")
    found = resumed(tmp_path / "log.h5")
    assert found.counters == whole.trajectory.counters
    assert found.equilibria["point"].size == 11


def test_ramp_that_was_interrupted_begins_anew(tmp_path: Path) -> None:
    whole = simulate(load_scenario(SCENARIOS / "tension_ramp.toml"))
    early = replace(whole, outcome=Outcome.INTERRUPTED, equilibria=whole.equilibria[:2])
    write_log(early, tmp_path / "log.h5")
    assert resumed(tmp_path / "log.h5").equilibria["point"].size == len(whole.equilibria)


def test_run_that_has_ended_is_not_run_again(tmp_path: Path) -> None:
    write_log(simulate(load_scenario(STEP)), tmp_path / "log.h5")
    result = runner.invoke(app, ["resume", str(tmp_path / "log.h5")])
    assert result.exit_code == 2
    assert "the run has ended (settled)" in result.stderr


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda log: {"attributes": log.attributes | {"method": "Euler"}}, "unknown integrator 'Euler'"),
        (lambda log: {"attributes": log.attributes | {"rtol": -1.0}}, "attribute rtol"),
        (lambda log: {"trajectory": _without(log, "elongation")}, "elongation is missing"),
        (lambda log: {"trajectory": _cut(log, "bend_angle")}, "3 segments, not 4"),
        (
            lambda log: {"trajectory": log.trajectory | {"time": log.trajectory["time"][::-1]}},
            "do not increase",
        ),
    ],
)
def test_samples_that_do_not_belong_to_the_scenario_are_refused(tmp_path: Path, spoil, said: str) -> None:
    log = broken_off(load_scenario(STEP), tmp_path / "log.h5", 40)
    with pytest.raises(LogError, match=said):
        resumption_of(replace(log, **spoil(log)), logged_scenario(log))


def _without(log: Log, name: str) -> dict[str, np.ndarray]:
    return {other: values for other, values in log.trajectory.items() if other != name}


def _cut(log: Log, name: str) -> dict[str, np.ndarray]:
    return {**log.trajectory, name: log.trajectory[name][:, :3]}


@pytest.mark.parametrize("name", ["shaken_base", "length_driven", "step_response"])
def test_columns_of_a_log_give_back_the_states_that_they_show(name: str) -> None:
    """A base that moves, and cables that are drawn in, book work that is not in the state."""
    scenario = load_scenario(SCENARIOS / f"{name}.toml")
    dynamics = Dynamics(scenario.scene)
    assert isinstance(scenario.study, MotionStudy)
    stretches = cut_into_intervals(scenario.profiles, scenario.study.duration)
    times = np.linspace(0.0, scenario.study.duration, 4)
    states = np.random.default_rng(0).normal(0.0, 1e-3, (4, dynamics.state_size))
    shown = observe_trajectory(dynamics, times, states, stretches.inputs(times), np.zeros(4), {})
    resumption = Resumption(Solver(), {}, columns_of(shown))
    found, _ = resumption.states(dynamics, stretches)
    np.testing.assert_allclose(found, states, rtol=1e-12, atol=1e-15)
