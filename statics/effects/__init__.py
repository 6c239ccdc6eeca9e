"""The effects that hold at rest: one file each, one line here each.

An effect is a list of load-displacement pairs (Rone 2012, Eq. 1). What a scene does not name is in
no equation and in no generated line.
"""

from statics.effects.bending import Bending as Bending
from statics.effects.cable_friction import CableFriction as CableFriction
from statics.effects.cables import Cables as Cables
from statics.effects.disk_loads import DiskLoad as DiskLoad
from statics.effects.disk_loads import DiskLoads as DiskLoads
from statics.effects.effect import Effect as Effect
from statics.effects.effect import Pair as Pair
from statics.effects.effect import effects_among
from statics.effects.extension import Extension as Extension
from statics.effects.gravity import Gravity as Gravity

STATIC_EFFECTS: dict[str, type[Effect]] = effects_among(globals())
"""The registry: every effect that is imported here, by its name in scenario files."""
