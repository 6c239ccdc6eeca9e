"""Steps of the passes for momenta: p = dT/du and dT/dq on the chain, O(n).

A disk beyond segment j moves with it as a rigid body does, so only the sums of momenta beyond count: P,
linear, and N, angular about the far disk, carried inwards by the transition's transpose as reactions are.
With S the segment's partials, v its far disk's velocity, omega0 its near disk's angular velocity and r its
reach:

    p_a     = S_a . (P, N)
    dT/dq_a = P . (omega0 z x r_a + r_ab u_b) - phi_a P . (z x v)

A point of the core moves with its own segment as a far disk does, but nothing beyond turns about it: it adds
S_a . P, and P . (omega0 z x r_a + r_ab u_b) with its own reach.

dT/dq_a is p_a with the rates of the partials, dv/dq_a = d(dv/du_a)/dt (Lagrange), and everything beyond
turns about the far disk. A payload beside its disk's centre makes the disk's T depend on its angle, and adds
no term: a body rotated together with its velocity keeps its T, so dT/dtheta + P . (z x v) = 0 for each disk.
"""

from dataclasses import replace

import sympy as sp

from continuum_dyn.equations.motion_steps import integrand, name_motion
from statics.derivation.cable_tension import drive_power, name_tensions
from statics.derivation.frames import AXES, MOMENTUM, POSE, linear, perpendicular
from statics.derivation.reach import Reach, core_reaches, reach_of
from statics.derivation.step import INWARD, OUTWARD, Step, carry_from_zero
from statics.derivation.steps.forces_by_name import name_forces, rewrite
from statics.derivation.steps.outward import sum_along
from statics.derivation.trace import Trace, column_by_name, jacobian, symbol, symbol_column, symbol_matrix
from statics.derivation.virtual_work import Forces, SceneForces, Symbols


def conservative(forces: SceneForces) -> SceneForces:
    """Forces of a scene without inertia and damping: -dV/dq at each site."""
    return replace(
        forces,
        on_segment=_conservative(forces.on_segment, forces.segment),
        on_disk=_conservative(forces.on_disk, forces.disk),
        on_span=forces.on_span and forces.span and _conservative(forces.on_span, forces.span),
        on_core=tuple(map(_conservative, forces.on_core, forces.core)),
    )


def _conservative(part: Forces, site: Symbols) -> Forces:
    force = part.force.subs(dict.fromkeys([*site.rates, *site.accelerations], 0))
    none = sp.zeros(*part.damping.shape)
    return replace(part, force=force, damping=none, stiffness=-jacobian(force, site.coordinates))


def _momentum(part: Forces, site: Symbols) -> sp.Matrix:
    """Momentum dT/du of one segment, disk or point of the core by itself, shape (coordinates, 1)."""
    return jacobian(sp.Matrix([part.energies["kinetic_energy"]]), site.rates).T


def _name_partial_rates(trace: Trace, forces: SceneForces, reach: Reach) -> None:
    """Name the time derivative of every column of the reach's partials."""
    omega = symbol("near_angular_velocity")
    for a, (slope, row) in enumerate(zip(reach.by_q, reach.by_qq, strict=True)):
        rate = omega * perpendicular(slope)
        for second, u in zip(row, forces.segment.rates, strict=True):
            rate += second * u
        for axis, value in enumerate(rate):
            trace.always_name(f"{reach.prefix}partial_rate_{axis}{a}", value)


def _partial_rates(reach: Reach) -> sp.Matrix:
    """Partial rates by name, shape (2, dofs)."""
    return symbol_matrix(f"{reach.prefix}partial_rate", len(AXES), len(reach.by_q))


def velocity_step(forces: SceneForces) -> Step:
    """Outward pass: geometry, velocities, momenta of the disks, and the loads of a conservative scene."""
    trace = Trace()
    reach, carried, known = name_motion(trace, forces)
    tensions = name_tensions(trace, forces.coupled, known, moves=False)
    name_forces(trace, forces, known)
    _name_partial_rates(trace, forces, reach)
    for row, value in enumerate(_momentum(forces.on_disk, forces.disk)):
        trace.always_name(f"disk_momentum_{row}", rewrite(value, known))
    for (point, to_point), part in zip(core_reaches(forces), forces.on_core, strict=True):
        _name_partial_rates(trace, forces, to_point)
        trace.name(f"{to_point.prefix}momentum", rewrite(_momentum(part, point), known))
    trace.name("segment_momentum", _momentum(forces.on_segment, forces.segment))
    power = {"input_power": integrand(forces, "input_power", known)}
    return Step(
        "velocity",
        "Outwards: reach, velocity, momentum of the disk, loads without inertia; power in.",
        OUTWARD,
        ("q", "u", "inputs", "segments", "disks", "chain"),
        trace,
        results=sum_along(trace, power, {"input_power": drive_power(forces.coupled)}),
        carried=carried | tensions,
    )


def momentum_step(forces: SceneForces) -> Step:
    """Inward pass: momentum p = dT/du of a segment's coordinates, and dT/dq."""
    trace, reach = Trace(), reach_of(forces)
    before = sp.Matrix([symbol(name) for name in MOMENTUM])
    beyond = trace.name("beyond", before + symbol_column("disk_momentum", len(POSE)))
    own = column_by_name("segment_momentum", _momentum(forces.on_segment, forces.segment))
    far_velocity = symbol_column("far_velocity", len(AXES))
    turning = trace.name("turning", -linear(beyond).dot(perpendicular(far_velocity)))
    momentum = reach.partials.T * beyond + own
    slope = _partial_rates(reach).T * linear(beyond) + reach.angle_by_q.T * turning
    at_near = reach.transition.T * beyond
    for _, to_point in core_reaches(forces):
        of_point = symbol_column(f"{to_point.prefix}momentum", len(AXES))
        momentum += to_point.position_partials.T * of_point
        slope += _partial_rates(to_point).T * of_point
        at_near += to_point.position_transition.T * of_point
    return Step(
        "momentum",
        "Inwards: momentum of the segment's coordinates, and the slope of the kinetic energy by them.",
        INWARD,
        ("chain", "momentum", "slope"),
        trace,
        carried=carry_from_zero(MOMENTUM, at_near),
        stores={"momentum": list(momentum), "slope": list(slope)},
    )
