"""Passes of a scene in motion, in the three sets that are derived together."""

from continuum_dyn.equations import momentum_steps, motion_steps
from continuum_dyn.equations.virtual_power import derive_dynamics
from statics.derivation.step import Step
from statics.derivation.steps.elimination import eliminate_step, substitute_step
from statics.derivation.steps.newton_matrix import ACCELERATION, CONSERVATIVE, IMPLICIT
from statics.derivation.steps.outward import clearance_step, displacement_step
from statics.derivation.steps.residual import residual_step
from statics.derivation.virtual_work import SceneForces
from statics.structure import Structure

Derived = tuple[SceneForces, list[Step]]


def derive_motion(structure: Structure) -> Derived:
    """Passes of implicit and explicit steps, with the Newton matrix M + g C + g^2 K, and observations."""
    forces = derive_dynamics(structure)
    return forces, [
        *motion_steps.measuring_steps(forces),
        motion_steps.motion_step(forces),
        residual_step(forces),
        eliminate_step(forces, IMPLICIT),
        substitute_step(forces, IMPLICIT),
        displacement_step(forces),
        clearance_step(forces),
        motion_steps.observe_motion_step(forces),
    ]


def derive_linearized(structure: Structure) -> Derived:
    """Passes of the accelerations, with the mass matrix M, and of their exact derivatives."""
    forces = derive_dynamics(structure)
    return forces, [
        *motion_steps.measuring_steps(forces),
        motion_steps.motion_step(forces),
        residual_step(forces),
        eliminate_step(forces, ACCELERATION),
        substitute_step(forces, ACCELERATION),
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
        residual_step(forces),
        momentum_steps.momentum_step(forces),
        eliminate_step(forces, CONSERVATIVE),
        substitute_step(forces, CONSERVATIVE),
        displacement_step(forces),
        clearance_step(forces),
    ]
