"""Cost of accuracy: a motion by every method and tolerance, on every mesh, and without each effect.

Times are the least of some repeats of the whole integration, samples and energies included: what else the
machine does can only add to them. Beside them stands the work, in segment evaluations, which no clock blurs.
"""

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from continuum_dyn.integrators import METHODS, Budget
from continuum_dyn.modes import rates
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.solver import Method, Solver
from continuum_dyn.simulation.accuracy import tip_distance
from continuum_dyn.simulation.mesh import richardson
from continuum_dyn.simulation.motion import Motion
from continuum_dyn.simulation.trajectory import Trajectory
from statics.equilibria import Equilibrium, StaticSolver
from statics.errors import InputError
from statics.judges.exact_rod import RodError, exact_rod

TOLERANCES: dict[Method, tuple[float, ...]] = {
    "chain": (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10),
    "explicit": (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9),
    "LSODA": (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9),
    "Radau": (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7),
    "BDF": (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8),
    "RK23": (1e-3, 1e-4, 1e-5, 1e-6),
    "RK45": (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8),
    "DOP853": (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9),
}
"""Relative tolerances tried, loosest first."""
REFERENCES = (Solver("chain", rtol=1e-13, atol=1e-15), Solver("Radau", rtol=1e-12, atol=1e-15))
"""Two methods that must agree on the motion that errors are measured against."""
SUBSEGMENTS = (1, 2, 4, 8, 16, 32, 64)
"""Segments from disk to disk."""
TARGETS = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
"""Tip errors (m) whose cheapest settings are the frontier."""
REPEATS = 5
BRIEF_REPEATS = 101
"""Repeats of a computation that takes microseconds."""
PATIENCE = 3.0
"""Longest time of a run, s; a longer one ends its method, as tighter tolerances would take longer still."""


@dataclass(frozen=True)
class Price:
    """One method and tolerance, with its largest tip error (m) over the samples and its cost."""

    method: Method
    rtol: float
    error: float
    seconds: float
    steps: int
    segment_evaluations: int


@dataclass(frozen=True)
class MeshPrice:
    """A number of segments from disk to disk, with the distance of its tip at rest from the exact rod's.

    Under the motion's last tensions; ``tip_error`` in m, ``angle_error`` in rad. ``limit_error`` is that of
    the tip extrapolated from this mesh and the one of half as many segments. ``seconds`` is the time of one
    equilibrium, ``iterations`` times segments its work; ``motion_seconds`` that of the whole motion, None
    if nodes without mass forbid it.
    """

    subsegments: int
    tip_error: float
    angle_error: float
    limit_error: float | None
    seconds: float
    segment_evaluations: int
    motion_seconds: float | None


@dataclass(frozen=True)
class LeftOut:
    """Change by leaving an effect out: of the tip (m, largest over the samples), of time, of stiffness.

    ``time_ratio`` is the time without it over the time with it, ``seconds`` the latter less the former;
    ``fastest_rate`` is the largest rate (1/s) of the linearized motion without it. All are None if there
    is no such motion without it.
    """

    name: str
    tip_shift: float | None = None
    time_ratio: float | None = None
    fastest_rate: float | None = None
    seconds: float | None = None


@dataclass(frozen=True)
class Cost:
    """The cost of accuracy for a scenario.

    ``no_meshes`` says why there are no ``meshes``. ``reference_gap`` (m) is how far the two references
    differ; ``over_budget`` names the methods that were given up, with the tolerance at which.
    """

    scenario: Scenario
    prices: tuple[Price, ...]
    meshes: tuple[MeshPrice, ...]
    no_meshes: str
    effects: tuple[LeftOut, ...]
    fastest_rate: float
    reference_gap: float
    over_budget: dict[str, float]

    def frontier(self) -> dict[float, Price | None]:
        """The settings of least work for each target error (m), or None if no run reached it.

        Work is weighed by its method's time for a segment evaluation.
        """
        weights = self.evaluation_seconds()
        return {
            target: min(
                (p for p in self.prices if p.error <= target),
                key=lambda p: (weights[p.method] * p.segment_evaluations, p.rtol),
                default=None,
            )
            for target in TARGETS
        }

    def evaluation_seconds(self) -> dict[Method, float]:
        """Time of each method for a segment evaluation, overhead included: of all its runs together, s."""
        totals: dict[Method, tuple[float, int]] = {}
        for price in self.prices:
            seconds, work = totals.get(price.method, (0.0, 0))
            totals[price.method] = seconds + price.seconds, work + price.segment_evaluations
        return {method: seconds / max(work, 1) for method, (seconds, work) in totals.items()}


def prepare_motion(scenario: Scenario) -> Motion:
    """The scenario's motion. Raises ``InputError`` at rest, or without an equilibrium to start from."""
    scenario.require_motion("cost needs a study of motion")
    motion = Motion(scenario)
    if not motion.rest.found:
        raise InputError(f"the motion has no equilibrium to start from: {motion.rest.outcome}.")
    return motion


def least_seconds(motion: Motion, solver: Solver) -> float:
    """Least time of the whole integration, s."""
    times = []
    for _ in range(REPEATS):
        started = time.perf_counter()
        motion.complete(solver)
        times.append(time.perf_counter() - started)
        if times[-1] > PATIENCE:
            break
    return min(times)


def fastest_rate(motion: Motion) -> float:
    """Largest rate (1/s) of the motion linearized at its start, which explicit steps must resolve."""
    if motion.dynamics.scene.arm.massless_nodes:
        return np.inf
    return rates(motion.dynamics, motion.start, motion.timeline.first)[1]


