"""What a scenario expects of its own run: the table [expect], bounds by which a hard case is judged."""

from typing import Annotated

from pydantic import Field
from pydantic.dataclasses import dataclass

from continuum_dyn.study import Method
from statics.checked import STRICT, Positive
from statics.outcome import Outcome


@dataclass(frozen=True, config=STRICT)
class Expect:
    """How a motion must end, by which methods, and what it may be off by; bounds left out are not checked.

    ``steps`` names the methods that claim the case and the most steps that each may take. ``tip_error`` (m)
    bounds the largest distance of the tip from that of a much tighter run, over the samples up to ``horizon``
    (s; all by default) and for each method, so that any two agree within twice that. ``settled_gap`` (m) is
    the tip's distance from a stable equilibrium at the end. In parts of the largest energy of the motion:
    ``ledger``, energy stored less work put in plus energy dissipated, and ``energy_growth``, the largest rise
    of the energy beyond the work put in. In parts of the range of the kinetic energy: ``energy_trend``, the
    slope of the total energy times the duration.
    """

    outcome: Annotated[Outcome, Field(strict=False)]
    steps: Annotated[dict[Method, int], Field(min_length=1)]
    tip_error: Positive | None = None
    horizon: Positive | None = None
    settled_gap: Positive | None = None
    ledger: Positive | None = None
    energy_growth: Positive | None = None
    energy_trend: Positive | None = None
