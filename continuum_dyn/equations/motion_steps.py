"""One step of the sweeps that only motion needs: velocities, accelerations, and their derivatives.

With v0, omega0, a0, alpha0 of the near disk, d the segment's reach and u, w its rates and
accelerations (the time derivatives of Rone 2012, Eq. 10):

    v = v0 + omega0 z x R d + R d_q u
    a = a0 + alpha0 z x R d - omega0^2 R d + 2 omega0 z x R d_q u + R (d_q w + u' d_qq u)
"""

from typing import Any

import sympy as sp

from statics.derivation import cable_steps
from statics.derivation.cable_tension import along_cables, drive_power, stored_in_cables
from statics.derivation.reach import Reach, core_reaches, reach_of, turned
from statics.derivation.recursion import (
    at_base,
    booked,
    core_positions,
    far_pose,
    from_start,
    name_forces,
    residual_step,
    span_ends,
    turn_frame,
)
from statics.derivation.segment import symbol
from statics.derivation.step import OUTWARD, Step
from statics.derivation.trace import Trace
from statics.derivation.virtual_work import SceneForces

ENERGIES = ("kinetic_energy", "elastic_energy", "gravity_energy")
POWERS = ("input_power", "dissipated_power")


def _near_velocity() -> tuple[sp.Matrix, sp.Symbol]:
    return sp.Matrix([symbol("near_velocity_x"), symbol("near_velocity_y")]), symbol("near_angular_velocity")


def _end_velocity(trace: Trace, forces: SceneForces, reach: Reach) -> sp.Matrix:
    """Velocity of a reach's end, shape (2, 1)."""
    near, spin = _near_velocity()
    relative = trace.let(f"{reach.prefix}relative_velocity", reach.by_q * sp.Matrix(forces.segment.rates))
    return trace.let(f"{reach.prefix}far_velocity", near + spin * turned(reach.whole) + relative)


def _far_velocity(
    trace: Trace, forces: SceneForces, reach: Reach
) -> tuple[dict[str, Any], dict[sp.Symbol, Any]]:
    """Velocity of the far disk: what is carried on, and what the disk's symbols stand for."""
    near, spin = _near_velocity()
    far = _end_velocity(trace, forces, reach)
    far_spin = trace.let("far_angular_velocity", spin + forces.segment.bend_angle_rate)
    carried = _from_base(forces, [*near, spin], [*far, far_spin])
    return carried, dict(zip(forces.disk.rates, [*far, far_spin], strict=True))


def _from_base(forces: SceneForces, near: list[sp.Symbol], far: list[Any]) -> dict[str, tuple[Any, Any]]:
    """Carried values of a disk's motion; before the first segment they are the base's."""
    return {
        str(name): (at_base(forces, str(name).replace("near", "base")), value)
        for name, value in zip(near, far, strict=True)
    }


def _near_acceleration() -> tuple[sp.Matrix, sp.Symbol]:
    near = sp.Matrix([symbol("near_acceleration_x"), symbol("near_acceleration_y")])
    return near, symbol("near_angular_acceleration")


def _end_acceleration(trace: Trace, forces: SceneForces, reach: Reach) -> sp.Matrix:
    """Acceleration of a reach's end, shape (2, 1)."""
    (near, spin_rate), (_, spin) = _near_acceleration(), _near_velocity()
    u, w = sp.Matrix(forces.segment.rates), sp.Matrix(forces.segment.accelerations)
    relative = sp.Matrix([symbol(f"{reach.prefix}relative_velocity_{axis}") for axis in range(2)])
    curving = sp.zeros(2, 1)
    for a, row in enumerate(reach.by_qq):
        for b, second in enumerate(row):
            curving += second * u[a] * u[b]
    return trace.let(
        f"{reach.prefix}far_acceleration",
        near
        + spin_rate * turned(reach.whole)
        - spin**2 * reach.whole
        + 2 * spin * turned(relative)
        + reach.by_q * w
        + curving,
    )


