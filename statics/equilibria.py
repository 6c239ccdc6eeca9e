"""Equilibria of a scene, one at a time.

Every returned equilibrium has a residual at rounding level. If there is none, or if it is not stable, the
outcome says so. Under loads without a potential, statics alone cannot decide its stability.
"""

from dataclasses import dataclass, replace
from enum import IntEnum
from functools import partial
from typing import Any

import numpy as np

from statics.arm import Arm
from statics.effects.cable_friction import FAR, SLIP_PART
from statics.effects.cables import Poses, cable_lengths
from statics.errors import NotFoundError
from statics.kernels.loading import Loader, load
from statics.outcome import Outcome
from statics.passes import newton, pseudo_transient, search, sticking
from statics.passes.rest_passes import REST
from statics.scene import Scene

MAX_ITERATIONS = 200
MOST_STICKING = 100
"""Largest number of iterations of a search for cables that stick."""
SHORTEST_STEP = 1 / 8
"""Shortest step of such a search from the inputs before to the requested ones, over the whole distance."""
MORE_STEPS = 5
"""Largest number of further steps of a search whose last step was small but left a force unbalanced."""
SLIP_PARTS = (1e-3, 1e-4, 1e-5, SLIP_PART)
"""Slip lengths of a release over the arm's length, from soft to the actual one."""

_OUTCOMES = {
    search.STABLE: Outcome.COMPLETED,
    search.BALANCED: Outcome.COMPLETED,
    search.UNSTABLE: Outcome.UNSTABLE_EQUILIBRIUM,
    search.LIMIT: Outcome.GEOMETRY_LIMIT,
    search.NOT_FOUND: Outcome.NO_EQUILIBRIUM,
}
_FOUND = (search.STABLE, search.BALANCED, search.UNSTABLE)


class Critical(IntEnum):
    """Change of a path of equilibria at one that is about to lose or gain stability."""

    NO = 0
    FOLD = 1
    BRANCHING = 2


@dataclass(frozen=True)
class Equilibrium:
    """An arm at rest under ``tension``, or the failed search for it if ``found`` is False.

    Arrays have shape (segments,), those of disks (disks,), ``tension`` (cables,), ``load_factor`` (driven
    loads,) or None; ``elongation`` is None in a scene without extension, the base's pose in an arm without
    ``base``; SI units. ``inputs`` are the scene's, without
    motion; ``tension`` is that at the base and ``cable_displacement`` the length drawn in there, m.
    ``residual`` is the largest unbalanced generalized force, N or N m. ``unstable_directions`` is None if
    it is not known: under loads without a potential, until the modes of small motion are computed.
    ``left`` are the unstable equilibria that the search has reached and left, in this order. Along a ramp
    ``critical`` says where its path of equilibria folds or branches, and ``lost_at`` is where the path from
    the equilibrium before left the stable ones, if it did. Then this one has ``jumped``, unless it lies on a
    path that branches off there.
    """

    outcome: Outcome
    inputs: np.ndarray
    tension: np.ndarray
    cable_displacement: np.ndarray
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
    base_x: float | None = None
    base_y: float | None = None
    base_theta: float | None = None
    left: tuple["Equilibrium", ...] = ()
    critical: Critical = Critical.NO
    lost_at: "Equilibrium | None" = None
    jumped: bool = False

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
    def drive(self) -> str:
        """Tensions and load factors, in words."""
        parts = []
        if self.tension.size:
            parts.append(f"tension {', '.join(f'{tau:g}' for tau in self.tension)} N")
        if self.load_factor is not None:
            parts.append(f"load factor {', '.join(f'{factor:g}' for factor in self.load_factor)}")
        return f"at {' and '.join(parts)}" if parts else "without cables"

    @property
    def tip(self) -> tuple[float, float, float]:
        """x, y (m) and theta (rad) of the last disk.

        Raises ``NotFoundError`` if no equilibrium was found: then the arrays hold the end of the search.
        """
        if not self.found:
            raise NotFoundError(
                f"no equilibrium was found {self.drive} ({self.outcome}), so the tip has no position. Check "
                "'found' first; disk_x, disk_y and disk_theta are the shape at which the search ended."
            )
        return float(self.disk_x[-1]), float(self.disk_y[-1]), float(self.disk_theta[-1])

    @property
    def poses(self) -> Poses:
        """Poses of the base and all disks."""
        base = (0.0 if value is None else value for value in (self.base_x, self.base_y, self.base_theta))
        of_disks = zip(base, (self.disk_x, self.disk_y, self.disk_theta), strict=True)
        x, y, theta = (np.append(start, values) for start, values in of_disks)
        return x, y, theta

    @property
    def coordinates(self) -> np.ndarray:
        """The generalized coordinates, shape (segments, dofs): bend angle, and elongation if any."""
        parts = [self.bend_angle] if self.elongation is None else [self.bend_angle, self.elongation]
        return np.column_stack(parts)


