"""The kernel of a scene at rest: outward poses, residual, elimination, and Newton's method on them."""

from dataclasses import replace
from pathlib import Path

from statics.codegen import DERIVATION, Recipe
from statics.scene import Scene

_HERE = Path(__file__).parent
_SHARED = (_HERE / "chain.py", _HERE / "search.py")
_BY_ENERGY, _BY_RESIDUAL = _HERE / "newton.py", _HERE / "balance.py"
_CABLES, _PIVOTS, _HELD = (_HERE / f"{stem}.py" for stem in ("cable_sweep", "pivots", "held_tensions"))


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
    sources = [_CABLES] if forces.coupled else []
    sources += [*_SHARED, *([_PIVOTS, _BY_ENERGY] if forces.conservative else [_BY_RESIDUAL])]
    if any(kind.rubs for kind in scene.cable_kinds) and not scene.without_potential:
        held = recursion.eliminate_step(forces, recursion.HELD)
        steps.append(replace(held, name="eliminate_held_step"))
        sources += [_PIVOTS, _HELD]
    return compose("Statics of a planar cable-driven arm.", forces, names, steps, sources)


_SOURCES = (*_SHARED, _CABLES, _PIVOTS, _HELD, _BY_ENERGY, _BY_RESIDUAL, Path(__file__))
RECIPE = Recipe("statics", write, (*DERIVATION, *_SOURCES))