def _far_acceleration(
    trace: Trace, forces: SceneForces, reach: Reach
) -> tuple[dict[str, Any], dict[sp.Symbol, Any]]:
    near, spin_rate = _near_acceleration()
    far = _end_acceleration(trace, forces, reach)
    far_spin_rate = trace.let("far_angular_acceleration", spin_rate + forces.segment.accelerations[0])
    carried = _from_base(forces, [*near, spin_rate], [*far, far_spin_rate])
    return carried, dict(zip(forces.disk.accelerations, [*far, far_spin_rate], strict=True))


def _span_velocity(trace: Trace, forces: SceneForces) -> tuple[dict[str, Any], dict[sp.Symbol, Any]]:
    """Velocity of the span's start: what is carried on, and what its symbols stand for."""
    carried, at_start = {}, {}
    for rate in [] if forces.span is None else forces.span.rates[3:]:
        name = rate.name.removeprefix("span_")
        at_start[rate] = trace.let(f"from_{name}", from_start(symbol(f"near_{name}"), rate))
        carried[rate.name] = (0.0, at_start[rate])
    return carried, at_start


def disk_in_motion(trace: Trace, forces: SceneForces) -> tuple[Reach, dict[str, Any], dict[Any, Any]]:
    """Poses and velocities of the far disk, of the core's points and of the span's start.

    Returns the segment's reach, what is carried on, and what the symbols of the forces stand for.
    """
    reach = reach_of(forces, trace)
    frame = turn_frame(trace, forces)
    pose, at_disk = far_pose(trace, forces, reach)
    motion, moving = _far_velocity(trace, forces, reach)
    ends, at = span_ends(trace, forces, frame, at_disk)
    ends_motion, at_start = _span_velocity(trace, forces)
    reaches = core_reaches(forces, trace)
    at_core = core_positions(trace, reaches)
    for point, of_core in reaches:
        velocity = _end_velocity(trace, forces, of_core)
        at_core |= dict(zip(point.rates, velocity, strict=True))
    return reach, frame | pose | motion | ends | ends_motion, at | moving | at_start | at_core


def integrated(forces: SceneForces, account: str, at: dict[Any, Any]) -> Any:
    """Integrand of an account of power; of a moving base's it is a part, see ``transport.py``."""
    of_base = booked(forces, "powers", "transport_power", at) if account == "input_power" else 0
    return booked(forces, "powers", account, at) + of_base


def motion_step(forces: SceneForces) -> Step:
    """Outwards: geometry, velocities, accelerations, and all loads, inertia included."""
    trace = Trace()
    reach, carried, at = disk_in_motion(trace, forces)
    push, pushed = _far_acceleration(trace, forces, reach)
    at |= pushed
    for point, of_core in core_reaches(forces):
        at |= dict(zip(point.accelerations, _end_acceleration(trace, forces, of_core), strict=True))
    cables = along_cables(trace, forces.coupled, at, moves=True)
    name_forces(trace, forces, at)
    powers = {name: trace.let(f"added_{name}", integrated(forces, name, at)) for name in POWERS}
    return Step(
        "motion",
        "Outwards: reach, velocity, acceleration, loads; power in and power dissipated.",
        OUTWARD,
        ("q", "u", "w", "inputs", "segments", "disks", "chain"),
        trace,
        results={
            name: (drive_power(forces.coupled) if name == "input_power" else 0.0, symbol(name) + added)
            for name, added in powers.items()
        },
        carried=carried | push | cables,
    )


def _in_motion(trace: Trace, forces: SceneForces) -> tuple[dict[str, Any], dict[Any, Any]]:
    _, carried, at = disk_in_motion(trace, forces)
    return carried, at


def measuring_steps(forces: SceneForces) -> list[Step]:
    """Steps that measure coupled cables in motion; none without them."""
    if not forces.coupled:
        return []
    return [
        cable_steps.lengths_step(forces, _in_motion, moves=True),
        cable_steps.beyond_step(forces, moves=True),
    ]


