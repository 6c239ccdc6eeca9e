"""The integrators that a scenario may name, each under a guard."""

from scipy.integrate import BDF, DOP853, LSODA, RK23, RK45, OdeSolver, Radau

from continuum_dyn.integrators.guard import Budget, Guard, Monitor, interruptible

IMPLICIT = ("Radau", "BDF", "LSODA")
"""Methods that use the Jacobian."""

METHODS: dict[str, type[OdeSolver]] = {
    method.__name__: type(f"Guarded{method.__name__}", (Guard, method), {})
    for method in (RK23, RK45, DOP853, Radau, BDF, LSODA)
}

__all__ = ["IMPLICIT", "METHODS", "Budget", "Guard", "Monitor", "interruptible"]
