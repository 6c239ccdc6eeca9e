"""The kernel of a scene at rest: outward poses, residual, elimination, and Newton's method on them."""

from pathlib import Path

from statics.codegen import DERIVATION, Recipe
from statics.scene import Scene

_NEWTON = Path(__file__).with_name("newton.py")
_CHAIN = Path(__file__).with_name("chain.py")


def write(scene: Scene) -> str:
    """Text of the kernel module; derives everything with sympy."""
    from statics import recursion
    from statics.compose import compose
    from statics.virtual_work import derive_statics

    forces = derive_statics(scene)
    steps = [
        recursion.pose_step(forces),
        recursion.residual_step(forces),
        recursion.eliminate_step(forces, recursion.STATIC),
        recursion.substitute_step(forces),
        recursion.observe_step(forces),
    ]
    names = [effect.name for effect in scene.effects]
    return compose("Statics of a planar cable-driven arm.", forces, names, steps, (_CHAIN, _NEWTON))


RECIPE = Recipe("statics", write, (*DERIVATION, _NEWTON, Path(__file__)))
