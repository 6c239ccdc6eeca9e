"""Search for the number of segments from disk to disk that gives the requested accuracy, in metres.

The error of a mesh falls with the square of its number of segments, so two meshes give the continuous
arm, with an error that falls with the fourth power (Richardson 1911, Phil. Trans. A 210). Meshes of m,
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
"""Error that the search aims at, over the allowed one."""
MOST_TRIALS = 5

Poses = TypeVar("Poses", Trajectory, Equilibrium)


@dataclass(frozen=True)
class Mesh:
    """A number of segments from disk to disk, with the estimate (m) of the remaining largest tip error.

    ``extrapolated`` says that the disks' poses follow from this mesh and one of twice as many segments.
    ``reached`` is False if no mesh that was tried was fine enough.
    """

    subsegments: int
    extrapolated: bool
    estimate: float
    reached: bool


def search_mesh(tips: Callable[[int], np.ndarray | None], allowed: float, most: int) -> Mesh | None:
    """The coarsest mesh found whose tip error is estimated below ``allowed`` (m).

    ``tips`` returns the tip's positions, shape (samples, 2), on a mesh, or None if its run was stopped; then
    the search returns the mesh found so far, or None. ``most`` is the largest number of segments from disk
    to disk.
    """
    found: Mesh | None = None
    subsegments = 1
    for _ in range(MOST_TRIALS):
        if (coarse := tips(subsegments)) is None:
            return found
        if (middle := tips(2 * subsegments)) is None or (fine := tips(4 * subsegments)) is None:
            return found
        limit = richardson(middle, fine)
        plain = _largest(coarse - limit)
        if plain <= allowed:
            return Mesh(subsegments, extrapolated=False, estimate=plain, reached=True)
        estimate = _largest(richardson(coarse, middle) - limit) * 16 / 15
        found = Mesh(subsegments, extrapolated=True, estimate=estimate, reached=estimate <= allowed)
        further = min(ceil(subsegments * (estimate / (AIM * allowed)) ** 0.25), most // 4)
        if found.reached or further <= subsegments:
            break
        subsegments = further
    return found


def richardson(coarse: np.ndarray, fine: np.ndarray) -> np.ndarray:
    """Richardson extrapolation from m and 2m segments."""
    return (4 * fine - coarse) / 3


def extrapolate(coarse: Poses, fine: Poses) -> Poses:
    """The finer of two results with the disks' poses extrapolated; unchanged if the coarser one has none."""
    if isinstance(coarse, Equilibrium) and not coarse.found:
        return fine
    names = ("disk_x", "disk_y", "disk_theta")
    return replace(fine, **{name: richardson(getattr(coarse, name), getattr(fine, name)) for name in names})


def _largest(apart: np.ndarray) -> float:
    return float(np.hypot(*apart.T).max())
