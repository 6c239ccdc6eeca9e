"""Solution of the chain's Newton system H dq = -residual in O(n): articulated bodies, 3x3 blocks eliminated.

The chain's second derivatives act through the reaction f = -sum P beyond the segment (R, d, S, X: see
``outward``):

    f . R d_qq,   f . z x R d_q,   -f . R d

A point of the core that carries mass adds a sum over its own S and X. Inside a span the blocks belong to two
poses, that of the segment's near node and that of the disk at the span's start, and are 6x6; at the span's
first segment the two poses are one, and merge.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import sympy as sp

from statics.derivation.frames import ANGLE, AXES, POSE, components, perpendicular
from statics.derivation.reach import Reach, core_reaches, reach_of
from statics.derivation.step import INWARD, OUTWARD, Carried, Step, carry_from_zero
from statics.derivation.steps.coupled_cables import carry_slopes, pass_hole, tensions_beyond_holes
from statics.derivation.steps.forces_by_name import cable_pull_by_name, force_by_name
from statics.derivation.steps.newton_matrix import Weights
from statics.derivation.steps.outward import at_span_start
from statics.derivation.trace import Trace, symbol, symbol_column, symbol_matrix
from statics.derivation.virtual_work import SceneForces

NEAR = slice(0, len(POSE))
"""Rows of the near node's pose among the states that a block belongs to."""


def eliminate_step(forces: SceneForces, weights: Weights) -> Step:
    """Inward pass: eliminate one segment's coordinates from H dq = -residual.

    With A, C, B, D its blocks, by rows the segment's and the near disk's: V' = D - B A^-1 C. Where the system
    is symmetric B is the transpose of C. The near disk's states are its pose, that of the span's start inside
    a span, and the tensions of coupled cables, whose rows of V are the lengths beyond it.
    """
    trace, reach = Trace(), reach_of(forces)
    symmetric, coupled = weights.is_symmetric(forces), weights.coupled_cables(forces)
    dofs = len(forces.segment.coordinates)
    S, X, here = reach.partials, reach.transition, weights.matrix(forces, "disk")
    if forces.span is not None:
        pose = sp.zeros(len(POSE))
        S, X, here = S.col_join(pose[:, :dofs]), sp.diag(X, sp.eye(len(POSE))), sp.diag(here, pose)
        here += weights.matrix(forces, "span")
    poses, tensions = S.shape[0], len(coupled)
    S, X = S.col_join(sp.zeros(tensions, dofs)), sp.diag(X, sp.eye(tensions))
    here = sp.diag(here, sp.zeros(tensions))
    states = range(poses + tensions)
    pulls = sp.zeros(dofs, len(states))
    for state, cable in enumerate(coupled, start=poses):
        pull = cable_pull_by_name(forces, cable)
        if forces.span is None:
            pulls[:, state] = pull
        else:
            here[:poses, state], here[state, :poses] = pull, pull.T
    load = symbol_column("carried_load", len(states))
    V = trace.matrix("V", symbol_matrix("carried", *here.shape, symmetric=symmetric) + here, symmetric)
    VS, VX = trace.name("VS", V * S), trace.name("VX", V * X)
    beyond, own = S.T * VS, weights.matrix(forces, "segment")
    blocks = _Blocks(beyond + own, X.T * VS + pulls.T, S.T * VX + pulls, X.T * VX)
    _add_curvature(trace, blocks, weights, symbol_column("reaction", len(AXES)), reach)
    for point, to_point in core_reaches(forces):
        _add_point(trace, blocks, weights.matrix(forces, point.name), to_point)
        _add_curvature(trace, blocks, weights, -force_by_name(forces, point.name), to_point)
    given = tuple(map(str, weights.given))
    if not (symmetric or weights.definite):
        blocks.A[:, :] += _slowing(dofs)
        given = ("slowing",)
    A, B, C, D = blocks
    terms = [(beyond[k, k], own[k, k], A[k, k] - beyond[k, k] - own[k, k]) for k in range(dofs)]
    A, B = trace.matrix("A", A, symmetric), trace.name("B", B)
    C = B.T if symmetric else trace.name("C", C)
    b = trace.name("b", S.T * load - symbol_column("residual", dofs))
    inverse, counted = _invert_pivot(trace, symmetric, A, terms, weights)
    gain, descent = trace.name("gain", inverse * C), trace.name("descent", inverse * b)
    next_load, next_V = X.T * load - B * descent, D - B * gain
    if forces.span is not None:
        next_V, next_load = _merge_poses(
            trace.matrix("next_V", next_V, symmetric), trace.name("next_load", next_load)
        )
    slopes = carry_slopes(trace, forces, coupled)
    for state, cable in enumerate(coupled, start=poses):
        next_V = trace.matrix(f"onto_{state}", next_V, symmetric)
        next_load = trace.name(f"onto_load_{state}", next_load)
        in_span = forces.span is not None
        next_V, next_load = pass_hole(trace, cable, state, next_V, next_load, weights, in_span)
        if "negative_pivots" in counted:
            start, count = counted["negative_pivots"]
            counted["negative_pivots"] = start, count - sp.Heaviside(-symbol(f"hole_pivot_{cable.number}"))
    entries = [(r, c) for r in states for c in states if c >= r or not symmetric]
    pivots = {"pivots": [A[r, c] for r in range(dofs) for c in range(r, dofs)]} if counted else {}
    return Step(
        "eliminate",
        "Inwards: one segment's coordinates eliminated; the rest goes to its near disk.",
        INWARD,
        ("segments", "disks", "chain", "residual", "descent", "pivots"),
        trace,
        results=counted,
        carried={f"carried_{r}{c}": (0.0, next_V[r, c]) for r, c in entries}
        | carry_from_zero(symbol_column("carried_load", len(states)), next_load)
        | slopes,
        given=given + (("keep_sign",) if pivots else ()),
        stores={"descent": list(descent)} | pivots,
    )