def _outcome(ended: int, negative: int) -> Outcome:
    """Outcome of a search, with the number of unstable directions if it is known."""
    if ended == search.BALANCED and negative > 0:
        return Outcome.UNSTABLE_EQUILIBRIUM
    return _OUTCOMES[ended]


class Slip(IntEnum):
    """Direction in which all cables with friction have slipped: the two branches of a ramp."""

    DRAWN_IN = 1
    LET_OUT = -1


class StaticSolver:
    """The kernel and the numbers of one scene, for many equilibria in a row.

    ``load`` makes the kernel: compiled, or interpreted.
    """

    def __init__(self, scene: Scene, load: Loader = load) -> None:
        self.scene = scene.at_rest
        self.kernel = load(self.scene.structure, REST)
        self.segments = self.scene.table("segment", self.kernel.segment_columns)
        self.disks = self.scene.table("disk", self.kernel.disk_columns)
        self.rubbing = self._columns_of_rubbing_cables()

    def _columns_of_rubbing_cables(self) -> np.ndarray:
        """Columns of every cable that rubs, shape (cables that rub, 3), as ``sticking`` takes them."""
        chain, segment = self.kernel.chain_columns.index, self.kernel.segment_columns.index
        return np.array(
            [
                (chain(f"length_beyond_{c}"), segment(f"length_before_{c}"), segment(f"slip_length_{c}"))
                for c, kind in enumerate(self.scene.cable_kinds, start=1)
                if kind.rubs
            ],
            dtype=float,
        )

    def solve(
        self,
        inputs: np.ndarray,
        start: np.ndarray | None = None,
        before: "Equilibrium | Slip" = Slip.DRAWN_IN,
    ) -> Equilibrium:
        """The equilibrium reached from ``start``, shape (segments, dofs); from straight by default.

        ``inputs`` are the scene's, ``Scene.inputs``; those of a base's motion play no part. ``before`` is
        the equilibrium before, or the direction in which the cables last slipped; only friction uses it.
        """
        arm = self.scene.arm
        q = np.zeros((arm.segments, len(self.scene.coordinates))) if start is None else start
        inputs = np.ascontiguousarray(inputs, dtype=float)  # rows of several lists have strides
        self._remember(before)
        if not self.rubbing.size or isinstance(before, Slip):
            return self._release(q, inputs)
        return self._search_from(before, q, inputs)

    def _search_from(self, before: Equilibrium, start: np.ndarray, inputs: np.ndarray) -> Equilibrium:
        """The stable equilibrium reached from the one before, by the first search that finds one.

        Failing that, an unstable one, or the failed search of a released arm.
        """
        stick, stick_exactly = (partial(self._stick, exactly=exactly) for exactly in (False, True))
        searches = [stick, self._release, stick_exactly, partial(self._stick_step_by_step, before)]
        if not self.kernel.passes.eliminate_held:  # a release leaves what is unstable, the others do not know
            searches[:2] = self._release, stick
        iterations, tried = 0, list[Equilibrium]()
        for search_from in searches:
            point = search_from(start, inputs)
            iterations += point.iterations
            if point.found and point.stable is not False:
                return replace(point, iterations=iterations)
            tried.append(point)
        best = next((point for point in tried if point.found), tried[searches.index(self._release)])
        return replace(best, iterations=iterations)

    def _release(self, start: np.ndarray, inputs: np.ndarray) -> Equilibrium:
        """The equilibrium that a released arm reaches, through larger slip lengths."""
        arm, left, q = self.scene.arm, list[Equilibrium](), start.copy()
        ended, iterations, passes = search.NOT_FOUND, 0, self.kernel.passes
        for slip_part in SLIP_PARTS if self.rubbing.size else (0.0,):
            self._set("slip_length", np.full(arm.segments, slip_part * arm.total_length))
            ended, more = self._find(q, inputs, MAX_ITERATIONS)
            iterations += more
            while ended == search.UNSTABLE and iterations < MAX_ITERATIONS:
                left.append(self.examine(q, inputs, ended, iterations))
                if not newton.leave_saddle(passes, q, inputs, self.segments, self.disks, arm.rest_length):
                    return left.pop()
                ended, more = self._find(q, inputs, MAX_ITERATIONS - iterations)
                iterations += more
        found = self.examine(q, inputs, ended, iterations)
        for _ in range(MORE_STEPS if ended == search.STABLE else 0):
            if found.found:
                break
            ended, more = self._find(q, inputs, MAX_ITERATIONS)
            iterations += more
            found = self.examine(q, inputs, ended, iterations)
        return replace(found, left=tuple(left)) if left else found

    def _stick(self, start: np.ndarray, inputs: np.ndarray, *, exactly: bool) -> Equilibrium:
        """The equilibrium of cables with friction, which stick or slip from their earlier position.

        An exact search takes a few times as long for an iteration, and finds what friction couples strongly.
        """
        arm, passes, q = self.scene.arm, self.kernel.passes, start.copy()
        self._set("slip_length", np.full(arm.segments, SLIP_PART * arm.total_length))
        numbers = (inputs, self.segments, self.disks, arm.rest_length)
        ended, iterations = sticking.find_sticking(passes, q, *numbers, self.rubbing, exactly, MOST_STICKING)
        if ended == search.BALANCED and not exactly:
            ended, more = self._find(q, inputs, MAX_ITERATIONS)
            iterations += more
        return self.examine(q, inputs, ended, iterations)

    def _stick_step_by_step(self, before: Equilibrium, start: np.ndarray, inputs: np.ndarray) -> Equilibrium:
        """The equilibrium as from ``_stick``, through intermediate inputs from the ones before.

        All of them start from the same one before, so the choice of the steps does not matter.
        """
        part, step, iterations = 0.0, 0.5, 0
        while step >= SHORTEST_STEP:
            trial = min(part + step, 1.0)
            point = self._stick(start, before.inputs + trial * (inputs - before.inputs), exactly=True)
            iterations += point.iterations
            if not point.found:
                step *= 0.5
            elif trial == 1.0:
                return replace(point, iterations=iterations)
            else:
                part, start = trial, point.coordinates
        return self.examine(start, inputs, search.NOT_FOUND, iterations)

    def _find(self, q: np.ndarray, inputs: np.ndarray, most: int) -> tuple[int, int]:
        """Move q to an equilibrium; returns how the search ended, and its iterations."""
        numbers = (inputs, self.segments, self.disks, self.scene.arm.rest_length)
        find = newton.find_stable if self.kernel.conservative else pseudo_transient.find_balance
        return find(self.kernel.passes, q, *numbers, most)

    def examine(self, q: np.ndarray, inputs: np.ndarray, ended: int, iterations: int = 0) -> Equilibrium:
        """Equilibrium at coordinates, shape (segments, dofs), at which a search has ``ended``."""
        arm, q = self.scene.arm, q.copy()
        pose = np.empty((arm.segments, 3))
        examine = newton.examine_stability if self.kernel.conservative else pseudo_transient.examine_balance
        elastic, gravity, residual, negative, balanced = examine(
            self.kernel.passes, q, inputs, self.segments, self.disks, arm.rest_length, pose
        )
        elongation = q[:, 1] if q.shape[1] == 2 else None
        disk_x, disk_y, disk_theta = pose[arm.disk_nodes].T
        driven = self.scene.driven_by(inputs, disk_x, disk_y, disk_theta)
        numbers = (q, pose, driven["tension"], driven["cable_displacement"], (elastic, gravity, residual))
        if (ended in _FOUND and not balanced) or not np.isfinite(np.concatenate(numbers, axis=None)).all():
            ended = search.NOT_FOUND
        return Equilibrium(
            outcome=_outcome(ended, negative),
            inputs=self.scene.with_zero_rates(inputs),
            **driven,
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

    def _remember(self, before: "Equilibrium | Slip") -> None:
        """Put the earlier lengths of the cables, from which they slip, into the table."""
        if not self.rubbing.size:
            return
        arm = self.scene.arm
        if isinstance(before, Slip):
            lengths = [np.full(arm.disks, before * FAR * arm.total_length) for _ in arm.cables]
        else:
            ways = [cable_lengths(cable, before.poses) for cable in arm.cables]
            starts = [cable.start or 0 for cable in arm.cables]
            ways = [
                np.pad(way, (start, arm.disks - start - way.size))
                for start, way in zip(starts, ways, strict=True)
            ]
            lengths = [np.cumsum(way[::-1])[::-1] for way in ways]
        for number, beyond in enumerate(lengths, start=1):
            self._set(f"length_before_{number}", np.repeat(beyond, arm.subsegments))

    def _set(self, name: str, values: np.ndarray) -> None:
        """Fill the columns of a quantity, numbered or not, if the kernel has them."""
        for column, known in enumerate(self.kernel.segment_columns):
            if known == name or known.rpartition("_")[0] == name:
                self.segments[:, column] = values

    def rests(self, near: Equilibrium) -> list[Equilibrium]:
        """Equilibria between which the arm may rest under the inputs of a found one: usually that one alone.

        Cables that rub may leave it anywhere on the way between the branch of cables drawn in and that of
        cables let out, if there are both; the equilibrium lies on it.
        """
        if not self.rubbing.size or not near.found:
            return [near] if near.found else []
        drawn_in, let_out = (self.solve(near.inputs, near.coordinates, slip) for slip in Slip)
        return [point for point in (drawn_in, near, let_out) if point.found]

    def warm_up(self) -> None:
        """Compile the kernel, or load it, so that later calls only solve."""
        inputs = np.zeros(len(self.scene.inputs))
        rest = self.solve(inputs)
        if self.rubbing.size:
            self.solve(inputs, rest.coordinates, rest)


def shape_of(arm: Arm, bend_angle: np.ndarray, elongation: np.ndarray | None) -> dict[str, Any]:
    """Curvature (1/m) and length (m) of segments, the paper's k and L, from their coordinates."""
    length = arm.rest_lengths + (np.zeros_like(bend_angle) if elongation is None else elongation)
    return {"curvature": bend_angle / length, "length": length}


def equilibrium(
    scene: Scene,
    tension: object = None,
    start: Equilibrium | None = None,
    before: Equilibrium | Slip = Slip.DRAWN_IN,
) -> Equilibrium:
    """The arm at rest under these tensions, shape (cables,), N; a number will do for a single cable.

    For a cable that is driven by its length it is the displacement, m. Newton's method from ``start``, or
    from the straight arm; effects that exist in motion only are ignored. ``before`` is the equilibrium that
    the arm comes from, or the direction in which its cables have slipped: with friction there are two
    branches, and equilibria between them. The ``outcome`` of a stable equilibrium is ``completed``. Raises
    ``InputError`` for tensions that do not fit. Rone 2012, Eq. 5.
    """
    values = scene.check_tension(tension)
    return StaticSolver(scene).solve(values, None if start is None else start.coordinates, before)
