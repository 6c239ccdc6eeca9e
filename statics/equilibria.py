"""Equilibria of a scene, and ramps of them.

What is returned as an equilibrium is one: residual at rounding level. Where there is none, or where it is
not stable, the outcome says so. Under loads without a potential statics alone cannot tell whether it is.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from statics import codegen, search
from statics.arm import Arm
from statics.outcome import Outcome
from statics.scene import Scene
from statics.statics_kernel import RECIPE

MAX_ITERATIONS = 200

_OUTCOMES = {
    search.STABLE: Outcome.COMPLETED,
    search.BALANCED: Outcome.COMPLETED,
    search.UNSTABLE: Outcome.UNSTABLE_EQUILIBRIUM,
    search.LIMIT: Outcome.GEOMETRY_LIMIT,
    search.NOT_FOUND: Outcome.NO_EQUILIBRIUM,
}


@dataclass(frozen=True)
class Equilibrium:
    """An arm at rest under ``tension``, or the search for it where ``found`` is False.

    Arrays have shape (segments,), those of disks (disks,), ``tension`` (cables,), ``load_factor`` (driven
    loads,) or None; ``elongation`` is None in a scene without extension; SI units. ``residual`` is the
    largest unbalanced generalized force, N or N m. ``unstable_directions`` is None where it is not known:
    under loads without a potential, until the modes of small motion have been asked.
    """

    outcome: Outcome
    tension: np.ndarray
    load_factor: np.ndarray | None
    bend_angle: np.ndarray
    elongation: np.ndarray | None
    curvature: np.ndarray
    length: np.ndarray
    disk_x: np.ndarray
    disk_y: np.ndarray
    disk_theta: np.ndarray
    elastic_energy: float
    gravity_energy: float
    unstable_directions: int | None
    iterations: int
    residual: float

    @property
    def found(self) -> bool:
        """Whether this is an equilibrium, stable or not."""
        return self.outcome in (Outcome.COMPLETED, Outcome.UNSTABLE_EQUILIBRIUM)

    @property
    def stable(self) -> bool | None:
        """Whether every small disturbance raises the energy or, by the modes, none grows; None if unknown."""
        if self.found and self.unstable_directions is None:
            return None
        return self.outcome is Outcome.COMPLETED

    @property
    def inputs(self) -> np.ndarray:
        """What drives the scene here: tensions, then factors of loads."""
        return self.tension if self.load_factor is None else np.append(self.tension, self.load_factor)

    @property
    def tip(self) -> tuple[float, float, float]:
        """x, y (m) and theta (rad) of the last disk."""
        return float(self.disk_x[-1]), float(self.disk_y[-1]), float(self.disk_theta[-1])

    @property
    def coordinates(self) -> np.ndarray:
        """The generalized coordinates, shape (segments, dofs): bend angle, and elongation if any."""
        parts = [self.bend_angle] if self.elongation is None else [self.bend_angle, self.elongation]
        return np.column_stack(parts)


class StaticSolver:
    """The kernel and the numbers of one scene, for many equilibria in a row.

    ``load`` makes the kernel: compiled, or interpreted.
    """

    def __init__(self, scene: Scene, load: codegen.Loader = codegen.load) -> None:
        self.scene = scene.at_rest
        self.kernel = load(self.scene, RECIPE)
        self.segments = self.scene.table("segment", self.kernel.SEGMENT_COLUMNS)
        self.disks = self.scene.table("disk", self.kernel.DISK_COLUMNS)

    def solve(self, tension: np.ndarray, start: np.ndarray | None = None) -> Equilibrium:
        """The equilibrium reached from ``start``, shape (segments, dofs); from straight by default.

        ``tension`` holds the scene's inputs: the tensions of its cables, then the factors of driven loads.
        """
        arm = self.scene.arm
        q = np.zeros((arm.segments, len(self.scene.coordinates))) if start is None else start.copy()
        ended, iterations = self.kernel.find_equilibrium(
            q, tension, self.segments, self.disks, arm.rest_length, MAX_ITERATIONS
        )
        pose = np.empty((arm.segments, 3))
        elastic, gravity, residual, negative = self.kernel.examine(
            q, tension, self.segments, self.disks, pose
        )
        elongation = q[:, 1] if q.shape[1] == 2 else None
        disk_x, disk_y, disk_theta = pose[arm.disk_nodes].T
        return Equilibrium(
            outcome=_OUTCOMES[ended],
            tension=tension[: self.scene.cables],
            load_factor=tension[self.scene.cables :] if self.scene.driven_loads else None,
            bend_angle=q[:, 0],
            elongation=elongation,
            **shape_of(arm, q[:, 0], elongation),
            disk_x=disk_x,
            disk_y=disk_y,
            disk_theta=disk_theta,
            elastic_energy=elastic,
            gravity_energy=gravity,
            unstable_directions=None if negative == search.UNKNOWN else negative,
            iterations=iterations,
            residual=residual,
        )

    def ramp(self, tensions: Iterable[np.ndarray], start: np.ndarray | None = None) -> list[Equilibrium]:
        """An equilibrium for each set of tensions, each from the last one that was found."""
        points: list[Equilibrium] = []
        for tension in tensions:
            points.append(self.solve(tension, start))
            if points[-1].found:
                start = points[-1].coordinates
        return points

    def warm_up(self) -> None:
        """Compile the kernel, or load it compiled, so that what follows is solving alone."""
        self.solve(np.zeros(len(self.scene.inputs)))


def shape_of(arm: Arm, bend_angle: np.ndarray, elongation: np.ndarray | None) -> dict[str, np.ndarray]:
    """Curvature (1/m) and length (m) of segments, the paper's k and L, from their coordinates."""
    length = arm.rest_lengths + (np.zeros_like(bend_angle) if elongation is None else elongation)
    return {"curvature": bend_angle / length, "length": length}


def equilibrium(scene: Scene, tension: object = None, start: Equilibrium | None = None) -> Equilibrium:
    """The arm at rest under these tensions, shape (cables,), N; a number will do for a single cable.

    Newton's method from ``start``, or from the straight arm; effects that exist in motion only play no
    part. Look at ``outcome``: an equilibrium that is not known to be unstable is ``completed``. Raises
    ``InputError`` for tensions that do not fit. Rone 2012, Eq. 5.
    """
    values = scene.check_tension(tension)
    return StaticSolver(scene).solve(values, None if start is None else start.coordinates)


def tension_ramp(scene: Scene, tensions: Iterable[object]) -> list[Equilibrium]:
    """Equilibria under one set of tensions after another, each found from the one before it.

    Each element of ``tensions`` is what ``equilibrium`` takes. Where none is found, the next search
    starts from the last one that was. Raises ``InputError`` for tensions that do not fit.
    """
    return StaticSolver(scene).ramp([scene.check_tension(tension) for tension in tensions])