def _complete(motion: Motion, solver: Solver) -> Trajectory:
    """The motion by that solver. Raises ``InputError`` if it does not reach its end."""
    found = motion.complete(solver)
    if found is None:
        raise InputError("the motion ends early; for the reason, see continuum-dyn run.")
    return found


def measure(scenario: Scenario, progress: Callable[[str], None] = lambda _: None) -> Cost:
    """Measure the cost of accuracy for the scenario's motion; ``progress`` receives the current step.

    Raises ``InputError`` for a study without motion, or if the references do not reach its end.
    """
    if scenario.scene.arm.massless_nodes:
        raise InputError(
            'cost compares methods, and only "chain" can move nodes without mass. '
            "Give the arm's core_density."
        )
    motion = prepare_motion(scenario)
    progress("references")
    reference, other = (_complete(motion, solver) for solver in REFERENCES)
    prices, over_budget = _prices(motion, reference, progress)
    meshes, no_meshes = _meshes(motion, progress)
    return Cost(
        scenario=scenario,
        prices=tuple(prices),
        meshes=tuple(meshes),
        no_meshes=no_meshes,
        effects=tuple(effects(motion, progress)),
        fastest_rate=fastest_rate(motion),
        reference_gap=tip_distance(reference, other),
        over_budget=over_budget,
    )


def _prices(
    motion: Motion, reference: Trajectory, progress: Callable[[str], None]
) -> tuple[list[Price], dict[str, float]]:
    prices: list[Price] = []
    over_budget: dict[str, float] = {}
    for method in _in_order(METHODS):
        motion.warm_up(Solver(method))
        for rtol in TOLERANCES[method]:
            progress(f"{method}, rtol {rtol:.0e}")
            solver = Solver(method).with_rtol(rtol)
            found = motion.complete(solver, Budget(seconds=PATIENCE))
            if found is None:
                over_budget[method] = rtol
                break
            counters = found.counters
            work = counters["segment_evaluations"]
            error = tip_distance(found, reference)
            prices.append(Price(method, rtol, error, least_seconds(motion, solver), counters["steps"], work))
    return prices, over_budget


def _meshes(motion: Motion, progress: Callable[[str], None]) -> tuple[list[MeshPrice], str]:
    """The equilibrium under the last tensions and the motion on every mesh; or why there is no exact rod."""
    scenario, tension = motion.scenario, motion.last_inputs
    progress("exact rod")
    try:
        rod = exact_rod(scenario.scene, tension[: scenario.scene.cables]).tip
    except (InputError, RodError) as reason:
        return [], str(reason)
    found: list[MeshPrice] = []
    tips: dict[int, np.ndarray] = {}
    for subsegments in SUBSEGMENTS:
        progress(f"{subsegments} segments from disk to disk")
        meshed = scenario.with_mesh(subsegments, 1.0)
        statics = StaticSolver(meshed.scene)
        rest, seconds = _timed(lambda solver=statics: solver.solve(tension))
        if not rest.found:
            return found, f"no equilibrium was found with {subsegments} segments from disk to disk"
        tips[subsegments] = np.array(rest.tip)
        apart = np.abs(tips[subsegments] - rod)
        limit = None
        if subsegments // 2 in tips:
            limit = float(np.hypot(*(richardson(tips[subsegments // 2], tips[subsegments]) - rod)[:2]))
        work = rest.iterations * meshed.scene.arm.segments
        error, angle, moved = float(np.hypot(*apart[:2])), float(apart[2]), _motion_seconds(meshed)
        found.append(MeshPrice(subsegments, error, angle, limit, seconds, work, moved))
    return found, ""


def _motion_seconds(scenario: Scenario) -> float | None:
    solver = Solver("chain")
    try:
        motion = prepare_motion(scenario)
        motion.warm_up(solver)
    except InputError:
        return None
    return least_seconds(motion, solver)


def _timed(work: Callable[[], Equilibrium]) -> tuple[Equilibrium, float]:
    """The answer, and the least time of some repeats after one that is not counted."""
    answer, times = work(), []
    for _ in range(BRIEF_REPEATS):
        started = time.perf_counter()
        work()
        times.append(time.perf_counter() - started)
    return answer, min(times)


def _in_order(methods: Iterable[str]) -> list[Method]:
    return [method for method in TOLERANCES if method in methods]


def effects(motion: Motion, progress: Callable[[str], None] = lambda _: None) -> list[LeftOut]:
    """Each effect left out in turn, at a tolerance at which the integration's own error does not show.

    Raises ``InputError`` if the motion with all effects does not reach its end.
    """
    solver, scenario = Solver("chain", rtol=1e-9, atol=1e-12), motion.scenario
    whole, seconds = _complete(motion, solver), least_seconds(motion, solver)
    found = []
    for effect in scenario.scene.effects:
        if effect.name == "inertia":
            continue
        progress(f"without {effect.name}")
        try:
            without = prepare_motion(scenario.without(effect.name))
            without.warm_up(solver)
        except InputError:
            found.append(LeftOut(effect.name))
            continue
        trajectory = without.complete(solver, Budget(seconds=10.0 * PATIENCE))
        if trajectory is None:
            found.append(LeftOut(effect.name))
            continue
        shift, spent = tip_distance(trajectory, whole), least_seconds(without, solver)
        found.append(LeftOut(effect.name, shift, spent / seconds, fastest_rate(without), seconds - spent))
    return found
