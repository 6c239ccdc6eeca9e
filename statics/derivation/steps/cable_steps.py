"""Steps that measure coupled cables before the passes that need their tensions.

An outward pass finds each length from hole to hole, an inward one the sums beyond each hole; in motion with
their rates, and for the exact Jacobian with the changes of both.
"""

from collections.abc import Callable

import sympy as sp

from statics.derivation.step import INWARD, OUTWARD, Carried, Step
from statics.derivation.steps.forces_by_name import Known
from statics.derivation.steps.outward import name_poses
from statics.derivation.trace import Trace, derivative, symbol
from statics.derivation.virtual_work import SceneForces

NameGeometry = Callable[[Trace, SceneForces], tuple[Carried, Known]]
"""Names one segment's geometry in a trace; returns what is carried on, and what symbols stand for."""


def measuring_steps(forces: SceneForces) -> list[Step]:
    """Steps that measure coupled cables at rest; none without them."""
    return [lengths_step(forces), beyond_step(forces)] if forces.coupled else []


def lengths_step(
    forces: SceneForces, name_geometry: NameGeometry = name_poses, *, moves: bool = False
) -> Step:
    """Outward pass: length of each coupled cable from hole to hole (m) and, in motion, its rate (m/s)."""
    trace = Trace()
    carried, known = name_geometry(trace, forces)
    ends = forces.span or forces.segment
    for cable in forces.coupled:
        c = cable.number
        trace.always_name(f"hole_to_hole_{c}", (cable.passes * cable.length).xreplace(known))
        if moves:
            pairs = zip(ends.coordinates, ends.rates, strict=True)
            rate = sum(derivative(cable.length, q) * u for q, u in pairs)
            trace.always_name(f"hole_to_hole_rate_{c}", (cable.passes * rate).xreplace(known))
    return Step(
        "lengths",
        "Outwards: hole-to-hole lengths of coupled cables.",
        OUTWARD,
        ("q", *(["u"] if moves else []), "inputs", "segments", "chain"),
        trace,
        carried=carried,
    )


def _sum_step(name: str, doc: str, measures: list[str], change: str = "") -> Step:
    """Inward pass: sums of the outward pass's measures over everything beyond the near hole."""
    trace, carried = Trace(), {}
    for measure in measures:
        total = symbol(f"beyond{measure}{change}") + symbol(f"hole_to_hole{measure}{change}")
        total = trace.always_name(f"length_beyond{measure}{change}", total)
        carried[f"beyond{measure}{change}"] = (0.0, total)
    return Step(name, doc, INWARD, ("chain",), trace, carried=carried)


def beyond_step(forces: SceneForces, *, moves: bool = False) -> Step:
    """Inward pass: length of each coupled cable beyond the near hole (m) and, in motion, its rate (m/s)."""
    measures = [f"_{cable.number}" for cable in forces.coupled]
    measures += [f"_rate_{cable.number}" for cable in forces.coupled if moves]
    return _sum_step("beyond", "Inwards: lengths beyond each hole.", measures)


def _lengths_and_rates(forces: SceneForces) -> list[str]:
    """Suffixes of the names of each coupled cable's length and of its rate."""
    return [f"{kind}_{cable.number}" for cable in forces.coupled for kind in ("", "_rate")]


def lengths_tangent_step(forces: SceneForces, name_geometry: NameGeometry) -> Step:
    """Outward pass: derivative of the moving ``lengths_step`` along a change of coordinates and rates."""
    step = lengths_step(forces, name_geometry, moves=True)
    moving = [*forces.segment.coordinates, *forces.segment.rates, *map(symbol, step.carried)]
    trace, change = step.trace.tangent({s: symbol(f"{s}_change") for s in moving})
    for measure in _lengths_and_rates(forces):
        name = f"hole_to_hole{measure}"
        trace.always_name(f"{name}_change", change.get(symbol(name), sp.Integer(0)))
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
    """Inward pass: derivative of the moving ``beyond_step`` along what ``lengths_tangent_step`` left."""
    doc = "Derivative of beyond_step along what lengths_tangent_step left."
    return _sum_step("beyond_tangent", doc, _lengths_and_rates(forces), "_change")
