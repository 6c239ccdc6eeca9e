"""The exact planar rod between the disks: an independent judge of the constant-curvature model.

Each span is an elastica (Love 1944, sec. 262) between rigid, point-like disks, with s from 0 to L0
along its undeformed length and the internal force F and moment M of all that lies beyond::

    dtheta/ds = k0 + M / EJ      dr/ds = (1 + F.t / EA) t      dM/ds = -dr/ds x F      dF/ds = -w

with t = (cos theta, sin theta). The core's own weight w, per undeformed length, acts if it has any: else F
is constant over a span. F.t / EA is left out in a scene without extension. There is no shear. Curvature is
measured per *undeformed* length, so the energy of a span is the integral of EJ (theta' - k0)^2 / 2
+ EA eps^2 / 2 over L0: with constant theta' = phi / L0 and eps = e / L0 it is that of the program's laws,
moment (EJ / L0)(phi - k0 L0) and force (EA / L0) e. The constant-curvature arm is this rod with fewer shapes
to choose from. Per deformed length, the bending law would differ from the program's by the strain.

Solved by multiple shooting on the internal loads, each piece of the core in the frame of the node that
it starts from, in which its weight has a direction that follows from the pieces before. What has to vanish
is the unbalance of every node. Nodes are the disks and, where the loads are large, points between them: a
piece that carries less than pi^2 EJ / length^2 is stable while its ends are held (the second variation of
its energy is the integral of EJ eta'^2 + F.t eta^2), so the arm is stable where the compliance of its nodes
has no negative eigenvalue. Nothing here knows the segment, the chain or the kernels.
"""

from dataclasses import dataclass, replace
from math import ceil, pi, sqrt
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from statics.effects import Bending, Cables, DiskLoads, Extension, Gravity
from statics.errors import ContinuumError, InputError
from statics.scene import Scene

KNOWN_EFFECTS = (Bending.name, Cables.name, Extension.name, Gravity.name, DiskLoads.name)

MAX_FORCE = (pi / 2) ** 2  # on a piece, in its EJ / length^2: a margin of 4 for what the strain adds
MAX_TURN = 1.0  # of a node in one step of the loads, rad: keeps to the branch that starts unloaded
MAX_BEND = 4.0  # of a piece in one Newton step, rad: beyond it the step is hopeless
SMALLEST_LOAD_STEP = 1e-5
MET = 0.01  # of the disk spacing: holes that near pull in no certain direction
NEGATIVE = -1e-9  # of the largest eigenvalue: an inextensible core has zeros, give or take rounding
MAX_ITERATIONS = 12
STEP_TOLERANCE = 1e-10  # Newton is quadratic here: what the last step leaves is rounding
ROUNDING = 1e-15  # of an angle, rad
MAX_THETA = 25.0  # within a piece, rad: Gauss's points resolve its cosine to 1e-13 up to there
MAX_SWEEPS = 60
SWEPT = 1e-14  # of the moments: the next sweep would change them by far less
NUDGE = 1e-30  # of the complex step: f(x + i NUDGE) = f(x) + i NUDGE f'(x), without cancellation


