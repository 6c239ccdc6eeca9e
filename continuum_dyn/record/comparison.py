"""Comparison of a run with an earlier one of the same scenario."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from continuum_dyn.record import Log

PART_OF_LENGTH = 1e-7
"""Largest distance of the tips, in arm lengths, if no tolerance gives one."""
STEPS_TOGETHER = 100.0
"""Largest error of all steps together, over the tolerance of one."""


@dataclass(frozen=True)
class Comparison:
    """The outcomes of two logs, and the largest distance (m) of their tips.

    ``place`` says at which time (s), or at which equilibrium; ``allowed`` (m) bounds the logs' own errors.
    ``tip_distance`` is None if they have nothing in common.
    """

    outcomes: tuple[str, str]
    tip_distance: float | None
    place: str
    allowed: float

    @property
    def same(self) -> bool:
        """Same outcome, and tips within what is allowed."""
        near = self.tip_distance is not None and self.tip_distance <= self.allowed
        return near and self.outcomes[0] == self.outcomes[1]


def compare(first: Log, second: Log) -> Comparison:
    """Compare two logs at the samples, or else the equilibria, that both have."""
    moved = bool(first.trajectory and second.trajectory)
    columns = (first.trajectory, second.trajectory) if moved else (first.equilibria, second.equilibria)
    distance, place = None, ""
    if all(columns):
        along = "time" if moved else "point"
        at = _common(columns[0][along], columns[1][along])
        if at.size:
            tips = [_tips(along, group, at) for group in columns]
            apart = np.hypot(*(tips[0] - tips[1]))
            worst = int(np.argmax(apart))
            distance = float(apart[worst])
            place = f"at t = {at[worst]:.6g} s" if moved else f"at point {at[worst]:g}"
    outcomes = str(first.outcome), str(second.outcome)
    return Comparison(outcomes, distance, place, _allowed(first) + _allowed(second))


def _common(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """The values of the first within the range of both."""
    if not (first.size and second.size):
        return first[:0]
    return first[(first >= second[0]) & (first <= second[-1])]


def _tips(along: str, group: Mapping[str, np.ndarray], at: np.ndarray) -> np.ndarray:
    return np.array([np.interp(at, group[along], group[name][:, -1]) for name in ("disk_x", "disk_y")])


def _allowed(log: Log) -> float:
    length = log.arm_length
    if "tip_error" in log.attributes:
        return log.attributes["tip_error"]
    tolerance = log.attributes.get("rtol", 0.0) + log.attributes.get("atol", 0.0)
    return length * max(STEPS_TOGETHER * tolerance, PART_OF_LENGTH)
