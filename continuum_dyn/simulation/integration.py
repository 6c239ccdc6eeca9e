"""Integration of the equations of motion by a solver with SciPy's interface, from corner to corner.

No step crosses a corner of a profile. Solvers restart there; the chain's own only if inputs jump or a
wave starts: at other corners accelerations are continuous, and the step size continues.
"""

import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from continuum_dyn.integrators import METHODS, Budget, Monitor, check
from continuum_dyn.integrators.methods import drive_frequency
from continuum_dyn.modes import fastest_frequency
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Interval, Intervals, Timeline, inputs_at, join_intervals
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.samples import Samples
from continuum_dyn.simulation.trajectory import Trajectory
from statics.outcome import Outcome

if TYPE_CHECKING:
    from scipy.integrate import OdeSolver

BRIEF = 1e-12
"""Duration of the motion that only loads kernels, s."""

PART_OF_PERIOD = 1 / 20
"""Default step of a method with equal steps, in the shortest period of the arm or of its drive."""


def with_step(dynamics: Dynamics, solver: Solver, timeline: Timeline, y: np.ndarray) -> Solver:
    """The solver's settings, with the default step of its method from rest at ``y`` if it takes one."""
    if not solver.has_fixed_step or solver.step is not None:
        return solver
    drive = max(map(drive_frequency, timeline))
    whole = 2.0 * np.pi / (timeline.end - timeline.start)
    fastest = max(fastest_frequency(dynamics, timeline.first, y), drive, whole)
    return replace(solver, step=PART_OF_PERIOD * 2.0 * np.pi / fastest)


def warm_up(dynamics: Dynamics, solver: Solver, interval: Interval) -> None:
    """Compile or load the kernels of the method, so that later calls only solve."""
    method = METHODS[solver.method]
    brief = Interval(interval.start, interval.start + BRIEF, interval.pieces)
    y = dynamics.state(np.zeros((dynamics.scene.arm.segments, dynamics.dofs)))
    dynamics.clearance(y)
    if method.on_chain:
        unwatched = Monitor(inspect=lambda _t, _y: None, budget=Budget(steps=1))
        timeline = Timeline.of(brief)
        integrate(dynamics, timeline, np.array([brief.start, brief.end]), y, solver, unwatched)
        return
    dynamics.rate(interval.start, y, interval)
    dynamics.observe(y[None, :], interval.inputs(np.array([interval.start])))
    if method.needs_jacobian:
        dynamics.jacobian(interval.start, y, interval)


def add_jump(dynamics: Dynamics, before: Interval, interval: Interval, monitor: Monitor) -> None:
    """Add the energy that a jump of a cable's displacement puts into its stretch to the input work."""
    if not dynamics.scene.driven_by_length:
        return
    t, y = monitor.reached
    inputs = np.concatenate([side.inputs(np.array([interval.start])) for side in (before, interval)])
    energy = dynamics.observe(np.tile(y, (2, 1)), inputs).ledger["elastic_energy"]
    y = y.copy()
    y[2 * dynamics.size] += energy[1] - energy[0]
    monitor.reached = (t, y)


def inspector(dynamics: Dynamics) -> Callable[[float, np.ndarray], tuple[Outcome, str] | None]:
    """A monitor's check of every accepted state: finite, and within the geometric limits."""

    def inspect(t: float, y: np.ndarray) -> tuple[Outcome, str] | None:
        if not np.isfinite(y).all():
            index = int(np.flatnonzero(~np.isfinite(y))[0])
            segment = index % dynamics.size // dynamics.dofs + 1
            return Outcome.DIVERGED, f"coordinates of segment {segment} overflow at t = {t:.6g} s"
        if dynamics.clearance(y) <= 0.0:
            disk = dynamics.closest_disk(y)
            return (
                Outcome.GEOMETRY_LIMIT,
                f"holes meet before disk {disk} at t = {t:.6g} s; reduce the inputs",
            )
        return None

    return inspect


