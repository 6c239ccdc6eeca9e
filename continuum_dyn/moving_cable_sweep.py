"""The sweeps that measure coupled cables in motion: plain Python, composed into kernels that need them."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from continuum_dyn.generated import lengths_step
    from statics.generated import BEYOND_START, beyond_step, lengths_start


def measure_moving_cables(
    q: np.ndarray, u: np.ndarray, inputs: np.ndarray, segments: np.ndarray, chain: np.ndarray
) -> None:
    """Lengths of coupled cables beyond each hole and their rates, into ``chain``."""
    outward, inward = lengths_start(inputs, segments, chain), BEYOND_START
    for i in range(q.shape[0]):
        outward = lengths_step(i, outward, q, u, inputs, segments, chain)
    for i in range(q.shape[0] - 1, -1, -1):
        inward = beyond_step(i, inward, chain)
