"""From a scenario to its answer: equilibria, and the motion between them.

Every run ends in a named outcome and keeps what it computed.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from continuum_dyn.accuracy import to_accuracy
from continuum_dyn.dynamics import Dynamics
from continuum_dyn.energy_balance import broken_ledger
from continuum_dyn.integration import inspector, integrate, warm_up, with_step
from continuum_dyn.integrators import Budget, Monitor, choose
from continuum_dyn.mesh import Mesh, extrapolated, to_mesh
from continuum_dyn.profiles import Span, spans
from continuum_dyn.resting_words import told_of_path, told_of_points, why
from continuum_dyn.settling import settled, tip_gap
from continuum_dyn.stability import Growth, judged, why_not_judged
from continuum_dyn.study import MAX_STORED, MotionStudy, RampStudy, Scenario, Solver, StepResponseStudy
from continuum_dyn.trajectory import Trajectory
from statics.arc_length import follow
from statics.arm import MAX_SEGMENTS
from statics.equilibria import Equilibrium, StaticSolver
from statics.interruption import Interruption, allowed, held
from statics.outcome import Outcome
from statics.ramp import limit_on_the_way, ramp

TIME_PART = 0.25
"""Part of the accuracy that a mesh's integration may use up; two extrapolated use nearly twice that."""


@dataclass(frozen=True)
class Run:
    """The answer to a scenario.

    ``equilibria`` are those of the study; for a motion the first one, the last one and, where asked for,
    those of every sample in ``static_path``. ``static_gap`` is the distance (m) of the tip from its final
    equilibrium. ``tip_error`` (m) is the estimate of the largest tip error where an accuracy was asked for;
    ``mesh`` what was found, and its part of the error, where the program chose that, too.
    ``solve_time`` (s) is the solving alone, with kernels loaded.
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
    mesh: Mesh | None = None
    solve_time: float = 0.0

    @property
    def tips(self) -> np.ndarray | None:
        """Places of the tip at the samples or points, shape (samples, 2), m; None if there are not all."""
        if not (self.outcome.answered or self.outcome is Outcome.UNSTABLE_EQUILIBRIUM):
            return None
        if self.trajectory is not None:
            return np.column_stack([self.trajectory.disk_x[:, -1], self.trajectory.disk_y[:, -1]])
        if not all(point.found for point in self.equilibria):
            return None
        return np.array([point.tip[:2] for point in self.equilibria])

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

    ``progress`` is called with the fraction done; ``budget`` bounds the steps and seconds of a motion, by
    default those of the scenario's solver.
    Raises ``InputError`` for a scene that cannot be simulated, ``KernelCacheError`` if kernels cannot be
    kept. Whatever happens while solving is an outcome, not an exception, Ctrl-C too: what was computed by
    then is in the run. Pressed again, it raises ``KeyboardInterrupt``.
    """
    if budget is None:
        budget = Budget(scenario.solver.max_steps, scenario.solver.max_seconds)
    with held() as interruption:
        if scenario.chooses_mesh:
            run = _with_chosen_mesh(scenario, progress, budget)
        elif isinstance(scenario.study, MotionStudy):
            run = _motion(scenario, scenario.study, progress, budget, interruption)
        else:
            run = _statics(scenario, interruption)
        if run.outcome is Outcome.INTERRUPTED:
            interruption.asked = False
    return run


