"""What accuracy costs: one motion by every method over a range of tolerances, and without each effect.

Times are medians of repeats of the whole integration, samples and energies included; beside them stands
the machine-independent work, in segment evaluations.
"""

import statistics
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from continuum_dyn.accuracy import tip_distance
from continuum_dyn.dynamics import Dynamics
from continuum_dyn.integration import inspector, integrate, warm_up
from continuum_dyn.integrators import METHODS, Budget, Monitor
from continuum_dyn.profiles import spans
from continuum_dyn.study import Method, MotionStudy, Scenario, Solver
from continuum_dyn.trajectory import Trajectory
from statics.equilibria import StaticSolver
from statics.errors import InputError
from statics.scene import Scene

TOLERANCES: dict[Method, tuple[float, ...]] = {
    "chain": (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10),
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
TARGETS = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
"""Tip errors (m) whose cheapest settings are the frontier."""
REPEATS = 5
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
class Effect:
    """What leaving an effect out does: to the tip (m, largest over the samples), to time, to stiffness.

    ``time_ratio`` is the time without it over the time with it; ``fastest_rate`` is the largest rate (1/s)
    of the linearized motion without it. All are None where there is no such motion without it.
    """

    name: str
    tip_shift: float | None = None
    time_ratio: float | None = None
    fastest_rate: float | None = None


@dataclass(frozen=True)
class Cost:
    """The answer to what accuracy costs for a scenario.

    ``reference_gap`` (m) is how far the two references differ; ``over_budget`` names the methods that
    were given up, with the tolerance at which.
    """

    scenario: Scenario
    prices: tuple[Price, ...]
    effects: tuple[Effect, ...]
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
    """A scenario's motion, ready to be integrated by any method."""

    def __init__(self, scenario: Scenario) -> None:
        assert isinstance(scenario.study, MotionStudy)
        self.dynamics = Dynamics(scenario.scene)
        self.stretches = spans(scenario.profiles, scenario.study.duration)
        self.samples = np.linspace(0.0, scenario.study.duration, scenario.study.samples)
        rest = StaticSolver(scenario.scene).solve(scenario.initial_tension)
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
        size = 2 * self.dynamics.size
        span = self.stretches[0]
        jacobian = self.dynamics.jacobian(span.start, self.start, span)[:size, :size]
        return float(np.abs(np.linalg.eigvals(jacobian)).max())


def measure(scenario: Scenario, progress: Callable[[str], None] = lambda _: None) -> Cost:
    """What accuracy costs for the scenario's motion; ``progress`` is told what is being measured.

    Raises ``InputError`` for a study without motion, or where the references do not reach its end.
    """
    if not isinstance(scenario.study, MotionStudy):
        raise InputError(f'cost is asked of a motion; this is a study of kind "{scenario.study.kind}".')
    motion = Motion(scenario)
    progress("references")
    references = [motion.run(solver) for solver in REFERENCES]
    if references[0] is None or references[1] is None:
        raise InputError("the motion does not get to its end; see its outcome with the command run.")
    prices, over_budget = _prices(motion, references[0], progress)
    return Cost(
        scenario=scenario,
        prices=tuple(prices),
        effects=tuple(_effects(scenario, motion, progress)),
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


def _in_order(methods: Iterable[str]) -> list[Method]:
    return [method for method in TOLERANCES if method in methods]


def _effects(scenario: Scenario, motion: Motion, progress: Callable[[str], None]) -> list[Effect]:
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
            without = Motion(_without(scenario, effect.name))
        except InputError:
            found.append(Effect(effect.name))
            continue
        without.warm_up("chain")
        trajectory = without.run(solver, Budget(seconds=10.0 * PATIENCE))
        if trajectory is None:
            found.append(Effect(effect.name))
            continue
        shift, ratio = tip_distance(trajectory, whole), without.seconds(solver) / seconds
        found.append(Effect(effect.name, shift, ratio, without.fastest_rate()))
    return found


def _without(scenario: Scenario, name: str) -> Scenario:
    scene = Scene(scenario.scene.arm, (effect for effect in scenario.scene.effects if effect.name != name))
    return replace(scenario, scene=scene, tension=scenario.tension if scene.cables else ())