def _gauss(number: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Gauss's points in (0, 1), and the weights of integrals from 0 to each of them and to 1."""
    z, weights = legendre.leggauss(number)
    values = legendre.legvander(z, number)  # P_k at the points
    primitive = np.column_stack([1 + z, *(values[:, k + 1] - values[:, k - 1] for k in range(1, number))])
    primitive[:, 1:] /= 2 * np.arange(1, number) + 1  # integrals of P_k from -1 on
    to_coefficients = (np.arange(number) + 0.5)[:, None] * values[:, :number].T * weights
    return (1 + z) / 2, primitive @ to_coefficients / 2, weights[None] / 2


POINTS, UP_TO_POINTS, TO_THE_END = _gauss(32)


class RodError(ContinuumError):
    """No stable equilibrium of the exact rod is found under the full loads."""


@dataclass(frozen=True)
class RodShape:
    """An exact rod in stable equilibrium: poses of its disks, shape (disks,), m and rad.

    ``residual`` is the largest unbalanced force (N) or moment (N m) on a disk or a node.
    """

    disk_x: np.ndarray
    disk_y: np.ndarray
    disk_theta: np.ndarray
    residual: float

    @property
    def tip(self) -> tuple[float, float, float]:
        """x, y (m) and theta (rad) of the last disk."""
        return float(self.disk_x[-1]), float(self.disk_y[-1]), float(self.disk_theta[-1])


class _Cable(NamedTuple):
    name: str
    hole_offset: float
    anchor: int
    tension: float


@dataclass(frozen=True)
class _Rod:
    """A loaded rod in the units of its pieces: their length, force EJ / length^2, moment EJ / length."""

    length: float  # of a piece, m
    force: float  # the unit, N
    parts: int  # pieces from disk to disk
    rest_bend: float  # k0 length, rad
    softness: float  # the unit of force over EA; 0 if the core cannot extend
    dead_load: np.ndarray  # force and moment on each disk, shape (disks, 3)
    weight: np.ndarray  # of a piece, in the frame of the base, shape (2,)
    cables: tuple[_Cable, ...]

    def under(self, part: float) -> "_Rod":
        """This rod under a part of its loads."""
        cables = tuple(cable._replace(tension=part * cable.tension) for cable in self.cables)
        return replace(self, dead_load=part * self.dead_load, weight=part * self.weight, cables=cables)


def exact_rod(scene: Scene, tension: object = None) -> RodShape:
    """The exact rod of this scene at rest under these tensions, shape (cables,), N.

    A cantilever from the arm's base, followed from no load to the full loads as long as it is
    stable. Effects that exist in motion only are ignored. Raises ``InputError`` for tensions that do
    not fit and for effects that the rod does not have, ``RodError`` if it buckles, snaps or comes to
    the end of its geometry before the full loads are on.
    """
    values = scene.check_tension(tension)[: scene.cables]
    if scene.arm.base_moves:
        raise InputError("the exact rod has a fixed base; leave out the motion of the base.")
    _check(scene.at_rest)
    rod = _rod(scene, values)
    loads = _follow_loads(rod)
    _, ends = _hung_ends(rod, loads)
    pose = _node_poses(ends)[rod.parts :: rod.parts]
    base_x, base_y, base_theta = scene.arm.base_pose
    x, y = _turned(pose[:, :2] * rod.length, np.array([0.0, 0.0, base_theta])).T
    unbalanced = _unbalance(rod, loads, ends) * (rod.force, rod.force, rod.force * rod.length)
    return RodShape(
        disk_x=base_x + x,
        disk_y=base_y + y,
        disk_theta=base_theta + pose[:, 2],
        residual=float(np.abs(unbalanced).max()),
    )


def _check(scene: Scene) -> None:
    unknown = [effect.name for effect in scene.effects if effect.name not in KNOWN_EFFECTS]
    if unknown:
        raise InputError(
            f"the exact rod has no effect {', '.join(unknown)}. Its effects: {', '.join(KNOWN_EFFECTS)}."
        )
    if scene.arm.holes_differ or any(values is not None for values in vars(scene.arm.each).values()):
        raise InputError("the exact rod is for arms of equal segments only.")
    if scene.driven_loads:
        raise InputError("the exact rod has no loads that change in time.")
    if any(kind.coupled for kind in scene.cable_kinds):
        raise InputError("the exact rod has cables of given tension only, without friction.")
    if any(cable.start for cable in scene.arm.cables[: scene.cables]):
        raise InputError("the exact rod has only cables that start at the base.")
    if scene.has_followers:
        raise InputError("the exact rod has no follower loads.")
    if scene.arm.payloads:
        raise InputError("the exact rod has no payloads.")
    if not scene.has(Bending.name):
        raise InputError("the exact rod needs effect 'bending'. Add it to the scene.")


def _rod(scene: Scene, tension: np.ndarray) -> _Rod:
    """The scene's numbers, with spans cut so that no piece can carry more than ``MAX_FORCE``."""
    arm, dead_load, weight = scene.arm, _dead_load(scene), _core_weight(scene)
    bending_stiffness = _given(arm.youngs_modulus) * _given(arm.second_moment)
    axial_stiffness = _given(arm.youngs_modulus) * _given(arm.area) if scene.has(Extension.name) else np.inf
    largest_force = np.hypot(*dead_load[:, :2].T).sum() + np.hypot(*weight) + tension.sum()
    parts = max(1, ceil(arm.disk_spacing * sqrt(largest_force / bending_stiffness / MAX_FORCE)))
    length = arm.disk_spacing / parts
    force = bending_stiffness / length**2
    cables = tuple(
        _Cable(cable.name, cable.holes(0)[0] / length, cable.anchor or arm.disks, tau / force)
        for cable, tau in zip(arm.cables if tension.size else (), tension, strict=True)
    )
    return _Rod(
        length=length,
        force=force,
        parts=parts,
        rest_bend=arm.reference_curvature * length,
        softness=force / axial_stiffness,
        dead_load=dead_load / (force, force, force * length),
        weight=weight / (arm.disks * parts) / force,
        cables=cables,
    )


def _given(number: float | None) -> float:
    """A number of the arm, which the scene guarantees."""
    assert number is not None
    return number


def _dead_load(scene: Scene) -> np.ndarray:
    """Weights and dead loads of the disks, in base axes: force and moment, shape (disks, 3), N and N m."""
    total = np.zeros((scene.arm.disks, 3))
    for effect in scene.effects:
        if isinstance(effect, Gravity):
            total[:, :2] += _given(scene.arm.disk_mass) * np.array(effect.acceleration)
        if isinstance(effect, DiskLoads):
            for load in effect.loads:
                total[load.disk - 1] += (*load.force, load.moment)
    total[:, :2] = _turned(total[:, :2], np.array([0.0, 0.0, -scene.arm.base_pose[2]]))
    return total


def _core_weight(scene: Scene) -> np.ndarray:
    """Weight of the core by itself, shape (2,), N."""
    gravity = [effect.acceleration for effect in scene.effects if isinstance(effect, Gravity)]
    return scene.arm.core_masses.sum() * np.sum([(0.0, 0.0), *gravity], axis=0)


def _follow_loads(rod: _Rod) -> np.ndarray:
    """Internal force and moment at the start of each piece under the full loads, shape (nodes, 3).

    From the unloaded rod, whose internal loads are zero, by steps that halve if they fail.
    """
    loads = np.zeros((len(rod.dead_load) * rod.parts, 3))
    reached, step = 0.0, 1.0
    while reached < 1.0:
        part = min(reached + step, 1.0)
        try:
            loads = _balanced(rod.under(part), loads)
        except RodError as reason:
            step /= 2
            if step < SMALLEST_LOAD_STEP:
                ending = _holes_met(rod, loads) or reason
                raise RodError(
                    f"the exact rod has a solution only up to {reached:.2%} of the loads: {ending}."
                ) from reason
        else:
            reached, step = part, 2 * step
    return loads


def _balanced(rod: _Rod, start: np.ndarray) -> np.ndarray:
    """Internal loads that balance every node, by Newton's method from ``start``.

    A step more than half as long as the one before it ends the search, lest it finds another branch
    (Deuflhard 2011, sec. 5.1). Raises ``RodError`` with the reason if they are not found near ``start``.
    """
    loads, longest = start, np.inf
    for _ in range(MAX_ITERATIONS):
        unbalance, matrix, _ = _newton_system(rod, loads)
        step = _solved(matrix, unbalance).reshape(loads.shape)
        length = np.abs(step).max()
        if length > longest or np.abs(step[:, 2]).max() > MAX_BEND:
            break
        loads, longest = loads - step, length / 2
        if length < STEP_TOLERANCE * max(1.0, np.abs(loads).max()):
            _check_geometry(rod, start, loads)
            _check_stability(rod, loads)
            return loads
    raise RodError("above, no equilibrium was found")


def _solved(matrix: np.ndarray, right_side: np.ndarray) -> np.ndarray:
    try:
        return np.linalg.solve(matrix, right_side)
    except np.linalg.LinAlgError:
        raise RodError("there, the arm is neutrally stable") from None


def _check_geometry(rod: _Rod, before: np.ndarray, loads: np.ndarray) -> None:
    """Refuse a shape that is far from the one before, or that is no arm any more."""
    angles, ends = _hung_ends(rod, loads)
    pose = _node_poses(ends)
    turn = pose[:, 2] - _node_poses(_hung_ends(rod, before)[1])[:, 2]
    if np.abs(turn).max() > MAX_TURN:
        raise RodError("above, the arm snaps to another shape")
    if any((_gaps(cable, pose[:: rod.parts]) <= 0).any() for cable in rod.cables):
        raise RodError("above, holes would pass each other")
    at_end = loads[:, :2] - _weight_in_frame(rod, angles)
    axial = np.concatenate([loads[:, 0], (at_end * _tangents(ends)).sum(axis=1)])
    if (1 + rod.softness * axial <= 0).any():
        raise RodError("there, the core is compressed to zero length")


def _check_stability(rod: _Rod, loads: np.ndarray) -> None:
    """Refuse a shape where some small dead load on the nodes would do negative work."""
    _, unbalance_by_loads, pose_by_loads = _newton_system(rod, loads)
    compliance = _solved(unbalance_by_loads.T, pose_by_loads.T)
    eigenvalues = np.linalg.eigvalsh((compliance + compliance.T) / 2)
    if eigenvalues[0] < NEGATIVE * np.abs(eigenvalues).max():
        raise RodError("above, the arm is not stable")


def _holes_met(rod: _Rod, loads: np.ndarray) -> str | None:
    """Name of the cable of which two holes have all but met, as the end of a sentence."""
    pose = _node_poses(_hung_ends(rod, loads)[1])[:: rod.parts]
    met = [cable.name for cable in rod.cables if _gaps(cable, pose).min() < MET * rod.parts]
    return f"there, holes of cable '{met[0]}' meet" if met else None


def _newton_system(rod: _Rod, loads: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unbalance of all nodes, and its and their poses' derivatives by all internal loads.

    Shapes (3 nodes,), (3 nodes, 3 nodes) twice. By complex steps; a piece's end depends on that piece's
    loads and its start's angle alone, so four nudges of each give all that has to be integrated.
    """
    angles, ends = _hung_ends(rod, loads)
    nudges = 1j * NUDGE * np.eye(4)[:, None, :]
    by_own = np.imag(_piece_ends(rod, loads + nudges[..., :3], angles + nudges[..., 3])) / NUDGE
    directions = np.eye(loads.size).reshape(-1, *loads.shape)
    change, turn = np.empty((loads.size, *ends.shape)), np.zeros((loads.size, 1))
    for piece in range(len(loads)):
        change[:, piece] = directions[:, piece] @ by_own[:3, piece] + turn * by_own[3, piece]
        turn = turn + change[:, piece, 2:3]
    ends = ends + 1j * NUDGE * change
    unbalance = _unbalance(rod, loads + 1j * NUDGE * directions, ends).reshape(loads.size, loads.size)
    pose = _node_poses(ends)[:, 1:].reshape(loads.size, loads.size)
    return np.real(unbalance[0]), np.imag(unbalance).T / NUDGE, np.imag(pose).T / NUDGE


def _hung_ends(rod: _Rod, loads: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Angles of the pieces' starts, shape (nodes,), and their ends under them, as ``_piece_ends`` has them.

    A piece's angle matters to its own weight only; from pass to pass one more piece has its final one, or
    all, sooner, to rounding.
    """
    angles = np.zeros(len(loads))
    for _ in range(len(loads)):
        ends = _piece_ends(rod, loads, angles)
        before, angles = angles, _node_poses(ends)[:-1, 2]
        if not rod.weight.any() or np.abs(angles - before).max() < ROUNDING:
            return angles, ends
    return angles, _piece_ends(rod, loads, angles)


def _piece_ends(rod: _Rod, loads: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Pose of each piece's end in the frame of its start, and moment there, shape (..., nodes, 4).

    ``loads``, shape (..., nodes, 3), are force and moment at the start, in that frame, ``angles``, shape
    (..., nodes), those of the frames; real or complex, in lengths, rad and the rod's units. By collocation
    at Gauss's points, from moments to angles and back until they stay (Picard): each sweep gains two powers
    of s, and what a piece may carry is so little that about ten are enough.
    """
    force_x, force_y, moment = np.moveaxis(loads, -1, 0)
    weight_x, weight_y = np.moveaxis(_weight_in_frame(rod, angles), -1, 0)
    along, across = (
        force - np.multiply.outer(POINTS, weight)
        for force, weight in ((force_x, weight_x), (force_y, weight_y))
    )

    def over_points(rates: np.ndarray, weights: np.ndarray) -> np.ndarray:
        return (weights @ rates.reshape(len(POINTS), -1)).reshape(-1, *moment.shape)

    carried = np.broadcast_to(moment, along.shape)
    for _ in range(MAX_SWEEPS):
        before, theta = carried, over_points(rod.rest_bend + carried, UP_TO_POINTS)
        if np.abs(np.real(theta)).max() > MAX_THETA:
            break
        cosine, sine = np.cos(theta), np.sin(theta)
        stretch = 1 + rod.softness * (along * cosine + across * sine)
        unbending = stretch * (across * cosine - along * sine)
        carried = moment - over_points(unbending, UP_TO_POINTS)
        if _same(carried, before):
            rates = stretch * cosine, stretch * sine, rod.rest_bend + carried, -unbending
            x, y, theta, change = (over_points(rate, TO_THE_END)[0] for rate in rates)
            return np.stack([x, y, theta, moment + change], axis=-1)
    raise RodError("there, a part of the core bends too sharply to be resolved")


def _same(moments: np.ndarray, before: np.ndarray) -> bool:
    """Whether moments differ by rounding alone, and so do their slopes, which are nudged by ``NUDGE``."""
    pairs = [(np.real(moments), np.real(before))]
    if np.iscomplexobj(moments):
        pairs.append((np.imag(moments) / NUDGE, np.imag(before) / NUDGE))
    return all(np.abs(one - two).max() <= SWEPT * max(1.0, np.abs(one).max()) for one, two in pairs)


def _weight_in_frame(rod: _Rod, angles: np.ndarray) -> np.ndarray:
    """A piece's weight in a frame at that angle, shape (..., nodes, 2)."""
    cosine, sine = np.cos(angles), np.sin(angles)
    x, y = rod.weight
    return np.stack([cosine * x + sine * y, cosine * y - sine * x], axis=-1)


def _node_poses(ends: np.ndarray) -> np.ndarray:
    """Poses of the base and the nodes, shape (..., nodes + 1, 3), from the pieces' ends."""
    pose = np.zeros((*ends.shape[:-2], ends.shape[-2] + 1, 3), dtype=ends.dtype)
    pose[..., 1:, 2] = np.cumsum(ends[..., 2], axis=-1)
    pose[..., 1:, :2] = np.cumsum(_turned(ends[..., :2], pose[..., :-1, :]), axis=-2)
    return pose


def _unbalance(rod: _Rod, loads: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Force and moment that each node lacks for balance, shape (..., nodes, 3).

    What the piece before it carries at its end, less what the next one carries at its start, less the
    load of the disk.
    """
    pose = _node_poses(ends)
    at_start = np.concatenate([_turned(loads[..., :2], pose[..., :-1, :]), loads[..., 2:]], axis=-1)
    unbalance = np.concatenate([at_start[..., :2] - rod.weight, ends[..., 3:]], axis=-1)
    unbalance[..., :-1, :] -= at_start[..., 1:, :]
    of_disks = unbalance[..., rod.parts - 1 :: rod.parts, :]
    of_disks -= rod.dead_load
    for cable in rod.cables:
        _subtract_pull(cable, pose[..., :: rod.parts, :], of_disks)
    return unbalance


def _subtract_pull(cable: _Cable, pose: np.ndarray, unbalance: np.ndarray) -> None:
    """Take a cable's pull towards the neighbouring holes from each disk. Rone 2012, Eq. 22-25."""
    hole = _holes(cable, pose)
    gap = np.diff(hole, axis=-2)
    pull = cable.tension * gap / np.sqrt((gap**2).sum(axis=-1, keepdims=True))
    on_disk = -pull
    on_disk[..., :-1, :] += pull[..., 1:, :]
    lever = (hole - pose[..., : cable.anchor + 1, :2])[..., 1:, :]
    unbalance[..., : cable.anchor, :2] -= on_disk
    unbalance[..., : cable.anchor, 2] -= _cross(lever, on_disk)


def _holes(cable: _Cable, pose: np.ndarray) -> np.ndarray:
    """Holes of a cable from the base to its anchor, shape (..., anchor + 1, 2)."""
    passed = pose[..., : cable.anchor + 1, :]
    return passed[..., :2] + _turned(np.array([0.0, cable.hole_offset]), passed)


def _gaps(cable: _Cable, pose: np.ndarray) -> np.ndarray:
    """From hole to hole along a span's mean direction, shape (anchor,): negative past each other."""
    along = _tangents((pose[1:] + pose[:-1]) / 2)[: cable.anchor]
    return (np.diff(_holes(cable, pose), axis=0) * along).sum(axis=1)


def _tangents(pose: np.ndarray) -> np.ndarray:
    """Unit vectors along +x of each pose's frame, shape (..., 2)."""
    return np.stack([np.cos(pose[..., 2]), np.sin(pose[..., 2])], axis=-1)


def _turned(vector: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Vectors given in the frames of the poses, in the frame of the base; shape (..., 2)."""
    cosine, sine = np.cos(pose[..., 2]), np.sin(pose[..., 2])
    x, y = vector[..., 0], vector[..., 1]
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)


def _cross(lever: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Moment of a force about the origin of its lever."""
    return lever[..., 0] * force[..., 1] - lever[..., 1] * force[..., 0]