def measuring_tangents(forces: SceneForces) -> list[Step]:
    """Their derivatives along a change of coordinates and rates."""
    if not forces.coupled:
        return []
    return [cable_steps.lengths_tangent_step(forces, _in_motion), cable_steps.beyond_tangent_step(forces)]


def motion_tangent_step(forces: SceneForces) -> Step:
    """The derivative of ``motion_step`` along a change of coordinates and rates."""
    step = motion_step(forces)
    moving = [*forces.segment.coordinates, *forces.segment.rates, *map(symbol, step.carried)]
    for cable in forces.coupled:
        moving += [symbol(f"length_beyond_{cable.number}"), symbol(f"length_beyond_rate_{cable.number}")]
    trace, change = step.trace.tangent({s: symbol(f"{s}_change") for s in moving})
    changes = {
        f"{name}_change": (trace.change_of(start, change), trace.change_of(value, change))
        for name, (start, value) in step.carried.items()
    }
    return Step(
        "motion_tangent",
        "Derivative of motion_step along q_change, u_change.",
        step.direction,
        (*step.arrays, "q_change", "u_change"),
        trace,
        results={
            f"{name}_change": (
                trace.change_of(start, change),
                symbol(f"{name}_change") + trace.change_of(value - symbol(name), change),
            )
            for name, (start, value) in step.results.items()
        },
        carried=step.carried | changes,
    )


def residual_tangent_step(forces: SceneForces) -> Step:
    """The derivative of ``residual_step`` along what ``motion_tangent_step`` left."""
    step, motion = residual_step(forces), motion_tangent_step(forces)
    inwards = step.results | step.carried
    known = {s for symbols, _ in motion.trace.lines for s in symbols}
    inputs = set().union(*(value.free_symbols for _, value in step.trace.lines)) | set().union(
        *(
            sp.sympify(value).free_symbols
            for value in (*step.stores["residual"], *(v for _, v in inwards.values()))
        )
    )
    direction = {s: symbol(f"{s}_change") for s in inputs if symbol(f"{s}_change") in known}
    direction |= {symbol(name): symbol(f"{name}_change") for name in inwards}
    trace, change = step.trace.tangent(direction)
    return Step(
        "residual_tangent",
        "Derivative of residual_step along what motion_tangent_step left.",
        step.direction,
        ("disks", "chain", "residual_change"),
        trace,
        carried=inwards
        | {f"{name}_change": (0.0, trace.change_of(value, change)) for name, (_, value) in inwards.items()},
        stores={"residual_change": [trace.change_of(value, change) for value in step.stores["residual"]]},
    )


def observe_motion_step(forces: SceneForces) -> Step:
    """Outwards: poses and velocities of the disks, energies and powers."""
    trace = Trace()
    _, carried, at = disk_in_motion(trace, forces)
    cables = along_cables(trace, forces.coupled, at, moves=True)
    transport = ("transport_energy",) if "transport_energy" in forces.on_disk.energies else ()
    accounts = {
        name: booked(forces, kind, name, at)
        for kind, names in (("energies", ENERGIES), ("powers", POWERS), ("energies", transport))
        for name in names
    }
    at_start = {
        "elastic_energy": stored_in_cables(forces.coupled),
        "input_power": drive_power(forces.coupled),
    }
    return Step(
        "observe",
        "Outwards: poses and velocities of the disks, energies and powers.",
        OUTWARD,
        ("q", "u", "inputs", "segments", "disks", "chain", "pose", "velocity"),
        trace,
        results={
            name: (at_start.get(name, 0.0), symbol(name) + trace.let(f"added_{name}", value))
            for name, value in accounts.items()
        },
        carried=carried | cables,
        stores={
            "pose": [at[coordinate] for coordinate in forces.disk.coordinates],
            "velocity": [at[rate] for rate in forces.disk.rates],
        },
    )
