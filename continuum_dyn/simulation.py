"""From a scenario to its answer: equilibria, and the motion between them.

Every run ends in a named outcome and keeps what it computed.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple, Protocol

import numpy as np

from continuum_dyn.accuracy import to_accuracy
from continuum_dyn.begun import Begun
from continuum_dyn.dynamics import Dynamics
from continuum_dyn.energy_balance import broken_ledger
from continuum_dyn.integration import inspector, integrate, warm_up, with_step
from continuum_dyn.integrators import Budget, Monitor, choose
from continuum_dyn.mesh import Mesh, extrapolated, to_mesh
from continuum_dyn.resting_words import told_of_path, told_of_points, why
from continuum_dyn.samples import Samples
from continuum_dyn.scenario.intervals import Interval, cut_into_intervals, intervals_after
from continuum_dyn.scenario.scenario import MAX_STORED, Scenario
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.scenario.studies import MotionStudy, RampStudy, StepResponseStudy
from continuum_dyn.settling import settled, tip_gap
from continuum_dyn.stability import Growth, judged, why_not_judged
from continuum_dyn.trajectory import Trajectory
from statics.arc_length import MOST_STEPS, follow
from statics.arm import MAX_SEGMENTS
from statics.equilibria import Equilibrium, StaticSolver
from statics.interruption import Interruption, allowed, held
from statics.outcome import Outcome
from statics.ramp import limit_on_the_way, ramp
from statics.stages import stage

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


class Sink(Protocol):
    """Who is told of a motion while it runs."""

    def begin(self, run: Run) -> None:
        """A motion begins; the run holds what is known of it. Where an accuracy is sought, once a trial."""

    def add(self, block: Trajectory) -> None:
        """Its next samples; those since the last block are in the answer alone."""


def simulate(
    scenario: Scenario,
    progress: Callable[[float], None] | None = None,
    budget: Budget | None = None,
    *,
    sink: Sink | None = None,
    begun: Begun | None = None,
) -> Run:
    """Answer a scenario: see ``Run``.

    ``progress`` is called with the fraction done; ``budget`` bounds the steps of a motion and the seconds of
    a motion or a ramp, by default those of the scenario's solver. The ``sink`` is told of a motion while it
    runs. A motion that was ``begun`` goes on from its last sample; where an accuracy is sought its trials
    begin anew.
    Raises ``InputError`` for a scene that cannot be simulated, ``KernelCacheError`` if kernels cannot be
    kept. Whatever happens while solving is an outcome, not an exception, Ctrl-C too: what was computed by
    then is in the run. Pressed again, it raises ``KeyboardInterrupt``.
    """
    if budget is None:
        budget = Budget(scenario.solver.max_steps, scenario.solver.max_seconds)
    with held() as interruption:
        if scenario.chooses_mesh:
            run = _with_chosen_mesh(scenario, progress, budget, sink)
        elif isinstance(scenario.study, MotionStudy):
            run = _motion(scenario, scenario.study, progress, budget, interruption, sink, begun)
        else:
            run = _statics(scenario, budget, interruption)
        if run.outcome is Outcome.INTERRUPTED:
            interruption.asked = False
    return run


def _with_chosen_mesh(
    scenario: Scenario, progress: Callable[[float], None] | None, budget: Budget, sink: Sink | None
) -> Run:
    """The answer on the coarsest mesh that is fine enough, and the estimate of all of its error."""
    assert scenario.accuracy is not None
    runs: dict[int, Run] = {}

    def tips(subsegments: int) -> np.ndarray | None:
        if subsegments not in runs:
            left = replace(budget, seconds=budget.seconds - (time.monotonic() - started))
            trial = scenario.with_mesh(subsegments, TIME_PART * asked)
            runs[subsegments] = simulate(trial, progress, left, sink=sink)
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


def _statics(scenario: Scenario, budget: Budget, interruption: Interruption) -> Run:
    try:
        with allowed(), stage("kernels of statics"):
            solver = StaticSolver(scenario.scene)
            solver.warm_up()
    except KeyboardInterrupt:
        return _interrupted_early(scenario)
    inputs = scenario.initial_inputs[None, :]
    if isinstance(scenario.study, RampStudy):
        ramps = np.array(scenario.ramps).T if scenario.ramps else np.empty((1, 0))
        inputs = np.hstack([ramps, np.tile(inputs[:, ramps.shape[1] :], (len(ramps), 1))])
        if scenario.study.path == "arc_length":
            return _followed(scenario, solver, inputs, budget, interruption)
    return _one_by_one(scenario, solver, inputs, budget, interruption)


def _followed(
    scenario: Scenario, solver: StaticSolver, inputs: np.ndarray, budget: Budget, interruption: Interruption
) -> Run:
    """The path of equilibria through all its folds."""
    started = time.monotonic()
    steps = budget.spent_on(interruption.until_asked(range(MOST_STEPS)), started)
    with stage("equilibria"):
        path = follow(solver, inputs, steps=steps)
    solve_time = time.monotonic() - started
    outcome, message = path.outcome, told_of_path(path)
    if outcome is Outcome.NO_EQUILIBRIUM and (interruption.asked or budget.is_spent(started)):
        outcome, words = _cut_short(budget, interruption)
        message = f"{words} {path.end.drive}"
    return Run(scenario, outcome, message, path.points, solve_time=solve_time)


def _one_by_one(
    scenario: Scenario, solver: StaticSolver, inputs: np.ndarray, budget: Budget, interruption: Interruption
) -> Run:
    """A stable equilibrium for each set of inputs."""
    started = time.monotonic()
    with stage("equilibria"):
        points = ramp(solver, budget.spent_on(interruption.until_asked(inputs), started))
    solve_time = time.monotonic() - started
    message, growths = told_of_points(points), [None] * len(points)
    if any(point.stable is None for point in points):
        message = why_not_judged(scenario.scene) or ""
        if why_not_judged(scenario.scene) is None:
            try:
                with allowed():  # kernels may have to be compiled
                    points, growths = _judged(Dynamics(scenario.scene), points)
            except KeyboardInterrupt:
                told = f"interrupted after {len(points)} of {len(inputs)} points, of unknown stability"
                return Run(scenario, Outcome.INTERRUPTED, told, points, solve_time=solve_time)
    outcome = Outcome.COMPLETED
    before: Equilibrium | None = None
    for point, growth, asked in zip(points, growths, inputs, strict=False):
        if point.outcome is not Outcome.COMPLETED:
            outcome, message = point.outcome, why(point, growth, _limit(solver, point, asked, before))
            break
        before = point
    if len(points) < len(inputs):
        outcome, words = _cut_short(budget, interruption)
        message = f"{words} after {len(points)} of {len(inputs)} points"
    return Run(scenario, outcome, message, points, solve_time=solve_time)


def _cut_short(budget: Budget, interruption: Interruption) -> tuple[Outcome, str]:
    """Why a ramp ended before its last point, as an outcome and in words."""
    if interruption.asked:
        return Outcome.INTERRUPTED, "interrupted"
    return Outcome.BUDGET_EXCEEDED, f"{budget.seconds:g} s used up"


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
    scenario: Scenario, study: MotionStudy, dynamics: Dynamics, y: np.ndarray, stretches: list[Interval]
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
    sink: Sink | None,
    begun: Begun | None,
) -> Run:
    try:
        with allowed(), stage("kernels of statics and dynamics"):
            statics, dynamics = StaticSolver(scenario.scene), Dynamics(scenario.scene)
            statics.warm_up()
    except KeyboardInterrupt:
        return _interrupted_early(scenario)
    stretches = cut_into_intervals(scenario.profiles, study.duration)
    started = time.perf_counter()
    (start,) = ramp(statics, [scenario.initial_inputs])
    if not start.found:
        limit = _limit(statics, start, scenario.initial_inputs, None)
        solve_time = time.perf_counter() - started
        return Run(scenario, start.outcome, why(start, None, limit), [start], solve_time=solve_time)
    y = dynamics.state(start.coordinates)
    try:
        with allowed(), stage("choice of the method, and its kernels"):
            solver = begun.solver if begun else _settled_on(scenario, study, dynamics, y, stretches)
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
    so_far = Run(scenario, Outcome.INTERRUPTED, "broken off while it ran", [start], solver=solver)
    with stage(f"motion by {solver.method}"):
        moved = _moved_as_asked(so_far, begun, dynamics, stretches, y, monitor, sink)
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
    """The equilibrium of every sample, or of those before Ctrl-C or the end of the budget."""
    samples = monitor.interruption.until_asked(trajectory.inputs)
    path = ramp(statics, monitor.budget.spent_on(samples, monitor.started), start.coordinates)
    if len(path) < len(trajectory.inputs):
        outcome, message = _cut_short(monitor.budget, monitor.interruption)
        monitor.stop(outcome, f"{message} after the motion, {len(path)} points on its path")
    return path


class _Moved(NamedTuple):
    trajectory: Trajectory
    solver: Solver
    tip_error: float | None


def _moved_as_asked(
    so_far: Run,
    begun: Begun | None,
    dynamics: Dynamics,
    stretches: list[Interval],
    y: np.ndarray,
    monitor: Monitor,
    sink: Sink | None,
) -> _Moved:
    """The motion to the accuracy that is asked for, or from where it was broken off, or else from ``y``."""
    assert so_far.solver is not None
    if so_far.scenario.accuracy is not None:
        return _moved_accurately(so_far, dynamics, stretches, y, monitor, sink)
    if begun is not None:
        return _Moved(_moved_on(so_far, begun, dynamics, stretches, monitor, sink), so_far.solver, None)
    return _Moved(_moved(so_far, dynamics, stretches, y, monitor, sink), so_far.solver, None)


def _moved(
    so_far: Run,
    dynamics: Dynamics,
    stretches: list[Interval],
    y: np.ndarray,
    monitor: Monitor,
    sink: Sink | None,
    done: tuple[np.ndarray, ...] | None = None,
) -> Trajectory:
    """The motion from state ``y`` with the run's solver, after the samples already done."""
    assert isinstance(so_far.scenario.study, MotionStudy)
    assert so_far.solver is not None
    study, gathered = so_far.scenario.study, Samples(dynamics, None if sink is None else sink.add)
    if sink is not None:
        sink.begin(so_far)
    if done is not None:
        gathered.add(*done)
    samples = np.linspace(0.0, study.duration, study.samples)
    return integrate(dynamics, stretches, samples, y, so_far.solver, monitor, gathered)


