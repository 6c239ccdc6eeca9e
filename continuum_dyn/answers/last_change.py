"""The last change of a motion's inputs."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from continuum_dyn.scenario.intervals import ROUNDING, Interval, cut_into_intervals
from continuum_dyn.scenario.scenario import Scenario
from statics.errors import InputError


class LastChange(NamedTuple):
    """The time (s) at which the inputs begin to change for the last time, and the time at which they stop.

    Both are the same for a step. From ``end`` on the motion is free.
    """

    begin: float
    end: float


def last_change(scenario: Scenario, until: float) -> LastChange:
    """The last change of tensions, load factors and the base's pose in a motion up to that time (s).

    Raises ``InputError`` if they never change, or still do at that time.
    """
    drives = (*scenario.drives, *scenario.load_factors, *scenario.base_motion)
    profiles = [profile for profile in drives if not isinstance(profile, tuple)]
    intervals = cut_into_intervals(profiles, until)
    before = np.array([profile.initial for profile in profiles])
    changes = list(_changes(before, intervals))
    if not changes:
        raise InputError(f"no input changes before the motion ends, at {until:g} s.")
    if changes[-1].end >= until:
        raise InputError(
            f"inputs still change when the motion ends, at {until:g} s. Make the [study] longer, or the "
            "change earlier."
        )
    return changes[-1]


def _changes(before: np.ndarray, intervals: Iterable[Interval]) -> list[LastChange]:
    """Jumps, and runs of intervals with continuous change."""
    found: list[LastChange] = []
    continues = False
    for interval in intervals:
        first, last = interval.inputs(np.array([interval.start, interval.end]))
        if np.any(np.abs(first - before) > ROUNDING * (np.abs(first) + np.abs(before))):
            found.append(LastChange(interval.start, interval.start))
            continues = False
        if changing := bool(interval.pieces[:, 2:4].any()):
            begin = found.pop().begin if continues else interval.start
            found.append(LastChange(begin, interval.end))
        continues, before = changing, last
    return found
