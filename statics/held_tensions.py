"""Stability of arms whose cables rub: plain Python, composed into kernels of such scenes.

Friction has no potential, but it only ever takes energy: with the tensions held as they are the rest has one,
and where that is at a minimum nothing grows.
"""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from statics.generated import ELIMINATE_HELD_START, PIVOT_COLUMNS, eliminate_held_step


def count_held(
    segments: np.ndarray, disks: np.ndarray, chain: np.ndarray, residual: np.ndarray, negative: np.ndarray
) -> None:
    """Number of directions, into ``negative``, shape (1,), that are unstable with the tensions held."""
    descent, pivots = np.empty_like(residual), np.empty((residual.shape[0], PIVOT_COLUMNS))
    keeping_signs = (0.0, 0.0, 1.0, *ELIMINATE_HELD_START[3:])
    carried = keeping_signs  # numba takes an unpacked tuple for a name that is assigned once
    for i in range(residual.shape[0] - 1, -1, -1):
        carried = eliminate_held_step(i, carried, segments, disks, chain, residual, descent, pivots)
    negative[0] = carried[0]
