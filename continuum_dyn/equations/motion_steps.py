"""Steps of the passes that only motion needs: velocities, accelerations, and their derivatives.

With v0, omega0, a0, alpha0 of the near disk, d the segment's reach and u, w its rates and
accelerations (the time derivatives of Rone 2012, Eq. 10):

    v = v0 + omega0 z x R d + R d_q u
    a = a0 + alpha0 z x R d - omega0^2 R d + 2 omega0 z x R d_q u + R (d_q w + u' d_qq u)
"""

from functools import cache
from typing import Any

import sympy as sp

from statics.derivation.cable_tension import drive_power, name_tensions, stored_in_cables
from statics.derivation.frames import ACCELERATION, AXES, TWIST, components, perpendicular, split
from statics.derivation.reach import Reach, core_reaches, reach_of
from statics.derivation.step import OUTWARD, Carried, Step, carry_from_zero
from statics.derivation.steps import cable_steps
from statics.derivation.steps.forces_by_name import Known, account_total, name_forces
from statics.derivation.steps.outward import (
    at_span_start,
    carry_from_base,
    name_core_positions,
    name_far_pose,
    name_rotation,
    name_span_ends,
    sum_along,
)
from statics.derivation.steps.residual import residual_step
from statics.derivation.trace import Trace, symbol, symbol_column
from statics.derivation.virtual_work import SceneForces

ENERGIES = ("kinetic_energy", "elastic_energy", "gravity_energy")
POWERS = ("input_power", "dissipated_power")


def _name_end_velocity(trace: Trace, forces: SceneForces, reach: Reach) -> sp.Matrix:
    """Name the velocity of a reach's end, shape (2, 1), m/s."""
    near, omega = split(components("near", TWIST))
    relative = reach.position_partials * sp.Matrix(forces.segment.rates)
    relative = trace.name(f"{reach.prefix}relative_velocity", relative)
    velocity = sp.Matrix(near) + omega * perpendicular(reach.whole) + relative
    return trace.name(f"{reach.prefix}far_velocity", velocity)


def _name_far_velocity(trace: Trace, forces: SceneForces, reach: Reach) -> tuple[Carried, Known]:
    """Name the velocity of the far disk."""
    _, omega = split(components("near", TWIST))
    linear = _name_end_velocity(trace, forces, reach)
    far = [*linear, trace.name("far_angular_velocity", omega + forces.segment.bend_angle_rate)]
    return carry_from_base(forces, TWIST, far), dict(zip(forces.disk.rates, far, strict=True))


def _name_end_acceleration(trace: Trace, forces: SceneForces, reach: Reach) -> sp.Matrix:
    """Name the acceleration of a reach's end, shape (2, 1), m/s^2."""
    (near, alpha), (_, omega) = split(components("near", ACCELERATION)), split(components("near", TWIST))
    u, w = forces.segment.rates, sp.Matrix(forces.segment.accelerations)
    relative = symbol_column(f"{reach.prefix}relative_velocity", len(AXES))
    acceleration = sp.Matrix(near) + alpha * perpendicular(reach.whole) - omega**2 * reach.whole
    acceleration += 2 * omega * perpendicular(relative) + reach.position_partials * w
    for row, u_a in zip(reach.by_qq, u, strict=True):
        for second, u_b in zip(row, u, strict=True):
            acceleration += second * u_a * u_b
    return trace.name(f"{reach.prefix}far_acceleration", acceleration)


def _name_far_acceleration(trace: Trace, forces: SceneForces, reach: Reach) -> tuple[Carried, Known]:
    """Name the acceleration of the far disk."""
    _, alpha = split(components("near", ACCELERATION))
    linear = _name_end_acceleration(trace, forces, reach)
    far = [*linear, trace.name("far_angular_acceleration", alpha + forces.segment.accelerations[0])]
    return carry_from_base(forces, ACCELERATION, far), dict(zip(forces.disk.accelerations, far, strict=True))


def _name_start_velocity(trace: Trace, forces: SceneForces) -> tuple[Carried, Known]:
    """Name the velocity of the span's start."""
    carried: Carried = {}
    known: Known = {}
    for name in TWIST if forces.span is not None else ():
        rate = symbol(f"span_{name}")
        known[rate] = trace.name(f"from_{name}", at_span_start(symbol(f"near_{name}"), rate))
        carried[rate.name] = (0.0, known[rate])
    return carried, known


def name_motion(trace: Trace, forces: SceneForces) -> tuple[Reach, Carried, Known]:
    """Name poses and velocities of the far disk, of the core's points and of the span's start.

    Returns the segment's reach, what is carried on, and what the symbols of the forces stand for.
    """
    reach = reach_of(forces, trace)
    rotation = name_rotation(trace, forces)
    pose, at_disk = name_far_pose(trace, forces, reach)
    motion, moving = _name_far_velocity(trace, forces, reach)
    ends, known = name_span_ends(trace, forces, rotation, at_disk)
    ends_motion, at_start = _name_start_velocity(trace, forces)
    reaches = core_reaches(forces, trace)
    known = known | moving | at_start | name_core_positions(trace, reaches)
    for point, to_point in reaches:
        velocity = _name_end_velocity(trace, forces, to_point)
        known |= dict(zip(point.rates, velocity, strict=True))
    return reach, rotation | pose | motion | ends | ends_motion, known


