"""One step of the sweeps for momenta: p = dT/du and dT/dq on the chain, O(n).

A disk beyond segment j moves with it as a rigid body does, so only the sums of momenta beyond count: P,
linear, and N, angular about the far disk, carried inwards by the transition's transpose as reactions are.
With S the segment's partials, v its far disk's velocity, omega0 its near disk's angular velocity and r its
reach:

    p_a     = S_a . (P, N)
    dT/dq_a = P . (omega0 z x r_a + r_ab u_b) - phi_a P . (z x v)

A point of the core moves with its own segment as a far disk does, but nothing beyond turns about it: it adds
S_a . P, and P . (omega0 z x r_a + r_ab u_b) with its own reach.

The second is p_a's with the partials' own rates: dv/dq_a = d(dv/du_a)/dt (Lagrange), and what lies beyond
turns about the far disk. A payload beside its disk's centre makes the disk's T depend on its angle, and adds
no term: turned together with its velocity a body keeps its T, so dT/dtheta + P . (z x v) = 0 for each disk.
"""

from dataclasses import replace
from typing import Any

import sympy as sp

from continuum_dyn.equations.motion_steps import disk_in_motion, integrated
from statics.derivation.cable_tension import along_cables, drive_power
from statics.derivation.reach import Reach, core_reaches, reach_of, turned
from statics.derivation.recursion import Weights, name_forces, placed
from statics.derivation.segment import symbol
from statics.derivation.step import INWARD, OUTWARD, Step
from statics.derivation.trace import Trace
from statics.derivation.virtual_work import Forces, SceneForces, Symbols

CONSERVATIVE = Weights(1, 0, symbol("stiffness_weight"))
"""Mass, and stiffness times the weight that the sweep is handed."""


def conservative(forces: SceneForces) -> SceneForces:
    """The scene with -dV/dq of each part for its force: without inertia's forces, and undamped."""
    return replace(
        forces,
        on_segment=_conservative(forces.on_segment, forces.segment),
        on_disk=_conservative(forces.on_disk, forces.disk),
        on_span=forces.on_span and forces.span and _conservative(forces.on_span, forces.span),
        on_core=tuple(map(_conservative, forces.on_core, forces.core)),
    )


def _conservative(part: Forces, at: Symbols) -> Forces:
    force = part.force.subs(dict.fromkeys([*at.rates, *at.accelerations], 0))
    none = sp.zeros(*part.damping.shape)
    return replace(part, force=force, damping=none, stiffness=-force.jacobian(at.coordinates))


def _momentum(part: Forces, at: Symbols) -> sp.Matrix:
    """Momentum dT/du of one segment, disk or point of the core by itself."""
    return sp.Matrix([part.energies["kinetic_energy"].diff(rate) for rate in at.rates])


def _name_partial_rates(trace: Trace, forces: SceneForces, reach: Reach) -> None:
    """Name the time derivative of every column of the reach's partials."""
    spin = symbol("near_angular_velocity")
    for a, row in enumerate(reach.by_qq):
        rate = spin * turned(reach.by_q[:, a])
        for second, u in zip(row, forces.segment.rates, strict=True):
            rate += second * u
        for axis in range(2):
            trace.name(f"{reach.prefix}partial_rate_{axis}{a}", rate[axis])


def _partial_rate(reach: Reach) -> sp.Matrix:
    """Partial rates by name, shape (2, dofs)."""
    name = f"{reach.prefix}partial_rate"
    return sp.Matrix(*reach.by_q.shape, lambda axis, a: symbol(f"{name}_{axis}{a}"))


def velocity_step(forces: SceneForces) -> Step:
    """Outwards: geometry, velocities, momenta of the disks, and the loads of a conservative scene."""
    trace = Trace()
    reach, carried, at = disk_in_motion(trace, forces)
    cables = along_cables(trace, forces.coupled, at, moves=False)
    name_forces(trace, forces, at)
    _name_partial_rates(trace, forces, reach)
    for row, value in enumerate(_momentum(forces.on_disk, forces.disk)):
        trace.name(f"disk_momentum_{row}", placed(value, at))
    for (point, of_core), part in zip(core_reaches(forces), forces.on_core, strict=True):
        _name_partial_rates(trace, forces, of_core)
        trace.let(f"{of_core.prefix}momentum", placed(_momentum(part, point), at))
    trace.let("segment_momentum", _momentum(forces.on_segment, forces.segment))
    power = integrated(forces, "input_power", at)
    return Step(
        "velocity",
        "Outwards: reach, velocity, momentum of the disk, loads without inertia; power in.",
        OUTWARD,
        ("q", "u", "inputs", "segments", "disks", "chain"),
        trace,
        results={
            "input_power": (
                drive_power(forces.coupled),
                symbol("input_power") + trace.let("added_input_power", power),
            )
        },
        carried=carried | cables,
    )


def momentum_step(forces: SceneForces) -> Step:
    """Inwards: the momentum p = dT/du of a segment's coordinates, and dT/dq."""
    trace = Trace()
    reach = reach_of(forces)
    carried = sp.Matrix([symbol(name) for name in ("momentum_x", "momentum_y", "angular_momentum")])
    whole = trace.let("beyond", carried + sp.Matrix([symbol(f"disk_momentum_{row}") for row in range(3)]))
    linear, far = whole[:2, 0], sp.Matrix([symbol("far_velocity_0"), symbol("far_velocity_1")])
    own = [
        value if value.is_Atom else symbol(f"segment_momentum_{a}")
        for a, value in enumerate(_momentum(forces.on_segment, forces.segment))
    ]
    turning = trace.let("turning", -linear.dot(turned(far)))
    momentum = reach.partials.T * whole + sp.Matrix(own)
    slope = _partial_rate(reach).T * linear + reach.turn_by_q.T * turning
    at_near: Any = reach.transition.T * whole
    for _, of_core in core_reaches(forces):
        of_point = sp.Matrix([symbol(f"{of_core.prefix}momentum_{axis}") for axis in range(2)])
        momentum += of_core.by_q.T * of_point
        slope += _partial_rate(of_core).T * of_point
        at_near += of_core.transition[:2, :].T * of_point
    return Step(
        "momentum",
        "Inwards: momentum of the segment's coordinates, and the slope of the kinetic energy by them.",
        INWARD,
        ("chain", "momentum", "slope"),
        trace,
        carried={str(name): (0.0, value) for name, value in zip(carried, at_near, strict=True)},
        stores={
            "momentum": list(momentum),
            "slope": list(slope),
        },
    )
