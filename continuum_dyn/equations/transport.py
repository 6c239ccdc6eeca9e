"""The work of a base that moves, as an integral that asks for no acceleration of the arm.

With V = v_b + omega_b z x (p - p_b), the velocity that a mass at p would have if it were fixed to the base
(its velocity of transport), the base does on the arm the work of all loads on the masses along V, inertia's
included, with its sign turned:

    power = sum (m a - F) . V = d/dt (sum m v . V) - sum (m v . A + F . V)
    A = a_b + alpha_b z x (p - p_b) - omega_b z x v_b

since dV/dt = A + omega_b z x v, and v . (z x v) = 0. Loads between segments balance, and do no work along V.
The second sum, ``transport_power``, follows from coordinates and rates: it is what a motion integrates. The
first, ``transport_energy``, is zero while the base is at rest, and is added where the work is read. For a
disk, whose payloads may stand beside its centre, m v is the momentum dT/du of its pose, and F its load, each
with a moment.
"""

from dataclasses import replace
from typing import Any

import sympy as sp

from statics.derivation.recursion import turned
from statics.derivation.segment import symbol
from statics.derivation.virtual_work import Forces
from statics.scene import BASE_MOTION, BASE_POSE


def with_transport(part: Forces, loads: sp.Matrix, at: Any) -> Forces:
    """Forces at a place that has a pose, with the energy and the power of transport booked.

    ``loads`` are the generalized forces there but for inertia's, shape (coordinates, 1).
    """
    x, y, _ = map(symbol, BASE_POSE)
    v_x, v_y, omega, a_x, a_y, alpha = map(symbol, BASE_MOTION)
    away = sp.Matrix([at.position[0] - x, at.position[1] - y])
    base_velocity = sp.Matrix([v_x, v_y])
    velocity = (base_velocity + omega * turned(away)).col_join(sp.Matrix([omega]))
    push = (sp.Matrix([a_x, a_y]) + alpha * turned(away) - omega * turned(base_velocity)).col_join(
        sp.Matrix([alpha])
    )
    known = slice(0, len(at.rates))
    momentum = sp.Matrix([part.energies["kinetic_energy"].diff(rate) for rate in at.rates])
    power = -(momentum.dot(push[known, 0]) + loads.dot(velocity[known, 0]))
    return replace(
        part,
        energies=part.energies | {"transport_energy": momentum.dot(velocity[known, 0])},
        powers=part.powers | {"transport_power": power},
    )
