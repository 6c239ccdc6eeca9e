"""What a scenario expects of its own run: the table [expect], by which a hard case is judged."""

from typing import Annotated

from pydantic import Field
from pydantic.dataclasses import dataclass

from continuum_dyn.study import Method
from statics.checked import STRICT, Positive
from statics.outcome import Outcome


@dataclass(frozen=True, config=STRICT)
class Expected:
    """How a motion must end, by which methods, and what is special about its bounds: see ``bounds.py``.

    ``steps`` names the methods that claim the case, with the most steps that each may take. Against the last
    one, at tighter tolerances, errors are measured. A method named in ``until`` (s) goes only as far as that,
    as a motion that is not asked whether it has settled.

    ``tip_error`` (m) bounds the error of a method otherwise than by its tolerance; ``horizon`` (s) is how far
    errors are looked at, all the way by default; ``amplification`` is how many times larger the motion itself
    makes them. ``still_swings`` (m) is what is left of the motion at its end. ``energy_trend`` bounds the slope of
    the total energy times the duration, in parts of the range of the kinetic energy.
    """

    outcome: Annotated[Outcome, Field(strict=False)]
    steps: Annotated[dict[Method, Annotated[int, Field(ge=1)]], Field(min_length=1)]
    until: dict[Method, Positive] = Field(default_factory=dict)
    tip_error: dict[Method, Positive] = Field(default_factory=dict)
    horizon: Positive | None = None
    amplification: Annotated[float, Field(ge=1)] = 1.0
    still_swings: Annotated[float, Field(ge=0)] = 0.0
    energy_trend: Positive | None = None


@dataclass(frozen=True, config=STRICT)
class Expect(Expected):
    """The same, and what is expected of the scenario with the effect ``extension``, or without it.

    A scenario is run so where that is given: with extension if it is not among its effects, else without.
    """

    with_extension: Expected | None = None
    without_extension: Expected | None = None