def integrand(forces: SceneForces, account: str, known: Known) -> Any:
    """Power (W) that a motion integrates for an account; a moving base's is a part, see ``transport``."""
    of_base = account_total(forces, "powers", "transport_power", known) if account == "input_power" else 0
    return account_total(forces, "powers", account, known) + of_base


@cache
def motion_step(forces: SceneForces) -> Step:
    """Outward pass: geometry, velocities, accelerations, and all loads, inertia included."""
    trace = Trace()
    reach, carried, known = name_motion(trace, forces)
    acceleration, accelerating = _name_far_acceleration(trace, forces, reach)
    known |= accelerating
    for point, to_point in core_reaches(forces):
        of_point = _name_end_acceleration(trace, forces, to_point)
        known |= dict(zip(point.accelerations, of_point, strict=True))
    tensions = name_tensions(trace, forces.coupled, known, moves=True)
    name_forces(trace, forces, known)
    powers = {name: integrand(forces, name, known) for name in POWERS}
    return Step(
        "motion",
        "Outwards: reach, velocity, acceleration, loads; power in and power dissipated.",
        OUTWARD,
        ("q", "u", "w", "inputs", "segments", "disks", "chain"),
        trace,
        results=sum_along(trace, powers, {"input_power": drive_power(forces.coupled)}),
        carried=carried | acceleration | tensions,
    )


def _name_carried_motion(trace: Trace, forces: SceneForces) -> tuple[Carried, Known]:
    _, carried, known = name_motion(trace, forces)
    return carried, known


def measuring_steps(forces: SceneForces) -> list[Step]:
    """Steps that measure coupled cables in motion; none without them."""
    if not forces.coupled:
        return []
    lengths = cable_steps.lengths_step(forces, _name_carried_motion, moves=True)
    return [lengths, cable_steps.beyond_step(forces, moves=True)]


def measuring_tangents(forces: SceneForces) -> list[Step]:
    """Derivatives of the measuring steps along a change of coordinates and rates; none without them."""
    if not forces.coupled:
        return []
    lengths = cable_steps.lengths_tangent_step(forces, _name_carried_motion)
    return [lengths, cable_steps.beyond_tangent_step(forces)]


@cache
def motion_tangent_step(forces: SceneForces) -> Step:
    """Outward pass: derivative of ``motion_step`` along a change of coordinates and rates."""
    step = motion_step(forces)
    moving = [*forces.segment.coordinates, *forces.segment.rates, *map(symbol, step.carried)]
    for cable in forces.coupled:
        moving += [symbol(f"length_beyond_{cable.number}"), symbol(f"length_beyond_rate_{cable.number}")]
    trace, change = step.trace.tangent({s: symbol(f"{s}_change") for s in moving})
    changes = {
        f"{name}_change": (trace.change_of(start, change), trace.change_of(value, change))
        for name, (start, value) in step.carried.items()
    }
    sums = {
        f"{name}_change": (
            trace.change_of(start, change),
            symbol(f"{name}_change") + trace.change_of(value - symbol(name), change),
        )
        for name, (start, value) in step.results.items()
    }
    return Step(
        "motion_tangent",
        "Derivative of motion_step along q_change, u_change.",
        step.direction,
        (*step.arrays, "q_change", "u_change"),
        trace,
        results=sums,
        carried=step.carried | changes,
    )


def residual_tangent_step(forces: SceneForces) -> Step:
    """Inward pass: derivative of ``residual_step`` along what ``motion_tangent_step`` left."""
    step = residual_step(forces)
    inwards, residual = step.results | step.carried, step.stores["residual"]
    named = {s for symbols, _ in motion_tangent_step(forces).trace.lines for s in symbols}
    values = [value for _, value in (*step.trace.lines, *inwards.values())] + residual
    used = set().union(*(sp.sympify(value).free_symbols for value in values))
    direction = {s: symbol(f"{s}_change") for s in used if symbol(f"{s}_change") in named}
    direction |= {symbol(name): symbol(f"{name}_change") for name in inwards}
    trace, change = step.trace.tangent(direction)
    changes = [trace.change_of(value, change) for _, value in inwards.values()]
    return Step(
        "residual_tangent",
        "Derivative of residual_step along what motion_tangent_step left.",
        step.direction,
        ("disks", "chain", "residual_change"),
        trace,
        carried=inwards | carry_from_zero([f"{name}_change" for name in inwards], changes),
        stores={"residual_change": [trace.change_of(value, change) for value in residual]},
    )


def observe_motion_step(forces: SceneForces) -> Step:
    """Outward pass: poses and velocities of the disks, energies (J) and powers (W)."""
    trace = Trace()
    _, carried, known = name_motion(trace, forces)
    tensions = name_tensions(trace, forces.coupled, known, moves=True)
    transport = ("transport_energy",) if "transport_energy" in forces.on_disk.energies else ()
    totals = {
        name: account_total(forces, kind, name, known)
        for kind, names in (("energies", ENERGIES), ("powers", POWERS), ("energies", transport))
        for name in names
    }
    of_drives = {
        "elastic_energy": stored_in_cables(forces.coupled),
        "input_power": drive_power(forces.coupled),
    }
    return Step(
        "observe",
        "Outwards: poses and velocities of the disks, energies and powers.",
        OUTWARD,
        ("q", "u", "inputs", "segments", "disks", "chain", "pose", "velocity"),
        trace,
        results=sum_along(trace, totals, of_drives),
        carried=carried | tensions,
        stores={
            "pose": [known[coordinate] for coordinate in forces.disk.coordinates],
            "velocity": [known[rate] for rate in forces.disk.rates],
        },
    )
