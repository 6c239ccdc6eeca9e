"""The sweeps that measure coupled cables at rest: plain Python, composed into kernels that need them."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from statics.generated import BEYOND_START, beyond_step, lengths_start, lengths_step


def measure_cables(q: np.ndarray, inputs: np.ndarray, segments: np.ndarray, chain: np.ndarray) -> None:
    """Lengths of coupled cables beyond each hole, into ``chain``."""
    outward, inward = lengths_start(inputs, segments, chain), BEYOND_START
    for i in range(q.shape[0]):
        outward = lengths_step(i, outward, q, inputs, segments, chain)
    for i in range(q.shape[0] - 1, -1, -1):
        inward = beyond_step(i, inward, chain)
