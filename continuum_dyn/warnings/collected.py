"""All warnings of a run, in the order of printing."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.warnings import asked, results, units

if TYPE_CHECKING:
    from continuum_dyn.simulation.run import Run

BEFORE: tuple[Callable[[Scenario], Iterator[str]], ...] = (
    units.odd_core,
    units.far_holes,
    units.turns_in_degrees,
    units.beyond_bending,
    units.slow_damping,
    asked.unused_numbers,
    asked.core_counted_twice,
    asked.drives_without_a_change,
)
"""Checks of the scenario."""
AFTER: "tuple[Callable[[Run], Iterator[str]], ...]" = (
    results.strained,
    results.coarser_than_the_travel,
    results.samples_too_far_apart,
    results.explicit_on_a_stiff_arm,
)
"""Checks of the results."""


def warnings_of(run: "Run") -> tuple[str, ...]:
    """All warnings about a run and its scenario, one or two sentences each."""
    with np.errstate(all="ignore"):
        before = [text for check in BEFORE for text in check(run.scenario)]
        return (*before, *(text for check in AFTER for text in check(run)))
