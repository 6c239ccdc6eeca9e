"""What sizes, widths and colours of a playback are measured by: the same for all runs shown together."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from continuum_dyn.views.playback.loads import acting_loads
from continuum_dyn.views.playback.story import Story

LEAST = 1e-300
"""What is zero throughout is measured by this."""


@dataclass(frozen=True)
class Measures:
    """Largest curvature (1/m), tension (N), force (N), moment (N m), either way; the arm's length (m)."""

    curvature: float
    tension: float
    force: float
    moment: float
    length: float


def measures_of(stories: Sequence[Story]) -> Measures:
    """The largest of each quantity in all of the stories."""
    loads = [load for story in stories for load in acting_loads(story, story.samples)]
    return Measures(
        curvature=_largest([story.columns["curvature"] for story in stories]),
        tension=_largest([story.columns["tension"] for story in stories]),
        force=_largest([np.linalg.norm(load.force, axis=1) for load in loads]),
        moment=_largest([load.moment for load in loads]),
        length=_largest([story.columns["length"][0].sum() for story in stories]),
    )


def _largest(values: Sequence[np.ndarray]) -> float:
    return max((float(np.abs(each).max(initial=LEAST)) for each in values), default=LEAST)
