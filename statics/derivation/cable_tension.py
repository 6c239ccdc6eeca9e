"""Tension along a cable with friction at its holes, or driven by its length.

Such a tension couples all segments that the cable passes. With Lambda_i the cable's length beyond the near
hole of span i, Lambda_1 all of it, the drive's tension is

    T_0 = tension,   or   T_0 = k max(0, Lambda_1 - rest length + displacement):   a cable never pushes

and at a hole that turns it by beta (Euler 1769) it changes to

    T_i = T_{i-1} exp(-mu |beta| tanh s),   s = -Lambda_i' / slip speed

in motion; at rest s = (Lambda_i before - Lambda_i) / slip length, where "before" is the equilibrium that the
arm comes from. tanh approximates the sign of the slip: near zero the cable sticks, that is, it creeps.
"""

from typing import Any

import sympy as sp

from statics.derivation.segment import CableSymbols
from statics.derivation.step import Carried
from statics.derivation.trace import Trace, symbol


def drive_tension(cable: CableSymbols) -> Any:
    """Tension of a cable at the base, N; if driven by its length, from its length beyond the first hole."""
    if not cable.kind.driven_by_length:
        return symbol(f"tension_{cable.number}")
    return symbol(f"cable_stiffness_{cable.number}") * sp.Max(0, _stretch(cable))


def _drive_slope(cable: CableSymbols) -> Any:
    """Derivative of ``drive_tension`` by the cable's length, N/m."""
    if not cable.kind.driven_by_length:
        return 0.0
    return symbol(f"cable_stiffness_{cable.number}") * sp.Heaviside(_stretch(cable))


def _stretch(cable: CableSymbols) -> Any:
    length, rest = symbol(f"length_beyond_{cable.number}"), symbol(f"cable_rest_length_{cable.number}")
    return length - rest + symbol(f"cable_displacement_{cable.number}")


def stored_in_cables(cables: list[CableSymbols]) -> Any:
    """Elastic energy (J) of the cables that are driven by their length."""
    total: Any = 0.0
    for cable in cables:
        if cable.kind.driven_by_length:
            total += drive_tension(cable) ** 2 / (2 * symbol(f"cable_stiffness_{cable.number}"))
    return total


def drive_potential(cables: list[CableSymbols]) -> Any:
    """Stored energy (J) of length-driven cables less a constant tension's potential, T_0 Lambda_1."""
    total = stored_in_cables(cables)
    for cable in cables:
        if cable.kind.driven_by_length:
            total -= drive_tension(cable) * symbol(f"length_beyond_{cable.number}")
    return total


def drive_power(cables: list[CableSymbols]) -> Any:
    """Power (W) put into length-driven cables less a constant tension's, -T_0 Lambda_1'."""
    total: Any = 0.0
    for cable in cables:
        if cable.kind.driven_by_length:
            drawing, length = (
                symbol(f"{name}_{cable.number}") for name in ("cable_displacement_rate", "length_beyond_rate")
            )
            total += drive_tension(cable) * (drawing + length)
    return total


def name_tensions(trace: Trace, cables: list[CableSymbols], known: dict[Any, Any], moves: bool) -> Carried:
    """Name the tensions of coupled cables on one span, and their derivatives; return what is carried on.

    Names ``tension_lost_c`` and, for the elimination, ``hole_factor_c``, ``place_slope_c`` and
    ``rate_slope_c``: T_i's derivatives by T_{i-1}, Lambda_i and Lambda_i'.
    """
    carried: Carried = {}
    for cable in cables:
        carried |= _name_tension(trace, cable, known, moves)
    return carried


def _name_tension(trace: Trace, cable: CableSymbols, known: dict[Any, Any], moves: bool) -> Carried:
    c, kind = cable.number, cable.kind
    carried: Carried = {}
    slope: Any = sp.Integer(0)
    if kind.driven_by_length:
        slope = symbol(f"drive_slope_{c}")
        carried |= {f"tension_{c}": (drive_tension(cable), symbol(f"tension_{c}"))}
        carried |= {f"drive_slope_{c}": (_drive_slope(cable), (1 - cable.passes) * slope)}
    if not kind.rubs:
        trace.always_name(f"place_slope_{c}", cable.passes * slope)
        return carried
    before, angle_before = symbol(f"tension_before_{c}"), symbol(f"angle_before_{c}")
    angle = trace.name(f"cable_angle_{c}", cable.angle.xreplace(known))
    turned = sp.Abs(angle - angle_before)
    turn = trace.name(f"cable_turn_{c}", cable.passes * symbol(f"friction_{c}") * turned)
    slip, slip_by_length, slip_by_rate = _slip(c, moves)
    sign = trace.name(f"slip_sign_{c}", sp.tanh(slip))
    factor = trace.always_name(f"hole_factor_{c}", sp.exp(-turn * sign))
    tension = trace.name(f"tension_here_{c}", before * factor)
    trace.name(f"tension_lost_{c}", symbol(f"tension_{c}") - tension)
    by_slip = trace.name(f"slip_slope_{c}", -turn * tension * (1 - sign**2))
    trace.always_name(f"place_slope_{c}", cable.passes * factor * slope + by_slip * slip_by_length)
    trace.always_name(f"rate_slope_{c}", by_slip * slip_by_rate)
    far = trace.name(f"far_cable_angle_{c}", cable.far_angle.xreplace(known))
    passes = cable.passes
    return carried | {
        f"tension_before_{c}": (drive_tension(cable), passes * tension + (1 - passes) * before),
        f"angle_before_{c}": (0.0, passes * far + (1 - passes) * angle_before),
    }


def _slip(number: int, moves: bool) -> tuple[Any, Any, Any]:
    """The slip s through a hole, and its derivatives by the length beyond and by that length's rate."""
    if moves:
        speed = symbol(f"slip_speed_{number}")
        return -symbol(f"length_beyond_rate_{number}") / speed, sp.Integer(0), -1 / speed
    unit = symbol(f"slip_length_{number}")
    slip = (symbol(f"length_before_{number}") - symbol(f"length_beyond_{number}")) / unit
    return slip, -1 / unit, sp.Integer(0)
