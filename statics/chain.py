"""The sweeps along the chain, O(n) each: plain Python, composed into every generated kernel.

Arrays hold one row for each segment and its far disk. ``chain`` holds what one sweep leaves for the
next. The steps that are called here are generated for the scene's effects; see ``generated.pyi``.
"""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from statics.generated import (
        CLEARANCE_START,
        RESIDUAL_START,
        SUBSTITUTE_START,
        Carried,
        clearance_step,
        eliminate_step,
        residual_step,
        substitute_step,
    )


def clearance_sweep(q: np.ndarray, segments: np.ndarray) -> float:
    """Smallest length or hole-to-hole length over L0; at zero the arm is at a geometric limit."""
    carried = CLEARANCE_START
    for i in range(q.shape[0]):
        carried = clearance_step(i, carried, q, segments)
    return carried[0]


def residual_sweep(disks: np.ndarray, chain: np.ndarray, residual: np.ndarray) -> "Carried":
    """Inwards: the residual S^T (f, N) - Q of every segment, from what the outward sweep left.

    What comes back begins with the wrench of the base on the arm: force (N) and torque about the base (N m).
    """
    carried = RESIDUAL_START
    for i in range(residual.shape[0] - 1, -1, -1):
        carried = residual_step(i, carried, disks, chain, residual)
    return carried


def eliminate_sweep(
    start: "Carried",
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    residual: np.ndarray,
    descent: np.ndarray,
    pivots: np.ndarray,
) -> "Carried":
    """Inwards: eliminate every segment from H dq = -residual, from ``ELIMINATE_START``.

    What comes back begins with the results of ``eliminate_step``.
    """
    carried = start
    for i in range(residual.shape[0] - 1, -1, -1):
        carried = eliminate_step(i, carried, segments, disks, chain, residual, descent, pivots)
    return carried


def substitute_sweep(chain: np.ndarray, descent: np.ndarray, change: np.ndarray) -> None:
    """Outwards: dq of every segment, into ``change``."""
    carried = SUBSTITUTE_START
    for i in range(change.shape[0]):
        carried = substitute_step(i, carried, chain, descent, change)
