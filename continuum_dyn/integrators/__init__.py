"""The integrators that a scenario may name, each under a guard."""

from scipy.integrate import BDF, DOP853, LSODA, RK23, RK45, OdeSolver, Radau

from continuum_dyn.integrators.chain_solver import ChainSolver
from continuum_dyn.integrators.choice import Choice, check, choose
from continuum_dyn.integrators.guard import Budget, Guard, Monitor
from continuum_dyn.integrators.midpoint_solver import MidpointSolver
from continuum_dyn.integrators.tableau import DOPRI8, ESDIRK5, Tableau

IMPLICIT = ("Radau", "BDF", "LSODA")
"""SciPy's methods that use the Jacobian."""

TABLEAUX: dict[str, Tableau] = {"chain": ESDIRK5, "explicit": DOPRI8}
"""Methods on the chain itself, with errors in metres."""

METHODS: dict[str, type[OdeSolver]] = {
    name: type(f"Guarded{method.__name__}", (Guard, method), {})
    for name, method in {
        "chain": ChainSolver,
        "explicit": ChainSolver,
        "midpoint": MidpointSolver,
        **{method.__name__: method for method in (RK23, RK45, DOP853, Radau, BDF, LSODA)},
    }.items()
}

__all__ = [
    "IMPLICIT",
    "METHODS",
    "TABLEAUX",
    "Budget",
    "ChainSolver",
    "Choice",
    "Guard",
    "MidpointSolver",
    "Monitor",
    "check",
    "choose",
]
