"""Scenarios come in; their answers, equilibria and motions between them, go out.

What is exported is loaded when it is first used.
"""

from typing import TYPE_CHECKING

from statics.support.lazy_names import loaded_when_asked_for

if TYPE_CHECKING:
    from continuum_dyn.simulation.entry import simulate
    from continuum_dyn.simulation.motion import Motion
    from continuum_dyn.simulation.resumption import Resumption
    from continuum_dyn.simulation.run import Run, Sink
    from continuum_dyn.simulation.trajectory import Trajectory

__all__ = ["Motion", "Resumption", "Run", "Sink", "Trajectory", "simulate"]

__getattr__ = loaded_when_asked_for(__file__)
