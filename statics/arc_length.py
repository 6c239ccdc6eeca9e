"""Paths of equilibria by arc length, through folds, at which a load cannot grow any further.

Along a ramp of inputs both the coordinates q and the ramp's parameter are unknown, and the step is given as
a length along the path (Riks 1979; Crisfield 1981; Keller 1977):

    r(q, parameter) = 0      t . (q - q0, parameter - parameter0) = length

with t the path's unit tangent. The bordered system takes two solutions with the elimination along the chain,
for -r and for -dr/dplace, so a step costs O(n). If the tangent turns back, the path has a fold; if the number
of unstable directions changes without a fold, another path branches off.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from statics.equilibria import Critical, Equilibrium, StaticSolver
from statics.outcome import Outcome
from statics.passes import newton, search
from statics.scene import Scene

FIRST_STEP, LONGEST_STEP, SHORTEST_STEP = 0.05, 0.25, 1e-9
"""Lengths of steps along the path: rad, and points of the ramp."""
MOST_STEPS = 10_000
MOST_CORRECTIONS = 10
EASY = 4
"""Corrections up to which the next step is longer."""
LEAST_COSINE = 0.95
"""Smallest cosine between consecutive tangents; below it the step is repeated at half its length."""
MOST_OFF = 0.1
"""Largest distance of a step from the mean of its tangents: beyond it the step has left the path."""
SHORTEST_HIDING = 1e-3
"""Shortest step that is searched for two hidden folds or branchings: closer ones may be missed."""
INVERSE_ITERATIONS = 3
"""Number of iterations for the least stiff mode."""
STIFFNESS_DIFFERENCE = 1e-4
"""Length along the path by which the stiffness is differenced."""
HALF_DIFFERENCE = 0.5
"""Change of the parameter by which the residual is differenced: tensions and factors are linear in it."""
NEARBY = 1e-6
"""Change of the parameter instead if cables driven by their length may go slack or catch nearby."""
CATCHING = 1e-3
"""Longest step in which a cable goes slack or catches, a corner of the path."""
NEAR_LIMIT = 1e-3
"""Clearance below which a path that cannot be continued is at a geometric limit."""
LOCATED = 1e-13
"""Part of a step's length within which folds, limits and points of the ramp are located."""
BRANCHING_LOCATED = 1e-6
"""Part of a step's length within which branchings are located: nearer, the matrix is singular."""
BESIDE_FOLD = 1e-4
"""Distance from a fold, over the step, at which the unstable directions on either side are counted."""


@dataclass(frozen=True)
class Path:
    """Equilibria along a path: those at the ramp's points, folds and branchings, in the order of the path.

    ``outcome`` says how it ended: ``completed`` at the ramp's last point, ``geometry_limit``, or
    ``no_equilibrium`` if it turns back beyond the ramp's first point or cannot be continued;
    ``end`` is where that was, and ``parameters`` are the ramp's at its points, counted from 0.
    """

    outcome: Outcome
    points: list[Equilibrium]
    parameters: list[float]
    end: Equilibrium
    message: str = ""

    @property
    def critical(self) -> list[Equilibrium]:
        """The folds and branchings."""
        return [point for point in self.points if point.critical]


def follow_path(
    scene: Scene, tensions: Sequence[object], start: Equilibrium | None = None, *, steps: int = MOST_STEPS
) -> Path:
    """The path of equilibria along a ramp of tensions through all its folds.

    Each of ``tensions`` is as for ``equilibrium``. The path starts at the equilibrium that a search finds
    from ``start``, or from the straight arm, and takes at most ``steps`` steps. Raises ``InputError`` for
    tensions that do not fit, and for scenes without a potential.
    """
    scene.check_followable()
    solver, ramp = StaticSolver(scene), np.array([scene.check_tension(tension) for tension in tensions])
    return follow(solver, ramp, None if start is None else start.coordinates, range(steps))


def follow(
    solver: StaticSolver,
    ramp: np.ndarray,
    start: np.ndarray | None = None,
    steps: Iterable[object] = range(MOST_STEPS),
) -> Path:
    """Path for inputs, shape (points, inputs), and a start's coordinates; one step for each of ``steps``.

    Raises ``InputError`` for scenes without a potential.
    """
    solver.scene.check_followable()
    first = solver.solve(ramp[0], start)
    if not first.found or len(ramp) == 1:
        return Path(first.outcome, [first] if first.found else [], [0.0], first)
    return ArcLength(solver, ramp).follow(first, steps)


