"""Outward pass over one segment: the far disk's pose from the near disk's (Rone 2012, Eq. 10), and loads.

With R the rotation of the segment's near disk and d(q) its far end in the axes of that disk,

    p = p0 + R d,   dp = X dp0 + S dq,   S = [R d_q; phi_q],   X: dp0 plus dtheta0 z x R d

If a span from disk to disk has several segments, a cable connects the poses of the span's two ends. A point
of the core with mass has its own reach from the near disk, and nothing beyond depends on it.

Functions here name the geometry in a trace. ``carried`` maps a name to its value before the first segment
and after this one; ``known`` maps the symbols in which forces are written to their names in the chain.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import sympy as sp

from statics.derivation.cable_tension import drive_potential, name_tensions, stored_in_cables
from statics.derivation.frames import NEAR_ROTATION, POSE, components, rotate, split
from statics.derivation.reach import Reach, core_reaches, reach_of
from statics.derivation.segment import CableSymbols, CorePointSymbols
from statics.derivation.step import OUTWARD, Carried, Step, carry_from_zero
from statics.derivation.steps.forces_by_name import Known, account_total, name_forces, rewrite
from statics.derivation.steps.sizes import name_sizes
from statics.derivation.trace import Trace, symbol, symbol_column
from statics.derivation.virtual_work import SceneForces


def at_base(forces: SceneForces, name: str) -> Any:
    """A coordinate, velocity or acceleration of the base: the input of that name if there is one, or zero."""
    return symbol(name) if name in forces.inputs else 0.0


def carry_from_base(forces: SceneForces, names: Sequence[str], far: Sequence[Any]) -> Carried:
    """Carry components of the far disk's motion on as the next near disk's, beginning with the base's."""
    return {
        f"near_{name}": (at_base(forces, f"base_{name}"), value)
        for name, value in zip(names, far, strict=True)
    }


def name_rotation(trace: Trace, forces: SceneForces) -> Carried:
    """Name cosine and sine of the far disk's angle, by angle addition, kept on the unit circle."""
    theta = at_base(forces, "base_theta")
    d, half = forces.segment.displacement, forces.segment.half_angle
    along, across = trace.name("half_chord", (d / forces.segment.length).applyfunc(sp.cancel))
    turn_cosine = trace.name("turn_cosine", 1 - 2 * half * across)
    turn_sine = trace.name("turn_sine", 2 * half * along)
    cosine, sine = rotate(NEAR_ROTATION, (turn_cosine, turn_sine))
    cosine, sine = trace.name("far_cosine", cosine), trace.name("far_sine", sine)
    onto_circle = trace.name("onto_circle", (3 - cosine**2 - sine**2) / 2)
    return {
        "cosine": (sp.cos(theta) if theta else 1.0, trace.name("next_cosine", cosine * onto_circle)),
        "sine": (sp.sin(theta) if theta else 0.0, trace.name("next_sine", sine * onto_circle)),
    }


def name_far_pose(trace: Trace, forces: SceneForces, reach: Reach) -> tuple[Carried, Known]:
    """Name the far disk's pose. Forces that depend on its angle need ``name_rotation`` as well."""
    (x, y), theta = split(components("near", POSE))
    reach_x, reach_y = reach.whole
    values = (x + reach_x, y + reach_y, theta + forces.segment.bend_angle)
    far = [trace.name(f"far_{name}", value) for name, value in zip(POSE, values, strict=True)]
    known: Known = dict(zip(forces.disk.coordinates, far, strict=True))
    angle = forces.disk.angle
    known |= {sp.cos(angle): symbol("next_cosine"), sp.sin(angle): symbol("next_sine")}
    return carry_from_base(forces, POSE, far), known


def name_core_positions(trace: Trace, reaches: list[tuple[CorePointSymbols, Reach]]) -> Known:
    """Name the positions of the core's points."""
    near, _ = split(components("near", POSE))
    known = {}
    for point, reach in reaches:
        position = trace.name(f"{reach.prefix}position", sp.Matrix(near) + reach.whole)
        known |= dict(zip(point.position, position, strict=True))
    return known


def at_span_start(near: Any, before: Any) -> Any:
    """Value at the start of the segment's span: the near node's if the segment is its first."""
    start = symbol("starts_span")
    return start * near + (1 - start) * before


def name_span_ends(
    trace: Trace, forces: SceneForces, rotation: Mapping[str, Any], known: Known
) -> tuple[Carried, Known]:
    """Name the pose of the span's start and its cables' lengths; returns ``known`` with them."""
    carried: Carried = {}
    if forces.span is None:
        return carried, known | _name_cable_lengths(trace, forces.segment.cables, {})
    known = dict(known)
    trace.always_name("starts_span", symbol("span_start"))
    for name, start in (*((name, 0.0) for name in POSE), ("cosine", 1.0), ("sine", 0.0)):
        near = symbol(name if name in rotation else f"near_{name}")
        value = trace.name(f"from_{name}", at_span_start(near, symbol(f"span_{name}")))
        carried[f"span_{name}"] = (start, value)
        known[symbol(f"span_{name}")] = value
    theta = symbol("span_theta")
    known |= {sp.cos(theta): carried["span_cosine"][1], sp.sin(theta): carried["span_sine"][1]}
    return carried, known | _name_cable_lengths(trace, forces.span.cables, known)


