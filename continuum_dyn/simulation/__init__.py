"""From a scenario to its answer: equilibria, and the motion between them.

What is exported is loaded when it is first used.
"""

from typing import TYPE_CHECKING

from statics.support.lazy_names import loaded_when_asked_for

if TYPE_CHECKING:
    from continuum_dyn.simulation.in_motion import Run, Sink, simulate

__all__ = ["Run", "Sink", "simulate"]

__getattr__ = loaded_when_asked_for(__file__)
