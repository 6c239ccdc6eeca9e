"""From a scenario to its answer: equilibria, and the motion between them.

Every run ends in a named outcome and keeps what it computed.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from continuum_dyn.accuracy import to_accuracy
from continuum_dyn.dynamics import Dynamics
from continuum_dyn.integration import inspector, integrate, warm_up, with_step
from continuum_dyn.integrators import Budget, Monitor, choose
from continuum_dyn.profiles import Span, spans
from continuum_dyn.settling import settled, tip_gap
from continuum_dyn.study import MotionStudy, RampStudy, Scenario, Solver, StepResponseStudy
from continuum_dyn.trajectory import Trajectory
from statics.equilibria import Equilibrium, StaticSolver
from statics.outcome import Outcome


@dataclass(frozen=True)
class Run:
    """The answer to a scenario.

    ``equilibria`` are those of the study; for a motion the first one, the last one and, where asked for,
    those of every sample in ``static_path``. ``static_gap`` is the distance (m) of the tip from its final
    equilibrium. ``solve_time`` (s) is the solving alone, with kernels loaded.
    """

    scenario: Scenario
    outcome: Outcome
    message: str = ""
    equilibria: list[Equilibrium] = field(default_factory=list)
    static_path: list[Equilibrium] = field(default_factory=list)
    trajectory: Trajectory | None = None
    static_gap: float | None = None
    solver: Solver | None = None
    tip_error: float | None = None
    solve_time: float = 0.0

    @property
    def tip(self) -> tuple[float, float, float] | None:
        """x, y (m) and theta (rad) of the last disk where the run ended; None if it has no state."""
        if self.trajectory is not None:
            return self.trajectory.tip
        found = [point for point in self.equilibria if point.found]
        return found[-1].tip if found else None


def simulate(
    scenario: Scenario, progress: Callable[[float], None] | None = None, budget: Budget | None = None
) -> Run:
    """Answer a scenario: see ``Run``.

    ``progress`` is called with the fraction done; ``budget`` bounds the steps and seconds of a motion.
    Raises ``InputError`` for a scene that cannot be simulated, ``KernelCacheError`` if kernels cannot be
    kept. Whatever happens while solving is an outcome, not an exception.
    """
    if isinstance(scenario.study, MotionStudy):
        return _motion(scenario, scenario.study, progress, budget or Budget())
    return _statics(scenario)


def _statics(scenario: Scenario) -> Run:
    solver = StaticSolver(scenario.scene)
    if isinstance(scenario.study, RampStudy):
        tensions = np.array(scenario.ramps).T if scenario.ramps else np.empty((1, 0))
    else:
        tensions = scenario.initial_tension[None, :]
    solver.warm_up()
    started = time.perf_counter()
    points = solver.ramp(tensions)
    solve_time = time.perf_counter() - started
    failed = next((point for point in points if not point.stable), None)
    outcome, message = (Outcome.COMPLETED, "") if failed is None else (failed.outcome, _why(failed))
    return Run(scenario, outcome, message, points, solve_time=solve_time)


def _why(point: Equilibrium) -> str:
    """What to tell of a search that did not end in a stable equilibrium."""
    at = (
        f"at tension {', '.join(f'{tau:g}' for tau in point.tension)} N"
        if point.tension.size
        else "without cables"
    )
    if point.outcome is Outcome.UNSTABLE_EQUILIBRIUM:
        return f"unstable in {point.unstable_directions} directions {at}"
    if point.outcome is Outcome.GEOMETRY_LIMIT:
        return f"{at} holes meet: the cable's length from hole to hole reaches zero; try less tension"
    return f"no equilibrium found {at} in {point.iterations} iterations; try a ramp from a lower tension"


def _motion(
    scenario: Scenario, study: MotionStudy, progress: Callable[[float], None] | None, budget: Budget
) -> Run:
    statics, dynamics = StaticSolver(scenario.scene), Dynamics(scenario.scene)
    stretches = spans(scenario.profiles, study.duration)
    statics.warm_up()
    solver = scenario.solver
    if solver.method == "auto":
        solver = replace(solver, method=choose(scenario.scene).method)
    warm_up(dynamics, solver, stretches[0])
    started = time.perf_counter()
    start = statics.solve(scenario.initial_tension)
    if not start.found:
        return Run(scenario, start.outcome, _why(start), [start], solve_time=time.perf_counter() - started)
    solver = with_step(dynamics, solver, stretches, dynamics.state(start.coordinates))
    monitor = Monitor(
        inspect=inspector(dynamics),
        progress=None if progress is None else lambda t: progress(t / study.duration),
        budget=budget,
    )
    moved = _moved(scenario, study, solver, dynamics, stretches, start, monitor)
    end = statics.solve(stretches[-1].tension(np.array([study.duration]))[0], start.coordinates)
    path = statics.ramp(moved.trajectory.tension, start.coordinates) if study.static_path else []
    run = Run(
        scenario,
        monitor.outcome or Outcome.COMPLETED,
        monitor.message,
        [start, end],
        path,
        moved.trajectory,
        solver=moved.solver,
        tip_error=moved.tip_error,
        solve_time=time.perf_counter() - started,
    )
    return run if monitor.outcome else _compared(run, study, end)


class _Moved(NamedTuple):
    trajectory: Trajectory
    solver: Solver
    tip_error: float | None


def _moved(
    scenario: Scenario,
    study: MotionStudy,
    solver: Solver,
    dynamics: Dynamics,
    stretches: list[Span],
    start: Equilibrium,
    monitor: Monitor,
) -> _Moved:
    """The motion with the solver's tolerances, or with those that the scenario's accuracy takes."""
    samples = np.linspace(0.0, study.duration, study.samples)
    y = dynamics.state(start.coordinates)
    last: list[Trajectory] = []

    def run(settings: Solver) -> Trajectory | None:
        last.append(integrate(dynamics, stretches, samples, y, settings, monitor))
        return None if monitor.outcome else last[-1]

    if scenario.accuracy is None:
        run(solver)
        return _Moved(last[-1], solver, None)
    asked = scenario.accuracy.tip
    found = to_accuracy(run, solver, asked, scenario.scene.arm.total_length)
    if found is None:
        return _Moved(last[-1], solver, None)
    if not found.reached:
        monitor.message = (
            f"accuracy of {asked:g} m not reached: {found.estimate:.2g} m at rtol {found.solver.rtol:.1g}, "
            f"after {len(found.trials)} trials"
        )
    return _Moved(found.trajectory, found.solver, found.estimate)


def _compared(run: Run, study: MotionStudy, end: Equilibrium) -> Run:
    """The run with its distance from the final equilibrium, and the verdict of a step response."""
    assert run.trajectory is not None
    gap = tip_gap(run.trajectory.tip, end.tip) if end.found else None
    if not isinstance(study, StepResponseStudy):
        return replace(run, static_gap=gap)
    if gap is None or not end.stable:
        return replace(run, static_gap=gap, outcome=end.outcome, message=_why(end))
    speed = float(run.trajectory.tip_speed[-1])
    verdict = Outcome.SETTLED if settled(gap, speed, run.scenario.settled_within) else Outcome.NOT_SETTLED
    return replace(run, static_gap=gap, outcome=verdict)
