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

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import sympy as sp

from statics.derivation.cable_tension import along_cables, drive_potential, stored_in_cables
from statics.derivation.reach import Reach, core_reaches, reach_of, turned
from statics.derivation.segment import CableSymbols, CorePointSymbols, symbol
from statics.derivation.step import INWARD, OUTWARD, Step
from statics.derivation.trace import Trace
from statics.derivation.virtual_work import SceneForces


def at_base(forces: SceneForces, name: str) -> Any:
    """A coordinate, velocity or acceleration of the base: the input of that name if there is one, or zero."""
    return symbol(name) if name in forces.inputs else 0.0


def turn_frame(trace: Trace, forces: SceneForces) -> dict[str, tuple[Any, Any]]:
    """Cosine and sine of the far disk's angle by angle addition, kept on the unit circle."""
    theta = at_base(forces, "base_theta")
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
        "cosine": (sp.cos(theta) if theta else 1.0, trace.let("next_cosine", far_cos * onto_circle)),
        "sine": (sp.sin(theta) if theta else 0.0, trace.let("next_sine", far_sin * onto_circle)),
    }


def far_pose(trace: Trace, forces: SceneForces, reach: Reach) -> tuple[dict[str, Any], dict[sp.Symbol, Any]]:
    """Pose of the far disk: what is carried on, and what the disk's symbols stand for.

    The trace must have ``turn_frame`` in it where the disk's forces ask for cosine and sine of its angle.
    """
    x, y, theta = (symbol(f"near_{name}") for name in ("x", "y", "theta"))
    far_x = trace.let("far_x", x + reach.whole[0])
    far_y = trace.let("far_y", y + reach.whole[1])
    far_theta = trace.let("far_theta", theta + forces.segment.bend_angle)
    carried = {
        f"near_{name}": (at_base(forces, f"base_{name}"), far)
        for name, far in (("x", far_x), ("y", far_y), ("theta", far_theta))
    }
    at_disk: dict[Any, Any] = dict(zip(forces.disk.coordinates, (far_x, far_y, far_theta), strict=True))
    turns = {sp.cos(forces.disk.angle): "next_cosine", sp.sin(forces.disk.angle): "next_sine"}
    return carried, at_disk | {turn: symbol(name) for turn, name in turns.items()}


def core_positions(trace: Trace, reaches: list[tuple[CorePointSymbols, Reach]]) -> dict[sp.Symbol, Any]:
    """Values of the positions of the core's points."""
    near, at = sp.Matrix([symbol("near_x"), symbol("near_y")]), {}
    for point, reach in reaches:
        position = trace.let(f"{reach.prefix}position", near + reach.whole)
        at |= dict(zip(point.position, position, strict=True))
    return at


def from_start(near: Any, before: Any) -> Any:
    """Value at the start of the segment's span: the near node's if the segment is its first."""
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
    """Outward: the clearance from a geometric limit, wherever the base is."""
    trace, forces = Trace(), replace(forces, inputs=())
    frame = turn_frame(trace, forces)
    pose, at_disk = far_pose(trace, forces, reach_of(forces, trace))
    ends, at = span_ends(trace, forces, frame, at_disk)
    return Step(
        "clearance",
        "Smallest length or hole-to-hole length over L0.",
        OUTWARD,
        ("q", "segments"),
        trace,
        results={"clearance": (1.0, _smallest(trace, forces, at))},
        carried=frame | pose | ends,
    )


def pose_step(forces: SceneForces) -> Step:
    """Outwards, at rest: geometry, loads, and the potential energy if there is one."""
    trace = Trace()
    reach = reach_of(forces, trace)
    carried = turn_frame(trace, forces)
    pose, at_disk = far_pose(trace, forces, reach)
    ends, at = span_ends(trace, forces, carried, at_disk)
    at |= core_positions(trace, core_reaches(forces, trace))
    cables = along_cables(trace, forces.coupled, at, moves=False)
    name_forces(trace, forces, at)
    energies = _potential(trace, forces, at) if forces.conservative else {}
    return Step(
        "pose",
        "Outwards, at rest: reach, loads, potential energy if there is one, clearance.",
        OUTWARD,
        ("q", "inputs", "segments", "disks", "chain"),
        trace,
        results=energies | {"clearance": (1.0, _smallest(trace, forces, at))},
        carried=carried | pose | ends | cables,
    )


