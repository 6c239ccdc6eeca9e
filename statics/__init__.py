"""Statics of planar cable-driven continuum arms by virtual work (Rone and Ben-Tzvi 2012).

Exported names are loaded when they are first used.
"""

from typing import TYPE_CHECKING

from statics.support.lazy_names import loaded_when_asked_for

if TYPE_CHECKING:
    from statics.arc_length import Path, follow_path
    from statics.arm import RONE2012_HOLE_OFFSET, Arm, Base, Cable, Payload, PerDisk
    from statics.effects import Bending, CableFriction, Cables, DiskLoad, DiskLoads, Extension, Gravity
    from statics.effects.cables import disk_loads
    from statics.equilibria import Critical, Equilibrium, StaticSolver, equilibrium
    from statics.errors import ContinuumError, InputError
    from statics.outcome import Outcome
    from statics.ramp import tension_ramp
    from statics.scene import Scene

__all__ = [
    "RONE2012_HOLE_OFFSET",
    "Arm",
    "Base",
    "Bending",
    "Cable",
    "CableFriction",
    "Cables",
    "ContinuumError",
    "Critical",
    "DiskLoad",
    "DiskLoads",
    "Equilibrium",
    "Extension",
    "Gravity",
    "InputError",
    "Outcome",
    "Path",
    "Payload",
    "PerDisk",
    "Scene",
    "StaticSolver",
    "disk_loads",
    "equilibrium",
    "follow_path",
    "tension_ramp",
]

__getattr__ = loaded_when_asked_for(__file__)
