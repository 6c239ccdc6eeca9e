"""Equations of motion and a state come in; states at the end of guarded steps go out."""

from continuum_dyn.integrators.choice import Choice, check, choose
from continuum_dyn.integrators.guard import Budget, Guard, Monitor
from continuum_dyn.integrators.methods import METHODS, Integrator

__all__ = [
    "METHODS",
    "Budget",
    "Choice",
    "Guard",
    "Integrator",
    "Monitor",
    "check",
    "choose",
]