def _potential(trace: Trace, forces: SceneForces, at: dict[Any, Any]) -> dict[str, tuple[float, Any]]:
    """Potential energy so far, and the sum of its parts' sizes."""
    parts = forces.places.items()
    energies = [(name, placed(sp.Add(*part.energies.values()), at)) for name, part in parts]
    energy = trace.let(
        "added_potential", sum(trace.let(f"{name}_potential", value) for name, value in energies)
    )
    drive = drive_potential(forces.coupled)
    return {
        "potential": (drive, symbol("potential") + energy),
        "potential_scale": (sp.Abs(drive), symbol("potential_scale") + sp.Abs(energy)),
    }


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
    for cable in forces.coupled:
        trace.let(f"cable_pull_{cable.number}", placed(_pull(forces, cable), at))


def _pull(forces: SceneForces, cable: CableSymbols) -> sp.Matrix:
    """Derivative of a cable's length, where it passes, by the coordinates of what it joins."""
    coordinates = (forces.span or forces.segment).coordinates
    return sp.Matrix([cable.passes * cable.length.diff(q) for q in coordinates])


def _let_matrix(trace: Trace, symmetric: bool, name: str, value: sp.Matrix) -> sp.Matrix:
    """Name the entries of a matrix, or those of the upper triangle of a symmetric one."""
    if symmetric:
        return trace.symmetric(name, value)
    return sp.Matrix(*value.shape, lambda r, c: trace.let(f"{name}_{r}{c}", value[r, c]))


def _named(name: str, value: sp.Matrix) -> sp.Matrix:
    """The names that ``Trace.let`` gave to a column in an earlier step; numbers and symbols as they are."""
    return sp.Matrix(*value.shape, lambda r, c: value[r, c] if value[r, c].is_Atom else symbol(f"{name}_{r}"))


def _named_matrix(symmetric: bool, name: str, value: sp.Matrix) -> sp.Matrix:
    """The names that ``_let_matrix`` gave in an earlier step; numbers and symbols as they are."""
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
    """Outwards, at rest: poses of the nodes, energies of what is elastic and of the weight."""
    trace = Trace()
    reach = reach_of(forces, trace)
    frame = turn_frame(trace, forces)
    pose, at_disk = far_pose(trace, forces, reach)
    ends, at = span_ends(trace, forces, frame, at_disk)
    at |= core_positions(trace, core_reaches(forces, trace))
    energies = {name: booked(forces, "energies", name, at) for name in ("elastic_energy", "gravity_energy")}
    at_start = {"elastic_energy": stored_in_cables(forces.coupled)}
    return Step(
        "observe",
        "Outwards, at rest: poses of the disks, elastic and gravity energy.",
        OUTWARD,
        ("q", "inputs", "segments", "disks", "chain", "pose"),
        trace,
        results={
            name: (at_start.get(name, 0.0), symbol(name) + trace.let(f"added_{name}", value))
            for name, value in energies.items()
        },
        carried=frame | pose | ends,
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
        "residual",
        "Inwards: reaction on the segment's far disk and the segment's residual.",
        INWARD,
        ("disks", "chain", "residual"),
        trace,
        results={name: (0.0, carried.pop(name)) for name in names},
        carried={name: (0.0, value) for name, value in carried.items()},
        stores={"residual": list(residual)},
    )