class _Blocks(NamedTuple):
    """The matrix of one segment's coordinates and its near disk's states, by rows: A, C; B, D."""

    A: sp.Matrix
    B: sp.Matrix
    C: sp.Matrix
    D: sp.Matrix


def _add_curvature(trace: Trace, blocks: _Blocks, weights: Weights, f: sp.Matrix, reach: Reach) -> None:
    """Add the reach's second derivatives along a reaction f at its end."""
    if weights.stiffness == 0:
        return
    f = trace.name(f"{reach.prefix}turning", weights.stiffness * f)
    for a, (slope, row) in enumerate(zip(reach.by_q, reach.by_qq, strict=True)):
        for b, second in enumerate(row):
            blocks.A[a, b] += f.dot(second)
        across = f.dot(perpendicular(slope))
        blocks.B[ANGLE, a] += across
        blocks.C[a, ANGLE] += across
    blocks.D[ANGLE, ANGLE] -= f.dot(reach.whole)


def _add_point(trace: Trace, blocks: _Blocks, V: sp.Matrix, reach: Reach) -> None:
    """Add the matrix V, shape (2, 2), of a point of the core at the end of that reach."""
    S, X = reach.position_partials, reach.position_transition
    VS, VX = trace.name(f"{reach.prefix}VS", V * S), trace.name(f"{reach.prefix}VX", V * X)
    blocks.A[:, :] += S.T * VS
    blocks.B[NEAR, :] += X.T * VS
    blocks.C[:, NEAR] += S.T * VX
    blocks.D[NEAR, NEAR] += X.T * VX


def _slowing(dofs: int) -> sp.Matrix:
    """Damping of a search without a potential: on bend angles that of a rotary damper, N m / rad.

    On elongations it is the same over the square of the rest length.
    """
    return symbol("slowing") * sp.diag(1, 1 / symbol("rest_length") ** 2)[:dofs, :dofs]


def _merge_poses(V: sp.Matrix, load: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
    """Matrix and load on (near node, span's start), merged onto the former at the span's first segment."""
    pose, zero = sp.eye(len(POSE)), sp.zeros(len(POSE))
    rest, start = V.shape[0] - 2 * len(POSE), symbol("starts_span")
    onto = sp.diag(pose.row_join(pose).col_join(zero.row_join(zero)), sp.eye(rest))
    return start * onto * V * onto.T + (1 - start) * V, start * onto * load + (1 - start) * load


def _invert_pivot(
    trace: Trace, symmetric: bool, A: sp.Matrix, terms: Sequence[Sequence[Any]], weights: Weights
) -> tuple[sp.Matrix, Carried]:
    """The pivot's inverse, and the numbers that the pass counts for it.

    ``terms`` are those that add up in each entry of the diagonal: their sizes say whether the pivot is
    singular. A pivot of a matrix that may be indefinite is made positive, unless ``keep_sign`` is given.
    A definite matrix has nothing to count, and for an unsymmetric one the count has no meaning.
    """
    dofs = A.shape[0]
    if weights.definite or not symmetric:
        return _plain_inverse(trace, A), {}
    entries = [(r, c) for r in range(dofs) for c in range(r, dofs)]
    units = [symbol("rest_length")] if dofs == 2 else []
    sizes = [
        sum(sp.Abs(trace.name(f"pivot_term_{k}{number}", term)) for number, term in enumerate(parts))
        for k, parts in enumerate(terms)
    ]
    *_, negative = trace.call(
        f"pivot_inverse_{dofs}",
        [
            *(A[r, c] for r, c in entries),
            *units,
            *trace.name("pivot_size", sp.Matrix(sizes)),
            symbol("keep_sign"),
        ],
        [*(f"inverse_{r}{c}" for r, c in entries), "negative"],
    )
    return symbol_matrix("inverse", dofs, dofs, symmetric=True), {
        "negative_pivots": (0.0, symbol("negative_pivots") + negative),
    }


def _plain_inverse(trace: Trace, A: sp.Matrix) -> sp.Matrix:
    if A.shape[0] == 1:
        return sp.Matrix([[trace.name("inverse_00", 1 / A[0, 0])]])
    determinant = trace.name("determinant", A[0, 0] * A[1, 1] - A[0, 1] * A[1, 0])
    scaled = sp.Matrix([[A[1, 1], -A[0, 1]], [-A[1, 0], A[0, 0]]]) / determinant
    return trace.matrix("inverse", scaled, symmetric=A == A.T)


def substitute_step(forces: SceneForces, weights: Weights) -> Step:
    """Outward pass: dq of one segment from the changes of its near disk's pose and of coupled tensions."""
    trace, reach = Trace(), reach_of(forces)
    dofs = len(forces.segment.coordinates)
    near, ends = components("shift", POSE), {}
    states = near
    if forces.span is not None:
        before = components("span_shift", POSE)
        at_start = trace.name("from_shift", at_span_start(near, before))
        ends, states = carry_from_zero(before, at_start), near.col_join(at_start)
    states, tensions = tensions_beyond_holes(trace, states, weights.coupled_cables(forces))
    gain = symbol_matrix("gain", dofs, len(states))
    change = trace.name("change", symbol_column("descent", dofs) - gain * states)
    far = reach.transition * near + reach.partials * change
    return Step(
        "substitute",
        "Outwards: the segment's part of the solution.",
        OUTWARD,
        ("chain", "descent", "change"),
        trace,
        carried=carry_from_zero(near, far) | ends | tensions,
        stores={"change": list(change)},
    )
