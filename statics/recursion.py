"""One step of each sweep along the chain, as matrix algebra in sympy.

Outwards the pose, velocity and acceleration of a disk follow from those of the disk before
(Rone 2012, Eq. 10 and its derivatives); inwards wrenches add up (recursive Newton-Euler) and 3x3 blocks
are eliminated (articulated bodies). With R the rotation of the segment's near disk and d(q) its far
end seen from there,

    p = p0 + R d,   dp = X dp0 + S dq,   S = [R d_q; phi_q],   X: dp0 plus dtheta0 z x R d

The chain's second derivatives act through the reaction f = -sum P beyond the segment:

    f . R d_qq,   f . z x R d_q,   -f . R d

A point of the core that carries mass hangs on the segment's near disk by a reach of its own, as the far disk
does, and nothing hangs on it: what it adds is a sum over its S and X.

Where several segments make a span from disk to disk, a cable joins the poses of the span's two ends. Then
what is carried inwards belongs to two poses, that of the segment's near node and that of the disk at the
span's start, with blocks of 6x6 instead of 3x3; at the span's first segment the two are one, and merge.
"""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import sympy as sp

from statics.reach import Reach, core_reaches, reach_of, turned
from statics.segment import CableSymbols, CorePointSymbols, symbol
from statics.trace import Trace
from statics.virtual_work import SceneForces


@dataclass(frozen=True)
class Step:
    """What one segment contributes to a sweep.

    ``results`` and ``carried`` map a name to its value before the first segment and after this one;
    results are what the sweep returns. ``arrays`` are the step's arguments, ``stores`` those that it
    writes, one column for each expression.
    """

    name: str
    doc: str
    arrays: tuple[str, ...]
    trace: Trace
    results: dict[str, tuple[float, Any]] = field(default_factory=dict)
    carried: dict[str, tuple[float, Any]] = field(default_factory=dict)
    stores: dict[str, list[Any]] = field(default_factory=dict)


def turn_frame(trace: Trace, forces: SceneForces) -> dict[str, tuple[float, Any]]:
    """Cosine and sine of the far disk's angle by angle addition, kept on the unit circle."""
    d, length = forces.segment.displacement, forces.segment.length
    chord = trace.let("half_chord", (d / length).applyfunc(sp.cancel))
    half = forces.segment.half_angle
    turn_cos = trace.let("turn_cosine", 1 - 2 * half * chord[1])
    turn_sin = trace.let("turn_sine", 2 * half * chord[0])
    cosine, sine = symbol("cosine"), symbol("sine")
    far_cos = trace.let("far_cosine", cosine * turn_cos - sine * turn_sin)
    far_sin = trace.let("far_sine", sine * turn_cos + cosine * turn_sin)
    onto_circle = trace.let("onto_circle", (3 - far_cos**2 - far_sin**2) / 2)
    return {
        "cosine": (1.0, trace.let("next_cosine", far_cos * onto_circle)),
        "sine": (0.0, trace.let("next_sine", far_sin * onto_circle)),
    }


def far_pose(trace: Trace, forces: SceneForces, reach: Reach) -> tuple[dict[str, Any], dict[sp.Symbol, Any]]:
    """Pose of the far disk: what is carried on, and what the disk's symbols stand for.

    The trace must have ``turn_frame`` in it where the disk's forces ask for cosine and sine of its angle.
    """
    x, y, theta = (symbol(f"near_{name}") for name in ("x", "y", "theta"))
    far_x = trace.let("far_x", x + reach.whole[0])
    far_y = trace.let("far_y", y + reach.whole[1])
    far_theta = trace.let("far_theta", theta + forces.segment.bend_angle)
    carried = {"near_x": (0.0, far_x), "near_y": (0.0, far_y), "near_theta": (0.0, far_theta)}
    at_disk: dict[Any, Any] = dict(zip(forces.disk.coordinates, (far_x, far_y, far_theta), strict=True))
    turns = {sp.cos(forces.disk.angle): "next_cosine", sp.sin(forces.disk.angle): "next_sine"}
    return carried, at_disk | {turn: symbol(name) for turn, name in turns.items()}


