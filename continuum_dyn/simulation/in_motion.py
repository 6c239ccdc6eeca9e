"""Answers of studies of motion."""

import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from continuum_dyn.integrators import Budget, Monitor
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.accuracy import search_tolerance
from continuum_dyn.simulation.at_rest import geometric_limit, judge, reason_to_stop
from continuum_dyn.simulation.energy_balance import unbalanced_message
from continuum_dyn.simulation.messages import failure_message
from continuum_dyn.simulation.motion import Motion
from continuum_dyn.simulation.rest_gap import tip_gap
from continuum_dyn.simulation.resumption import Resumption
from continuum_dyn.simulation.run import Run, Sink, interrupted_early
from continuum_dyn.simulation.samples import Samples
from continuum_dyn.simulation.trajectory import Trajectory
from continuum_dyn.stability import why_not_judged
from statics.equilibria import Equilibrium
from statics.outcome import Outcome
from statics.ramp import ramp
from statics.support.interruption import Interruption, allowed
from statics.support.stages import stage


def compute_motion(
    scenario: Scenario,
    progress: Callable[[float], None] | None,
    budget: Budget,
    interruption: Interruption,
    sink: Sink | None,
    resumption: Resumption | None,
) -> Run:
    """Answer a study of motion."""
    try:
        with allowed(), stage("kernels of statics and dynamics"):
            motion = Motion(scenario)
            motion.statics.warm_up()
    except KeyboardInterrupt:
        return interrupted_early(scenario)
    started = time.perf_counter()
    start = motion.rest
    if not start.found:
        limit = geometric_limit(motion.statics, start, scenario.initial_inputs, None)
        message, solve_time = failure_message(start, None, limit), time.perf_counter() - started
        return Run(scenario, start.outcome, message, [start], solve_time=solve_time)
    try:
        with allowed(), stage("choice of the method, and its kernels"):
            solver = resumption.solver if resumption else motion.choose_solver()
            motion.warm_up(solver)
    except KeyboardInterrupt:
        return Run(scenario, Outcome.INTERRUPTED, "interrupted before the motion began", [start])
    return _integrate_and_check(
        motion, solver, motion.monitor(budget, interruption, progress), sink, resumption
    )


def _integrate_and_check(
    motion: Motion, solver: Solver, monitor: Monitor, sink: Sink | None, resumption: Resumption | None
) -> Run:
    """Integrate, check the energies, and compare the end with the final equilibrium."""
    scenario, started = motion.scenario, time.perf_counter()
    with stage(f"motion by {solver.method}"):
        if scenario.accuracy is None:
            moved = _Moved(_integrate(motion, solver, monitor, sink, resumption), solver, None)
        else:
            moved = _integrate_to_accuracy(motion, solver, scenario.accuracy.tip, monitor, sink)
    trajectory, length = moved.trajectory, scenario.scene.arm.total_length
    unbalanced = unbalanced_message(trajectory, moved.solver, length, scenario.solver.chooses_method)
    if unbalanced is not None:
        monitor.stop(Outcome.DIVERGED, unbalanced)
    end, message = _find_end(motion, trajectory)
    path = _find_static_path(motion, trajectory, monitor) if motion.study.static_path else []
    solve_time = time.perf_counter() - started
    ends, growths = [motion.rest, end], [None, None]
    if why_not_judged(scenario.scene) is None:
        ends, growths = judge(motion.dynamics, ends)
    run = Run(
        scenario,
        monitor.outcome or Outcome.COMPLETED,
        monitor.message or message,
        ends,
        path,
        trajectory,
        solver=moved.solver,
        tip_error=moved.tip_error,
        solve_time=solve_time,
    )
    if monitor.outcome:
        return run
    return run.with_trajectory(trajectory, motion.statics.rests(ends[-1]), growths[-1])


class _Moved(NamedTuple):
    trajectory: Trajectory
    solver: Solver
    tip_error: float | None


def _integrate(
    motion: Motion,
    solver: Solver,
    monitor: Monitor,
    sink: Sink | None,
    resumption: Resumption | None = None,
) -> Trajectory:
    """Integrate from the start, or from where an interrupted motion resumes."""
    gathered = Samples(motion.dynamics, None if sink is None else sink.add)
    if sink is not None:
        message = "the run ended before it was complete"
        sink.begin(Run(motion.scenario, Outcome.INTERRUPTED, message, [motion.rest], solver=solver))
    if resumption is not None:
        return resumption.integrate(motion, monitor, gathered)
    return motion.integrate(solver, monitor, gathered)


def _integrate_to_accuracy(
    motion: Motion, solver: Solver, tip: float, monitor: Monitor, sink: Sink | None
) -> _Moved:
    """Integrate with the loosest tolerances whose tip error is estimated below ``tip`` (m)."""
    tried: list[_Moved] = []

    def run(settings: Solver) -> Trajectory | None:
        tried.append(_Moved(_integrate(motion, settings, monitor, sink), settings, None))
        return None if monitor.outcome else tried[-1].trajectory

    started = time.perf_counter()
    found = search_tolerance(run, solver, tip, motion.scenario.scene.arm.total_length)
    if found is None:
        return tried[-1]
    if not found.reached:
        stopped = f"{monitor.message}; " if monitor.message else ""
        monitor.message = (
            f"{stopped}accuracy of {tip:g} m not reached: {found.estimate:.2g} m at rtol "
            f"{found.solver.rtol:.1g}, after {len(found.trials)} trials and "
            f"{time.perf_counter() - started:.3g} s"
        )
    return _Moved(found.trajectory, found.solver, found.estimate)


def _find_end(motion: Motion, trajectory: Trajectory) -> tuple[Equilibrium, str]:
    """The equilibrium that the motion should settle to, searched from its start or, failing that, its end.

    A message says if it is the latter. Cables that rub leave the arm anywhere between two branches.
    """
    inputs, within = motion.last_inputs, motion.scenario.settled_within
    end = motion.statics.solve(inputs, motion.rest.coordinates, motion.rest)
    if _rests_at(end, motion, trajectory):
        return end, ""
    last = trajectory.bend_angle[-1], None if trajectory.elongation is None else trajectory.elongation[-1]
    near = motion.statics.solve(inputs, np.column_stack([column for column in last if column is not None]))
    if not _rests_at(near, motion, trajectory):
        return end, ""
    x, y, _ = near.tip
    message = f"at another equilibrium than the one next to the start: tip at x {x:.4g} m, y {y:.4g} m"
    return near, message if end.found and tip_gap(near.tip, [end.tip]) > within else ""


def _rests_at(end: Equilibrium, motion: Motion, trajectory: Trajectory) -> bool:
    """Whether the tip has reached that equilibrium, or another position that friction allows."""
    rests = [rest.tip for rest in motion.statics.rests(end)]
    return bool(rests) and tip_gap(trajectory.tip, rests) < motion.scenario.settled_within


def _find_static_path(motion: Motion, trajectory: Trajectory, monitor: Monitor) -> list[Equilibrium]:
    """The equilibrium of every sample, or of those before Ctrl-C or the end of the budget."""
    samples = monitor.interruption.until_asked(trajectory.inputs)
    within_budget = monitor.budget.spent_on(samples, monitor.started)
    path = ramp(motion.statics, within_budget, motion.rest.coordinates)
    if len(path) < len(trajectory.inputs):
        outcome, reason = reason_to_stop(monitor.budget, monitor.interruption)
        points = f"{len(path)} of {len(trajectory.inputs)} points"
        monitor.stop(outcome, f"{reason} after the motion, with {points} of its static path")
    return path
