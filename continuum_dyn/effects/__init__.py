"""The effects that exist in motion only, listed with those that hold at rest."""

from continuum_dyn.effects.inertia import Inertia
from continuum_dyn.effects.linear_drag import LinearDrag
from continuum_dyn.effects.mass_damping import MassDamping
from continuum_dyn.effects.material_damping import MaterialDamping
from continuum_dyn.effects.quadratic_drag import QuadraticDrag
from continuum_dyn.effects.rotary_inertia import RotaryInertia
from statics.effects import STATIC_EFFECTS, Effect

EFFECTS: dict[str, type[Effect]] = STATIC_EFFECTS | {
    effect.name: effect
    for effect in (Inertia, RotaryInertia, MaterialDamping, MassDamping, LinearDrag, QuadraticDrag)
}

__all__ = [
    "EFFECTS",
    "Inertia",
    "LinearDrag",
    "MassDamping",
    "MaterialDamping",
    "QuadraticDrag",
    "RotaryInertia",
]
