"""The kernel of implicit steps: the Newton matrices M + g C + g^2 K of a scene in motion."""

from pathlib import Path

import statics.chain
from continuum_dyn import equations_of_motion, motion_kernel
from statics.codegen import Recipe
from statics.scene import Scene

_HERE = Path(__file__).parent
_SOURCES = (
    Path(statics.chain.__file__),
    Path(equations_of_motion.__file__),
    _HERE / "integrators" / "esdirk.py",
)


def write(scene: Scene) -> str:
    """Text of the kernel module; derives everything with sympy."""
    from continuum_dyn import motion_steps
    from continuum_dyn.virtual_power import derive_dynamics
    from statics import recursion
    from statics.compose import compose

    forces = derive_dynamics(scene)
    steps = [
        *motion_steps.measuring_steps(forces),
        motion_steps.motion_step(forces),
        recursion.residual_step(forces),
        recursion.eliminate_step(forces, recursion.IMPLICIT),
        recursion.substitute_step(forces, recursion.IMPLICIT),
        recursion.displacement_step(forces),
        recursion.clearance_step(forces),
    ]
    names = [effect.name for effect in scene.effects]
    sources = (*([motion_kernel.CABLES] if forces.coupled else []), *_SOURCES)
    return compose("Implicit steps of a planar cable-driven arm.", forces, names, steps, sources)


RECIPE = Recipe("implicit", write, (*motion_kernel.RECIPE.sources, *_SOURCES, Path(__file__)))
