"""The effects that exist in motion only, one line here each, listed with those that hold at rest."""

from continuum_dyn.effects.inertia import Inertia as Inertia
from continuum_dyn.effects.linear_drag import LinearDrag as LinearDrag
from continuum_dyn.effects.mass_damping import MassDamping as MassDamping
from continuum_dyn.effects.material_damping import MaterialDamping as MaterialDamping
from continuum_dyn.effects.quadratic_drag import QuadraticDrag as QuadraticDrag
from continuum_dyn.effects.rotary_inertia import RotaryInertia as RotaryInertia
from statics.effects import STATIC_EFFECTS, Effect
from statics.effects.effect import effects_among

EFFECTS: dict[str, type[Effect]] = STATIC_EFFECTS | effects_among(globals())
"""The registry: every effect of the program, by its name in scenario files."""
