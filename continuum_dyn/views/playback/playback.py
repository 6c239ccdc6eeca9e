"""A log's columns along a time line, and the rows of them that are shown."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from continuum_dyn.record import Log
from continuum_dyn.record.logged_scenario import logged_scenario
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.views.figures.loads import ActingLoad, acting_loads
from statics.errors import LogError
from statics.support.plain_text import plain_line

FRAMES_PER_SECOND = 60
SHORTEST_PLAYBACK = 10.0
"""Shortest time that a playback takes, s; shorter motions play in slow motion."""

MOST_FRAMES = 2000
MOST_POSES = 500_000
"""Largest number of frames times segments; arms of many segments are drawn in fewer frames."""

MOST_SAMPLES = 20_000


@dataclass(frozen=True)
class Playback:
    """A log as it is played: ``columns`` by glossary name, one row for each of ``times`` on the time line.

    A motion runs along ``sim_time``, times in s; equilibria along ``point``, times their numbers.
    ``scenario`` is None if the log holds none. ``name`` distinguishes runs that are shown together, and is
    empty for a single run; ``rank`` counts them from 0.
    """

    log: Log
    timeline: str
    times: np.ndarray
    columns: Mapping[str, np.ndarray]
    scenario: Scenario | None
    name: str = ""
    rank: int = 0

    @property
    def moves(self) -> bool:
        """Whether the log is of a motion."""
        return self.timeline == "sim_time"

    @property
    def duration(self) -> float:
        """Length of a motion in s; 0 for equilibria."""
        return float(np.ptp(self.times)) if self.moves else 0.0

    @property
    def frames(self) -> np.ndarray:
        """Rows in which the arm is drawn."""
        rows, segments = self.columns["curvature"].shape
        played = int(FRAMES_PER_SECOND * max(self.duration, SHORTEST_PLAYBACK))
        return spread(rows, max(1, min(played, MOST_FRAMES, MOST_POSES // segments)))

    @property
    def samples(self) -> np.ndarray:
        """Rows that are plotted."""
        return spread(len(self.times), MOST_SAMPLES)

    def loads(self, rows: np.ndarray) -> list[ActingLoad]:
        """The loads on disks at those rows; none if the log holds no scenario."""
        return acting_loads(self.scenario, self.columns, rows)

    def at(self, *path: str) -> str:
        """The entity of that path, with the run's name after its root if several runs are shown."""
        return "/".join(part for part in (path[0], self.name, *path[1:]) if part)


def spread(count: int, most: int) -> np.ndarray:
    """At most ``most`` of the numbers below ``count``, spaced evenly, both ends included."""
    return np.linspace(0, count - 1, min(count, most)).round().astype(int)


def playback_of(log: Log, name: str = "", rank: int = 0) -> Playback | None:
    """The playback of a motion, or else of equilibria; None if the run ended before its first pose."""
    try:
        scenario = logged_scenario(log)
    except LogError:
        scenario = None
    if log.trajectory and log.trajectory["time"].size:
        return Playback(log, "sim_time", log.trajectory["time"], log.trajectory, scenario, name, rank)
    if log.equilibria:
        return Playback(log, "point", log.equilibria["point"], log.equilibria, scenario, name, rank)
    return None


def names_of(logs: Sequence[Log]) -> list[str]:
    """A distinct name for each log shown with others: its file's, with as much of its path as needed."""
    if len(logs) == 1:
        return [""]
    paths = [tuple(map(plain_line, log.path.resolve().with_suffix("").parts)) for log in logs]
    for length in range(1, max(map(len, paths)) + 1):
        names = [" ".join(parts[-length:]) for parts in paths]
        if len(set(names)) == len(names):
            return names
    return [f"{number} {parts[-1]}" for number, parts in enumerate(paths, start=1)]
