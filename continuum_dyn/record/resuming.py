"""State from which an interrupted motion resumes, read from its log."""

import numpy as np
from pydantic import ValidationError

from continuum_dyn.integrators import METHODS
from continuum_dyn.record import Log
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.resumption import Resumption
from statics.errors import LogError
from statics.outcome import Outcome

RESUMABLE = (Outcome.INTERRUPTED, Outcome.BUDGET_EXCEEDED)
"""Outcomes of runs that can be resumed."""


def resumption_of(log: Log, scenario: Scenario) -> Resumption | None:
    """State from which the motion of a log resumes; None if the motion must restart.

    It must restart if nothing moved yet, or if its accuracy is found by trials. Raises ``LogError`` if the
    run has ended, or if the samples do not belong to the scenario.
    """
    if log.complete and log.outcome not in RESUMABLE:
        raise LogError(
            f"{log.path}: the run has ended ({log.outcome}) and cannot be resumed. "
            f"To run it again: continuum-dyn run {log.path}"
        )
    if scenario.study.motion is None or scenario.accuracy is not None:
        return None
    if not log.trajectory or not log.trajectory["time"].size:
        return None
    _check_samples(log, scenario)
    return Resumption(_solver(log, scenario), log.counters, log.trajectory)


def _solver(log: Log, scenario: Scenario) -> Solver:
    """The solver of the interrupted run, with the method that was chosen for it."""
    names = ("method", "rtol", "atol", "step")
    given = {name: log.attributes[name] for name in names if name in log.attributes}
    if given.get("method") not in METHODS:
        raise LogError(f"{log.path}: attribute method: unknown integrator {given.get('method')!r}.")
    budget = {"max_steps": scenario.solver.max_steps, "max_seconds": scenario.solver.max_seconds}
    try:
        return Solver(**given, **budget)
    except ValidationError as error:
        detail = error.errors()[0]
        place = " ".join(map(str, detail["loc"]))
        raise LogError(f"{log.path}: attribute {place}: {detail['msg']}.") from error


def _check_samples(log: Log, scenario: Scenario) -> None:
    found, arm = log.trajectory, scenario.scene.arm
    message = f"{log.path}: its trajectory does not fit its scenario:"
    if found["bend_angle"].shape[1] != arm.segments:
        raise LogError(f"{message} {found['bend_angle'].shape[1]} segments, not {arm.segments}.")
    for name in ("elongation", "elongation_rate"):
        if (name in found) != ("elongation" in scenario.scene.coordinates):
            raise LogError(f"{message} {name} is {'unexpected' if name in found else 'missing'}.")
    time = found["time"]
    if time[0] != 0.0 or np.any(np.diff(time) <= 0.0):
        raise LogError(f"{message} its times do not increase from 0.")
