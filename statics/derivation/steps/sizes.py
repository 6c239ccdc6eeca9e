"""Sizes of the forces that contribute to each row of the residual, which must be small relative to them.

An outward pass names the sizes at each site: what its pairs add, one by one, and what rounding of the
coordinates and of cable lengths can leave. An inward pass adds them up as the residual's own pass adds up the
forces, each of them positive.
"""

from collections.abc import Sequence
from typing import Any

import sympy as sp

from statics.derivation.frames import AXES, POSE
from statics.derivation.reach import Reach, core_reaches, reach_of
from statics.derivation.step import INWARD, Carried, Step, carry_from_zero
from statics.derivation.steps.forces_by_name import Known, cable_pull_by_name, rewrite
from statics.derivation.trace import Trace, matrix_by_name, symbol
from statics.derivation.virtual_work import Forces, SceneForces

ROUNDED = 1e-6
"""Factor on the change of a force by rounding of its argument, which makes it 1e-14 in all."""
SIZE = ("size_x", "size_y", "size_theta")
"""Names of the size of the wrench that the residual's pass carries."""


def name_sizes(trace: Trace, forces: SceneForces, known: Known) -> Carried:
    """Name the sizes of the generalized forces at every site; return what is carried for them."""
    of_lengths = "segment" if forces.span is None else "span"
    for site, part in forces.sites.items():
        for row in range(len(part.force)):
            sizes = _sizes_of_terms(trace, f"{site}_term_{row}", [term[row] for term in part.terms], known)
            if site == "segment":
                stiffness = matrix_by_name("segment_stiffness", part.stiffness, forces.conservative)[row, row]
                sizes.append(ROUNDED * sp.Abs(stiffness) * sp.Abs(forces.segment.coordinates[row]))
            if site == of_lengths:
                sizes += [_by_length(forces, number, row) for number in _driven_by_length(forces)]
            if sizes:
                trace.always_name(f"{site}_size_{row}", sp.Add(*sizes))
    return {
        f"held_{number}": (
            symbol(f"cable_stiffness_{number}") * symbol(f"cable_rest_length_{number}"),
            symbol(f"held_{number}"),
        )
        for number in _driven_by_length(forces)
    }


def _sizes_of_terms(trace: Trace, name: str, terms: Sequence[Any], known: Known) -> list[Any]:
    named = [trace.name(f"{name}_{k}", rewrite(term, known)) for k, term in enumerate(terms) if term != 0]
    return [sp.Abs(term) for term in named]


def _driven_by_length(forces: SceneForces) -> list[int]:
    return [cable.number for cable in forces.coupled if cable.kind.driven_by_length]


def _by_length(forces: SceneForces, number: int, row: int) -> Any:
    """Change of the tension of a length-driven cable by rounding of its length."""
    cable = next(cable for cable in forces.coupled if cable.number == number)
    return ROUNDED * symbol(f"held_{number}") * sp.Abs(cable_pull_by_name(forces, cable)[row])


def _sizes_by_name(site: str, part: Forces, *, always: bool = False) -> sp.Matrix:
    """The sizes at a site as ``name_sizes`` left them, shape (coordinates, 1)."""
    rows = range(len(part.force))
    there = [always or any(term[row] != 0 for term in part.terms) for row in rows]
    return sp.Matrix([symbol(f"{site}_size_{row}") if there[row] else 0 for row in rows])


def sizes_step(forces: SceneForces) -> Step:
    """Inward pass: for each row of the residual the size of the forces that meet in it, N or N m.

    After them the segment's own stiffness against bending, N m / rad.
    """
    trace, reach = Trace(), reach_of(forces)
    at_disk = _sizes_by_name("disk", forces.on_disk)
    at_near = sp.zeros(len(POSE), 1)
    if forces.span is not None and forces.on_span is not None:
        of_span = _sizes_by_name("span", forces.on_span, always=bool(_driven_by_length(forces)))
        at_disk, at_near = at_disk + of_span[: len(POSE), :], of_span[len(POSE) :, :]
    wrench = trace.name("far_size", sp.Matrix([symbol(name) for name in SIZE]) + at_disk)
    rows = _seen_along(reach, wrench, reach.partials) + _sizes_by_name(
        "segment", forces.on_segment, always=True
    )
    near = _moved(reach, wrench) + at_near
    for point, to_point in core_reaches(forces):
        force = _sizes_by_name(point.name, forces.sites[point.name])
        rows += _seen_along(to_point, force, to_point.position_partials)
        near += _moved(to_point, force)
    stiffness = matrix_by_name("segment_stiffness", forces.on_segment.stiffness, forces.conservative)
    return Step(
        "sizes",
        "Inwards: size of the forces that meet in each row of the residual, and the stiffness to bending.",
        INWARD,
        ("disks", "chain", "sizes"),
        trace,
        carried=carry_from_zero([symbol(name) for name in SIZE], near),
        stores={"sizes": [*rows, sp.Abs(stiffness[0, 0])]},
    )


def _seen_along(reach: Reach, sizes: sp.Matrix, partials: sp.Matrix) -> sp.Matrix:
    """Size of the generalized forces that a wrench of that size has along the partials of its place."""
    return partials.applyfunc(sp.Abs).T * sizes


def _moved(reach: Reach, sizes: sp.Matrix) -> sp.Matrix:
    """Size of a wrench at the near disk that has the given one at the end of the reach."""
    x, y = (sp.Abs(part) for part in reach.whole)
    moment = sizes[0] * y + sizes[1] * x
    return sp.Matrix([*sizes[: len(AXES)], moment + sum(sizes[len(AXES) :])])