def core_positions(trace: Trace, reaches: list[tuple[CorePointSymbols, Reach]]) -> dict[sp.Symbol, Any]:
    """What the positions of the core's points stand for."""
    near, at = sp.Matrix([symbol("near_x"), symbol("near_y")]), {}
    for point, reach in reaches:
        position = trace.let(f"{reach.prefix}position", near + reach.whole)
        at |= dict(zip(point.position, position, strict=True))
    return at


def from_start(near: Any, before: Any) -> Any:
    """What holds at the start of the segment's span: the near node's value if the segment is its first."""
    start = symbol("starts_span")
    return start * near + (1 - start) * before


def span_ends(
    trace: Trace, forces: SceneForces, frame: dict[str, Any], at_disk: dict[sp.Symbol, Any]
) -> tuple[dict[str, Any], dict[Any, Any]]:
    """Poses of the span's two ends: what is carried on, and what all symbols of a step stand for."""
    carried, at = {}, dict(at_disk)
    if forces.span is None:
        return carried, at | _cable_lengths(trace, forces.segment.cables, {})
    trace.name("starts_span", symbol("span_start"))
    for name, start in (("x", 0.0), ("y", 0.0), ("theta", 0.0), ("cosine", 1.0), ("sine", 0.0)):
        near = symbol(name if name in frame else f"near_{name}")
        at_start = trace.let(f"from_{name}", from_start(near, symbol(f"span_{name}")))
        carried[f"span_{name}"] = (start, at_start)
        at[symbol(f"span_{name}")] = at_start
    theta = symbol("span_theta")
    at |= {sp.cos(theta): carried["span_cosine"][1], sp.sin(theta): carried["span_sine"][1]}
    return carried, at | _cable_lengths(trace, forces.span.cables, at)


def _cable_lengths(trace: Trace, cables: list[CableSymbols], at: dict[Any, Any]) -> dict[Any, Any]:
    """Names for those lengths that are roots, and what their powers, which forces hold, stand for."""
    known: dict[Any, Any] = {}
    for number, cable in enumerate(cables, start=1):
        squared = cable.length**2
        if cable.length == sp.sqrt(squared) and cable.length.is_Pow:
            value = trace.let(f"squared_{number}", squared.xreplace(at))
            length = trace.let(f"cable_length_{number}", sp.sqrt(value))
            known |= {squared ** sp.Rational(power, 2): length**power for power in (1, -1, -3)}
    return known


def _smallest(trace: Trace, forces: SceneForces, at: dict[Any, Any]) -> Any:
    """Smallest so far of length and hole-to-hole lengths over L0; cables that do not pass are left out."""
    span, rest = forces.span or forces.segment, symbol("rest_length")
    apart = rest if forces.span is None else symbol("disk_spacing")
    ratios = [
        sp.Max(placed(cable.gap, at) / apart, 1 - symbol(f"cable_passes_{number}"))
        for number, cable in enumerate(span.cables, start=1)
    ]
    if forces.segment.elongation != 0:
        ratios.append(forces.segment.length / rest)
    return sp.Min(symbol("clearance"), *(trace.let(f"ratio_{k}", ratio) for k, ratio in enumerate(ratios)))


def clearance_step(forces: SceneForces) -> Step:
    """How far the arm is from a geometric limit."""
    trace = Trace()
    frame = turn_frame(trace, forces)
    pose, at_disk = far_pose(trace, forces, reach_of(forces, trace))
    ends, at = span_ends(trace, forces, frame, at_disk)
    return Step(
        "clearance_step",
        "Smallest length or hole-to-hole length over L0.",
        ("q", "segments"),
        trace,
        results={"clearance": (1.0, _smallest(trace, forces, at))},
        carried=frame | pose | ends,
    )


