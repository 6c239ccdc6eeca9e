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

    ``tip_error`` holds for each method that claims the case, so that any two agree within twice that.
    """

    outcome: Annotated[Outcome, Field(strict=False, description="how the motion ends")]
    steps: Annotated[
        dict[Method, int],
        Field(min_length=1, description="methods that claim the case, and the most steps that each may take"),
    ]
    tip_error: Annotated[
        Positive | None,
        Field(description="largest distance of the tip from that of a much tighter run, over the samples, m"),
    ] = None
    horizon: Annotated[
        Positive | None, Field(description="time up to which tip_error holds, s; by default the end")
    ] = None
    settled_gap: Annotated[
        Positive | None, Field(description="distance of the tip from a stable equilibrium at the end, m")
    ] = None
    ledger: Annotated[
        Positive | None,
        Field(
            description="energy stored less work put in plus energy dissipated, in parts of the largest "
            "energy of the motion"
        ),
    ] = None
    energy_growth: Annotated[
        Positive | None,
        Field(
            description="largest rise of the energy beyond the work put in, in parts of the largest energy "
            "of the motion"
        ),
    ] = None
    energy_trend: Annotated[
        Positive | None,
        Field(
            description="slope of the total energy times the duration, in parts of the range of the kinetic "
            "energy"
        ),
    ] = None
