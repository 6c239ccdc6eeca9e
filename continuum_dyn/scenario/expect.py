"""What a scenario expects of its own run: the table [expect], by which a hard case is judged."""

from dataclasses import field
from typing import Annotated

from pydantic import Field
from pydantic.dataclasses import dataclass

from continuum_dyn.scenario.solver import Method
from statics.outcome import Outcome
from statics.support.checked import STRICT, NonNegative, Positive


@dataclass(frozen=True, config=STRICT)
class Expected:
    """How a motion must end, by which methods, and what is special about its bounds: see ``bounds.py``.

    Errors are measured against the last method of ``steps``, at tighter tolerances.
    """

    outcome: Annotated[Outcome, Field(strict=False, description="how the motion ends")]
    steps: Annotated[
        dict[Method, Annotated[int, Field(ge=1)]],
        Field(min_length=1, description="methods that claim the case, and the most steps that each may take"),
    ]
    until: Annotated[
        dict[Method, Positive],
        Field(description="how far a method goes that does not go to the end, s; it need not settle"),
    ] = field(default_factory=dict)
    tip_error: Annotated[
        dict[Method, Positive],
        Field(description="error of the tip of a method where it does not go by its tolerance, m"),
    ] = field(default_factory=dict)
    horizon: Annotated[
        Positive | None, Field(description="time up to which errors are looked at, s; by default the end")
    ] = None
    amplification: Annotated[
        float, Field(ge=1, description="how many times larger the motion itself makes an error")
    ] = 1.0
    still_swings: Annotated[
        NonNegative, Field(description="what is left of the motion at the tip at its end, m")
    ] = 0.0
    energy_trend: Annotated[
        Positive | None,
        Field(
            description="slope of the total energy times the duration, in parts of the range of the kinetic "
            "energy"
        ),
    ] = None


@dataclass(frozen=True, config=STRICT)
class Expect(Expected):
    """The same, and what is expected of the scenario with the effect ``extension``, or without it.

    A scenario is run so where that is given: with extension if it is not among its effects, else without.
    """

    with_extension: Annotated[
        Expected | None, Field(description="what is expected of the same scenario with extension")
    ] = None
    without_extension: Annotated[
        Expected | None, Field(description="what is expected of the same scenario without extension")
    ] = None
