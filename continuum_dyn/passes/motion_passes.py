"""The passes of a scene in motion, as compiled code takes them.

Fields are addresses of passes, zero if the scene has none, and sizes of arrays.
"""

from typing import NamedTuple

from statics.kernels.loading import Family

_FAMILIES = "continuum_dyn.equations.families"


class MotionPasses(NamedTuple):
    """Passes of implicit and explicit steps, and of observations."""

    lengths: int
    beyond: int
    motion: int
    residual: int
    eliminate: int
    substitute: int
    displacement: int
    clearance: int
    observe: int
    inputs: int
    chain_columns: int


class LinearizedPasses(NamedTuple):
    """Passes of the accelerations, and of their derivatives along a change of coordinates and rates."""

    lengths: int
    beyond: int
    motion: int
    residual: int
    eliminate: int
    substitute: int
    lengths_tangent: int
    beyond_tangent: int
    motion_tangent: int
    residual_tangent: int
    inputs: int
    chain_columns: int


class MidpointPasses(NamedTuple):
    """Passes of the variational midpoint rule."""

    lengths: int
    beyond: int
    velocity: int
    residual: int
    momentum: int
    eliminate: int
    substitute: int
    displacement: int
    clearance: int
    inputs: int
    chain_columns: int


MOTION = Family("motion", "Motion of a planar cable-driven arm.", f"{_FAMILIES}:derive_motion", MotionPasses)
LINEARIZED = Family(
    "linearized",
    "Accelerations of a planar cable-driven arm, and their derivatives.",
    f"{_FAMILIES}:derive_linearized",
    LinearizedPasses,
)
MIDPOINT = Family(
    "midpoint",
    "The midpoint rule for a planar cable-driven arm.",
    f"{_FAMILIES}:derive_midpoint",
    MidpointPasses,
)
