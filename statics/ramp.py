"""Ramps: stable equilibria for a sequence of inputs, with every jump reported.

From one point of a ramp to the next the path of equilibria is continued. If its slopes at both ends show that
the two lie on one smooth path, this is enough; otherwise it is followed by arc length.
"""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from statics.arc_length import ArcLength, Path
from statics.equilibria import Critical, Equilibrium, Slip, StaticSolver
from statics.outcome import Outcome
from statics.scene import Scene

SMOOTH = 0.25
"""Largest difference of a path's slopes at two points from the line between them, over the line's slope."""
SAME = 1e-6
"""Root of the summed squares of the changes of bend angle, rad, below which two equilibria are the same."""
TOUCHING = 1e-3
"""Such a change below which two paths meet at a branching, where the matrix is singular."""


def tension_ramp(scene: Scene, tensions: Iterable[object]) -> list[Equilibrium]:
    """Equilibria under one set of tensions after another, each found from the one before it.

    Each element of ``tensions`` is one for ``equilibrium``. If none is found, the next search starts from the
    last one found. One that does not continue the one before has ``jumped``, and
    ``lost_at`` is the point that it jumped from, or at which the ramp continues on another branch.
    With friction the first is that of cables drawn in, and every other remembers the one before it. Raises
    ``InputError`` for tensions that do not fit.
    """
    return ramp(StaticSolver(scene), [scene.check_tension(tension) for tension in tensions])


def ramp(
    solver: StaticSolver, points: Iterable[np.ndarray], start: np.ndarray | None = None
) -> list[Equilibrium]:
    """An equilibrium for each set of inputs, each from the last one that was found."""
    found: list[Equilibrium] = []
    before: Equilibrium | Slip = Slip.DRAWN_IN
    can_be_followed = not solver.scene.path_hindrances
    for inputs in points:
        point = solver.solve(inputs, start, before)
        if point.found and can_be_followed and isinstance(before, Equilibrium):
            point = _continued(solver, before, point)
        elif point.outcome is Outcome.GEOMETRY_LIMIT:
            point = _come_to_step_by_step(solver, inputs, before) or point
        found.append(point)
        if point.found:
            start, before = point.coordinates, point
    return found


def _come_to_step_by_step(
    solver: StaticSolver, inputs: np.ndarray, before: Equilibrium | Slip
) -> Equilibrium | None:
    """The stable equilibrium at the end of the path to the inputs, if any: a search from afar may miss it.

    Close to the limit the search's long steps run into it.
    """
    path = _way(solver, inputs, before if isinstance(before, Equilibrium) else None)
    if path is None or path.outcome is not Outcome.COMPLETED or not path.end.stable:
        return None
    return path.end


def limit_on_the_way(
    solver: StaticSolver, inputs: np.ndarray, start: Equilibrium | None
) -> Equilibrium | None:
    """The equilibrium at which the path to inputs without one reaches a geometric limit, if it does.

    The path starts at ``start``, or at slack cables and zero load factors.
    """
    path = _way(solver, inputs, start)
    return path.end if path is not None and path.outcome is Outcome.GEOMETRY_LIMIT else None


def _way(solver: StaticSolver, inputs: np.ndarray, start: Equilibrium | None) -> Path | None:
    if solver.scene.path_hindrances:
        return None
    if start is None:
        drives = solver.scene.cables + solver.scene.driven_loads
        start = solver.solve(np.concatenate([np.zeros(drives), inputs[drives:]]))
    if not start.found:
        return None
    return ArcLength(solver, np.array([start.inputs, inputs])).follow(start)


def _continued(solver: StaticSolver, before: Equilibrium, point: Equilibrium) -> Equilibrium:
    """The equilibrium that continues the one before, or else ``point``, with where the path was lost."""
    arc = ArcLength(solver, np.array([before.inputs, point.inputs]))
    if not point.left and _on_one_smooth_path(arc, before, point):
        return point
    path = arc.follow(before, until_critical=True)
    if path.critical or path.outcome is not Outcome.COMPLETED:
        return replace(point, lost_at=path.end, jumped=not _branches_off(solver, path, point))
    change = path.end.coordinates - point.coordinates
    if np.sqrt(arc.inner(change, change)) < SAME:
        return point
    return replace(path.end, iterations=point.iterations)


def _branches_off(solver: StaticSolver, lost: Path, point: Equilibrium) -> bool:
    """Whether the path back from a point ends where the path before it branches.

    There that path only touches the inputs at which it branches off, which looks like a fold.
    """
    if lost.end.critical is not Critical.BRANCHING:
        return False
    arc = ArcLength(solver, np.array([point.inputs, lost.points[0].inputs]))
    back = arc.follow(point, until_critical=True)
    change = back.end.coordinates - lost.end.coordinates
    return bool(back.critical) and bool(np.sqrt(arc.inner(change, change)) < TOUCHING)


def _on_one_smooth_path(arc: ArcLength, before: Equilibrium, point: Equilibrium) -> bool:
    """Whether both slopes of the path are nearly that of the straight line between the two."""
    way = point.coordinates - before.coordinates
    length = np.sqrt(arc.inner(way, way))
    if length < SAME:
        return point.unstable_directions == before.unstable_directions
    for parameter, end in ((0.0, before), (1.0, point)):
        off = arc.tangent_at(end.coordinates, parameter)[0] - way
        if np.sqrt(arc.inner(off, off)) > SMOOTH * length:
            return False
    return True