def pose_step(forces: SceneForces) -> Step:
    """Outwards, at rest: geometry, loads and potential energy."""
    trace = Trace()
    reach = reach_of(forces, trace)
    carried = turn_frame(trace, forces)
    pose, at_disk = far_pose(trace, forces, reach)
    ends, at = span_ends(trace, forces, carried, at_disk)
    at |= core_positions(trace, core_reaches(forces, trace))
    name_forces(trace, forces, at)
    parts = forces.places.items()
    energies = [(name, placed(sp.Add(*part.energies.values()), at)) for name, part in parts]
    energy = trace.let(
        "added_potential", sum(trace.let(f"{name}_potential", value) for name, value in energies)
    )
    smallest = _smallest(trace, forces, at)
    return Step(
        "pose_step",
        "Outwards, at rest: reach, loads, potential energy, clearance.",
        ("q", "inputs", "segments", "disks", "chain"),
        trace,
        results={
            "potential": (0.0, symbol("potential") + energy),
            "potential_scale": (0.0, symbol("potential_scale") + sp.Abs(energy)),
            "clearance": (1.0, smallest),
        },
        carried=carried | pose | ends,
    )


def placed(expression: Any, at: dict[Any, Any]) -> Any:
    """An expression with the chain's names for the poses and motions that it is written in."""
    return expression.xreplace(at) if hasattr(expression, "xreplace") else sp.sympify(expression)


def booked(forces: SceneForces, kind: str, account: str, at: dict[Any, Any]) -> Any:
    """One line of the ledger: what all places put into it."""
    return sum(placed(getattr(part, kind).get(account, 0), at) for part in forces.places.values())


def name_forces(trace: Trace, forces: SceneForces, at: dict[Any, Any]) -> None:
    """Name the generalized forces and their derivatives for the inward sweeps."""
    for place, part in forces.places.items():
        trace.let(f"{place}_force", placed(part.force, at))
        for name in ("mass", "damping", "stiffness"):
            _let_matrix(trace, forces.conservative, f"{place}_{name}", placed(getattr(part, name), at))


def _let_matrix(trace: Trace, symmetric: bool, name: str, value: sp.Matrix) -> sp.Matrix:
    """Name the entries of a matrix, or those of the upper triangle of a symmetric one."""
    return trace.symmetric(name, value) if symmetric else trace.let(name, value)


def _named(name: str, value: sp.Matrix) -> sp.Matrix:
    """The names that ``Trace.let`` gave to a column in an earlier step; numbers and symbols as they are."""
    return sp.Matrix(*value.shape, lambda r, c: value[r, c] if value[r, c].is_Atom else symbol(f"{name}_{r}"))


def _named_matrix(symmetric: bool, name: str, value: sp.Matrix) -> sp.Matrix:
    """Likewise for ``_let_matrix``."""
    named = sp.Matrix(
        *value.shape, lambda r, c: value[r, c] if value[r, c].is_Atom else symbol(f"{name}_{r}{c}")
    )
    return _mirrored(named) if symmetric else named


def _mirrored(value: sp.Matrix) -> sp.Matrix:
    """The symmetric matrix with that upper triangle."""
    return sp.Matrix(*value.shape, lambda r, c: value[min(r, c), max(r, c)])


def _core_forces(forces: SceneForces) -> list[sp.Matrix]:
    """Forces on the points of the core, by the names that ``name_forces`` gave them."""
    return [
        _named(f"{point.name}_force", part.force)
        for point, part in zip(forces.core, forces.on_core, strict=True)
    ]


def observe_step(forces: SceneForces) -> Step:
    """Outwards, at rest: poses of the nodes and the energies of the core and of the weight."""
    trace = Trace()
    reach = reach_of(forces, trace)
    frame = turn_frame(trace, forces)
    pose, at_disk = far_pose(trace, forces, reach)
    at = at_disk | core_positions(trace, core_reaches(forces, trace))
    energies = {name: booked(forces, "energies", name, at) for name in ("elastic_energy", "gravity_energy")}
    return Step(
        "observe_step",
        "Outwards, at rest: poses of the disks, elastic and gravity energy.",
        ("q", "inputs", "segments", "disks", "pose"),
        trace,
        results={
            name: (0.0, symbol(name) + trace.let(f"added_{name}", value)) for name, value in energies.items()
        },
        carried=frame | pose,
        stores={"pose": [at_disk[coordinate] for coordinate in forces.disk.coordinates]},
    )


