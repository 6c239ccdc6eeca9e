"""The equations of motion through a solver with SciPy's interface, from corner to corner.

No step crosses a corner of a profile. Solvers start anew there; the chain's own only where inputs jump or a
wave sets in: elsewhere accelerations go on, and the size of the steps with them.
"""

import warnings
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.integrate import OdeSolver

from continuum_dyn.dynamics import Dynamics
from continuum_dyn.integrators import IMPLICIT, METHODS, TABLEAUX, Budget, Monitor, check
from continuum_dyn.modes import fastest_frequency
from continuum_dyn.samples import Samples
from continuum_dyn.scenario.intervals import Interval, inputs_at, join_intervals
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.trajectory import Trajectory
from statics.outcome import Outcome

BRIEF = 1e-12
"""Duration of the motion that only loads what is compiled, s."""

FIRST_STEP = 1e-3
"""First step of each span, in radians of the arm's lowest frequency or of the drive's, if that is higher."""

PART_OF_PERIOD = 1 / 20
"""Step of the midpoint rule, in the shortest period of the arm or of its drive."""


def with_step(dynamics: Dynamics, solver: Solver, stretches: list[Interval], y: np.ndarray) -> Solver:
    """The solver's settings, with the step that its method takes by default from rest at ``y``."""
    if solver.method != "midpoint" or solver.step is not None:
        return solver
    drive = max(float(np.max(span.pieces[:, 4], initial=0.0)) for span in stretches)
    whole = 2.0 * np.pi / (stretches[-1].end - stretches[0].start)
    fastest = max(fastest_frequency(dynamics, stretches[0], y), drive, whole)
    return replace(solver, step=PART_OF_PERIOD * 2.0 * np.pi / fastest)


def warm_up(dynamics: Dynamics, solver: Solver, span: Interval) -> None:
    """Compile what the method needs, or load it compiled, so that what follows is solving alone."""
    brief = Interval(span.start, span.start + BRIEF, span.pieces)
    y = dynamics.state(np.zeros((dynamics.scene.arm.segments, dynamics.dofs)))
    dynamics.clearance(y)
    if solver.method in (*TABLEAUX, "midpoint"):
        unwatched = Monitor(inspect=lambda _t, _y: None, budget=Budget(steps=1))
        integrate(dynamics, [brief], np.array([brief.start, brief.end]), y, solver, unwatched)
        return
    dynamics.rate(span.start, y, span)
    dynamics.observe(y[None, :], span.inputs(np.array([span.start])))
    if solver.method in IMPLICIT:
        dynamics.jacobian(span.start, y, span)


def add_jump(dynamics: Dynamics, before: Interval, span: Interval, monitor: Monitor) -> None:
    """Add what a jump of a cable's displacement puts into its stretch to the state's input work."""
    if not dynamics.scene.driven_by_length:
        return
    t, y = monitor.reached
    inputs = np.concatenate([stretch.inputs(np.array([span.start])) for stretch in (before, span)])
    energy = dynamics.observe(np.tile(y, (2, 1)), inputs).ledger["elastic_energy"]
    y = y.copy()
    y[2 * dynamics.size] += energy[1] - energy[0]
    monitor.reached = (t, y)


def inspector(dynamics: Dynamics) -> Callable[[float, np.ndarray], tuple[Outcome, str] | None]:
    """What a monitor asks of every accepted state: finite, and within the geometric limits."""

    def inspect(t: float, y: np.ndarray) -> tuple[Outcome, str] | None:
        if not np.isfinite(y).all():
            index = int(np.flatnonzero(~np.isfinite(y))[0])
            segment = index % dynamics.size // dynamics.dofs + 1
            return Outcome.DIVERGED, f"segment {segment} is no longer finite at t = {t:.6g} s"
        if dynamics.clearance(y) <= 0.0:
            disk = dynamics.closest_disk(y)
            return Outcome.GEOMETRY_LIMIT, f"holes meet before disk {disk} at t = {t:.6g} s"
        return None

    return inspect


def integrate(
    dynamics: Dynamics,
    stretches: list[Interval],
    samples: np.ndarray,
    y: np.ndarray,
    solver: Solver,
    monitor: Monitor,
    gathered: Samples | None = None,
) -> Trajectory:
    """The motion from state ``y`` over all spans, at ``samples`` (s; both ends included).

    They join those that are ``gathered`` already. A run that the monitor stops early keeps the samples up to
    there, and the last acceptable state. Raises ``InputError`` where the method cannot integrate the scene.
    """
    check(dynamics.scene, solver.method)
    start = stretches[0].start
    monitor.reached = (start, y)
    steps, rejections = monitor.steps, monitor.rejections
    solver = with_step(dynamics, solver, stretches, y)
    gathered = gathered or Samples(dynamics)
    samples = samples[samples > gathered.latest]
    done = int(np.searchsorted(samples, start, side="right"))
    gathered.add(samples[:done], np.tile(y, (done, 1)), stretches[0].inputs(samples[:done]), np.zeros(done))
    counters: Counter[str] = Counter()
    before = None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for joined in _joined(dynamics, solver, stretches):
            if before is not None:
                add_jump(dynamics, before, joined[0], monitor)
            before = joined[-1]
            side = "right" if before is stretches[-1] else "left"
            until = int(np.searchsorted(samples, before.end, side=side))
            stepper = _solve(dynamics, solver, joined, samples[done:until], monitor, gathered)
            counters.update(_counted(stepper, dynamics, solver))
            if stepper.status == "failed":
                _add_last_reached(gathered, joined, monitor.reached)
                break
            done = until
    counters["steps"] = monitor.steps - steps
    if solver.method in TABLEAUX:
        counters["rejections"] = monitor.rejections - rejections
    trajectory = gathered.trajectory(dict(counters))
    if gathered.overflow is not None:
        monitor.stop(Outcome.DIVERGED, f"energies overflow at t = {gathered.overflow:.6g} s")
    return trajectory


