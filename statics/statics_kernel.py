"""The kernel of a scene at rest: outward poses, residual, elimination, and Newton's method on them."""

from pathlib import Path

from statics.codegen import DERIVATION, Recipe
from statics.scene import Scene

_HERE = Path(__file__).parent
_SHARED = (_HERE / "chain.py", _HERE / "search.py")
_BY_ENERGY, _BY_RESIDUAL = _HERE / "newton.py", _HERE / "balance.py"
_CABLES = _HERE / "cable_sweep.py"


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
    cables = [_CABLES] if forces.coupled else []
    sources = (*cables, *_SHARED, _BY_ENERGY if forces.conservative else _BY_RESIDUAL)
    return compose("Statics of a planar cable-driven arm.", forces, names, steps, sources)


RECIPE = Recipe("statics", write, (*DERIVATION, *_SHARED, _CABLES, _BY_ENERGY, _BY_RESIDUAL, Path(__file__)))