def residual_step(forces: SceneForces) -> Step:
    """Inwards: reaction wrenches and the residual S^T (f, N) - Q (Eq. 5, with its sign turned)."""
    trace = Trace()
    reach = reach_of(forces)
    names = ("force_x", "force_y", "torque")
    on_span = sp.zeros(6, 1) if forces.on_span is None else _named("span_force", forces.on_span.force)
    on_disk = _named("disk_force", forces.on_disk.force) + on_span[:3, :]
    wrench = sp.Matrix([symbol(name) for name in names]) - on_disk
    reaction = sp.Matrix([trace.name(f"reaction_{row}", value) for row, value in enumerate(wrench)])
    residual = reach.partials.T * reaction - _named("segment_force", forces.on_segment.force)
    inwards = reach.transition.T * reaction
    for (_, of_core), force in zip(core_reaches(forces), _core_forces(forces), strict=True):
        residual -= of_core.by_q.T * force
        inwards -= of_core.transition[:2, :].T * force
    carried = dict(zip(names, inwards, strict=True))
    if forces.on_span is not None:
        at_start = sp.Matrix([symbol(f"span_{name}") for name in names]) - on_span[3:, :]
        carried = dict(zip(names, inwards + symbol("starts_span") * at_start, strict=True))
        inside = from_start(sp.zeros(3, 1), at_start)
        carried |= {f"span_{name}": value for name, value in zip(names, inside, strict=True)}
    return Step(
        "residual_step",
        "Inwards: reaction on the segment's far disk and the segment's residual.",
        ("disks", "chain", "residual"),
        trace,
        carried={name: (0.0, value) for name, value in carried.items()},
        stores={"residual": list(residual)},
    )


@dataclass(frozen=True)
class Weights:
    """A Newton matrix: mass M + damping C + stiffness K, each times its weight.

    A weight may be a number, or a symbol whose value the sweep is handed. ``definite`` says that the
    matrix is taken as positive, so that its pivots need no care.
    """

    mass: Any
    damping: Any
    stiffness: Any
    definite: bool = True

    @property
    def handed(self) -> list[sp.Symbol]:
        """The weights that are symbols."""
        return [w for w in (self.mass, self.damping, self.stiffness) if isinstance(w, sp.Symbol)]


STATIC = Weights(0, 0, 1, definite=False)
ACCELERATION = Weights(1, 0, 0)
IMPLICIT = Weights(1, symbol("damping_weight"), symbol("stiffness_weight"))