def _add_last_reached(
    gathered: Samples, joined: Sequence[Interval], reached: tuple[float, np.ndarray]
) -> None:
    """The last acceptable state of a run that stopped early, unless it is a sample already."""
    t, y = reached
    if t > gathered.latest:
        time = np.array([t])
        gathered.add(time, y[None, :], inputs_at(joined, time), np.zeros(1))


def _counted(stepper: Any, dynamics: Dynamics, solver: Solver) -> dict[str, int]:
    """What a stretch cost: the solver's own counts, and machine-independent work in segment evaluations.

    One is a segment's part of a right-hand side, of a Newton iteration, or of one column of a Jacobian.
    """
    n, columns = dynamics.scene.arm.segments, 2 * dynamics.size
    if solver.method in (*TABLEAUX, "midpoint"):
        return {"newton_iterations": stepper.nfev, "segment_evaluations": stepper.nfev * n}
    return {
        "evaluations": int(stepper.nfev),
        "jacobians": int(stepper.njev),
        "decompositions": int(stepper.nlu),
        "segment_evaluations": int(stepper.nfev + stepper.njev * columns) * n,
    }


def _first_step(dynamics: Dynamics, span: Interval) -> float:
    """A step that resolves the arm and its drive: at rest, solvers left alone try the whole span."""
    fastest = max(dynamics.frequency, float(np.max(span.pieces[:, 4], initial=0.0)))
    return min(FIRST_STEP / fastest, span.end - span.start)


def _joined(dynamics: Dynamics, solver: Solver, stretches: list[Interval]) -> list[list[Interval]]:
    """The spans that one solver may cross: the chain's own go on where neither forces nor a wave set in.

    Where nodes carry no mass a corner of the forces is a jump of their accelerations.
    """
    if solver.method not in TABLEAUX or dynamics.scene.arm.massless_nodes:
        return [[span] for span in stretches]
    return join_intervals(stretches)


def _solve(
    dynamics: Dynamics,
    solver: Solver,
    joined: list[Interval],
    at: np.ndarray,
    monitor: Monitor,
    gathered: Samples,
) -> OdeSolver:
    """The solver after its last step from where the monitor is; states at the times ``at`` are gathered.

    A step that the monitor ends the run after is sampled like any other, unless its end is not acceptable.
    """
    stepper: Any = METHODS[solver.method](
        lambda t, y: dynamics.rate(t, y, joined[0]),
        joined[0].start,
        monitor.reached[1],
        joined[-1].end,
        monitor=monitor,
        **_options(dynamics, solver, joined),
    )
    done = 0
    while stepper.status == "running":
        stepper.step()
        until = int(np.searchsorted(at, stepper.t, side="right"))
        acceptable = stepper.t_old is not None and monitor.reached[0] == stepper.t
        if acceptable and until > done:
            times = at[done:until]
            states = stepper.dense_output()(times).T
            gathered.add(times, states, inputs_at(joined, times), _step_sizes(stepper, times))
            done = until
    return stepper


def _step_sizes(stepper: Any, times: np.ndarray) -> np.ndarray:
    """Of the solver's last step, or of the internal ones that it was made of, at times within it; s."""
    ends = stepper.internal_times
    if ends is None:
        return np.full(times.size, (stepper.t - stepper.t_old) / stepper.internal_steps)
    return np.diff(ends)[np.clip(np.searchsorted(ends, times) - 1, 0, len(ends) - 2)]


def _options(dynamics: Dynamics, solver: Solver, joined: list[Interval]) -> dict[str, Any]:
    """What the method needs beside the equations."""
    span = joined[0]
    if solver.method == "midpoint":
        return {"dynamics": dynamics, "span": span, "step": solver.step}
    first_step = _first_step(dynamics, span)
    if solver.method in TABLEAUX:
        allowed = (solver.rtol + solver.atol) * dynamics.scene.arm.total_length
        chain = {"dynamics": dynamics, "spans": joined, "tableau": TABLEAUX[solver.method]}
        return chain | {"tolerance": allowed, "first_step": first_step}
    tolerances = {"rtol": solver.rtol, "atol": solver.atol * dynamics.scales(), "first_step": first_step}
    if solver.method in IMPLICIT:
        return tolerances | {"jac": lambda t, y: dynamics.jacobian(t, y, span)}
    return tolerances
