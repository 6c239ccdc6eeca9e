"""What is told of equilibria, and of paths of them: in words, for messages."""

from collections.abc import Sequence

from statics.arc_length import Path
from statics.equilibria import Critical, Equilibrium
from statics.outcome import Outcome

MOST_TOLD = 6
"""Folds, branchings or jumps that a message names."""


def why(point: Equilibrium, growth: object | None = None, limit: Equilibrium | None = None) -> str:
    """What to tell of a search that did not end in a stable equilibrium.

    ``growth`` is what grows about it, ``limit`` the equilibrium at the geometric limit on the way there.
    """
    if growth is not None:
        return f"{growth}, {point.drive}"
    if point.outcome is Outcome.UNSTABLE_EQUILIBRIUM:
        return f"unstable in {point.unstable_directions} directions {point.drive}"
    if point.outcome is Outcome.GEOMETRY_LIMIT:
        meets = "holes meet: the cable's length from hole to hole reaches zero; try less tension"
        return f"{point.drive} {meets}" if limit is None else f"{at_limit(limit)}, on the way {point.drive}"
    lost = f"no equilibrium found {point.drive} in {point.iterations} iterations"
    return f"{lost}; try a ramp from a lower tension"


def at_limit(limit: Equilibrium) -> str:
    """Where a ramp comes to its geometric limit."""
    return f"geometric limit {limit.drive}: there holes meet, or a length reaches zero"


def told_of_points(points: Sequence[Equilibrium]) -> str:
    """What is to be known of equilibria that were found: which ones the search left, and which ones jump."""
    told = []
    for before, point in zip((None, *points), points, strict=False):
        if point.lost_at is not None and before is not None:
            way = "jumps" if point.jumped else "goes on along another path"
            told.append(
                f"{way} between points {before.drive} and {point.drive}: {_what_happens(point.lost_at)}"
            )
        elif point.left:
            ways = point.left[-1].unstable_directions
            told.append(f"{point.drive} left an equilibrium that is unstable in {ways} directions")
    return "; ".join(_shortened(told))


def told_of_path(path: Path) -> str:
    """Where a path folds or branches, and how it ended."""
    told = _shortened([_what_happens(point) for point in path.critical])
    if path.outcome is Outcome.GEOMETRY_LIMIT:
        told.append(at_limit(path.end))
    elif path.message:
        told.append(f"the path ends {path.end.drive}: {path.message}")
    elif not path.end.found:
        told.append(why(path.end))
    return "; ".join(told)


def _what_happens(point: Equilibrium) -> str:
    if point.critical is Critical.FOLD:
        return f"the path folds {point.drive}"
    if point.critical is Critical.BRANCHING:
        return f"another path branches off {point.drive}"
    return f"the path is lost {point.drive}"


def _shortened(told: list[str]) -> list[str]:
    more = len(told) - MOST_TOLD
    return told if more <= 0 else [*told[:MOST_TOLD], f"and {more} more"]
