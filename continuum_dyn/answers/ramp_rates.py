"""The lag of a ramp at other rates, by running it."""

from collections.abc import Callable
from dataclasses import replace
from math import ceil

import numpy as np

from continuum_dyn.answers.lag import gap, rate_within
from continuum_dyn.answers.pace import at_pace
from continuum_dyn.answers.ramp import RampAnswers, RateLag
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.simulation import simulate
from statics.errors import InputError

PACES = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Rates to run at, over the rate at which a proportional lag would reach the error."""
CLOSE, REFINEMENTS = 0.02, 3
"""Relative distance of a lag from the error that is close enough, and largest number of runs to get there.

The oscillations that a ramp's corners excite make the lag uneven between two rates.
"""


def measure_at_other_rates(
    found: RampAnswers, scenario: Scenario, progress: Callable[[str], None] = lambda _: None
) -> RampAnswers:
    """Add to a ramp's figures its lags at rates about ``quasistatic_rate``, and that rate from them.

    Raises ``InputError`` if the log has no motion, or if a run does not reach its end.
    """
    own, about, error = (found.figures[n] for n in ("ramp_rate", "quasistatic_rate", "quasistatic_error"))
    if own is None or about is None or error is None:
        raise InputError(f"no quasistatic rate can be measured: {found.missing['quasistatic_rate']}.")
    lags = [_lag_at(scenario, own, pace * about, progress) for pace in PACES]
    rate = rate_within(error, *np.array(lags).T)
    for _ in range(REFINEMENTS):
        if rate is None or any(abs(lag / error - 1.0) < CLOSE for _, lag in lags):
            break
        lags.append(_lag_at(scenario, own, rate, progress))
        rate = rate_within(error, *np.array(lags).T)
    missing = {name: why for name, why in found.missing.items() if name != "measured_quasistatic_rate"}
    if rate is None:
        missing["measured_quasistatic_rate"] = "at none of the rates run does the lag exceed the error"
    figures = found.figures | {"measured_quasistatic_rate": rate}
    return replace(found, measured=tuple(sorted(lags)), figures=figures, missing=missing)


def _lag_at(scenario: Scenario, own: float, rate: float, progress: Callable[[str], None]) -> RateLag:
    progress(f"at {rate:.3g} per s")
    pace = rate / own
    faster = at_pace(scenario, pace)
    study = faster.require_motion("only a motion can be run at other rates")
    samples = max(study.samples, 1 + ceil((study.samples - 1) / pace))  # no farther apart
    run = simulate(replace(faster, study=replace(study, samples=samples, static_path=True)))
    found = [sample for sample, point in enumerate(run.static_path) if point.found]
    if run.tips is None or not found:
        reason = run.message or "no equilibrium of its static path was found"
        raise InputError(f"at {pace:.3g} times its rate the ramp ends as {run.outcome}: {reason}.")
    rests = np.array([run.static_path[sample].tip[:2] for sample in found])
    return RateLag(rate, float(gap(run.tips[found], rests).max()))
