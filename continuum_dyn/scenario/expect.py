"""Expectations of a scenario's run: the table [expect], by which a hard case is judged."""

from dataclasses import field
from typing import Annotated

from pydantic import Field
from pydantic.dataclasses import dataclass

from continuum_dyn.scenario.solver import Method
from statics.outcome import Outcome
from statics.support.checked import STRICT, NonNegative, Positive


@dataclass(frozen=True, config=STRICT)
class Expected:
    """Outcome of a motion, the methods that reach it, and exceptions to ``experiments/bounds.py``.

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
    """Expectations of the scenario as it is, and with the effect ``extension`` added or left out.

    If one of the latter is given, the scenario is run in that way, too.
    """

    with_extension: Annotated[
        Expected | None, Field(description="what is expected of the same scenario with extension")
    ] = None
    without_extension: Annotated[
        Expected | None, Field(description="what is expected of the same scenario without extension")
    ] = None
