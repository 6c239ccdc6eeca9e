"""The passes of a scene at rest: poses and loads outward, residual, elimination, substitution."""

from dataclasses import replace

from statics.derivation import cable_steps, recursion
from statics.derivation.step import Step
from statics.derivation.virtual_work import SceneForces, derive_statics
from statics.structure import Structure


def derive_rest(structure: Structure) -> tuple[SceneForces, list[Step]]:
    """Forces and steps of all passes that a search for an equilibrium calls."""
    forces = derive_statics(structure)
    steps = [
        *cable_steps.measuring_steps(forces),
        recursion.pose_step(forces),
        recursion.residual_step(forces),
        recursion.eliminate_step(forces, recursion.STATIC),
        recursion.substitute_step(forces, recursion.STATIC),
        recursion.observe_step(forces),
    ]
    if any(kind.rubs for kind in structure.cable_kinds) and not structure.has_follower_loads:
        held = recursion.eliminate_step(forces, recursion.HELD)
        steps.append(replace(held, name="eliminate_held"))
    return forces, steps
