"""Messages about equilibria and equilibrium paths."""

from collections.abc import Sequence

import numpy as np

from statics.arc_length import Path
from statics.equilibria import Critical, Equilibrium
from statics.outcome import Outcome

NOT_CARRIED = (
    "no tension acts: check that the core can carry its weight and loads (youngs_modulus in Pa, section)"
)
"""Advice on an arm that has no equilibrium though no drive acts."""
NO_GEOMETRY = "holes of a cable meet, or a segment has no length left"
MOST_NAMED = 6
"""Largest number of folds, branchings or jumps that a message names."""


def failure_message(
    point: Equilibrium, growth: object | None = None, limit: Equilibrium | None = None
) -> str:
    """Message about a search that did not end in a stable equilibrium.

    ``growth`` holds the modes that grow about it, ``limit`` the equilibrium at the geometric limit before it.
    """
    if growth is not None:
        return f"unstable {point.drive}: {growth}"
    if point.outcome is Outcome.UNSTABLE_EQUILIBRIUM:
        return f"unstable {point.drive}, in {_directions(point)}"
    if point.outcome is Outcome.GEOMETRY_LIMIT:
        if limit is None:
            return f"no equilibrium {point.drive}: {NO_GEOMETRY}; {_less(point)}"
        return f"{limit_message(limit)}; no equilibrium {point.drive}"
    lost = f"no equilibrium found {point.drive} in {point.iterations} iterations"
    return f"{lost}; {_slower(point)}"


def _drives(point: Equilibrium) -> str:
    """Inputs that act on an arm at that point, in words; empty if all are zero."""
    named = {"tension": point.tension, "load factor": point.load_factor}
    return " and ".join(name for name, values in named.items() if values is not None and np.any(values))


def _less(point: Equilibrium) -> str:
    drives = _drives(point)
    return f"try less {drives}" if drives else NOT_CARRIED


def _slower(point: Equilibrium) -> str:
    drives = _drives(point)
    return f"try a ramp to it in small steps from a lower {drives}" if drives else NOT_CARRIED


def _inputs(point: Equilibrium) -> str:
    return point.drive.removeprefix("at ")


def _directions(point: Equilibrium) -> str:
    count = point.unstable_directions
    return "1 direction" if count == 1 else f"{count} directions"


def limit_message(limit: Equilibrium) -> str:
    """Message about the drive at which a ramp reaches its geometric limit."""
    return f"geometric limit {limit.drive}: {NO_GEOMETRY}"


def points_message(points: Sequence[Equilibrium]) -> str:
    """Message about the equilibria of a ramp that jump, or whose search left an unstable one."""
    parts = []
    for before, point in zip((None, *points), points, strict=False):
        if point.lost_at is not None and before is not None:
            verb = "jumps" if point.jumped else "continues on another path"
            parts.append(f"{verb} between {_inputs(before)} and {_inputs(point)}: {_event(point.lost_at)}")
        elif point.left:
            unstable = f"an equilibrium that is unstable in {_directions(point.left[-1])}"
            parts.append(f"left {unstable}, {point.drive}")
    return "; ".join(_shorten(parts))


def path_message(path: Path) -> str:
    """Message about where a path folds or branches, and how it ended."""
    parts = _shorten([_event(point) for point in path.critical])
    if path.outcome is Outcome.GEOMETRY_LIMIT:
        parts.append(limit_message(path.end))
    elif path.message:
        parts.append(f"the path ends {path.end.drive}: {path.message}")
    elif not path.end.found:
        parts.append(failure_message(path.end))
    return "; ".join(parts)


def _event(point: Equilibrium) -> str:
    if point.critical is Critical.FOLD:
        return f"the path folds {point.drive}"
    if point.critical is Critical.BRANCHING:
        return f"another path branches off {point.drive}"
    return f"the path is lost {point.drive}"


def _shorten(parts: list[str]) -> list[str]:
    more = len(parts) - MOST_NAMED
    return parts if more <= 0 else [*parts[:MOST_NAMED], f"and {more} more"]
