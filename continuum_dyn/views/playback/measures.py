"""Largest values, which scale sizes, widths and colours alike for all runs shown together."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from continuum_dyn.views.playback.playback import Playback

LEAST = 1e-300
"""Smallest scale, for quantities that are zero throughout."""


@dataclass(frozen=True)
class Measures:
    """Largest curvature (1/m), tension (N), force (N), moment (N m), either way; the arm's length (m)."""

    curvature: float
    tension: float
    force: float
    moment: float
    length: float


def measures_of(playbacks: Sequence[Playback]) -> Measures:
    """The largest of each quantity in all playbacks."""
    loads = [load for playback in playbacks for load in playback.loads(playback.samples)]
    return Measures(
        curvature=_largest([playback.columns["curvature"] for playback in playbacks]),
        tension=_largest([playback.columns["tension"] for playback in playbacks]),
        force=_largest([np.linalg.norm(load.force, axis=1) for load in loads]),
        moment=_largest([load.moment for load in loads]),
        length=_largest([playback.columns["length"][0].sum() for playback in playbacks]),
    )


def _largest(values: Sequence[np.ndarray]) -> float:
    return max((float(np.abs(each).max(initial=LEAST)) for each in values), default=LEAST)
