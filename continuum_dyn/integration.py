"""The equations of motion through ``scipy.integrate.solve_ivp``, from corner to corner.

Integration restarts at every corner of a tension profile, so that no step crosses one.
"""

import warnings
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from continuum_dyn.dynamics import Dynamics
from continuum_dyn.integrators import IMPLICIT, METHODS, Monitor, interruptible
from continuum_dyn.profiles import Span
from continuum_dyn.study import Solver
from continuum_dyn.trajectory import Trajectory, trajectory_of
from statics.outcome import Outcome

COUNTERS = {"nfev": "evaluations", "njev": "jacobians", "nlu": "decompositions"}
"""What SciPy's solvers count, and what we call it."""

FIRST_STEP = 1e-3
"""First step of each span, in radians of the arm's lowest frequency or of the drive's, if that is higher."""


class _Samples(NamedTuple):
    time: np.ndarray
    states: np.ndarray
    tension: np.ndarray


def inspector(dynamics: Dynamics) -> Callable[[float, np.ndarray], tuple[Outcome, str] | None]:
    """What a monitor asks of every accepted state: finite, and within the geometric limits."""

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


def integrate(
    dynamics: Dynamics,
    stretches: list[Span],
    samples: np.ndarray,
    y: np.ndarray,
    solver: Solver,
    monitor: Monitor,
) -> Trajectory:
    """The motion from state ``y`` over all spans, at ``samples`` (s; both ends included).

    A run that the monitor stops early keeps the samples up to there, and the last acceptable state.
    """
    monitor.reached = (0.0, y)
    parts = [_Samples(samples[:1], y[None, :], stretches[0].tension(samples[:1]))]
    counters = dict.fromkeys(COUNTERS.values(), 0)
    with interruptible(monitor), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for span in stretches:
            inside = samples[1:][(samples[1:] >= span.start) & (samples[1:] < span.end)]
            if span is stretches[-1]:
                inside = samples[1:][samples[1:] >= span.start]
            solution = _solve_span(dynamics, solver, span, np.append(inside, span.end), monitor)
            time = np.array(solution.t[: len(inside)], dtype=float)
            states = np.reshape(solution.y, (dynamics.state_size, -1)).T[: len(time)]
            parts.append(_Samples(time, states, span.tension(time)))
            for theirs, ours in COUNTERS.items():
                counters[ours] += int(getattr(solution, theirs))
            if solution.status != 0:
                parts.append(_last_reached(parts, span, monitor.reached))
                break
    times, states, tension = (np.concatenate(column) for column in zip(*parts, strict=True))
    whole = trajectory_of(dynamics, times, states, tension, {"steps": monitor.steps, **counters})
    finite = whole.finite()
    if finite.time.size < whole.time.size:
        monitor.stop(Outcome.DIVERGED, f"energies overflow at t = {times[finite.time.size]:.6g} s")
    return finite


def _last_reached(parts: list[_Samples], span: Span, reached: tuple[float, np.ndarray]) -> _Samples:
    """The last acceptable state of a run that stopped early, unless it is a sample already."""
    t, y = reached
    sampled = any(part.time.size and part.time[-1] >= t for part in parts)
    time = np.array([] if sampled else [t])
    return _Samples(time, np.tile(y, (time.size, 1)), span.tension(time))


def _first_step(dynamics: Dynamics, span: Span) -> float:
    """A step that resolves the arm and its drive: at rest, solvers left alone try the whole span."""
    fastest = max(dynamics.frequency, float(np.max(span.pieces[:, 4], initial=0.0)))
    return min(FIRST_STEP / fastest, span.end - span.start)


def _solve_span(dynamics: Dynamics, solver: Solver, span: Span, at: np.ndarray, monitor: Monitor) -> Any:
    """``solve_ivp`` over one span, from where the monitor has seen the last acceptable state."""
    return solve_ivp(
        lambda t, y: dynamics.rate(t, y, span),
        (span.start, span.end),
        monitor.reached[1],
        method=METHODS[solver.method],
        t_eval=np.unique(at),
        rtol=solver.rtol,
        atol=solver.atol * dynamics.scales(),
        first_step=_first_step(dynamics, span),
        monitor=monitor,
        **({"jac": lambda t, y: dynamics.jacobian(t, y, span)} if solver.method in IMPLICIT else {}),
    )
