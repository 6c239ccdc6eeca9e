"""The effects that hold at rest: one file each, listed here.

An effect is a list of load-displacement pairs (Rone 2012, Eq. 1). What a scene does not name is in
no equation and in no generated line.
"""

from statics.effects.bending import Bending
from statics.effects.cable_friction import CableFriction
from statics.effects.cables import Cables
from statics.effects.disk_loads import DiskLoad, DiskLoads
from statics.effects.effect import Effect, Pair
from statics.effects.extension import Extension
from statics.effects.gravity import Gravity

STATIC_EFFECTS: dict[str, type[Effect]] = {
    effect.name: effect for effect in (Bending, Extension, Gravity, Cables, CableFriction, DiskLoads)
}

__all__ = [
    "STATIC_EFFECTS",
    "Bending",
    "CableFriction",
    "Cables",
    "DiskLoad",
    "DiskLoads",
    "Effect",
    "Extension",
    "Gravity",
    "Pair",
]
