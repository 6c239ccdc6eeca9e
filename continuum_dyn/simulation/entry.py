"""Entry of the simulation: a scenario in, its answer out.

Every run ends in a named outcome and keeps what it computed.
"""

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from continuum_dyn.integrators import Budget
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.solver import Accuracy
from continuum_dyn.simulation.at_rest import find_equilibria
from continuum_dyn.simulation.in_motion import compute_motion
from continuum_dyn.simulation.mesh import Mesh, extrapolate, search_mesh
from continuum_dyn.simulation.resumption import Resumption
from continuum_dyn.simulation.run import Run, Sink
from statics.outcome import Outcome
from statics.support.interruption import defer_interruption

TIME_PART = 0.25
"""Largest integration error of a mesh, over the accuracy; two extrapolated make nearly twice that."""


def simulate(
    scenario: Scenario,
    progress: Callable[[float], None] | None = None,
    budget: Budget | None = None,
    *,
    sink: Sink | None = None,
    resumption: Resumption | None = None,
) -> Run:
    """Answer a scenario: see ``Run``.

    ``progress`` is called with the fraction done; ``budget`` bounds the steps of a motion and the seconds of
    a motion or a ramp, by default those of the scenario's solver. The ``sink`` receives a motion's samples
    while it runs. With a ``resumption`` a motion continues from its last sample; if an accuracy is requested,
    its trials restart.
    Raises ``InputError`` for a scene that cannot be simulated, ``KernelCacheError`` if kernels cannot be
    kept. Every event during solving, Ctrl-C included, is an outcome, not an exception: the run holds all that
    was computed. A second Ctrl-C raises ``KeyboardInterrupt``.
    """
    if budget is None:
        budget = Budget(scenario.solver.max_steps, scenario.solver.max_seconds)
    with defer_interruption() as interruption:
        if scenario.chooses_mesh and scenario.accuracy is not None:
            run = _choose_mesh(scenario, scenario.accuracy, progress, budget, sink)
        elif scenario.study.motion is not None:
            run = compute_motion(scenario, progress, budget, interruption, sink, resumption)
        else:
            run = find_equilibria(scenario, budget, interruption)
        if run.outcome is Outcome.INTERRUPTED:
            interruption.asked = False
    return run


def _choose_mesh(
    scenario: Scenario,
    accuracy: Accuracy,
    progress: Callable[[float], None] | None,
    budget: Budget,
    sink: Sink | None,
) -> Run:
    """Answer on the coarsest mesh that is fine enough, with the estimate of the whole error."""
    started, tip = time.monotonic(), accuracy.tip
    runs: dict[int, Run] = {}

    def tips(subsegments: int) -> np.ndarray | None:
        if subsegments not in runs:
            left = replace(budget, seconds=budget.seconds - (time.monotonic() - started))
            trial = scenario.with_mesh(subsegments, TIME_PART * tip)
            runs[subsegments] = simulate(trial, progress, left, sink=sink)
        return runs[subsegments].tips

    most = scenario.study.max_subsegments(scenario.scene.arm)
    mesh = search_mesh(tips, (1.0 - 2.0 * TIME_PART) * tip, most)
    solve_time = sum(run.solve_time for run in runs.values())
    if mesh is None:
        return replace(next(run for run in runs.values() if run.tips is None), solve_time=solve_time)
    run = runs[mesh.subsegments]
    if mesh.extrapolated:
        run = _extrapolate_run(run, runs[2 * mesh.subsegments])
    if not mesh.reached:
        stopped = next((run for run in runs.values() if run.tips is None), run)
        reason = f"{stopped.message}; " if stopped is not run else ""
        run = replace(run, outcome=stopped.outcome, message=reason + _coarse_message(mesh, tip, solve_time))
    error = mesh.estimate + (run.tip_error or 0.0)
    requested = replace(run.scenario, accuracy=accuracy, chooses_mesh=True)
    return replace(run, scenario=requested, tip_error=error, mesh=mesh, solve_time=solve_time)


def _extrapolate_run(coarse: Run, fine: Run) -> Run:
    """The finer run with the poses of the continuous arm."""
    run = replace(
        fine,
        equilibria=list(map(extrapolate, coarse.equilibria, fine.equilibria)),
        static_path=list(map(extrapolate, coarse.static_path, fine.static_path)),
    )
    if coarse.trajectory is None or fine.trajectory is None:
        return run
    error = (4.0 * (fine.tip_error or 0.0) + (coarse.tip_error or 0.0)) / 3.0
    trajectory = extrapolate(coarse.trajectory, fine.trajectory)
    rests = list(map(extrapolate, coarse.rests, fine.rests))
    return replace(run, tip_error=error).with_trajectory(trajectory, rests)


def _coarse_message(mesh: Mesh, tip: float, seconds: float) -> str:
    return (
        f"accuracy of {tip:g} m not reached: {mesh.estimate:.2g} m from meshes of {mesh.subsegments} and "
        f"{2 * mesh.subsegments} segments from disk to disk, after {seconds:.3g} s"
    )
