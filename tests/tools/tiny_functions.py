"""Two functions that know no scene, compiled and kept as every other; for tests of how that is done."""

import numpy as np

from statics.kernels.calling import run
from statics.kernels.compiled import compiled
from statics.kernels.slots import LARGEST, SCALARS, SLOWING


@compiled
def times(address: int, x: float) -> float:
    """What the pass at that address makes of x."""
    scalars = np.empty(SCALARS)
    scalars[SLOWING] = x
    run(address, 1, scalars)
    return scalars[LARGEST]


@compiled
def times_plus_one(address: int, x: float) -> float:
    """The same, plus 1."""
    return times(address, x) + 1.0
