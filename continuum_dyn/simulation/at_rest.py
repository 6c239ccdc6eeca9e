"""Answers of studies at rest: equilibria one by one, or a path of them through its folds."""

import time

import numpy as np

from continuum_dyn.integrators import Budget
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.simulation.messages import failure_message, path_message, points_message
from continuum_dyn.simulation.run import Run, interrupted_early
from continuum_dyn.stability import Growth, judged, why_not_judged
from statics.arc_length import MOST_STEPS, follow
from statics.equilibria import Equilibrium, StaticSolver
from statics.outcome import Outcome
from statics.ramp import limit_on_the_way, ramp
from statics.support.interruption import Interruption, allowed
from statics.support.stages import stage


def find_equilibria(scenario: Scenario, budget: Budget, interruption: Interruption) -> Run:
    """Answer a study at rest."""
    try:
        with allowed(), stage("kernels of statics"):
            solver = StaticSolver(scenario.scene)
            solver.warm_up()
    except KeyboardInterrupt:
        return interrupted_early(scenario)
    inputs = scenario.study.input_rows(scenario)
    if scenario.study.follows_path:
        return _follow_path(scenario, solver, inputs, budget, interruption)
    return _find_one_by_one(scenario, solver, inputs, budget, interruption)


def _follow_path(
    scenario: Scenario, solver: StaticSolver, inputs: np.ndarray, budget: Budget, interruption: Interruption
) -> Run:
    """Follow the path of equilibria through all its folds."""
    started = time.monotonic()
    steps = budget.spent_on(interruption.until_asked(range(MOST_STEPS)), started)
    with stage("equilibria"):
        path = follow(solver, inputs, steps=steps)
    solve_time = time.monotonic() - started
    outcome, message = path.outcome, path_message(path)
    if outcome is Outcome.NO_EQUILIBRIUM and (interruption.asked or budget.is_spent(started)):
        outcome, reason = reason_to_stop(budget, interruption)
        message = f"{reason} {path.end.drive}"
    return Run(scenario, outcome, message, path.points, solve_time=solve_time)


def _find_one_by_one(
    scenario: Scenario, solver: StaticSolver, inputs: np.ndarray, budget: Budget, interruption: Interruption
) -> Run:
    """Find a stable equilibrium for each set of inputs."""
    started = time.monotonic()
    with stage("equilibria"):
        points = ramp(solver, budget.spent_on(interruption.until_asked(inputs), started))
    solve_time = time.monotonic() - started
    message, growths = points_message(points), [None] * len(points)
    if any(point.stable is None for point in points):
        message = why_not_judged(scenario.scene) or ""
        if not message:
            try:
                with allowed():  # kernels may have to be compiled
                    points, growths = judge(Dynamics(scenario.scene), points)
            except KeyboardInterrupt:
                reason = f"interrupted after {len(points)} of {len(inputs)} points, stability unknown"
                return Run(scenario, Outcome.INTERRUPTED, reason, points, solve_time=solve_time)
    outcome = Outcome.COMPLETED
    before: Equilibrium | None = None
    for point, growth, requested in zip(points, growths, inputs, strict=False):
        if point.outcome is not Outcome.COMPLETED:
            limit = geometric_limit(solver, point, requested, before)
            outcome, message = point.outcome, failure_message(point, growth, limit)
            break
        before = point
    if len(points) < len(inputs):
        outcome, reason = reason_to_stop(budget, interruption)
        message = f"{reason} after {len(points)} of {len(inputs)} points"
    return Run(scenario, outcome, message, points, solve_time=solve_time)


def reason_to_stop(budget: Budget, interruption: Interruption) -> tuple[Outcome, str]:
    """Outcome of a ramp that ended before its last point, and the reason in words."""
    if interruption.asked:
        return Outcome.INTERRUPTED, "interrupted"
    return Outcome.BUDGET_EXCEEDED, f"max_seconds = {budget.seconds:g} used up"


def geometric_limit(
    solver: StaticSolver, point: Equilibrium, inputs: np.ndarray, before: Equilibrium | None
) -> Equilibrium | None:
    """The equilibrium at which the inputs of a failed search reach a geometric limit, if they do."""
    if point.outcome is not Outcome.GEOMETRY_LIMIT:
        return None
    return limit_on_the_way(solver, inputs, before)


def judge(dynamics: Dynamics, points: list[Equilibrium]) -> tuple[list[Equilibrium], list[Growth | None]]:
    """Equilibria with the verdict of their modes if their energy gives none, and what grows about each."""
    found = [judged(dynamics, point) if point.stable is None else (point, None) for point in points]
    return [point for point, _ in found], [growth for _, growth in found]
