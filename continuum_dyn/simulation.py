"""From a scenario to its answer: equilibria, and the motion between them.

Every run ends in a named outcome and keeps what it computed. The motion goes through
``scipy.integrate.solve_ivp``, restarted at every corner of a tension profile, so that no step crosses one.
"""

import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.integrate import solve_ivp

from continuum_dyn.dynamics import Dynamics
from continuum_dyn.integrators import IMPLICIT, METHODS, Budget, Monitor, interruptible
from continuum_dyn.profiles import Span, spans
from continuum_dyn.settling import settled, tip_gap
from continuum_dyn.study import MotionStudy, RampStudy, Scenario, StepResponseStudy
from statics.arm import Arm
from statics.equilibria import Equilibrium, StaticSolver, shape_of
from statics.outcome import Outcome


@dataclass(frozen=True)
class Trajectory:
    """A motion at its samples; SI units.

    ``time`` and energies have shape (samples,), ``tension`` (samples, cables), the rest
    (samples, disks). ``elongation`` and its rate are None in a scene without extension. ``ledger`` holds
    energies (J), powers (W), and the integrals ``input_work`` and ``dissipated_energy`` (J) by glossary name.
    ``counters`` are the solver's: steps, evaluations, Jacobians, decompositions.
    """

    time: np.ndarray
    tension: np.ndarray
    bend_angle: np.ndarray
    bend_angle_rate: np.ndarray
    elongation: np.ndarray | None
    elongation_rate: np.ndarray | None
    curvature: np.ndarray
    length: np.ndarray
    disk_x: np.ndarray
    disk_y: np.ndarray
    disk_theta: np.ndarray
    tip_speed: np.ndarray
    ledger: dict[str, np.ndarray]
    counters: dict[str, int] = field(default_factory=dict)

    @property
    def tip(self) -> tuple[float, float, float]:
        """x, y (m) and theta (rad) of the last disk at the last sample."""
        return float(self.disk_x[-1, -1]), float(self.disk_y[-1, -1]), float(self.disk_theta[-1, -1])

    @property
    def ledger_gap(self) -> np.ndarray:
        """Energy stored since the start, less work put in, plus energy dissipated, shape (samples,), J.

        Zero up to the integrator's error.
        """
        stored = sum(self.ledger[name] for name in ("kinetic_energy", "elastic_energy", "gravity_energy"))
        return stored - stored[0] - self.ledger["input_work"] + self.ledger["dissipated_energy"]


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
    at = f"at tension {', '.join(f'{tau:g}' for tau in point.tension)} N" if point.tension.size else "without cables"
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
    dynamics.warm_up(stretches[0])
    started = time.perf_counter()
    start = statics.solve(scenario.initial_tension)
    if not start.found:
        return Run(scenario, start.outcome, _why(start), [start], solve_time=time.perf_counter() - started)
    monitor = Monitor(
        inspect=_inspector(dynamics),
        progress=None if progress is None else lambda t: progress(t / study.duration),
        budget=budget,
    )
    trajectory = _integrate(dynamics, scenario, study, stretches, start, monitor)
    end = statics.solve(stretches[-1].tension(np.array([study.duration]))[0], start.coordinates)
    path = statics.ramp(trajectory.tension, start.coordinates) if study.static_path else []
    run = Run(
        scenario,
        monitor.outcome or Outcome.COMPLETED,
        monitor.message,
        [start, end],
        path,
        trajectory,
        solve_time=time.perf_counter() - started,
    )
    return run if monitor.outcome else _compared(run, study, end)


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


def _inspector(dynamics: Dynamics) -> Callable[[float, np.ndarray], tuple[Outcome, str] | None]:
    def inspect(t: float, y: np.ndarray) -> tuple[Outcome, str] | None:
        if not np.isfinite(y).all():
            index = int(np.flatnonzero(~np.isfinite(y))[0])
            segment = index % dynamics.size // dynamics.dofs + 1
            return Outcome.DIVERGED, f"segment {segment} is no longer finite at t = {t:.6g} s"
        if dynamics.clearance(y) <= 0.0:
            segment = dynamics.closest_segment(y)
            return Outcome.GEOMETRY_LIMIT, f"holes meet on segment {segment} at t = {t:.6g} s"
        return None

    return inspect


def _integrate(
    dynamics: Dynamics,
    scenario: Scenario,
    study: MotionStudy,
    stretches: list[Span],
    start: Equilibrium,
    monitor: Monitor,
) -> Trajectory:
    samples = np.linspace(0.0, study.duration, study.samples)
    y = dynamics.state(start.coordinates)
    times, states, tensions = [np.zeros(0)], [np.zeros((0, y.size))], [np.zeros((0, scenario.scene.cables))]
    counters = {"steps": 0, "evaluations": 0, "jacobians": 0, "decompositions": 0}
    with interruptible(monitor), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for span in stretches:
            inside = samples[(samples >= span.start) & (samples < span.end)]
            if span is stretches[-1]:
                inside = samples[samples >= span.start]
            solution = _solve_span(dynamics, scenario, span, y, np.append(inside, span.end), monitor)
            kept = min(len(inside), len(solution.t))
            times.append(solution.t[:kept])
            states.append(solution.y.T[:kept])
            tensions.append(span.tension(solution.t[:kept]))
            counters["evaluations"] += int(solution.nfev)
            counters["jacobians"] += int(solution.njev)
            counters["decompositions"] += int(solution.nlu)
            if solution.status != 0:
                break
            y = solution.y[:, -1]
    counters["steps"] = monitor.steps
    return _trajectory(dynamics, np.concatenate(times), np.vstack(states), np.vstack(tensions), counters)


def _solve_span(
    dynamics: Dynamics, scenario: Scenario, span: Span, y: np.ndarray, at: np.ndarray, monitor: Monitor
) -> object:
    solver = scenario.solver
    return solve_ivp(
        lambda t, y: dynamics.rate(t, y, span),
        (span.start, span.end),
        y,
        method=METHODS[solver.method],
        t_eval=np.unique(at),
        rtol=solver.rtol,
        atol=solver.atol * dynamics.scales(),
        monitor=monitor,
        **({"jac": lambda t, y: dynamics.jacobian(t, y, span)} if solver.method in IMPLICIT else {}),
    )


def _trajectory(
    dynamics: Dynamics, times: np.ndarray, states: np.ndarray, tension: np.ndarray, counters: dict[str, int]
) -> Trajectory:
    arm: Arm = dynamics.scene.arm
    q, u = dynamics.split(states)
    extends = dynamics.dofs == 2
    elongation = q[:, :, 1] if extends else None
    seen = dynamics.observe(states, tension)
    return Trajectory(
        time=times,
        tension=tension,
        bend_angle=q[:, :, 0],
        bend_angle_rate=u[:, :, 0],
        elongation=elongation,
        elongation_rate=u[:, :, 1] if extends else None,
        **shape_of(arm, q[:, :, 0], elongation),
        disk_x=seen.disk_x,
        disk_y=seen.disk_y,
        disk_theta=seen.disk_theta,
        tip_speed=seen.tip_speed,
        ledger=seen.ledger | {"input_work": states[:, -2], "dissipated_energy": states[:, -1]},
        counters=counters,
    )