def _name_cable_lengths(trace: Trace, cables: list[CableSymbols], known: Known) -> Known:
    """Name cable lengths that are square roots; their powers, as forces contain them, are then known."""
    powers: Known = {}
    for number, cable in enumerate(cables, start=1):
        if cable.length.is_Pow and cable.length == sp.sqrt(squared := cable.length**2):
            value = trace.name(f"squared_{number}", squared.xreplace(known))
            length = trace.name(f"cable_length_{number}", sp.sqrt(value))
            powers |= {squared ** sp.Rational(power, 2): length**power for power in (1, -1, -3)}
    return powers


def name_poses(trace: Trace, forces: SceneForces, reach: Reach | None = None) -> tuple[Carried, Known]:
    """Name the poses of the far disk and of the span's start, and the reach unless it is given."""
    rotation = name_rotation(trace, forces)
    pose, known = name_far_pose(trace, forces, reach or reach_of(forces, trace))
    ends, known = name_span_ends(trace, forces, rotation, known)
    return rotation | pose | ends, known


def _name_poses_and_core(trace: Trace, forces: SceneForces) -> tuple[Carried, Known]:
    """Name the poses of the far disk and of the span's start, and the positions of the core's points."""
    carried, known = name_poses(trace, forces, reach_of(forces, trace))
    return carried, known | name_core_positions(trace, core_reaches(forces, trace))


def _clearance(trace: Trace, forces: SceneForces, known: Known) -> tuple[float, Any]:
    """Smallest so far of length and hole-to-hole lengths over L0; cables that do not pass are left out."""
    span, rest = forces.span or forces.segment, symbol("rest_length")
    spacing = rest if forces.span is None else symbol("disk_spacing")
    ratios = [
        sp.Max(rewrite(cable.gap, known) / spacing, 1 - symbol(f"cable_passes_{number}"), evaluate=False)
        for number, cable in enumerate(span.cables, start=1)
    ]
    if forces.segment.elongation != 0:
        ratios.append(forces.segment.length / rest)
    names = [trace.name(f"ratio_{k}", ratio) for k, ratio in enumerate(ratios)]
    return 1.0, sp.Min(symbol("clearance"), *names, evaluate=False)


def clearance_step(forces: SceneForces) -> Step:
    """Outward pass: the clearance from a geometric limit, for any pose of the base."""
    trace, forces = Trace(), replace(forces, inputs=())
    carried, known = name_poses(trace, forces)
    return Step(
        "clearance",
        "Smallest length or hole-to-hole length over L0.",
        OUTWARD,
        ("q", "segments"),
        trace,
        results={"clearance": _clearance(trace, forces, known)},
        carried=carried,
    )


def pose_step(forces: SceneForces) -> Step:
    """Outward pass at rest: geometry, loads, and the potential energy if there is one."""
    trace = Trace()
    carried, known = _name_poses_and_core(trace, forces)
    tensions = name_tensions(trace, forces.coupled, known, moves=False)
    name_forces(trace, forces, known)
    drives = name_sizes(trace, forces, known)
    energies = _potential(trace, forces, known) if forces.conservative else {}
    return Step(
        "pose",
        "Outwards, at rest: reach, loads, potential energy if there is one, clearance.",
        OUTWARD,
        ("q", "inputs", "segments", "disks", "chain"),
        trace,
        results=energies | {"clearance": _clearance(trace, forces, known)},
        carried=carried | tensions | drives,
    )


def _potential(trace: Trace, forces: SceneForces, known: Known) -> Carried:
    """Potential energy (J) so far, and the sum of the absolute values of its parts."""
    parts = [(site, rewrite(sp.Add(*part.energies.values()), known)) for site, part in forces.sites.items()]
    energy = trace.name(
        "added_potential", sum(trace.name(f"{site}_potential", value) for site, value in parts)
    )
    drive = drive_potential(forces.coupled)
    return {
        "potential": (drive, symbol("potential") + energy),
        "potential_scale": (sp.Abs(drive), symbol("potential_scale") + sp.Abs(energy)),
    }


def sum_along(trace: Trace, totals: Mapping[str, Any], of_drives: Mapping[str, Any]) -> Carried:
    """Results of a pass that sums each account along the arm, starting with the cables' drives."""
    return {
        name: (of_drives.get(name, 0.0), symbol(name) + trace.name(f"added_{name}", value))
        for name, value in totals.items()
    }


def observe_step(forces: SceneForces) -> Step:
    """Outward pass at rest: poses of the nodes, elastic and gravity energy."""
    trace = Trace()
    carried, known = _name_poses_and_core(trace, forces)
    energies = {
        name: account_total(forces, "energies", name, known) for name in ("elastic_energy", "gravity_energy")
    }
    of_drives = {"elastic_energy": stored_in_cables(forces.coupled)}
    return Step(
        "observe",
        "Outwards, at rest: poses of the disks, elastic and gravity energy.",
        OUTWARD,
        ("q", "inputs", "segments", "disks", "chain", "pose"),
        trace,
        results=sum_along(trace, energies, of_drives),
        carried=carried,
        stores={"pose": [known[coordinate] for coordinate in forces.disk.coordinates]},
    )


def displacement_step(forces: SceneForces) -> Step:
    """Outward pass: largest squared displacement (m^2) of a disk under a small change of coordinates."""
    trace = Trace()
    reach, near = reach_of(forces), components("shift", POSE)
    change = symbol_column("change", len(forces.segment.coordinates))
    far = trace.name("far_shift", reach.transition * near + reach.partials * change)
    (far_x, far_y), _ = split(far)
    return Step(
        "displacement",
        "Outwards: largest squared displacement of a disk under a small change of coordinates.",
        OUTWARD,
        ("chain", "change"),
        trace,
        results={"largest": (0.0, sp.Max(symbol("largest"), far_x**2 + far_y**2))},
        carried=carry_from_zero(near, far),
    )
