"""The passes of a scene in motion, in the three sets that are derived together."""

from continuum_dyn.equations import momentum_steps, motion_steps
from continuum_dyn.equations.virtual_power import derive_dynamics
from statics.derivation import recursion
from statics.derivation.step import Step
from statics.derivation.virtual_work import SceneForces
from statics.structure import Structure

Derived = tuple[SceneForces, list[Step]]


def derive_motion(structure: Structure) -> Derived:
    """Passes of implicit and explicit steps, with the Newton matrix M + g C + g^2 K, and observations."""
    forces = derive_dynamics(structure)
    return forces, [
        *motion_steps.measuring_steps(forces),
        motion_steps.motion_step(forces),
        recursion.residual_step(forces),
        recursion.eliminate_step(forces, recursion.IMPLICIT),
        recursion.substitute_step(forces, recursion.IMPLICIT),
        recursion.displacement_step(forces),
        recursion.clearance_step(forces),
        motion_steps.observe_motion_step(forces),
    ]


def derive_linearized(structure: Structure) -> Derived:
    """Passes of the accelerations, with the mass matrix alone, and of their exact derivatives."""
    forces = derive_dynamics(structure)
    return forces, [
        *motion_steps.measuring_steps(forces),
        motion_steps.motion_step(forces),
        recursion.residual_step(forces),
        recursion.eliminate_step(forces, recursion.ACCELERATION),
        recursion.substitute_step(forces, recursion.ACCELERATION),
        *motion_steps.measuring_tangents(forces),
        motion_steps.motion_tangent_step(forces),
        motion_steps.residual_tangent_step(forces),
    ]


def derive_midpoint(structure: Structure) -> Derived:
    """Passes of the midpoint rule: momenta of a scene without dissipation, and M + g^2 K."""
    forces = momentum_steps.conservative(derive_dynamics(structure))
    return forces, [
        *motion_steps.measuring_steps(forces),
        momentum_steps.velocity_step(forces),
        recursion.residual_step(forces),
        momentum_steps.momentum_step(forces),
        recursion.eliminate_step(forces, momentum_steps.CONSERVATIVE),
        recursion.substitute_step(forces, momentum_steps.CONSERVATIVE),
        recursion.displacement_step(forces),
        recursion.clearance_step(forces),
    ]
