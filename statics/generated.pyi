"""What a generated kernel module offers to the sweeps that are composed into it.

``carried`` is the tuple that a sweep hands from segment to segment, the sweep's results first; its
length depends on the scene's effects.
"""

import numpy as np

Carried = tuple[float, ...]

SEGMENT_COLUMNS: tuple[str, ...]
DISK_COLUMNS: tuple[str, ...]
INPUTS: int
COUPLED: bool
CHAIN_COLUMNS: int
PIVOT_COLUMNS: int
BEYOND_START: Carried
CLEARANCE_START: Carried
RESIDUAL_START: Carried
ELIMINATE_START: Carried
ELIMINATE_HELD_START: Carried
SUBSTITUTE_START: Carried

def lengths_start(inputs: np.ndarray, segments: np.ndarray, chain: np.ndarray) -> Carried: ...
def lengths_step(
    i: int, carried: Carried, q: np.ndarray, inputs: np.ndarray, segments: np.ndarray, chain: np.ndarray
) -> Carried: ...
def beyond_step(i: int, carried: Carried, chain: np.ndarray) -> Carried: ...
def clearance_step(i: int, carried: Carried, q: np.ndarray, segments: np.ndarray) -> Carried: ...
def pose_start(inputs: np.ndarray, segments: np.ndarray, chain: np.ndarray) -> Carried: ...
def pose_step(
    i: int,
    carried: Carried,
    q: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
) -> Carried: ...
def observe_start(inputs: np.ndarray, segments: np.ndarray, chain: np.ndarray) -> Carried: ...
def observe_step(
    i: int,
    carried: Carried,
    q: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    pose: np.ndarray,
) -> Carried: ...
def residual_step(
    i: int, carried: Carried, disks: np.ndarray, chain: np.ndarray, residual: np.ndarray
) -> Carried: ...
def eliminate_step(
    i: int,
    carried: Carried,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    residual: np.ndarray,
    descent: np.ndarray,
    pivots: np.ndarray,
) -> Carried: ...
def eliminate_held_step(
    i: int,
    carried: Carried,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    residual: np.ndarray,
    descent: np.ndarray,
    pivots: np.ndarray,
) -> Carried: ...
def substitute_step(
    i: int, carried: Carried, chain: np.ndarray, descent: np.ndarray, change: np.ndarray
) -> Carried: ...
