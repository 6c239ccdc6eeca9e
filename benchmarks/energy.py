"""How well the midpoint rule keeps energy: 1e5 periods of the first mode after a release from 2 N.

The paper's arm without damping. Reported for each run: steps, processor time, the range of the energy's
error in parts of the energy of motion, and its trend, the rise of a straight line fitted through it from the
first sample to the last, in parts of that range. DOP853 at its default tolerances over a shorter time stands
beside it. Asserted: the midpoint rule's trend is below a hundredth of the range.
"""

import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from continuum_dyn import load_scenario
from continuum_dyn.integrators import Budget, Monitor
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Interval, cut_into_intervals
from continuum_dyn.scenario.profiles import Step
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.integration import integrate, warm_up
from continuum_dyn.simulation.trajectory import Trajectory
from statics import Scene, equilibrium

SCENARIO = Path(__file__).parents[1] / "scenarios" / "step_response.toml"
RELEASE = Step(before=2.0, after=0.0)
PERIODS, SHORT = 100_000, 1_000
SAMPLES = 50_001
LARGEST_TREND = 0.01
"""Of the energy's error, in parts of its range."""


def undamped(extension: bool) -> Scene:
    """The paper's arm and its effects but damping, with or without extension."""
    scene = load_scenario(SCENARIO).scene
    left_out = {"material_damping"} | (set() if extension else {"extension"})
    return Scene(scene.arm, (effect for effect in scene.effects if effect.name not in left_out))


def first_period(dynamics: Dynamics, interval: Interval, y: np.ndarray) -> float:
    """Longest period (s) of the motion linearized at a state at rest."""
    size = dynamics.size
    stiffness = -dynamics.jacobian(interval.start, y, interval)[size : 2 * size, :size]
    return float(2.0 * np.pi / np.sqrt(np.linalg.eigvals(stiffness).real.min()))


def energy_error(found: Trajectory) -> np.ndarray:
    """Energy less that at the start, over the range of the kinetic energy, shape (samples,)."""
    energy = sum(found.ledger[name] for name in ("kinetic_energy", "elastic_energy", "gravity_energy"))
    assert isinstance(energy, np.ndarray)
    return (energy - energy[0]) / np.ptp(found.ledger["kinetic_energy"])


def run(extension: bool, solver: Solver, periods: float, steps_a_period: int | None = None) -> float:
    """Integrate, print a row, and return the trend over the range."""
    scene = undamped(extension)
    dynamics = Dynamics(scene)
    y = dynamics.state(equilibrium(scene, RELEASE.before).coordinates)
    period = first_period(dynamics, cut_into_intervals((RELEASE,), 1.0).first, y)
    stretches = cut_into_intervals((RELEASE,), periods * period)
    if steps_a_period is not None:
        solver = replace(solver, step=period / steps_a_period)
    warm_up(dynamics, solver, stretches.first)
    samples = np.linspace(0.0, stretches.end, SAMPLES)
    monitor = Monitor(inspect=lambda _t, _y: None, budget=Budget(steps=10**12, seconds=1e6))
    started = time.process_time()
    found = integrate(dynamics, stretches, samples, y, solver, monitor)
    seconds = time.process_time() - started
    error = energy_error(found)
    trend = np.polyfit(found.time / found.time[-1], error, 1)[0] / np.ptp(error)
    print(
        f"{'with' if extension else 'without':9s}  {solver.method:8s}  {periods:7.0f}"
        f"  {found.counters['steps']:9d}  {seconds:6.1f} s  {np.ptp(error):8.1e}  {trend:15.1e}",
        flush=True,
    )
    return float(trend)


def main() -> None:
    """Print the table and check the trends."""
    midpoint, drifting = Solver("midpoint"), Solver("DOP853")
    print("extension  method    periods  steps      time      range     trend / range")
    trends = [
        run(False, midpoint, PERIODS),
        run(False, midpoint, PERIODS, steps_a_period=100),
        run(True, midpoint, PERIODS, steps_a_period=100),
        run(True, midpoint, SHORT),
    ]
    run(False, drifting, SHORT)
    assert max(map(abs, trends)) < LARGEST_TREND


if __name__ == "__main__":
    main()
