"""What a generated motion kernel offers to ``equations_of_motion`` beside what every kernel does."""

import numpy as np

Carried = tuple[float, ...]

INPUTS: int
CHAIN_COLUMNS: int
BEYOND_TANGENT_START: Carried
DISPLACEMENT_START: Carried
ELIMINATE_START: Carried
MOMENTUM_START: Carried
RESIDUAL_TANGENT_START: Carried

def lengths_step(
    i: int,
    carried: Carried,
    q: np.ndarray,
    u: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    chain: np.ndarray,
) -> Carried: ...
def lengths_tangent_start(inputs: np.ndarray, segments: np.ndarray, chain: np.ndarray) -> Carried: ...
def lengths_tangent_step(
    i: int,
    carried: Carried,
    q: np.ndarray,
    u: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    chain: np.ndarray,
    q_change: np.ndarray,
    u_change: np.ndarray,
) -> Carried: ...
def beyond_tangent_step(i: int, carried: Carried, chain: np.ndarray) -> Carried: ...
def motion_start(inputs: np.ndarray, segments: np.ndarray, chain: np.ndarray) -> Carried: ...
def motion_step(
    i: int,
    carried: Carried,
    q: np.ndarray,
    u: np.ndarray,
    w: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
) -> Carried: ...
def motion_tangent_start(inputs: np.ndarray, segments: np.ndarray, chain: np.ndarray) -> Carried: ...
def motion_tangent_step(
    i: int,
    carried: Carried,
    q: np.ndarray,
    u: np.ndarray,
    w: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    q_change: np.ndarray,
    u_change: np.ndarray,
) -> Carried: ...
def residual_tangent_step(
    i: int, carried: Carried, disks: np.ndarray, chain: np.ndarray, residual_change: np.ndarray
) -> Carried: ...
def observe_start(inputs: np.ndarray, segments: np.ndarray, chain: np.ndarray) -> Carried: ...
def observe_step(
    i: int,
    carried: Carried,
    q: np.ndarray,
    u: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    pose: np.ndarray,
    velocity: np.ndarray,
) -> Carried: ...
def displacement_step(i: int, carried: Carried, chain: np.ndarray, change: np.ndarray) -> Carried: ...
def velocity_start(inputs: np.ndarray, segments: np.ndarray, chain: np.ndarray) -> Carried: ...
def velocity_step(
    i: int,
    carried: Carried,
    q: np.ndarray,
    u: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
) -> Carried: ...
def momentum_step(
    i: int, carried: Carried, chain: np.ndarray, momentum: np.ndarray, slope: np.ndarray
) -> Carried: ...
