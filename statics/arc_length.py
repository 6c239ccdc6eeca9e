"""Paths of equilibria by arc length, through folds, at which a load cannot grow any further.

The path is walked in steps of a given length (``statics/bordered_system.py``). If its tangent turns back, the
path has a fold; if the number of unstable directions changes without a fold, another path branches off.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from statics.bordered_system import SHORTEST_STEP, BorderedSystem, PathPoint
from statics.equilibria import Critical, Equilibrium, StaticSolver
from statics.outcome import Outcome
from statics.passes import search
from statics.scene import Scene

FIRST_STEP, LONGEST_STEP = 0.05, 0.25
"""Lengths of steps along the path: rad, and points of the ramp."""
MOST_STEPS = 10_000
EASY = 4
"""Corrections up to which the next step is longer."""
LEAST_COSINE = 0.95
"""Smallest cosine between consecutive tangents; below it the step is repeated at half its length."""
MOST_OFF = 0.1
"""Largest distance of a step from the mean of its tangents: beyond it the step has left the path."""
SHORTEST_HIDING = 1e-3
"""Shortest step that is searched for two hidden folds or branchings: closer ones may be missed."""
CATCHING = 1e-3
"""Longest step in which a cable goes slack or catches, a corner of the path."""
NEAR_LIMIT = 1e-3
"""Clearance below which a path that cannot be continued is at a geometric limit."""
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
    return follow_from(BorderedSystem(solver, ramp), first, steps)


def follow_from(
    system: BorderedSystem,
    first: Equilibrium,
    steps: Iterable[object] = range(MOST_STEPS),
    *,
    until_critical: bool = False,
) -> Path:
    """The path from an equilibrium at the ramp's first point to its last, or to a fold or branching."""
    return _Walk(system, first).follow(steps, until_critical)


class _Walk:
    """One walk along a path."""

    def __init__(self, system: BorderedSystem, first: Equilibrium) -> None:
        self.system, self.length, self.forwards = system, FIRST_STEP, True
        self.here = system.point_at(first.coordinates, 0.0, 0, (0.0 * first.coordinates, 1.0))
        self.points, self.parameters = [first], [0.0]

    def follow(self, steps: Iterable[object], until_critical: bool) -> Path:
        last = len(self.system.ramp) - 1
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

    def _step(self) -> tuple[PathPoint, Critical, bool] | None:
        """Next point of the path: the end of a step, or the first event within it; None if there is none."""
        while self.length > SHORTEST_STEP:
            length, there = self.length, self.system.corrected(self.here, self.length)
            if there is not None:
                if there.corrections <= EASY:
                    self.length = min(1.5 * self.length, LONGEST_STEP)
                stepped = self._cut(there, length)
                if stepped is not None:
                    return stepped
            self.length = 0.5 * min(length, self.length)
        return None

    def _is_smooth(self, there: PathPoint, length: float) -> bool:
        """Whether the path turns little in a step, agrees with its tangents, and hides no two folds."""
        here, inner = self.here, self.system.inner
        if self.system.by_length and length < CATCHING and self.system.taut(here) != self.system.taut(there):
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

    def _hides_branchings(self, there: PathPoint, length: float) -> bool:
        """Whether the cubic with the stiffness and its slopes at both ends changes its sign between them."""
        if self.here.negative != there.negative:
            return False
        push = self.system.softest_push(there)
        (start, slope), (end, end_slope) = (
            self.system.stiffness_along(point, push) for point in (self.here, there)
        )
        if start * end <= 0.0:
            return False
        return _turns_through_zero(start, slope * length, end, end_slope * length)

    def _cut(self, there: PathPoint, length: float) -> tuple[PathPoint, Critical, bool] | None:
        """A step up to the first event within it: a limit, a point of the ramp, a fold, a branching."""
        system, here = self.system, self.here
        at_limit = there.clearance < search.AT_LIMIT
        if at_limit:
            cut = system.located(here, length, lambda at: at.clearance - search.AT_LIMIT)
            if cut is None:
                return None
            there, length = cut
        point, come_to = _point_between(here.parameter, there.parameter), there
        if point is not None:
            cut = system.located(here, length, lambda at: at.parameter - point)
            if cut is None:
                return None
            come_to, there = system.at_point(cut[0], point, np.sign(there.parameter - here.parameter))
            length, at_limit = cut[1], False
        if not at_limit and not self._is_smooth(come_to, length):
            return None
        if (there.along_parameter > 0.0) != self.forwards:
            return self._cut_at_fold(there, length)
        if here.negative != there.negative:
            return self._cut_at_branching(there, length)
        return there, Critical.NO, at_limit

    def _cut_at_fold(self, there: PathPoint, length: float) -> tuple[PathPoint, Critical, bool] | None:
        """A step up to the fold within it, or to a branching before that; None if lost."""
        system, here = self.system, self.here
        cut = system.located(here, length, lambda at: at.along_parameter)
        if cut is None:
            return None
        fold, at = cut
        ahead = system.corrected(here, at * (1.0 - BESIDE_FOLD))
        beyond = system.corrected(here, min(length, at * (1.0 + BESIDE_FOLD))) or there
        if ahead is not None and ahead.negative != here.negative:
            return self._cut_at_branching(ahead, at * (1.0 - BESIDE_FOLD))
        return fold._replace(negative=beyond.negative), Critical.FOLD, False

    def _cut_at_branching(self, there: PathPoint, length: float) -> tuple[PathPoint, Critical, bool] | None:
        """A step up to the first change of the number of unstable directions; None if lost.

        The number may change there by one or by more at once.
        """
        system, here = self.system, self.here
        low = 0.0
        while abs(there.negative - here.negative) > 1 and length - low > BRANCHING_LOCATED * length:
            middle = 0.5 * (low + length)
            at = system.corrected(here, middle)
            if at is None:
                return None
            if at.negative == here.negative:
                low = middle
            else:
                there, length = at, middle
        between = 0.5 * (here.negative + there.negative)
        cut = system.located(here, length, lambda at: at.negative - between, BRANCHING_LOCATED)
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
        here, system = self.here, self.system
        ended = search.UNSTABLE if here.negative else search.STABLE
        return system.solver.examine(here.q, system.inputs(here.parameter, here.leg), ended)

    def _lost(self) -> Path:
        if self.here.clearance < NEAR_LIMIT:
            return self._ended(Outcome.GEOMETRY_LIMIT)
        return self._ended(
            Outcome.NO_EQUILIBRIUM, 'no point follows, even in the smallest steps; try path = "stable"'
        )

    def _ended(self, outcome: Outcome, message: str = "") -> Path:
        return Path(outcome, self.points, self.parameters, self._equilibrium(), message)


def _hides_folds(here: PathPoint, there: PathPoint, length: float) -> bool:
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