def eliminate_step(forces: SceneForces, weights: Weights) -> Step:
    """Inwards: eliminate one segment's coordinates from the chain's Newton system H dq = -residual.

    With A, C, B, D its blocks, by rows the segment's and the near disk's: V' = D - B A^-1 C. Where the system
    is symmetric B is the transpose of C.
    """
    trace = Trace()
    reach = reach_of(forces)
    symmetric = forces.conservative or weights.damping == weights.stiffness == 0
    dofs = len(forces.segment.coordinates)
    S, X, here = reach.partials, reach.transition, _weighted(weights, symmetric, forces, "disk")
    if forces.on_span is not None:
        S, X, here = S.col_join(sp.zeros(3, dofs)), sp.diag(X, sp.eye(3)), sp.diag(here, sp.zeros(3))
        here += _weighted(weights, symmetric, forces, "span")
    poses = range(S.shape[0])
    carried = sp.Matrix(*X.shape, lambda r, c: symbol(f"carried_{r}{c}"))
    if symmetric:
        carried = _mirrored(carried)
    load = sp.Matrix([symbol(f"carried_load_{r}") for r in poses])
    V = _let_matrix(trace, symmetric, "V", carried + here)
    VS, VX = trace.let("VS", V * S), trace.let("VX", V * X)
    A = S.T * VS + _weighted(weights, symmetric, forces, "segment")
    blocks = _Blocks(A, X.T * VS, S.T * VX, X.T * VX)
    _add_turning(trace, blocks, weights, sp.Matrix([symbol("reaction_0"), symbol("reaction_1")]), reach)
    for (point, of_core), force in zip(core_reaches(forces), _core_forces(forces), strict=True):
        _add_hanging(trace, blocks, _weighted(weights, symmetric, forces, point.name), of_core)
        _add_turning(trace, blocks, weights, -force, of_core)
    A, B, C, D = blocks
    A = _let_matrix(trace, symmetric, "A", A)
    B = trace.let("B", B)
    C = B.T if symmetric else trace.let("C", C)
    b = trace.let("b", S.T * load - sp.Matrix([symbol(f"residual_{a}") for a in range(dofs)]))
    inverse, results = _pivot_inverse(trace, symmetric, A, weights)
    gain = trace.let("gain", inverse * C)
    descent = trace.let("descent", inverse * b)
    next_load = X.T * load - B * descent
    next_V = D - B * gain
    if forces.on_span is not None:
        next_V, next_load = _merged(
            _let_matrix(trace, symmetric, "next_V", next_V), trace.let("next_load", next_load)
        )
    entries = [(r, c) for r in poses for c in poses if c >= r or not symmetric]
    return Step(
        "eliminate_step",
        "Inwards: one segment's coordinates eliminated; the rest goes to its near disk.",
        ("segments", "disks", "chain", "residual", "descent", "pivots"),
        trace,
        results={str(weight): (0.0, weight) for weight in weights.handed} | results,
        carried={f"carried_{r}{c}": (0.0, next_V[r, c]) for r, c in entries}
        | {f"carried_load_{r}": (0.0, next_load[r]) for r in poses},
        stores={"descent": list(descent)}
        | ({} if weights.definite else {"pivots": [A[r, c] for r in range(dofs) for c in range(r, dofs)]}),
    )


class _Blocks(NamedTuple):
    """The matrix of one segment's coordinates and what they hang on, by rows: A, C; B, D."""

    A: sp.Matrix
    B: sp.Matrix
    C: sp.Matrix
    D: sp.Matrix


def _add_turning(trace: Trace, blocks: _Blocks, weights: Weights, f: sp.Matrix, reach: Reach) -> None:
    """Add the reach's second derivatives along a reaction f at its end."""
    if weights.stiffness == 0:
        return
    f = trace.let(f"{reach.prefix}turning", weights.stiffness * f)
    for a, row in enumerate(reach.by_qq):
        for b, second in enumerate(row):
            blocks.A[a, b] += f.dot(second)
        across = f.dot(turned(reach.by_q[:, a]))
        blocks.B[2, a] += across
        blocks.C[a, 2] += across
    blocks.D[2, 2] -= f.dot(reach.whole)


def _add_hanging(trace: Trace, blocks: _Blocks, V: sp.Matrix, reach: Reach) -> None:
    """Add the matrix V, shape (2, 2), of a point that hangs by that reach, and on which nothing hangs."""
    S, X = reach.by_q, reach.transition[:2, :]
    VS, VX = trace.let(f"{reach.prefix}VS", V * S), trace.let(f"{reach.prefix}VX", V * X)
    blocks.A[:, :] += S.T * VS
    blocks.B[:3, :] += X.T * VS
    blocks.C[:, :3] += S.T * VX
    blocks.D[:3, :3] += X.T * VX