def _with_chosen_mesh(scenario: Scenario, progress: Callable[[float], None] | None, budget: Budget) -> Run:
    """The answer on the coarsest mesh that is fine enough, and the estimate of all of its error."""
    assert scenario.accuracy is not None
    runs: dict[int, Run] = {}

    def tips(subsegments: int) -> np.ndarray | None:
        if subsegments not in runs:
            left = replace(budget, seconds=budget.seconds - (time.monotonic() - started))
            runs[subsegments] = simulate(scenario.with_mesh(subsegments, TIME_PART * asked), progress, left)
        return runs[subsegments].tips

    started, asked, arm = time.monotonic(), scenario.accuracy.tip, scenario.scene.arm
    most = MAX_SEGMENTS // arm.disks
    if isinstance(scenario.study, MotionStudy):
        most = min(most, MAX_STORED // (arm.disks * scenario.study.samples))
    mesh = to_mesh(tips, (1.0 - 2.0 * TIME_PART) * asked, most)
    solve_time = sum(run.solve_time for run in runs.values())
    if mesh is None:
        return replace(next(run for run in runs.values() if run.tips is None), solve_time=solve_time)
    run = runs[mesh.subsegments]
    if mesh.extrapolated:
        run = _extrapolated(run, runs[2 * mesh.subsegments])
    if not mesh.reached:
        stopped = next((run for run in runs.values() if run.tips is None), run)
        told = f"{stopped.message}; " if stopped is not run else ""
        run = replace(run, outcome=stopped.outcome, message=told + _coarse(mesh, asked, solve_time))
    error = mesh.estimate + (run.tip_error or 0.0)
    asked_for = replace(run.scenario, accuracy=scenario.accuracy, chooses_mesh=True)
    return replace(run, scenario=asked_for, tip_error=error, mesh=mesh, solve_time=solve_time)


def _extrapolated(coarse: Run, fine: Run) -> Run:
    """The finer run with the poses of the continuous arm."""
    run = replace(
        fine,
        equilibria=list(map(extrapolated, coarse.equilibria, fine.equilibria)),
        static_path=list(map(extrapolated, coarse.static_path, fine.static_path)),
    )
    if coarse.trajectory is None or fine.trajectory is None:
        return run
    error = (4.0 * (fine.tip_error or 0.0) + (coarse.tip_error or 0.0)) / 3.0
    run = replace(run, trajectory=extrapolated(coarse.trajectory, fine.trajectory), tip_error=error)
    assert isinstance(fine.scenario.study, MotionStudy)
    return _compared(run, fine.scenario.study, run.equilibria[-1:])


def _coarse(mesh: Mesh, asked: float, seconds: float) -> str:
    return (
        f"accuracy of {asked:g} m not reached: {mesh.estimate:.2g} m from meshes of {mesh.subsegments} and "
        f"{2 * mesh.subsegments} segments from disk to disk, after {seconds:.3g} s"
    )


def _statics(scenario: Scenario, interruption: Interruption) -> Run:
    try:
        with allowed():
            solver = StaticSolver(scenario.scene)
            solver.warm_up()
    except KeyboardInterrupt:
        return _interrupted_early(scenario)
    if isinstance(scenario.study, RampStudy):
        inputs = np.array(scenario.ramps).T if scenario.ramps else np.empty((1, 0))
        others = scenario.initial_tension[inputs.shape[1] :]
        inputs = np.hstack([inputs, np.tile(others, (len(inputs), 1))])
    else:
        inputs = scenario.initial_tension[None, :]
    started = time.perf_counter()
    if isinstance(scenario.study, RampStudy) and scenario.study.path == "arc_length":
        path = follow(solver, inputs)
        solve_time = time.perf_counter() - started
        return Run(scenario, path.outcome, told_of_path(path), path.points, solve_time=solve_time)
    points = ramp(solver, interruption.until_asked(inputs))
    solve_time = time.perf_counter() - started
    message, growths = told_of_points(points), [None] * len(points)
    if any(point.stable is None for point in points):
        message = why_not_judged(scenario.scene) or ""
        if why_not_judged(scenario.scene) is None:
            points, growths = _judged(Dynamics(scenario.scene), points)
    outcome = Outcome.COMPLETED
    before: Equilibrium | None = None
    for point, growth, asked in zip(points, growths, inputs, strict=False):
        if point.outcome is not Outcome.COMPLETED:
            outcome, message = point.outcome, why(point, growth, _limit(solver, point, asked, before))
            break
        before = point
    if len(points) < len(inputs):
        outcome, message = Outcome.INTERRUPTED, f"interrupted after {len(points)} of {len(inputs)} points"
    return Run(scenario, outcome, message, points, solve_time=solve_time)


def _limit(
    solver: StaticSolver, point: Equilibrium, inputs: np.ndarray, before: Equilibrium | None
) -> Equilibrium | None:
    """Where the way to a search that ended at a geometric limit comes to it."""
    if point.outcome is not Outcome.GEOMETRY_LIMIT:
        return None
    return limit_on_the_way(solver, inputs, before)


def _interrupted_early(scenario: Scenario) -> Run:
    return Run(scenario, Outcome.INTERRUPTED, "interrupted before anything was computed")


def _judged(dynamics: Dynamics, points: list[Equilibrium]) -> tuple[list[Equilibrium], list[Growth | None]]:
    """Equilibria, where their energy does not tell whether they are stable, as their modes do."""
    found = [judged(dynamics, point) if point.stable is None else (point, None) for point in points]
    return [point for point, _ in found], [growth for _, growth in found]


def _settled_on(
    scenario: Scenario, study: MotionStudy, dynamics: Dynamics, y: np.ndarray, stretches: list[Span]
) -> Solver:
    """The solver with what the program chooses: the method, and the midpoint rule's step."""
    solver, exact = scenario.solver, scenario.accuracy is not None
    if solver.method == "auto":
        solver = replace(solver, method=choose(dynamics, y, stretches[0], study.duration, exact).method)
    return with_step(dynamics, solver, stretches, y)


def _motion(
    scenario: Scenario,
    study: MotionStudy,
    progress: Callable[[float], None] | None,
    budget: Budget,
    interruption: Interruption,
) -> Run:
    try:
        with allowed():
            statics, dynamics = StaticSolver(scenario.scene), Dynamics(scenario.scene)
            statics.warm_up()
    except KeyboardInterrupt:
        return _interrupted_early(scenario)
    stretches = spans(scenario.profiles, study.duration)
    started = time.perf_counter()
    start = statics.solve(scenario.initial_tension)
    if not start.found:
        limit = _limit(statics, start, scenario.initial_tension, None)
        solve_time = time.perf_counter() - started
        return Run(scenario, start.outcome, why(start, None, limit), [start], solve_time=solve_time)
    y = dynamics.state(start.coordinates)
    try:
        with allowed():
            solver = _settled_on(scenario, study, dynamics, y, stretches)
            warm_up(dynamics, solver, stretches[0])
    except KeyboardInterrupt:
        return Run(scenario, Outcome.INTERRUPTED, "interrupted before the motion began", [start])
    started = time.perf_counter()
    monitor = Monitor(
        inspect=inspector(dynamics),
        progress=None if progress is None else lambda t: progress(t / study.duration),
        budget=budget,
        interruption=interruption,
    )
    moved = _moved(scenario, study, solver, dynamics, stretches, start, monitor)
    _check_energies(scenario, moved, monitor)
    last = stretches[-1].inputs(np.array([study.duration]))[0]
    end, message = _end(statics, last, start, moved.trajectory, scenario.settled_within)
    path = _static_path(statics, moved.trajectory, start, monitor) if study.static_path else []
    solve_time = time.perf_counter() - started
    ends, growths = [start, end], [None, None]
    if why_not_judged(scenario.scene) is None:
        ends, growths = _judged(dynamics, ends)
    run = Run(
        scenario,
        monitor.outcome or Outcome.COMPLETED,
        monitor.message or message,
        ends,
        path,
        moved.trajectory,
        solver=moved.solver,
        tip_error=moved.tip_error,
        solve_time=solve_time,
    )
    return run if monitor.outcome else _compared(run, study, statics.branches(last, ends[-1]), growths[-1])


def _check_energies(scenario: Scenario, moved: "_Moved", monitor: Monitor) -> None:
    length = scenario.scene.arm.total_length
    told = broken_ledger(moved.trajectory, (moved.solver.rtol + moved.solver.atol) * length)
    if told is not None:
        monitor.stop(Outcome.DIVERGED, told)


def _end(
    statics: StaticSolver, inputs: np.ndarray, start: Equilibrium, moved: Trajectory, within: float
) -> tuple[Equilibrium, str]:
    """Where the motion may end: the equilibrium found from its start, or another one that it came to instead.

    The latter is told in words. Cables that rub leave it anywhere between two branches.
    """
    end = statics.solve(inputs, start.coordinates, start)
    if _rests_at(end, statics, inputs, moved, within):
        return end, ""
    last = moved.bend_angle[-1], None if moved.elongation is None else moved.elongation[-1]
    near = statics.solve(inputs, np.column_stack([column for column in last if column is not None]))
    if not _rests_at(near, statics, inputs, moved, within):
        return end, ""
    x, y, _ = near.tip
    told = f"at another equilibrium than the one found from the start: tip at x {x:.4g} m, y {y:.4g} m"
    return near, told if end.found and tip_gap(near.tip, [end.tip]) > within else ""


def _rests_at(
    end: Equilibrium, statics: StaticSolver, inputs: np.ndarray, moved: Trajectory, within: float
) -> bool:
    """Whether the tip has come to that equilibrium, or between the branches that belong to it."""
    rests = [branch.tip for branch in statics.branches(inputs, end) if branch.found] if end.found else []
    return bool(rests) and tip_gap(moved.tip, rests) < within


def _static_path(
    statics: StaticSolver, trajectory: Trajectory, start: Equilibrium, monitor: Monitor
) -> list[Equilibrium]:
    """The equilibrium of every sample, or of those before Ctrl-C."""
    path = ramp(statics, monitor.interruption.until_asked(trajectory.inputs), start.coordinates)
    if len(path) < len(trajectory.inputs):
        monitor.stop(Outcome.INTERRUPTED, f"interrupted after the motion, {len(path)} points on its path")
    return path


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
    last: list[_Moved] = []

    def run(settings: Solver) -> Trajectory | None:
        trajectory = integrate(dynamics, stretches, samples, y, settings, monitor)
        last.append(_Moved(trajectory, settings, None))
        return None if monitor.outcome else trajectory

    if scenario.accuracy is None:
        run(solver)
        return last[-1]
    asked = scenario.accuracy.tip
    started = time.perf_counter()
    found = to_accuracy(run, solver, asked, scenario.scene.arm.total_length)
    if found is None:
        return last[-1]
    if not found.reached:
        stopped = f"{monitor.message}; " if monitor.message else ""
        monitor.message = (
            f"{stopped}accuracy of {asked:g} m not reached: {found.estimate:.2g} m at rtol "
            f"{found.solver.rtol:.1g}, after {len(found.trials)} trials and "
            f"{time.perf_counter() - started:.3g} s"
        )
    return _Moved(found.trajectory, found.solver, found.estimate)


def _compared(run: Run, study: MotionStudy, ends: Sequence[Equilibrium], growth: Growth | None = None) -> Run:
    """The run with its distance from where it may end, and the verdict of a step response."""
    assert run.trajectory is not None
    end, rests = ends[-1], [point.tip for point in ends if point.found]
    gap = tip_gap(run.trajectory.tip, rests) if rests else None
    if not isinstance(study, StepResponseStudy):
        return replace(run, static_gap=gap)
    if gap is None or end.outcome is not Outcome.COMPLETED:
        return replace(run, static_gap=gap, outcome=end.outcome, message=why(end, growth))
    speed = float(run.trajectory.tip_speed[-1])
    verdict = Outcome.SETTLED if settled(gap, speed, run.scenario.settled_within) else Outcome.NOT_SETTLED
    return replace(run, static_gap=gap, outcome=verdict)
