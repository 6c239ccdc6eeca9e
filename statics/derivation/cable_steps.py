"""Steps that measure coupled cables before the sweeps that need their tensions.

Outwards each length from hole to hole, inwards the sum beyond each hole. In motion with their rates, and for
the exact Jacobian with the changes of both.
"""

from collections.abc import Callable
from typing import Any

import sympy as sp

from statics.derivation.recursion import far_pose, reach_of, span_ends, turn_frame
from statics.derivation.segment import symbol
from statics.derivation.step import INWARD, OUTWARD, Step
from statics.derivation.trace import Trace
from statics.derivation.virtual_work import SceneForces

Outward = Callable[[Trace, SceneForces], tuple[dict[str, Any], dict[Any, Any]]]
"""Puts one segment's geometry into a trace; returns what is carried on, and what symbols stand for."""


def at_rest(trace: Trace, forces: SceneForces) -> tuple[dict[str, Any], dict[Any, Any]]:
    """Poses of the far disk and of the span's start."""
    frame = turn_frame(trace, forces)
    pose, at_disk = far_pose(trace, forces, reach_of(forces, trace))
    ends, at = span_ends(trace, forces, frame, at_disk)
    return frame | pose | ends, at


def measuring_steps(forces: SceneForces) -> list[Step]:
    """Steps that measure coupled cables at rest; none without them."""
    return [lengths_step(forces), beyond_step(forces)] if forces.coupled else []


def lengths_step(forces: SceneForces, outward: Outward = at_rest, *, moves: bool = False) -> Step:
    """Outwards: the length of each coupled cable from hole to hole and, in motion, its rate."""
    trace = Trace()
    carried, at = outward(trace, forces)
    joined = forces.span or forces.segment
    for cable in forces.coupled:
        c = cable.number
        trace.name(f"hole_to_hole_{c}", (cable.passes * cable.length).xreplace(at))
        if moves:
            pairs = zip(joined.coordinates, joined.rates, strict=True)
            rate = sum(cable.length.diff(q) * u for q, u in pairs)
            trace.name(f"hole_to_hole_rate_{c}", (cable.passes * rate).xreplace(at))
    return Step(
        "lengths",
        "Outwards: hole-to-hole lengths of coupled cables.",
        OUTWARD,
        ("q", *(["u"] if moves else []), "inputs", "segments", "chain"),
        trace,
        carried=carried,
    )


def beyond_step(forces: SceneForces, *, moves: bool = False) -> Step:
    """Inwards: length of each coupled cable beyond the near hole and, in motion, its rate."""
    trace = Trace()
    names = [f"_{c.number}" for c in forces.coupled]
    names += [f"_rate_{c.number}" for c in forces.coupled if moves]
    carried = {}
    for name in names:
        whole = trace.name(f"length_beyond{name}", symbol(f"beyond{name}") + symbol(f"hole_to_hole{name}"))
        carried[f"beyond{name}"] = (0.0, whole)
    return Step("beyond", "Inwards: lengths beyond each hole.", INWARD, ("chain",), trace, carried=carried)


def lengths_tangent_step(forces: SceneForces, outward: Outward) -> Step:
    """The derivative of the moving ``lengths_step`` along a change of coordinates and rates."""
    step = lengths_step(forces, outward, moves=True)
    moving = [*forces.segment.coordinates, *forces.segment.rates, *map(symbol, step.carried)]
    trace, change = step.trace.tangent({s: symbol(f"{s}_change") for s in moving})
    for cable in forces.coupled:
        for name in (f"hole_to_hole_{cable.number}", f"hole_to_hole_rate_{cable.number}"):
            trace.name(f"{name}_change", change.get(symbol(name), sp.Integer(0)))
    changes = {
        f"{name}_change": (0.0, trace.change_of(value, change)) for name, (_, value) in step.carried.items()
    }
    return Step(
        "lengths_tangent",
        "Derivative of lengths_step along q_change, u_change.",
        step.direction,
        (*step.arrays, "q_change", "u_change"),
        trace,
        carried=step.carried | changes,
    )


def beyond_tangent_step(forces: SceneForces) -> Step:
    """The derivative of the moving ``beyond_step`` along what ``lengths_tangent_step`` left."""
    trace, carried = Trace(), {}
    for cable in forces.coupled:
        for name in (f"_{cable.number}", f"_rate_{cable.number}"):
            change = symbol(f"beyond{name}_change") + symbol(f"hole_to_hole{name}_change")
            carried[f"beyond{name}_change"] = (0.0, trace.name(f"length_beyond{name}_change", change))
    return Step(
        "beyond_tangent",
        "Derivative of beyond_step along what lengths_tangent_step left.",
        INWARD,
        ("chain",),
        trace,
        carried=carried,
    )