def _merged(V: sp.Matrix, load: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
    """Matrix and load on (near node, span's start) where, at the span's first segment, the two are one."""
    start, zero = symbol("starts_span"), sp.zeros(3)
    both = sp.eye(3).row_join(sp.eye(3))
    merged_V, merged_load = sp.diag(both * V * both.T, zero), (both * load).col_join(sp.zeros(3, 1))
    return start * merged_V + (1 - start) * V, start * merged_load + (1 - start) * load


def _weighted(weights: Weights, symmetric: bool, forces: SceneForces, place: str) -> sp.Matrix:
    part = forces.places[place]
    return (
        weights.mass * _named_matrix(symmetric, f"{place}_mass", part.mass)
        + weights.damping * _named_matrix(symmetric, f"{place}_damping", part.damping)
        + weights.stiffness * _named_matrix(symmetric, f"{place}_stiffness", part.stiffness)
    )


def _pivot_inverse(
    trace: Trace, symmetric: bool, A: sp.Matrix, weights: Weights
) -> tuple[sp.Matrix, dict[str, Any]]:
    """The pivot's inverse and what the sweep counts.

    Where the matrix may be indefinite the pivot is made positive, unless the sweep is asked to keep its
    sign; otherwise there is nothing to count.
    """
    dofs = A.shape[0]
    if weights.definite or not symmetric:
        return _plain_inverse(trace, A), {}
    entries = [(r, c) for r in range(dofs) for c in range(r, dofs)]
    units = [symbol("rest_length")] if dofs == 2 else []
    *inverse, size, negative = trace.call(
        f"pivot_inverse_{dofs}",
        [*(A[r, c] for r, c in entries), *units, symbol("pivot_scale"), symbol("keep_sign")],
        [*(f"inverse_{r}{c}" for r, c in entries), "pivot_size", "negative"],
    )
    by_place = dict(zip(entries, inverse, strict=True))
    matrix = sp.Matrix(dofs, dofs, lambda r, c: by_place[min(r, c), max(r, c)])
    return matrix, {
        "negative_pivots": (0.0, symbol("negative_pivots") + negative),
        "pivot_scale": (0.0, size),
        "keep_sign": (0.0, symbol("keep_sign")),
    }


def _plain_inverse(trace: Trace, A: sp.Matrix) -> sp.Matrix:
    if A.shape[0] == 1:
        return sp.Matrix([[trace.let("inverse_00", 1 / A[0, 0])]])
    determinant = trace.let("determinant", A[0, 0] * A[1, 1] - A[0, 1] * A[1, 0])
    scaled = sp.Matrix([[A[1, 1], -A[0, 1]], [-A[1, 0], A[0, 0]]]) / determinant
    return trace.symmetric("inverse", scaled) if A == A.T else trace.let("inverse", scaled)


def substitute_step(forces: SceneForces) -> Step:
    """Outwards: dq of one segment from the change of its near disk's pose."""
    trace = Trace()
    reach = reach_of(forces)
    dofs = len(forces.segment.coordinates)
    near, ends = _shifts("shift"), {}
    known = near
    if forces.span is not None:
        before = _shifts("span_shift")
        at_start = trace.let("from_shift", from_start(near, before))
        ends = {str(name): (0.0, value) for name, value in zip(before, at_start, strict=True)}
        known = near.col_join(at_start)
    gain = sp.Matrix(dofs, len(known), lambda r, c: symbol(f"gain_{r}{c}"))
    change = trace.let("change", sp.Matrix([symbol(f"descent_{a}") for a in range(dofs)]) - gain * known)
    far = reach.transition * near + reach.partials * change
    return Step(
        "substitute_step",
        "Outwards: the segment's part of the solution.",
        ("chain", "descent", "change"),
        trace,
        carried={str(name): (0.0, value) for name, value in zip(near, far, strict=True)} | ends,
        stores={"change": list(change)},
    )


def _shifts(name: str) -> sp.Matrix:
    return sp.Matrix([symbol(f"{name}_{part}") for part in ("x", "y", "theta")])


def displacement_step(forces: SceneForces) -> Step:
    """Outwards: how far each disk moves under a small change of coordinates."""
    trace = Trace()
    reach = reach_of(forces)
    near = _shifts("shift")
    change = sp.Matrix([symbol(f"change_{a}") for a in range(len(forces.segment.coordinates))])
    far = trace.let("far_shift", reach.transition * near + reach.partials * change)
    return Step(
        "displacement_step",
        "Outwards: largest squared displacement of a disk under a small change of coordinates.",
        ("chain", "change"),
        trace,
        results={"largest": (0.0, sp.Max(symbol("largest"), far[0] ** 2 + far[1] ** 2))},
        carried={str(name): (0.0, value) for name, value in zip(near, far, strict=True)},
    )
