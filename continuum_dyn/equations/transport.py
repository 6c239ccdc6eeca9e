"""Work of a moving base, as an integral that needs no acceleration of the arm.

With V = v_b + omega_b z x (p - p_b), the velocity that a mass at p would have if it were fixed to the base
(its velocity of transport), the base does on the arm the work of all loads on the masses along V, inertia's
included, with its sign changed:

    power = sum (m a - F) . V = d/dt (sum m v . V) - sum (m v . A + F . V)
    A = a_b + alpha_b z x (p - p_b) - omega_b z x v_b

since dV/dt = A + omega_b z x v, and v . (z x v) = 0. Loads between segments balance, and do no work along V.
The second sum, ``transport_power``, follows from coordinates and rates, and is integrated along the motion.
The first, ``transport_energy``, is zero while the base is at rest, and is added where the work is read. For a
disk, whose payloads may stand beside its centre, m v is the momentum dT/du of its pose, and F its load, each
with a moment.
"""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import sympy as sp

from statics.derivation.frames import ACCELERATION, POSE, TWIST, components, perpendicular, split
from statics.derivation.trace import derivative
from statics.derivation.virtual_work import Forces


def with_transport(part: Forces, loads: sp.Matrix, site: Any) -> Forces:
    """Forces at a disk or point of the core, with transport_energy (J) and transport_power (W) added.

    ``loads`` are the generalized forces there without inertia's, shape (coordinates, 1).
    """
    (base, _), (base_velocity, omega), (base_acceleration, alpha) = (
        split(components("base", names)) for names in (POSE, TWIST, ACCELERATION)
    )
    away = sp.Matrix(site.position) - sp.Matrix(base)
    velocity = sp.Matrix(base_velocity) + omega * perpendicular(away)
    push = sp.Matrix(base_acceleration) + alpha * perpendicular(away)
    push -= omega * perpendicular(sp.Matrix(base_velocity))
    momentum = [derivative(part.energies["kinetic_energy"], rate) for rate in site.rates]

    def along(values: Iterable[Any], linear: sp.Matrix, angular: Any) -> Any:
        """Scalar product with a twist; the values of a point of the core have no angular one."""
        return sum(value * rate for value, rate in zip(values, (*linear, angular), strict=False))

    power = -(along(momentum, push, alpha) + along(loads, velocity, omega))
    return replace(
        part,
        energies=part.energies | {"transport_energy": along(momentum, velocity, omega)},
        powers=part.powers | {"transport_power": power},
    )
