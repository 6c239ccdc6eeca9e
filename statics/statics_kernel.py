"""The kernel of a scene at rest: outward poses, residual, elimination, and Newton's method on them."""

from pathlib import Path

from statics.codegen import DERIVATION, Recipe
from statics.scene import Scene

_NEWTON = Path(__file__).with_name("newton.py")
_CHAIN = Path(__file__).with_name("chain.py")
_CABLES = Path(__file__).with_name("cable_sweep.py")


def write(scene: Scene) -> str:
    """Text of the kernel module; derives everything with sympy."""
    from statics import cable_steps, recursion
    from statics.compose import compose
    from statics.virtual_work import derive_statics

    forces = derive_statics(scene)
    steps = [
        *cable_steps.measuring_steps(forces),
        recursion.pose_step(forces),
        recursion.residual_step(forces),
        recursion.eliminate_step(forces, recursion.STATIC),
        recursion.substitute_step(forces, recursion.STATIC),
        recursion.observe_step(forces),
    ]
    names = [effect.name for effect in scene.effects]
    sources = (*([_CABLES] if forces.coupled else []), _CHAIN, _NEWTON)
    return compose("Statics of a planar cable-driven arm.", forces, names, steps, sources)


RECIPE = Recipe("statics", write, (*DERIVATION, _CABLES, _NEWTON, Path(__file__)))
