"""Operations in a scene's generated steps, counted in their source, and the share of each effect."""

import ast

from continuum_dyn.equations import motion_steps
from continuum_dyn.equations.virtual_power import derive_dynamics
from statics.derivation.steps.elimination import eliminate_step, substitute_step
from statics.derivation.steps.newton_matrix import IMPLICIT, STATIC
from statics.derivation.steps.outward import pose_step
from statics.derivation.steps.residual import residual_step
from statics.derivation.virtual_work import derive_statics
from statics.errors import InputError
from statics.kernels.printing import module_text
from statics.scene import Scene


def operations(scene: Scene) -> int:
    """Operations per segment of one evaluation: outward loads, residual, elimination, substitution.

    In motion it takes the matrix of an implicit stage; a scene without inertia is counted at rest. See
    ``count``; the call for all sigma_n is one operation.
    """
    if scene.has("inertia"):
        forces = derive_dynamics(scene.structure)
        outward, weights = motion_steps.motion_step(forces), IMPLICIT
    else:
        forces = derive_statics(scene.at_rest.structure)
        outward, weights = pose_step(forces), STATIC
    inward = [residual_step(forces), eliminate_step(forces, weights)]
    steps = [outward, *inward, substitute_step(forces, weights)]
    tree = ast.parse(module_text("Counted.", forces, [], steps))
    names = {f"{step.name}_step" for step in steps}
    bodies = [node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name in names]
    return sum(map(count, bodies))


def count(tree: ast.AST) -> int:
    """Operations in Python text: + - * / ** and signs, unless of numbers alone, and calls."""
    return sum(
        isinstance(node, ast.Call) or (isinstance(node, ast.BinOp | ast.UnaryOp) and _has_name(node))
        for node in ast.walk(tree)
    )


def _has_name(node: ast.AST) -> bool:
    return any(isinstance(part, ast.Name) for part in ast.walk(node))


def added_by_each(scene: Scene) -> dict[str, int | None]:
    """Operations per segment that each effect adds, by its name.

    None for inertia, without which nothing moves, and for an effect that others need.
    """
    whole = operations(scene)
    return {effect.name: _added(scene, effect.name, whole) for effect in scene.effects}


def _added(scene: Scene, name: str, whole: int) -> int | None:
    if name == "inertia":
        return None
    try:
        return whole - operations(scene.without(name))
    except InputError:
        return None