class _PathPoint(NamedTuple):
    """A point of the path: coordinates, parameter of the ramp, unit tangent, results of the elimination.

    ``leg`` is the ramp's leg that the path is on, counted from 0: its inputs are linear from the point of
    that number to the next one, and beyond both.
    """

    q: np.ndarray
    parameter: float
    leg: int
    along: np.ndarray
    along_parameter: float
    negative: int
    clearance: float
    corrections: int = 0


class ArcLength:
    """The bordered systems of one scene along one ramp of inputs, shape (points, inputs)."""

    def __init__(self, solver: StaticSolver, ramp: np.ndarray) -> None:
        self.solver, self.kernel = solver, solver.kernel
        self.ramp = np.ascontiguousarray(ramp, dtype=float)
        segments, dofs = solver.scene.arm.segments, len(solver.scene.coordinates)
        self.chain = np.empty((segments, self.kernel.widths["chain"]))
        units = np.array([1.0, solver.scene.arm.rest_length])[:dofs]
        self.by_length = solver.scene.driven_by_length
        self.half_difference = NEARBY if self.by_length else HALF_DIFFERENCE
        self.push = np.random.default_rng(0).standard_normal((segments, dofs)) / units
        self.weight = segments / units**2
        """Scale by which a uniform bend of the arm counts as its angle, for any number of segments."""

    def inputs(self, parameter: float, leg: int) -> np.ndarray:
        """Inputs at a parameter, on a leg of the ramp or on its straight continuation."""
        if parameter == leg + 1:
            return self.ramp[leg + 1]
        return self.ramp[leg] + (parameter - leg) * (self.ramp[leg + 1] - self.ramp[leg])

    def leg_from(self, point: float, way: float) -> int:
        """The leg that starts at a point of the ramp, forwards or backwards; at its ends the only one."""
        return min(max(int(point) - (way < 0.0), 0), len(self.ramp) - 2)

    def residual(self, q: np.ndarray, inputs: np.ndarray) -> tuple[np.ndarray, float]:
        """Unbalanced generalized forces, shape of q, and the clearance."""
        solver, residual = self.solver, np.empty_like(q)
        numbers = (inputs, solver.segments, solver.disks, self.chain)
        return residual, newton.unbalanced(self.kernel.passes, q, *numbers, residual)

    def by_parameter(self, q: np.ndarray, parameter: float, leg: int) -> np.ndarray:
        """Derivative of the residual by the ramp's parameter."""
        way = self.ramp[leg + 1] - self.ramp[leg]
        ahead, behind = (self.inputs(parameter, leg) + sign * self.half_difference * way for sign in (1, -1))
        return (self.residual(q, ahead)[0] - self.residual(q, behind)[0]) / (2 * self.half_difference)

    def taut(self, at: _PathPoint) -> list[bool]:
        """Whether each cable pulls at a point: those driven by their length may be slack."""
        solver, pose = self.solver, np.empty((len(at.q), 3))
        inputs = self.inputs(at.parameter, at.leg)
        numbers = (inputs, solver.segments, solver.disks, self.chain)
        self.kernel.run("observe", at.q, *numbers, pose)
        disks = pose[solver.scene.arm.disk_nodes].T
        return (solver.scene.driven_by(inputs, *disks)["tension"] > 0.0).tolist()

    def solve(self, right: np.ndarray) -> tuple[np.ndarray, int]:
        """-H^-1 right, for the q of the last ``residual``; and the number of H's negative eigenvalues."""
        solver, change = self.solver, np.empty_like(right)
        numbers = (solver.segments, solver.disks, self.chain, right, change)
        return change, newton.solve_exactly(self.kernel.passes, *numbers)

    def softest_push(self, at: _PathPoint) -> np.ndarray:
        """Forces, shape of q, near those of the least stiff mode, by inverse iteration."""
        self.residual(at.q, self.inputs(at.parameter, at.leg))
        push = self.push
        for _ in range(INVERSE_ITERATIONS):
            push = self.solve(push)[0] * self.weight
            push /= np.abs(push).max()
        return push

    def stiffness(self, q: np.ndarray, inputs: np.ndarray, push: np.ndarray) -> float:
        """Stiffness against a push: it changes its sign where the matrix is singular."""
        self.residual(q, inputs)
        return -1.0 / float(np.sum(push * self.solve(push)[0]))

    def stiffness_along(self, at: _PathPoint, push: np.ndarray) -> tuple[float, float]:
        """The stiffness at a point, and its derivative along the path."""
        step = STIFFNESS_DIFFERENCE
        nearby = self.inputs(at.parameter + step * at.along_parameter, at.leg)
        here = self.stiffness(at.q, self.inputs(at.parameter, at.leg), push)
        return here, (self.stiffness(at.q + step * at.along, nearby, push) - here) / step

    def tangent_at(self, q: np.ndarray, parameter: float, leg: int = 0) -> tuple[np.ndarray, int, float]:
        """dq/dplace along the path, the number of unstable directions, and the clearance."""
        by_parameter = self.by_parameter(q, parameter, leg)
        clearance = self.residual(q, self.inputs(parameter, leg))[1]
        return *self.solve(by_parameter), clearance

    def point_at(
        self,
        q: np.ndarray,
        parameter: float,
        leg: int,
        towards: tuple[np.ndarray, float],
        corrections: int = 0,
    ) -> _PathPoint:
        """An equilibrium as a point of the path, with the tangent in that direction."""
        by_parameter, negative, clearance = self.tangent_at(q, parameter, leg)
        length = np.sqrt(self.inner(by_parameter, by_parameter) + 1.0)
        ahead = self.inner(by_parameter, towards[0]) + towards[1] >= 0.0
        length = length if ahead else -length
        tangent = by_parameter / length, 1.0 / length
        return _PathPoint(q, parameter, leg, *tangent, negative, clearance, corrections)

    def inner(self, one: np.ndarray, other: np.ndarray) -> float:
        """Scalar product of two changes of coordinates, in rad^2."""
        return float(np.sum(self.weight * one * other))

    def corrected(self, here: _PathPoint, length: float) -> _PathPoint | None:
        """The point of the path that far along its tangent, by Newton's method; None if it is not found."""
        q, parameter = here.q + length * here.along, here.parameter + length * here.along_parameter
        size, leg = np.inf, here.leg
        for correction in range(1, MOST_CORRECTIONS + 1):
            by_parameter = self.by_parameter(q, parameter, leg)
            residual, _ = self.residual(q, self.inputs(parameter, leg))
            change, _ = self.solve(residual)
            turning, _ = self.solve(by_parameter)
            lacking = length - self.inner(here.along, q - here.q)
            lacking -= here.along_parameter * (parameter - here.parameter) + self.inner(here.along, change)
            step = lacking / (self.inner(here.along, turning) + here.along_parameter)
            change += step * turning
            last, size = size, np.abs(change * np.sqrt(self.weight)).max() + abs(step)
            if not size < 10.0 * max(length, SHORTEST_STEP):
                return None
            q, parameter = q + change, parameter + step
            if size < search.AT_REST and not (self.by_length and size < search.FALLING * last):
                return self.point_at(q, parameter, leg, (here.along, here.along_parameter), correction)
        return None

    def at_point(self, near: _PathPoint, point: float, way: float) -> tuple[_PathPoint, _PathPoint]:
        """The equilibrium at exactly a point of the ramp, from one within rounding of it.

        One point before it and one after it, in the direction ``way``, 1 or -1: the ramp may have a corner
        there, or turn back.
        """
        residual, _ = self.residual(near.q, self.inputs(point, near.leg))
        q = near.q + self.solve(residual)[0]
        towards = 0.0 * q, way
        coming, going = (
            self.point_at(q, point, leg, towards) for leg in (near.leg, self.leg_from(point, way))
        )
        return coming, going

    def located(
        self, here: _PathPoint, there: float, value: Callable[[_PathPoint], float], within: float = LOCATED
    ) -> tuple[_PathPoint, float] | None:
        """Point up to ``there`` at which a value changes sign, and its distance; None if lost."""
        from scipy.optimize import brentq  # every run loads this module, few follow a path, and SciPy is slow

        found: dict[float, _PathPoint] = {0.0: here}

        def value_at(length: float) -> float:
            if length not in found:
                point = self.corrected(here, length)
                if point is None:
                    raise _LostError
                found[length] = point
            return value(found[length])

        try:
            length = float(brentq(value_at, 0.0, there, xtol=within * there, rtol=8.9e-16))  # pyright: ignore[reportArgumentType]
        except _LostError:
            return None
        return found[length], length

    def follow(
        self,
        first: Equilibrium,
        steps: Iterable[object] = range(MOST_STEPS),
        *,
        until_critical: bool = False,
    ) -> Path:
        """The path from an equilibrium at the ramp's first point to its last, or to a fold or branching."""
        return _Follower(self, first).follow(steps, until_critical)


