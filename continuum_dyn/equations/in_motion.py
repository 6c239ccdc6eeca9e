"""The kernel of a scene in motion: accelerations, their exact Jacobian, energies and powers."""

from pathlib import Path

import statics.chain
from statics.kernels.loading import DERIVATION, Recipe
from statics.scene import Scene

_HERE = Path(__file__).parent
_CHAIN = Path(statics.chain.__file__)
_EQUATIONS = _HERE / "equations_of_motion.py"
CABLES, CABLE_CHANGES = _HERE / "moving_cable_sweep.py", _HERE / "cable_change_sweep.py"
_BASE_POWER = _HERE / "base_power.py"


def write(scene: Scene) -> str:
    """Text of the kernel module; derives everything with sympy."""
    from continuum_dyn.equations import motion_steps
    from continuum_dyn.equations.virtual_power import derive_dynamics
    from statics.derivation import recursion
    from statics.kernels.printing import compose

    forces = derive_dynamics(scene)
    measured, changes = motion_steps.measuring_steps(forces), motion_steps.measuring_tangents(forces)
    steps = [
        *measured,
        motion_steps.motion_step(forces),
        recursion.residual_step(forces),
        recursion.eliminate_step(forces, recursion.ACCELERATION),
        recursion.substitute_step(forces, recursion.ACCELERATION),
        *changes,
        motion_steps.motion_tangent_step(forces),
        motion_steps.residual_tangent_step(forces),
        motion_steps.observe_motion_step(forces),
        recursion.clearance_step(forces),
    ]
    names = [effect.name for effect in scene.effects]
    cables = [CABLES, CABLE_CHANGES] if forces.coupled else []
    sources = (*cables, _CHAIN, _EQUATIONS, *([_BASE_POWER] if scene.arm.base_moves else []))
    return compose("Dynamics of a planar cable-driven arm.", forces, names, steps, sources)


RECIPE = Recipe(
    "motion",
    write,
    (
        *DERIVATION,
        CABLES,
        CABLE_CHANGES,
        _EQUATIONS,
        _BASE_POWER,
        *(_HERE / f"{stem}.py" for stem in ("virtual_power", "transport", "motion_steps", "motion_kernel")),
    ),
)