def _moved_on(
    so_far: Run,
    begun: Begun,
    dynamics: Dynamics,
    stretches: list[Interval],
    monitor: Monitor,
    sink: Sink | None,
) -> Trajectory:
    """The motion from where it was broken off; its samples are those asked for, as of one in one go."""
    assert isinstance(so_far.scenario.study, MotionStudy)
    study, times = so_far.scenario.study, begun.columns["time"]
    states, inputs = begun.states(dynamics, stretches)
    asked = np.isin(times, np.linspace(0.0, study.duration, study.samples))
    done = times[asked], states[asked], inputs[asked], begun.columns["step_size"][asked]
    rest = intervals_after(stretches, float(times[-1]))
    if not rest:
        gathered = Samples(dynamics)
        gathered.add(*done)
        return gathered.trajectory(dict(begun.counters))
    trajectory = _moved(so_far, dynamics, rest, states[-1], monitor, sink, done)
    counters = {name: count + begun.counters.get(name, 0) for name, count in trajectory.counters.items()}
    return replace(trajectory, counters=counters)


def _moved_accurately(
    so_far: Run,
    dynamics: Dynamics,
    stretches: list[Interval],
    y: np.ndarray,
    monitor: Monitor,
    sink: Sink | None,
) -> _Moved:
    """The motion with the tolerances that the scenario's accuracy takes."""
    scenario = so_far.scenario
    assert scenario.accuracy is not None
    assert so_far.solver is not None
    last: list[_Moved] = []

    def run(settings: Solver) -> Trajectory | None:
        trajectory = _moved(replace(so_far, solver=settings), dynamics, stretches, y, monitor, sink)
        last.append(_Moved(trajectory, settings, None))
        return None if monitor.outcome else trajectory

    asked = scenario.accuracy.tip
    started = time.perf_counter()
    found = to_accuracy(run, so_far.solver, asked, scenario.scene.arm.total_length)
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