class _LostError(Exception):
    """A point between two of the path is not found: the step was too long."""


class _Follower:
    """One walk along a path."""

    def __init__(self, arc: ArcLength, first: Equilibrium) -> None:
        self.arc, self.length, self.forwards = arc, FIRST_STEP, True
        self.here = arc.point_at(first.coordinates, 0.0, 0, (0.0 * first.coordinates, 1.0))
        self.points, self.parameters = [first], [0.0]

    def follow(self, steps: Iterable[object], until_critical: bool) -> Path:
        last = len(self.arc.ramp) - 1
        for _ in steps:
            stepped = self._step()
            if stepped is None:
                return self._lost()
            before = self.here.negative
            self.here, critical, at_limit = stepped
            if at_limit:
                return self._ended(Outcome.GEOMETRY_LIMIT)
            if critical or self.here.parameter in range(last + 1):
                self._keep(critical, before)
            if critical and until_critical:
                return Path(Outcome.COMPLETED, self.points, self.parameters, self.points[-1])
            if not critical and self.here.parameter == last:
                return self._ended(Outcome.COMPLETED)
            if self.here.parameter <= 0.0 and not self.forwards:
                return self._ended(
                    Outcome.NO_EQUILIBRIUM, "it turns back and leaves the ramp at its first point"
                )
        return self._ended(Outcome.NO_EQUILIBRIUM, "all steps are used up before the ramp's last point")

    def _step(self) -> tuple[_PathPoint, Critical, bool] | None:
        """Next point of the path: the end of a step, or the first event within it; None if there is none."""
        while self.length > SHORTEST_STEP:
            length, there = self.length, self.arc.corrected(self.here, self.length)
            if there is not None:
                if there.corrections <= EASY:
                    self.length = min(1.5 * self.length, LONGEST_STEP)
                stepped = self._cut(there, length)
                if stepped is not None:
                    return stepped
            self.length = 0.5 * min(length, self.length)
        return None

    def _is_smooth(self, there: _PathPoint, length: float) -> bool:
        """Whether the path turns little in a step, agrees with its tangents, and hides no two folds."""
        here, inner = self.here, self.arc.inner
        if self.arc.by_length and length < CATCHING and self.arc.taut(here) != self.arc.taut(there):
            return True
        cosine = inner(here.along, there.along) + here.along_parameter * there.along_parameter
        off = (there.q - here.q) / length - 0.5 * (here.along + there.along)
        off_parameter = (there.parameter - here.parameter) / length - 0.5 * (
            here.along_parameter + there.along_parameter
        )
        if cosine < LEAST_COSINE or np.sqrt(inner(off, off) + off_parameter**2) > MOST_OFF:
            return False
        return length < SHORTEST_HIDING or not (
            _hides_folds(here, there, length) or self._hides_branchings(there, length)
        )

    def _hides_branchings(self, there: _PathPoint, length: float) -> bool:
        """Whether the cubic with the stiffness and its slopes at both ends changes its sign between them."""
        if self.here.negative != there.negative:
            return False
        push = self.arc.softest_push(there)
        (start, slope), (end, end_slope) = (
            self.arc.stiffness_along(point, push) for point in (self.here, there)
        )
        if start * end <= 0.0:
            return False
        return _turns_through_zero(start, slope * length, end, end_slope * length)

    def _cut(self, there: _PathPoint, length: float) -> tuple[_PathPoint, Critical, bool] | None:
        """A step up to the first event within it: a limit, a point of the ramp, a fold, a branching."""
        arc, here = self.arc, self.here
        at_limit = there.clearance < search.AT_LIMIT
        if at_limit:
            cut = arc.located(here, length, lambda at: at.clearance - search.AT_LIMIT)
            if cut is None:
                return None
            there, length = cut
        point, come_to = _point_between(here.parameter, there.parameter), there
        if point is not None:
            cut = arc.located(here, length, lambda at: at.parameter - point)
            if cut is None:
                return None
            come_to, there = arc.at_point(cut[0], point, np.sign(there.parameter - here.parameter))
            length, at_limit = cut[1], False
        if not at_limit and not self._is_smooth(come_to, length):
            return None
        if (there.along_parameter > 0.0) != self.forwards:
            return self._cut_at_fold(there, length)
        if here.negative != there.negative:
            return self._cut_at_branching(there, length)
        return there, Critical.NO, at_limit

    def _cut_at_fold(self, there: _PathPoint, length: float) -> tuple[_PathPoint, Critical, bool] | None:
        """A step up to the fold within it, or to a branching before that; None if lost."""
        arc, here = self.arc, self.here
        cut = arc.located(here, length, lambda at: at.along_parameter)
        if cut is None:
            return None
        fold, at = cut
        ahead = arc.corrected(here, at * (1.0 - BESIDE_FOLD))
        beyond = arc.corrected(here, min(length, at * (1.0 + BESIDE_FOLD))) or there
        if ahead is not None and ahead.negative != here.negative:
            return self._cut_at_branching(ahead, at * (1.0 - BESIDE_FOLD))
        return fold._replace(negative=beyond.negative), Critical.FOLD, False

    def _cut_at_branching(self, there: _PathPoint, length: float) -> tuple[_PathPoint, Critical, bool] | None:
        """A step up to the first change of the number of unstable directions; None if lost.

        The number may change there by one or by more at once.
        """
        arc, here = self.arc, self.here
        low = 0.0
        while abs(there.negative - here.negative) > 1 and length - low > BRANCHING_LOCATED * length:
            middle = 0.5 * (low + length)
            at = arc.corrected(here, middle)
            if at is None:
                return None
            if at.negative == here.negative:
                low = middle
            else:
                there, length = at, middle
        between = 0.5 * (here.negative + there.negative)
        cut = arc.located(here, length, lambda at: at.negative - between, BRANCHING_LOCATED)
        return None if cut is None else (cut[0]._replace(negative=there.negative), Critical.BRANCHING, False)

    def _keep(self, critical: Critical, before: int) -> None:
        """Keep the point reached; ``before`` is the number of unstable directions before it."""
        here = self.here
        found = self._equilibrium()
        if critical is Critical.FOLD:
            self.forwards = not self.forwards
        if critical:
            fewest = min(here.negative, before)
            found = replace(found, outcome=Outcome.UNSTABLE_EQUILIBRIUM, unstable_directions=fewest)
        self.points.append(replace(found, critical=critical))
        self.parameters.append(here.parameter)

    def _equilibrium(self) -> Equilibrium:
        here, arc = self.here, self.arc
        ended = search.UNSTABLE if here.negative else search.STABLE
        return arc.solver.examine(here.q, arc.inputs(here.parameter, here.leg), ended)

    def _lost(self) -> Path:
        if self.here.clearance < NEAR_LIMIT:
            return self._ended(Outcome.GEOMETRY_LIMIT)
        return self._ended(
            Outcome.NO_EQUILIBRIUM, 'no point follows, even in the smallest steps; try path = "stable"'
        )

    def _ended(self, outcome: Outcome, message: str = "") -> Path:
        return Path(outcome, self.points, self.parameters, self._equilibrium(), message)


