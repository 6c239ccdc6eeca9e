"""The methods that a scenario may name: a guarded solver each, its options, and its properties."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from typing import Any

import numpy as np

from continuum_dyn.integrators.chain_stepper import ChainStepper
from continuum_dyn.integrators.guard import Guard
from continuum_dyn.integrators.midpoint_stepper import MidpointStepper
from continuum_dyn.integrators.tableau import ESDIRK5, Tableau, dopri8
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

    ``solver`` returns its class, with SciPy's interface. A method ``on_chain`` has kernels of its own, which
    work along the chain of segments; the others evaluate the right-hand side.
    """

    name: str
    solver: Callable[[], type]
    options: Options
    implicit: bool = False
    on_chain: bool = False

    @cached_property
    def stepper(self) -> Any:
        """The solver's class under a guard."""
        return type(f"Guarded{self.name}", (Guard, self.solver()), {})

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


def _chain_method(name: str, tableau: Callable[[], Tableau], implicit: bool) -> Integrator:
    def options(dynamics: Dynamics, solver: Solver, intervals: Sequence[Interval]) -> dict[str, Any]:
        return {
            "dynamics": dynamics,
            "intervals": intervals,
            "tableau": tableau(),
            "tolerance": solver.tolerance(dynamics.scene.arm.total_length),
            "first_step": _first_step(dynamics, intervals[0]),
        }

    return Integrator(name, lambda: ChainStepper, options, implicit, on_chain=True)


def _midpoint_options(dynamics: Dynamics, solver: Solver, intervals: Sequence[Interval]) -> dict[str, Any]:
    return {"dynamics": dynamics, "interval": intervals[0], "step": solver.step}


def _scipy_method(name: str, implicit: bool = False, module: str = "scipy.integrate") -> Integrator:
    def options(dynamics: Dynamics, solver: Solver, intervals: Sequence[Interval]) -> dict[str, Any]:
        atol, first_step = solver.atol * dynamics.scales(), _first_step(dynamics, intervals[0])
        jacobian = {"jac": lambda t, y: dynamics.jacobian(t, y, intervals[0])} if implicit else {}
        return {"rtol": solver.rtol, "atol": atol, "first_step": first_step} | jacobian

    return Integrator(name, lambda: getattr(import_module(module), name), options, implicit)


METHODS: dict[str, Integrator] = {
    method.name: method
    for method in (
        _chain_method("chain", lambda: ESDIRK5, implicit=True),
        _chain_method("explicit", dopri8, implicit=False),
        Integrator("midpoint", lambda: MidpointStepper, _midpoint_options, implicit=True, on_chain=True),
        *(_scipy_method(method) for method in ("RK23", "RK45", "DOP853")),
        *(_scipy_method(method, implicit=True) for method in ("Radau", "BDF", "LSODA")),
    )
}
"""Methods by the name that a scenario gives."""
