"""Elimination and substitution of the tensions of cables that couple all segments.

With l = V_T x - load_T the change of the length beyond a hole, the tension T beyond it changes by
dT = E dT0 + kappa l; E and kappa are the derivatives of the cable's law (``cable_tension``). So
dT = m (E dT0 + kappa (V_To o - load_T)), with o the other states and m = 1 / (1 - kappa V_TT).
"""

import sympy as sp

from statics.derivation.segment import CableSymbols
from statics.derivation.step import Carried
from statics.derivation.steps.newton_matrix import Weights
from statics.derivation.trace import Trace, symbol
from statics.derivation.virtual_work import SceneForces


def _slope_names(cable: CableSymbols) -> list[str]:
    """Names of the derivatives that a cable's tension has at a hole."""
    names = ["place_slope", "hole_factor", "rate_slope"] if cable.kind.rubs else ["place_slope"]
    return [f"{name}_{cable.number}" for name in names]


def carry_slopes(trace: Trace, forces: SceneForces, coupled: list[CableSymbols]) -> Carried:
    """Carry the slopes from a span's end, where they are known, to the hole at its start.

    A span that the cable does not pass has the slopes of a hole that changes no tension.
    """
    carried: Carried = {}
    start = symbol("starts_span")
    for cable in coupled if forces.span is not None else []:
        for name in _slope_names(cable):
            here, before = symbol(name), symbol(f"{name}_inside")
            unchanged = 1.0 if name.startswith("hole_factor") else 0.0
            value = trace.name(f"{name}_there", cable.passes * here + (1 - cable.passes) * before)
            carried[str(before)] = (unchanged, start * unchanged + (1 - start) * value)
    return carried


def pass_hole(
    trace: Trace,
    cable: CableSymbols,
    state: int,
    V: sp.Matrix,
    load: sp.Matrix,
    weights: Weights,
    in_span: bool,
) -> tuple[sp.Matrix, sp.Matrix]:
    """Replace the tension beyond a hole, at row ``state`` of V and load, by the tension before it."""
    c, start = cable.number, symbol("starts_span") if in_span else sp.Integer(1)
    by_length, *of_friction = (symbol(f"{name}_there" if in_span else name) for name in _slope_names(cable))
    factor, by_rate = of_friction or (sp.Integer(1), sp.Integer(0))
    kappa = trace.name(f"kappa_{c}", start * (weights.stiffness * by_length + weights.damping * by_rate))
    factor = trace.name(f"tension_factor_{c}", start * factor + 1 - start)
    m = 1 / trace.name(f"hole_pivot_{c}", 1 - kappa * V[state, state])
    onto = sp.eye(V.shape[0])
    for k in range(V.shape[0]):
        gain = m * (factor if k == state else kappa * V[state, k])
        onto[state, k] = trace.always_name(f"hole_gain_{c}_{k}", gain)
    push = trace.always_name(f"hole_push_{c}", -m * kappa * load[state])
    return V * onto, load - V.col(state) * push


def tensions_beyond_holes(
    trace: Trace, poses: sp.Matrix, coupled: list[CableSymbols]
) -> tuple[sp.Matrix, Carried]:
    """Changes of the poses, then of the tensions beyond the near holes, which are carried on as well."""
    states = [*poses, *(symbol(f"shift_tension_{cable.number}") for cable in coupled)]
    carried: Carried = {}
    for state, cable in reversed(list(enumerate(coupled, start=len(poses)))):
        c = cable.number
        gains = [symbol(f"hole_gain_{c}_{k}") for k in range(len(states))]
        value = sum(gain * change for gain, change in zip(gains, states, strict=True))
        states[state] = trace.name(f"tension_beyond_{c}", value + symbol(f"hole_push_{c}"))
        carried[f"shift_tension_{c}"] = (0.0, states[state])
    return sp.Matrix(states), carried
