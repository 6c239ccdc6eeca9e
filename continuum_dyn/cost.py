"""What accuracy costs: a motion by every method and tolerance, on every mesh, and without each effect.

Times are medians of repeats of the whole integration, samples and energies included; beside them stands
the machine-independent work, in segment evaluations.
"""

import statistics
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from continuum_dyn.accuracy import tip_distance
from continuum_dyn.dynamics import Dynamics
from continuum_dyn.integration import inspector, integrate, warm_up
from continuum_dyn.integrators import METHODS, Budget, Monitor
from continuum_dyn.mesh import between
from continuum_dyn.modes import rates
from continuum_dyn.scenario.intervals import cut_into_intervals
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.solver import Method, Solver
from continuum_dyn.scenario.studies import MotionStudy
from continuum_dyn.trajectory import Trajectory
from statics.equilibria import Equilibrium, StaticSolver
from statics.errors import InputError
from statics.exact_rod import RodError, exact_rod

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
"""Repeats of what takes microseconds."""
PATIENCE = 3.0
"""A run that takes longer than this (s) ends its method: tighter tolerances would take longer still."""


@dataclass(frozen=True)
class Price:
    """One way to compute the motion: its largest tip error (m) over the samples, and what it costs."""

    method: Method
    rtol: float
    error: float
    seconds: float
    steps: int
    segment_evaluations: int


@dataclass(frozen=True)
class MeshPrice:
    """A number of segments from disk to disk: how far the tip rests from the exact rod's, and what it costs.

    Under the motion's last tensions; ``tip_error`` in m, ``angle_error`` in rad. ``limit_error`` is that of
    the tip extrapolated from this mesh and the one of half as many segments. ``seconds`` is the time of one
    equilibrium, ``iterations`` times segments its work; ``motion_seconds`` that of the whole motion, None
    where nodes without mass forbid it.
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
    """What leaving an effect out does: to the tip (m, largest over the samples), to time, to stiffness.

    ``time_ratio`` is the time without it over the time with it, ``seconds`` the latter less the former;
    ``fastest_rate`` is the largest rate (1/s) of the linearized motion without it. All are None where there
    is no such motion without it.
    """

    name: str
    tip_shift: float | None = None
    time_ratio: float | None = None
    fastest_rate: float | None = None
    seconds: float | None = None


@dataclass(frozen=True)
class Cost:
    """The answer to what accuracy costs for a scenario.

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
        """The cheapest way to each target error (m), or None where no run reached it."""
        return {
            target: min((p for p in self.prices if p.error <= target), key=lambda p: p.seconds, default=None)
            for target in TARGETS
        }


class Motion:
    """A scenario's motion, ready to be integrated by any method.

    Raises ``InputError`` for a study without motion, and where there is no equilibrium to start from.
    """

    def __init__(self, scenario: Scenario) -> None:
        if not isinstance(scenario.study, MotionStudy):
            raise InputError(f'cost is asked of a motion; this is a study of kind "{scenario.study.kind}".')
        self.dynamics = Dynamics(scenario.scene)
        self.stretches = cut_into_intervals(scenario.profiles, scenario.study.duration)
        self.samples = np.linspace(0.0, scenario.study.duration, scenario.study.samples)
        rest = StaticSolver(scenario.scene).solve(scenario.initial_inputs)
        if not rest.found:
            raise InputError(f"the motion has no equilibrium to start from: {rest.outcome}.")
        self.start = self.dynamics.state(rest.coordinates)

    def run(self, solver: Solver, budget: Budget | None = None) -> Trajectory | None:
        """The motion by that solver; None if it did not get to its end."""
        monitor = Monitor(inspect=inspector(self.dynamics), budget=budget or Budget())
        trajectory = integrate(self.dynamics, self.stretches, self.samples, self.start, solver, monitor)
        return None if monitor.outcome else trajectory

    def seconds(self, solver: Solver) -> float:
        """Median time of the whole integration."""
        times = []
        for _ in range(REPEATS):
            started = time.perf_counter()
            self.run(solver)
            times.append(time.perf_counter() - started)
            if times[-1] > PATIENCE:
                break
        return statistics.median(times)

    def warm_up(self, method: Method) -> None:
        """Load what is compiled for the method."""
        warm_up(self.dynamics, Solver(method), self.stretches[0])

    def fastest_rate(self) -> float:
        """Largest rate (1/s) of the motion linearized at its start: what explicit steps must resolve."""
        if self.dynamics.scene.arm.massless_nodes:
            return np.inf
        return rates(self.dynamics, self.start, self.stretches[0])[1]


