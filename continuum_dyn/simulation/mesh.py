"""How many segments an arm needs from disk to disk for its tip to be as exact as asked, in metres.

The error of a mesh falls with the square of its number of segments, so two meshes tell where the continuous
arm is, with an error that falls with the fourth power (Richardson 1911, Phil. Trans. A 210). Meshes of m,
2 m and 4 m segments from disk to disk check each other.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import ceil
from typing import TypeVar

import numpy as np

from continuum_dyn.simulation.trajectory import Trajectory
from statics.equilibria import Equilibrium

AIM = 0.5
"""Part of what is allowed that the search aims at."""
MOST_TRIALS = 5

Poses = TypeVar("Poses", Trajectory, Equilibrium)


@dataclass(frozen=True)
class Mesh:
    """A number of segments from disk to disk, with the estimate (m) of the largest tip error that is left.

    ``extrapolated`` says that the disks' poses follow from this mesh and one of twice as many segments.
    ``reached`` is False where nothing that was tried was enough.
    """

    subsegments: int
    extrapolated: bool
    estimate: float
    reached: bool


def to_mesh(tips: Callable[[int], np.ndarray | None], allowed: float, most: int) -> Mesh | None:
    """The coarsest mesh found whose tip error is estimated below ``allowed`` (m).

    ``tips`` returns the tip's places, shape (samples, 2), on a mesh; None where it was stopped, and then so
    does this, unless a mesh had been found by then. ``most`` is the largest number of segments from disk to
    disk.
    """
    found: Mesh | None = None
    subsegments = 1
    for _ in range(MOST_TRIALS):
        if (coarse := tips(subsegments)) is None:
            return found
        if (middle := tips(2 * subsegments)) is None or (fine := tips(4 * subsegments)) is None:
            return found
        limit = between(middle, fine)
        plain = _largest(coarse - limit)
        if plain <= allowed:
            return Mesh(subsegments, extrapolated=False, estimate=plain, reached=True)
        estimate = _largest(between(coarse, middle) - limit) * 16 / 15
        found = Mesh(subsegments, extrapolated=True, estimate=estimate, reached=estimate <= allowed)
        further = min(ceil(subsegments * (estimate / (AIM * allowed)) ** 0.25), most // 4)
        if found.reached or further <= subsegments:
            break
        subsegments = further
    return found


def between(coarse: np.ndarray, fine: np.ndarray) -> np.ndarray:
    """What two meshes, the second of twice as many segments, have for their limit."""
    return (4 * fine - coarse) / 3


def extrapolated(coarse: Poses, fine: Poses) -> Poses:
    """The finer one with the disks' poses of the continuous arm; as it is where the coarser one has none."""
    if isinstance(coarse, Equilibrium) and not coarse.found:
        return fine
    names = ("disk_x", "disk_y", "disk_theta")
    return replace(fine, **{name: between(getattr(coarse, name), getattr(fine, name)) for name in names})


def _largest(apart: np.ndarray) -> float:
    return float(np.hypot(*apart.T).max())
