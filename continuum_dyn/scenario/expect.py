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
        Field(min_length=1, description="methods that run the case, each with its largest number of steps"),
    ]
    until: Annotated[
        dict[Method, Positive],
        Field(description="time at which a method stops early, s; it need not settle"),
    ] = field(default_factory=dict)
    tip_error: Annotated[
        dict[Method, Positive],
        Field(description="largest tip error of a method, if not derived from its tolerance, m"),
    ] = field(default_factory=dict)
    horizon: Annotated[
        Positive | None, Field(description="time up to which errors are checked, s; by default the end")
    ] = None
    amplification: Annotated[
        float, Field(ge=1, description="factor by which the motion itself amplifies errors")
    ] = 1.0
    still_swings: Annotated[
        NonNegative, Field(description="remaining amplitude of the tip at the end, m")
    ] = 0.0
    energy_trend: Annotated[
        Positive | None,
        Field(
            description="slope of the total energy times the duration, over the range of the kinetic energy"
        ),
    ] = None


@dataclass(frozen=True, config=STRICT)
class Expect(Expected):
    """Expectations of the scenario as it is, and with the effect ``extension`` added or left out.

    If one of the latter is given, the scenario is run in that way, too.
    """

    with_extension: Annotated[
        Expected | None, Field(description="expectations of the same scenario with extension")
    ] = None
    without_extension: Annotated[
        Expected | None, Field(description="expectations of the same scenario without extension")
    ] = None
