"""Passes of a scene at rest: poses and loads outward, residual, elimination, substitution."""

from dataclasses import replace

from statics.derivation.step import Step
from statics.derivation.steps import cable_steps, newton_matrix, outward
from statics.derivation.steps.elimination import eliminate_step, substitute_step
from statics.derivation.steps.residual import residual_step
from statics.derivation.steps.sizes import sizes_step
from statics.derivation.virtual_work import SceneForces, derive_statics
from statics.structure import Structure


def derive_rest(structure: Structure) -> tuple[SceneForces, list[Step]]:
    """Forces and steps of all passes that a search for an equilibrium calls."""
    forces = derive_statics(structure)
    steps = [
        *cable_steps.measuring_steps(forces),
        outward.pose_step(forces),
        residual_step(forces),
        sizes_step(forces),
        eliminate_step(forces, newton_matrix.STATIC),
        substitute_step(forces, newton_matrix.STATIC),
        outward.observe_step(forces),
    ]
    if any(kind.rubs for kind in structure.cable_kinds) and not structure.has_follower_loads:
        steps.append(replace(eliminate_step(forces, newton_matrix.FIXED_TENSION), name="eliminate_held"))
    return forces, steps