@dataclass(frozen=True)
class Weights:
    """A Newton matrix: mass M + damping C + stiffness K, each times its weight.

    A weight may be a number, or a symbol whose value the sweep is handed. ``definite`` says that the
    matrix is taken as positive, so that its pivots need no care; not ``coupled``, that the tensions of cables
    are held as they are.
    """

    mass: Any
    damping: Any
    stiffness: Any
    definite: bool = True
    coupled: bool = True

    @property
    def given(self) -> list[sp.Symbol]:
        """The weights that are symbols."""
        return [w for w in (self.mass, self.damping, self.stiffness) if isinstance(w, sp.Symbol)]


STATIC = Weights(0, 0, 1, definite=False)
HELD = Weights(0, 0, 1, definite=False, coupled=False)
ACCELERATION = Weights(1, 0, 0)
IMPLICIT = Weights(1, symbol("damping_weight"), symbol("stiffness_weight"))


def eliminate_step(forces: SceneForces, weights: Weights) -> Step:
    """Inwards: eliminate one segment's coordinates from the chain's Newton system H dq = -residual.

    With A, C, B, D its blocks, by rows the segment's and the near disk's: V' = D - B A^-1 C. Where the system
    is symmetric B is the transpose of C. Beside poses the near disk hands on the tensions of coupled cables,
    whose rows of V are the lengths beyond it.
    """
    trace = Trace()
    reach = reach_of(forces)
    symmetric = forces.conservative or not weights.coupled or weights.damping == weights.stiffness == 0
    dofs = len(forces.segment.coordinates)
    coupled = coupled_by(forces, weights)
    S, X, here = reach.partials, reach.transition, _weighted(weights, symmetric, forces, "disk")
    if forces.on_span is not None:
        S, X, here = S.col_join(sp.zeros(3, dofs)), sp.diag(X, sp.eye(3)), sp.diag(here, sp.zeros(3))
        here += _weighted(weights, symmetric, forces, "span")
    size = S.shape[0]
    S, X = S.col_join(sp.zeros(len(coupled), dofs)), sp.diag(X, sp.eye(len(coupled)))
    here = sp.diag(here, sp.zeros(len(coupled)))
    states = range(S.shape[0])
    pulls = sp.zeros(dofs, len(states))
    for state, cable in enumerate(coupled, start=size):
        pull = _named(f"cable_pull_{cable.number}", _pull(forces, cable))
        if forces.span is None:
            pulls[:, state] = pull
        else:
            here[:size, state], here[state, :size] = pull, pull.T
    carried = sp.Matrix(*X.shape, lambda r, c: symbol(f"carried_{r}{c}"))
    if symmetric:
        carried = _mirrored(carried)
    load = sp.Matrix([symbol(f"carried_load_{r}") for r in states])
    V = _let_matrix(trace, symmetric, "V", carried + here)
    VS, VX = trace.let("VS", V * S), trace.let("VX", V * X)
    A = S.T * VS + _weighted(weights, symmetric, forces, "segment")
    blocks = _Blocks(A, X.T * VS + pulls.T, S.T * VX + pulls, X.T * VX)
    _add_turning(trace, blocks, weights, sp.Matrix([symbol("reaction_0"), symbol("reaction_1")]), reach)
    for (point, of_core), force in zip(core_reaches(forces), _core_forces(forces), strict=True):
        _add_hanging(trace, blocks, _weighted(weights, symmetric, forces, point.name), of_core)
        _add_turning(trace, blocks, weights, -force, of_core)
    given = tuple(map(str, weights.given))
    if not (symmetric or weights.definite):
        blocks.A[:, :] += _slowing(dofs)
        given = ("slowing",)
    A, B, C, D = blocks
    A = _let_matrix(trace, symmetric, "A", A)
    B = trace.let("B", B)
    C = B.T if symmetric else trace.let("C", C)
    b = trace.let("b", S.T * load - sp.Matrix([symbol(f"residual_{a}") for a in range(dofs)]))
    inverse, counted = _pivot_inverse(trace, symmetric, A, weights)
    gain = trace.let("gain", inverse * C)
    descent = trace.let("descent", inverse * b)
    next_load = X.T * load - B * descent
    next_V = D - B * gain
    if forces.on_span is not None:
        next_V, next_load = _merged(
            _let_matrix(trace, symmetric, "next_V", next_V), trace.let("next_load", next_load)
        )
    inside = _slopes_inside(trace, forces, coupled)
    for state, cable in enumerate(coupled, start=size):
        next_V, next_load = _through_hole(
            trace,
            cable,
            state,
            _let_matrix(trace, symmetric, f"onto_{state}", next_V),
            trace.let(f"onto_load_{state}", next_load),
            weights,
            forces,
        )
        if "negative_pivots" in counted:
            start, count = counted["negative_pivots"]
            counted["negative_pivots"] = start, count - sp.Heaviside(-symbol(f"hole_pivot_{cable.number}"))
    entries = [(r, c) for r in states for c in states if c >= r or not symmetric]
    return Step(
        "eliminate",
        "Inwards: one segment's coordinates eliminated; the rest goes to its near disk.",
        INWARD,
        ("segments", "disks", "chain", "residual", "descent", "pivots"),
        trace,
        results={name: counted.pop(name) for name in ("negative_pivots",) if name in counted},
        carried={f"carried_{r}{c}": (0.0, next_V[r, c]) for r, c in entries}
        | {f"carried_load_{r}": (0.0, next_load[r]) for r in states}
        | counted
        | inside,
        given=given + (("keep_sign",) if counted else ()),
        stores={"descent": list(descent)}
        | ({"pivots": [A[r, c] for r in range(dofs) for c in range(r, dofs)]} if counted else {}),
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


def coupled_by(forces: SceneForces, weights: Weights) -> list[CableSymbols]:
    """The cables that couple all segments in such a matrix: none in that of the masses."""
    in_play = weights.coupled and (weights.damping != 0 or weights.stiffness != 0)
    return forces.coupled if in_play else []


def _slopes_of(cable: CableSymbols) -> list[str]:
    """Names of the derivatives that a cable's tension has at a hole."""
    names = ["place_slope", "hole_factor", "rate_slope"] if cable.kind.rubs else ["place_slope"]
    return [f"{name}_{cable.number}" for name in names]


def _slopes_inside(trace: Trace, forces: SceneForces, coupled: list[CableSymbols]) -> dict[str, Any]:
    """Carry the slopes from a span's end, where they are known, to its start, where the hole is."""
    inside: dict[str, Any] = {}
    for cable in coupled if forces.span is not None else []:
        for name in _slopes_of(cable):
            here, before = symbol(name), symbol(f"{name}_inside")
            value = trace.let(f"{name}_there", cable.passes * here + (1 - cable.passes) * before)
            inside[str(before)] = (0.0, value)
    return inside


def _through_hole(
    trace: Trace,
    cable: CableSymbols,
    state: int,
    V: sp.Matrix,
    load: sp.Matrix,
    weights: Weights,
    forces: SceneForces,
) -> tuple[sp.Matrix, sp.Matrix]:
    """V and load on the tension before a hole, from those on the tension T beyond it.

    With l = V_T x - load_T the change of the length beyond, dT = E dT0 + kappa l; E and kappa are the law's
    derivatives. So dT = m (E dT0 + kappa (V_To o - load_T)), with o the other states and
    m = 1 / (1 - kappa V_TT).
    """
    c, spans = cable.number, forces.span is not None
    start = symbol("starts_span") if spans else sp.Integer(1)
    place, *of_friction = (symbol(f"{name}_there" if spans else name) for name in _slopes_of(cable))
    factor, rate = of_friction or (sp.Integer(1), sp.Integer(0))
    kappa = trace.let(f"kappa_{c}", start * (weights.stiffness * place + weights.damping * rate))
    factor = trace.let(f"tension_factor_{c}", start * factor + 1 - start)
    own = V[state, state]
    m = 1 / trace.let(f"hole_pivot_{c}", 1 - kappa * own)
    onto = sp.eye(V.shape[0])
    for k in range(V.shape[0]):
        gain = m * (factor if k == state else kappa * V[state, k])
        onto[state, k] = trace.name(f"hole_gain_{c}_{k}", gain)
    push = trace.name(f"hole_push_{c}", -m * kappa * load[state])
    return V * onto, load - V[:, state] * push


def _slowing(dofs: int) -> sp.Matrix:
    """Damping of a search without a potential: on bend angles it turns as a spring would, N m / rad.

    On elongations it pulls with that over the square of the rest length.
    """
    return symbol("slowing") * sp.diag(1, 1 / symbol("rest_length") ** 2)[:dofs, :dofs]


def _merged(V: sp.Matrix, load: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
    """Matrix and load on (near node, span's start) where, at the span's first segment, the two are one."""
    rest = V.shape[0] - 6
    start, zero = symbol("starts_span"), sp.zeros(3)
    both = sp.diag(sp.eye(3).row_join(sp.eye(3)), sp.eye(rest))
    apart = sp.diag(sp.eye(3).col_join(zero), sp.eye(rest))
    onto = apart * both
    return start * onto * V * onto.T + (1 - start) * V, start * onto * load + (1 - start) * load


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
    sign; otherwise, and where it has no symmetry that would give the counts a meaning, nothing is counted.
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
    }


def _plain_inverse(trace: Trace, A: sp.Matrix) -> sp.Matrix:
    if A.shape[0] == 1:
        return sp.Matrix([[trace.let("inverse_00", 1 / A[0, 0])]])
    determinant = trace.let("determinant", A[0, 0] * A[1, 1] - A[0, 1] * A[1, 0])
    scaled = sp.Matrix([[A[1, 1], -A[0, 1]], [-A[1, 0], A[0, 0]]]) / determinant
    return trace.symmetric("inverse", scaled) if A == A.T else trace.let("inverse", scaled)


def substitute_step(forces: SceneForces, weights: Weights) -> Step:
    """Outwards: dq of one segment from the changes of its near disk's pose and of coupled tensions."""
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
    known, tensions = _beyond_holes(trace, known, coupled_by(forces, weights))
    gain = sp.Matrix(dofs, len(known), lambda r, c: symbol(f"gain_{r}{c}"))
    change = trace.let("change", sp.Matrix([symbol(f"descent_{a}") for a in range(dofs)]) - gain * known)
    far = reach.transition * near + reach.partials * change
    return Step(
        "substitute",
        "Outwards: the segment's part of the solution.",
        OUTWARD,
        ("chain", "descent", "change"),
        trace,
        carried={str(name): (0.0, value) for name, value in zip(near, far, strict=True)} | ends | tensions,
        stores={"change": list(change)},
    )


def _beyond_holes(
    trace: Trace, known: sp.Matrix, coupled: list[CableSymbols]
) -> tuple[sp.Matrix, dict[str, tuple[float, Any]]]:
    """The changes of poses with those of the tensions beyond the near holes, and what is carried on."""
    size = len(known)
    states = [*known, *(symbol(f"shift_tension_{cable.number}") for cable in coupled)]
    carried = {}
    for state, cable in reversed(list(enumerate(coupled, start=size))):
        c = cable.number
        gains = [symbol(f"hole_gain_{c}_{k}") for k in range(len(states))]
        value = sum(gain * change for gain, change in zip(gains, states, strict=True))
        states[state] = trace.let(f"tension_beyond_{c}", value + symbol(f"hole_push_{c}"))
        carried[f"shift_tension_{c}"] = (0.0, states[state])
    return sp.Matrix(states), carried


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
        "displacement",
        "Outwards: largest squared displacement of a disk under a small change of coordinates.",
        OUTWARD,
        ("chain", "change"),
        trace,
        results={"largest": (0.0, sp.Max(symbol("largest"), far[0] ** 2 + far[1] ** 2))},
        carried={str(name): (0.0, value) for name, value in zip(near, far, strict=True)},
    )