def integrate(
    dynamics: Dynamics,
    timeline: Timeline,
    samples: np.ndarray,
    y: np.ndarray,
    solver: Solver,
    monitor: Monitor,
    gathered: Samples | None = None,
) -> Trajectory:
    """The motion from state ``y`` over the whole timeline, at ``samples`` (s; both ends included).

    They join those that are ``gathered`` already. A run that the monitor stops early keeps the samples up to
    there, and the last acceptable state. Raises ``InputError`` if the method cannot integrate the scene.
    """
    check(dynamics.scene, solver.method)
    start, first = timeline.start, timeline.first
    monitor.reached = (start, y)
    steps, rejections = monitor.steps, monitor.rejections
    solver = with_step(dynamics, solver, timeline, y)
    gathered = gathered or Samples(dynamics)
    samples = samples[samples > gathered.latest]
    done = int(np.searchsorted(samples, start, side="right"))
    gathered.add(samples[:done], np.tile(y, (done, 1)), first.inputs(samples[:done]), np.zeros(done))
    counters: Counter[str] = Counter()
    before = None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for intervals in _group(dynamics, solver, timeline):
            if before is not None:
                add_jump(dynamics, before, intervals[0], monitor)
            before = intervals[-1]
            side = "right" if before.end == timeline.end else "left"
            until = int(np.searchsorted(samples, before.end, side=side))
            stepper = _solve(dynamics, solver, intervals, samples[done:until], monitor, gathered)
            counters.update(_count_work(stepper, dynamics, solver))
            if stepper.status == "failed":
                _add_last_reached(gathered, intervals, monitor.reached)
                break
            done = until
    counters["steps"] = monitor.steps - steps
    if METHODS[solver.method].crosses_corners:
        counters["rejections"] = monitor.rejections - rejections
    trajectory = gathered.trajectory(dict(counters))
    if gathered.overflow is not None:
        monitor.stop(Outcome.DIVERGED, f"energies overflow at t = {gathered.overflow:.6g} s")
    return trajectory


def _add_last_reached(
    gathered: Samples, intervals: Sequence[Interval], reached: tuple[float, np.ndarray]
) -> None:
    """Add the last acceptable state of a run that stopped early, unless it is a sample already."""
    t, y = reached
    if t > gathered.latest:
        time = np.array([t])
        gathered.add(time, y[None, :], inputs_at(intervals, time), np.zeros(1))


def _count_work(stepper: Any, dynamics: Dynamics, solver: Solver) -> dict[str, int]:
    """Counts of the solver, and its machine-independent work in segment evaluations.

    One of these is a segment's part of a right-hand side, a Newton iteration, or one column of a Jacobian.
    """
    n, columns = dynamics.scene.arm.segments, 2 * dynamics.size
    if METHODS[solver.method].on_chain:
        return {"newton_iterations": stepper.nfev, "segment_evaluations": stepper.nfev * n}
    return {
        "evaluations": int(stepper.nfev),
        "jacobians": int(stepper.njev),
        "decompositions": int(stepper.nlu),
        "segment_evaluations": int(stepper.nfev + stepper.njev * columns) * n,
    }


def _group(dynamics: Dynamics, solver: Solver, timeline: Timeline) -> Iterator[Intervals]:
    """The intervals in groups that one solver may cross: without a jump of accelerations between them.

    If nodes carry no mass, a corner of the forces is such a jump.
    """
    separate = not METHODS[solver.method].crosses_corners or dynamics.scene.arm.massless_nodes
    for block in timeline.blocks():
        if separate:
            yield from (block[number : number + 1] for number in range(len(block)))
        else:
            yield from join_intervals(block)


def _solve(
    dynamics: Dynamics,
    solver: Solver,
    intervals: Intervals,
    at: np.ndarray,
    monitor: Monitor,
    gathered: Samples,
) -> "OdeSolver":
    """Step from the monitor's state to the end of the intervals, gather states at the times ``at``.

    The last step before the monitor ends the run is sampled like any other, unless its end is not acceptable.
    """
    method = METHODS[solver.method]
    stepper: Any = method.stepper(
        lambda t, y: dynamics.rate(t, y, intervals[0]),
        intervals[0].start,
        monitor.reached[1],
        intervals[-1].end,
        monitor=monitor,
        **method.options(dynamics, solver, intervals),
    )
    done = 0
    while stepper.status == "running":
        stepper.step()
        until = int(np.searchsorted(at, stepper.t, side="right"))
        acceptable = stepper.t_old is not None and monitor.reached[0] == stepper.t
        if acceptable and until > done:
            times = at[done:until]
            states = stepper.dense_output()(times).T
            gathered.add(times, states, inputs_at(intervals, times), _step_sizes(stepper, times))
            done = until
    return stepper


def _step_sizes(stepper: Any, times: np.ndarray) -> np.ndarray:
    """Sizes (s) of the solver's last step, or of its internal steps, at times within it."""
    ends = stepper.internal_times
    if ends is None:
        return np.full(times.size, (stepper.t - stepper.t_old) / stepper.internal_steps)
    return np.diff(ends)[np.clip(np.searchsorted(ends, times) - 1, 0, len(ends) - 2)]
