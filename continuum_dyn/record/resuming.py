"""The motion of a log that was broken off, for the simulation to go on with."""

import numpy as np
from pydantic import ValidationError

from continuum_dyn.integrators import METHODS
from continuum_dyn.record import Log
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.resumption import Resumption
from statics.errors import LogError
from statics.outcome import Outcome

BROKEN_OFF = (Outcome.INTERRUPTED, Outcome.BUDGET_EXCEEDED)
"""Outcomes that say nothing against going on."""


def logged_motion(log: Log, scenario: Scenario) -> Resumption | None:
    """What the log of that scenario has of its motion; None where it must begin anew.

    That is where nothing moved yet, and where an accuracy is sought, by trials. Raises ``LogError`` for a
    log that has ended, or whose samples are not those of its scenario.
    """
    if log.complete and log.outcome not in BROKEN_OFF:
        raise LogError(
            f"{log.path}: the run has ended ({log.outcome}); there is nothing to go on with. "
            f"To run it again: continuum-dyn run {log.path}"
        )
    if scenario.study.motion is None or scenario.accuracy is not None:
        return None
    if not log.trajectory or not log.trajectory["time"].size:
        return None
    _check_samples(log, scenario)
    return Resumption(_solver(log, scenario), log.counters, log.trajectory)


def _solver(log: Log, scenario: Scenario) -> Solver:
    """The one that has resumption: with the method that the program had chosen, if it was its to choose."""
    names = ("method", "rtol", "atol", "step")
    given = {name: log.attributes[name] for name in names if name in log.attributes}
    if given.get("method") not in METHODS:
        raise LogError(f"{log.path}: attribute method: {given.get('method')!r} is no integrator of a motion.")
    budget = {"max_steps": scenario.solver.max_steps, "max_seconds": scenario.solver.max_seconds}
    try:
        return Solver(**given, **budget)
    except ValidationError as error:
        detail = error.errors()[0]
        place = " ".join(map(str, detail["loc"]))
        raise LogError(f"{log.path}: attribute {place}: {detail['msg']}.") from error


def _check_samples(log: Log, scenario: Scenario) -> None:
    found, arm = log.trajectory, scenario.scene.arm
    told = f"{log.path}: its trajectory is not that of its scenario:"
    if found["bend_angle"].shape[1] != arm.segments:
        raise LogError(f"{told} {found['bend_angle'].shape[1]} segments of {arm.segments}.")
    for name in ("elongation", "elongation_rate"):
        if (name in found) != ("elongation" in scenario.scene.coordinates):
            raise LogError(f"{told} {name} is {'there' if name in found else 'missing'}.")
    time = found["time"]
    if time[0] != 0.0 or np.any(np.diff(time) <= 0.0):
        raise LogError(f"{told} its times do not rise from 0.")
