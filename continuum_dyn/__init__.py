"""Dynamics of planar cable-driven continuum arms by virtual power (Kane's method).

What is exported is loaded when it is first asked for.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from continuum_dyn.scenario import load_scenario
    from continuum_dyn.simulation import Run, simulate
    from continuum_dyn.study import Scenario
    from continuum_dyn.trajectory import Trajectory

__all__ = ["Run", "Scenario", "Trajectory", "load_scenario", "simulate"]

_HOMES = {
    "Run": "simulation",
    "Scenario": "study",
    "Trajectory": "trajectory",
    "load_scenario": "scenario",
    "simulate": "simulation",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
