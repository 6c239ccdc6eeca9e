"""Planar kinematics: components of poses and wrenches, rotations, and transfer from pose to pose.

A spatial arm would need the same functions with other components; no other module depends on the plane.
"""

from collections.abc import Sequence
from typing import Any

import sympy as sp

from statics.derivation.trace import symbol

POSE = ("x", "y", "theta")
TWIST = ("velocity_x", "velocity_y", "angular_velocity")
ACCELERATION = ("acceleration_x", "acceleration_y", "angular_acceleration")
MOMENTUM = ("momentum_x", "momentum_y", "angular_momentum")
WRENCH = ("force_x", "force_y", "torque")
"""Components of a pose, twist or wrench: two along the base axes, one about z."""

AXES, ANGLE = range(2), 2
"""Rows of the position in a pose, and the row of the angle; the same in a twist or wrench."""

NEAR_ROTATION = symbol("cosine"), symbol("sine")
"""Cosine and sine of the near disk's angle."""

STILL = sp.Float(1e-60)
"""Speed (m/s, rad/s) whose square, added to that of a speed above 1e-50, changes no bit."""


def components(prefix: str, names: Sequence[str]) -> sp.Matrix:
    """The symbols ``prefix_name`` of a pose, twist or wrench, shape (names, 1)."""
    return sp.Matrix([symbol(f"{prefix}_{name}") for name in names])


def linear(matrix: sp.Matrix) -> sp.Matrix:
    """Rows of the position (velocity, force, ...) without that of the angle."""
    return matrix[: len(AXES), :]


def split(pose: Sequence[Any]) -> tuple[tuple[Any, Any], Any]:
    """The position (velocity, force, ...) as a vector, and the angle."""
    x, y, theta = pose
    return (x, y), theta


def rotate(rotation: Sequence[Any], vector: Sequence[Any]) -> tuple[Any, Any]:
    """A vector rotated by the angle of which ``rotation`` is cosine and sine.

    Rotating another cosine and sine adds the two angles.
    """
    (cosine, sine), (x, y) = rotation, vector
    return cosine * x - sine * y, sine * x + cosine * y


def perpendicular(vector: sp.Matrix) -> sp.Matrix:
    """The product z x vector."""
    x, y = vector
    return sp.Matrix([-y, x])


def transition(reach: sp.Matrix) -> sp.Matrix:
    """The derivative X of a pose by that of a rigid body's point ``reach`` (m) before it, shape (3, 3)."""
    across_x, across_y = perpendicular(reach)
    return sp.Matrix([[1, 0, across_x], [0, 1, across_y], [0, 0, 1]])


def norm(*vector: Any) -> Any:
    """Length of a vector. ``STILL`` keeps its derivatives finite where the vector is zero."""
    return sp.sqrt(sum(component**2 for component in vector) + STILL**2)
