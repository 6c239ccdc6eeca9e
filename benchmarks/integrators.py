"""What accuracy costs: the chain's own integrator against SciPy's, at one and the same tip error.

The step response of the paper's arm with extension, 1 s, 1001 samples, all through ``solve_ivp`` on the same
compiled equations, SciPy's implicit methods with the exact Jacobian. A method's time at an error is read
from its curve of error against time over a range of tolerances. Times are medians of repeats.
"""

import statistics
import time
from pathlib import Path

import numpy as np

from continuum_dyn import Scenario, Trajectory, load_scenario
from continuum_dyn.dynamics import Dynamics
from continuum_dyn.integration import inspector, integrate, warm_up
from continuum_dyn.integrators import Monitor
from continuum_dyn.scenario.intervals import cut_into_intervals
from continuum_dyn.scenario.solver import Method, Solver
from continuum_dyn.scenario.studies import MotionStudy
from statics import equilibrium

SCENARIO = Path(__file__).parents[1] / "scenarios" / "step_response.toml"
METHODS: dict[Method, list[float]] = {
    "chain": [10.0**-k for k in range(5, 11)],
    "LSODA": [10.0**-k for k in range(4, 11)],
    "Radau": [10.0**-k for k in range(3, 8)],
    "BDF": [10.0**-k for k in range(4, 9)],
}
ERRORS = (1e-6, 1e-7)
AHEAD = 6.0
"""Least factor by which the chain's method must be faster than the best of SciPy's at each error."""
REAL_TIME = 300.0
"""Least factor by which it must be faster than the motion itself, at the first error."""
REPEATS = 5


class Case:
    """A motion, ready to be integrated by any method."""

    def __init__(self, scenario: Scenario) -> None:
        assert isinstance(scenario.study, MotionStudy)
        self.dynamics = Dynamics(scenario.scene)
        self.stretches = cut_into_intervals(scenario.profiles, scenario.study.duration)
        self.samples = np.linspace(0.0, scenario.study.duration, scenario.study.samples)
        rest = equilibrium(scenario.scene, scenario.initial_inputs)
        self.start = self.dynamics.state(rest.coordinates)

    def run(self, solver: Solver) -> Trajectory:
        """The motion by that solver."""
        monitor = Monitor(inspect=inspector(self.dynamics))
        return integrate(self.dynamics, self.stretches, self.samples, self.start, solver, monitor)

    def seconds(self, solver: Solver) -> float:
        """Median time of the whole integration, samples and energies included."""
        warm_up(self.dynamics, solver, self.stretches[0])
        times = []
        for _ in range(REPEATS):
            started = time.perf_counter()
            self.run(solver)
            times.append(time.perf_counter() - started)
        return statistics.median(times)


def tip_error(found: Trajectory, reference: Trajectory) -> float:
    """Largest distance of the tips over all samples, m."""
    apart = [getattr(found, name)[:, -1] - getattr(reference, name)[:, -1] for name in ("disk_x", "disk_y")]
    return float(np.hypot(*apart).max())


def time_at(error: float, curve: list[tuple[float, float]]) -> float:
    """Time (s) at which a method reaches the error, log-log between its points; inf if it does not."""
    errors, times = np.log(np.array(sorted(curve))).T
    return float(np.exp(np.interp(np.log(error), errors, times, left=np.inf)))


def main() -> None:
    """Print every method's curve, then the ratios, and check them."""
    case = Case(load_scenario(SCENARIO))
    reference = case.run(Solver("chain", rtol=1e-13, atol=1e-15))
    other = case.run(Solver("Radau", rtol=1e-12, atol=1e-15))
    print(f"two references differ by {tip_error(reference, other):.1e} m")
    curves: dict[str, list[tuple[float, float]]] = {}
    print("method   rtol     tip error     time       steps  segment evaluations")
    for method, tolerances in METHODS.items():
        for rtol in tolerances:
            solver = Solver(method, rtol=rtol, atol=1e-3 * rtol)
            found = case.run(solver)
            error, seconds = tip_error(found, reference), case.seconds(solver)
            curves.setdefault(method, []).append((error, seconds))
            work, steps = found.counters["segment_evaluations"], found.counters["steps"]
            print(f"{method:7s}  {rtol:.0e}  {error:.2e} m  {seconds * 1e3:7.2f} ms  {steps:6d}  {work:9d}")
    for error in ERRORS:
        ours = time_at(error, curves["chain"])
        best, name = min((time_at(error, curves[m]), m) for m in METHODS if m != "chain")
        print(
            f"at {error:.0e} m: chain {ours * 1e3:.2f} ms, best of SciPy's {name} {best * 1e3:.2f} ms: "
            f"{best / ours:.1f} times (at least {AHEAD}); {1.0 / ours:.0f} times real time"
        )
        assert best / ours > AHEAD
    assert 1.0 / time_at(ERRORS[0], curves["chain"]) > REAL_TIME


if __name__ == "__main__":
    main()
