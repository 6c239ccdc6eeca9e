"""The methods that a scenario may name: a guarded solver each, its options, and its properties."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import BDF, DOP853, LSODA, RK23, RK45, OdeSolver, Radau

from continuum_dyn.integrators.chain_solver import ChainSolver
from continuum_dyn.integrators.guard import Guard
from continuum_dyn.integrators.midpoint_solver import MidpointSolver
from continuum_dyn.integrators.tableau import DOPRI8, ESDIRK5, Tableau
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Interval
from continuum_dyn.scenario.solver import FIXED_STEP, Solver

FIRST_STEP = 1e-3
"""First step of each solver, in radians of the arm's lowest frequency or of the drive's, if higher."""

Options = Callable[[Dynamics, Solver, Sequence[Interval]], dict[str, Any]]
"""Makes a solver's options beside the equations, for consecutive intervals."""


@dataclass(frozen=True)
class Integrator:
    """A method of integration.

    ``stepper`` is its class, with SciPy's interface and under a guard. A method ``on_chain`` has kernels of
    its own, which work along the chain of segments; the others evaluate the right-hand side.
    """

    name: str
    stepper: Any
    options: Options
    implicit: bool = False
    on_chain: bool = False

    @property
    def is_adaptive(self) -> bool:
        """Whether it chooses its steps by tolerances."""
        return self.name not in FIXED_STEP

    @property
    def needs_jacobian(self) -> bool:
        """Whether it calls for the Jacobian of the whole right-hand side."""
        return self.implicit and not self.on_chain

    @property
    def crosses_corners(self) -> bool:
        """Whether it steps on over corners of the inputs where accelerations are continuous."""
        return self.on_chain and self.is_adaptive

    @property
    def moves_massless_nodes(self) -> bool:
        """Whether it can move nodes that carry no mass."""
        return self.implicit and self.crosses_corners


def drive_frequency(interval: Interval) -> float:
    """Highest angular frequency of the inputs, rad/s."""
    return float(np.max(interval.pieces[:, 4], initial=0.0))


def _first_step(dynamics: Dynamics, interval: Interval) -> float:
    """A step that resolves the arm and its drive: at rest, solvers left alone try the whole interval."""
    return min(FIRST_STEP / max(dynamics.frequency, drive_frequency(interval)), interval.end - interval.start)


def _chain_method(name: str, tableau: Tableau, implicit: bool) -> Integrator:
    def options(dynamics: Dynamics, solver: Solver, intervals: Sequence[Interval]) -> dict[str, Any]:
        return {
            "dynamics": dynamics,
            "spans": intervals,
            "tableau": tableau,
            "tolerance": solver.tolerance(dynamics.scene.arm.total_length),
            "first_step": _first_step(dynamics, intervals[0]),
        }

    return Integrator(name, _guard(ChainSolver), options, implicit, on_chain=True)


def _midpoint_options(dynamics: Dynamics, solver: Solver, intervals: Sequence[Interval]) -> dict[str, Any]:
    return {"dynamics": dynamics, "span": intervals[0], "step": solver.step}


def _scipy_method(method: type[OdeSolver], implicit: bool = False) -> Integrator:
    def options(dynamics: Dynamics, solver: Solver, intervals: Sequence[Interval]) -> dict[str, Any]:
        atol, first_step = solver.atol * dynamics.scales(), _first_step(dynamics, intervals[0])
        jacobian = {"jac": lambda t, y: dynamics.jacobian(t, y, intervals[0])} if implicit else {}
        return {"rtol": solver.rtol, "atol": atol, "first_step": first_step} | jacobian

    return Integrator(method.__name__, _guard(method), options, implicit)


def _guard(method: type[OdeSolver]) -> type[OdeSolver]:
    return type(f"Guarded{method.__name__}", (Guard, method), {})


METHODS: dict[str, Integrator] = {
    method.name: method
    for method in (
        _chain_method("chain", ESDIRK5, implicit=True),
        _chain_method("explicit", DOPRI8, implicit=False),
        Integrator("midpoint", _guard(MidpointSolver), _midpoint_options, implicit=True, on_chain=True),
        *(_scipy_method(method) for method in (RK23, RK45, DOP853)),
        *(_scipy_method(method, implicit=True) for method in (Radau, BDF, LSODA)),
    )
}
"""Methods by the name that a scenario gives."""