def measure(scenario: Scenario, progress: Callable[[str], None] = lambda _: None) -> Cost:
    """What accuracy costs for the scenario's motion; ``progress`` is told what is being measured.

    Raises ``InputError`` for a study without motion, or where the references do not reach its end.
    """
    if scenario.scene.arm.massless_nodes:
        raise InputError(
            'cost compares methods, and nodes without mass leave only "chain". Give the arm\'s core_density.'
        )
    motion = Motion(scenario)
    progress("references")
    references = [motion.run(solver) for solver in REFERENCES]
    if references[0] is None or references[1] is None:
        raise InputError("the motion does not get to its end; see its outcome with the command run.")
    prices, over_budget = _prices(motion, references[0], progress)
    meshes, no_meshes = _meshes(scenario, progress)
    return Cost(
        scenario=scenario,
        prices=tuple(prices),
        meshes=tuple(meshes),
        no_meshes=no_meshes,
        effects=tuple(effects(scenario, motion, progress)),
        fastest_rate=motion.fastest_rate(),
        reference_gap=tip_distance(references[0], references[1]),
        over_budget=over_budget,
    )


def _prices(
    motion: Motion, reference: Trajectory, progress: Callable[[str], None]
) -> tuple[list[Price], dict[str, float]]:
    prices: list[Price] = []
    over_budget: dict[str, float] = {}
    for method in _in_order(METHODS):
        motion.warm_up(method)
        for rtol in TOLERANCES[method]:
            progress(f"{method}, rtol {rtol:.0e}")
            solver = Solver(method, rtol=rtol, atol=1e-3 * rtol)
            found = motion.run(solver, Budget(seconds=PATIENCE))
            if found is None:
                over_budget[method] = rtol
                break
            counters = found.counters
            work = counters["segment_evaluations"]
            error = tip_distance(found, reference)
            prices.append(Price(method, rtol, error, motion.seconds(solver), counters["steps"], work))
    return prices, over_budget


def _meshes(scenario: Scenario, progress: Callable[[str], None]) -> tuple[list[MeshPrice], str]:
    """The equilibrium under the last tensions and the motion on every mesh; or why there is no exact rod."""
    assert isinstance(scenario.study, MotionStudy)
    last = cut_into_intervals(scenario.profiles, scenario.study.duration)[-1]
    tension = last.inputs(np.array([last.end]))[0]
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
        tips[subsegments] = np.array(rest.tip)
        apart = np.abs(tips[subsegments] - rod)
        limit = None
        if subsegments // 2 in tips:
            limit = float(np.hypot(*(between(tips[subsegments // 2], tips[subsegments]) - rod)[:2]))
        work = rest.iterations * meshed.scene.arm.segments
        error, angle, moved = float(np.hypot(*apart[:2])), float(apart[2]), _motion_seconds(meshed)
        found.append(MeshPrice(subsegments, error, angle, limit, seconds, work, moved))
    return found, ""


def _motion_seconds(scenario: Scenario) -> float | None:
    try:
        motion = Motion(scenario)
        motion.warm_up("chain")
    except InputError:
        return None
    return motion.seconds(Solver("chain"))


def _timed(work: Callable[[], Equilibrium]) -> tuple[Equilibrium, float]:
    """The answer, and the median time of some repeats after one that is not counted."""
    answer, times = work(), []
    for _ in range(BRIEF_REPEATS):
        started = time.perf_counter()
        work()
        times.append(time.perf_counter() - started)
    return answer, statistics.median(times)


def _in_order(methods: Iterable[str]) -> list[Method]:
    return [method for method in TOLERANCES if method in methods]


def effects(
    scenario: Scenario, motion: Motion, progress: Callable[[str], None] = lambda _: None
) -> list[LeftOut]:
    """Each effect left out in turn, at a tolerance at which the integration's own error does not show."""
    solver = Solver("chain", rtol=1e-9, atol=1e-12)
    whole, seconds = motion.run(solver), motion.seconds(solver)
    assert whole is not None
    found = []
    for effect in scenario.scene.effects:
        if effect.name == "inertia":
            continue
        progress(f"without {effect.name}")
        try:
            without = Motion(scenario.without(effect.name))
            without.warm_up("chain")
        except InputError:
            found.append(LeftOut(effect.name))
            continue
        trajectory = without.run(solver, Budget(seconds=10.0 * PATIENCE))
        if trajectory is None:
            found.append(LeftOut(effect.name))
            continue
        shift, spent = tip_distance(trajectory, whole), without.seconds(solver)
        found.append(LeftOut(effect.name, shift, spent / seconds, without.fastest_rate(), seconds - spent))
    return found