def _hides_folds(here: _PathPoint, there: _PathPoint, length: float) -> bool:
    """Whether the cubic with the slopes of the parameter at both ends turns back and forth between them."""
    start, end = np.array([here.along_parameter, there.along_parameter]) * np.sign(here.along_parameter)
    mean = (there.parameter - here.parameter) / length * np.sign(here.along_parameter)
    bend, twist = 6.0 * mean - 4.0 * start - 2.0 * end, 3.0 * (start + end) - 6.0 * mean
    if end <= 0.0 or twist <= 0.0 or not 0.0 < -bend < 2.0 * twist:
        return False
    return start - bend**2 / (4.0 * twist) < 0.0


def _turns_through_zero(start: float, slope: float, end: float, end_slope: float) -> bool:
    """Whether the cubic over 0 to 1 with these values and slopes at both ends is zero somewhere between."""
    change = end - start
    roots = np.roots([slope + end_slope - 2.0 * change, 3.0 * change - 2.0 * slope - end_slope, slope, start])
    return bool(np.any((roots.imag == 0.0) & (roots.real > 0.0) & (roots.real < 1.0)))


def _point_between(parameter: float, other: float) -> float | None:
    """The ramp's first point between one parameter and another; None without one."""
    if other > parameter:
        point = float(np.floor(parameter)) + 1.0
        return point if point <= other else None
    point = float(np.ceil(parameter)) - 1.0
    return point if point >= other else None
