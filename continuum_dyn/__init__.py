"""Dynamics of planar cable-driven continuum arms by virtual power (Kane's method).

Exported names are loaded when they are first used.
"""

from typing import TYPE_CHECKING

from statics.support.lazy_names import loaded_when_asked_for

if TYPE_CHECKING:
    from continuum_dyn.scenario.scenario import Scenario
    from continuum_dyn.scenario_files.reading import load_scenario
    from continuum_dyn.simulation import Run, simulate
    from continuum_dyn.simulation.trajectory import Trajectory

__all__ = ["Run", "Scenario", "Trajectory", "load_scenario", "simulate"]

__getattr__ = loaded_when_asked_for(__file__)
