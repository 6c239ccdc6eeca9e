"""The kernel of the midpoint rule: momenta of a scene without dissipation, and M + g^2 K."""

from pathlib import Path

import statics.chain
from continuum_dyn import equations_of_motion, motion_kernel
from statics.codegen import Recipe
from statics.scene import Scene

_HERE = Path(__file__).parent
_SOURCES = (
    Path(statics.chain.__file__),
    Path(equations_of_motion.__file__),
    _HERE / "integrators" / "midpoint.py",
)


def write(scene: Scene) -> str:
    """Text of the kernel module; derives everything with sympy."""
    from continuum_dyn import momentum_steps, motion_steps
    from continuum_dyn.virtual_power import derive_dynamics
    from statics import recursion
    from statics.compose import compose

    forces = momentum_steps.conservative(derive_dynamics(scene))
    steps = [
        *motion_steps.measuring_steps(forces),
        momentum_steps.velocity_step(forces),
        recursion.residual_step(forces),
        momentum_steps.momentum_step(forces),
        recursion.eliminate_step(forces, momentum_steps.CONSERVATIVE),
        recursion.substitute_step(forces, momentum_steps.CONSERVATIVE),
        recursion.displacement_step(forces),
        recursion.clearance_step(forces),
    ]
    names = [effect.name for effect in scene.effects]
    sources = (*([motion_kernel.CABLES] if forces.coupled else []), *_SOURCES)
    return compose("The midpoint rule for a planar cable-driven arm.", forces, names, steps, sources)


RECIPE = Recipe(
    "midpoint",
    write,
    (*motion_kernel.RECIPE.sources, *_SOURCES, _HERE / "momentum_steps.py", Path(__file__)),
)
