"""One of each effect, with numbers of no symmetry, for an arm of two disks or more."""

from continuum_dyn.effects import (
    Inertia,
    LinearDrag,
    MassDamping,
    MaterialDamping,
    QuadraticDrag,
    RotaryInertia,
)
from statics import Bending, CableFriction, Cables, DiskLoad, DiskLoads, Extension, Gravity
from statics.effects import Effect

ONE_OF_EACH: tuple[Effect, ...] = (
    Bending(),
    Extension(),
    Gravity((1.7, -9.6)),
    Cables(),
    CableFriction(),
    DiskLoads((DiskLoad(1, (-0.3, 0.5), -0.01), DiskLoad(2, (0.4, -0.7), 0.02))),
    Inertia(),
    RotaryInertia(),
    MaterialDamping(1.2e-3),
    MassDamping(3.0),
    LinearDrag(0.02, 1e-6),
    QuadraticDrag(0.3, 1e-8),
)
