"""Inward pass of the residual: wrenches add up from the tip to the base (recursive Newton-Euler)."""

import sympy as sp

from statics.derivation.frames import POSE, WRENCH, components
from statics.derivation.reach import core_reaches, reach_of
from statics.derivation.step import INWARD, Step, carry_from_zero
from statics.derivation.steps.forces_by_name import force_by_name
from statics.derivation.steps.outward import at_span_start
from statics.derivation.trace import Trace, symbol
from statics.derivation.virtual_work import SceneForces


def residual_step(forces: SceneForces) -> Step:
    """Inward pass: reaction (f, N) on the far disk, N and N m, and the residual S^T (f, N) - Q.

    The residual is Rone 2012, Eq. 5, with its sign changed.
    """
    trace, reach = Trace(), reach_of(forces)
    on_disk, on_start, carried = force_by_name(forces, "disk"), sp.zeros(len(POSE), 1), {}
    if forces.span is not None:
        on_span = force_by_name(forces, "span")
        on_disk += on_span[: len(POSE), :]
        before = components("span", WRENCH)
        at_start = before - on_span[len(POSE) :, :]
        on_start = symbol("starts_span") * at_start
        carried = carry_from_zero(before, at_span_start(sp.zeros(len(POSE), 1), at_start))
    wrench = sp.Matrix([symbol(name) for name in WRENCH]) - on_disk
    reaction = sp.Matrix([trace.always_name(f"reaction_{row}", value) for row, value in enumerate(wrench)])
    residual = reach.partials.T * reaction - force_by_name(forces, "segment")
    on_near = reach.transition.T * reaction + on_start
    for point, to_point in core_reaches(forces):
        force = force_by_name(forces, point.name)
        residual -= to_point.position_partials.T * force
        on_near -= to_point.position_transition.T * force
    return Step(
        "residual",
        "Inwards: reaction on the segment's far disk and the segment's residual.",
        INWARD,
        ("disks", "chain", "residual"),
        trace,
        results=carry_from_zero(WRENCH, on_near),
        carried=carried,
        stores={"residual": list(residual)},
    )
