"""Kinds of study: equilibrium, ramp, motion, step response."""

from typing import Annotated, Literal

from pydantic import Field
from pydantic.dataclasses import dataclass

from statics.checked import STRICT, Positive

MAX_SAMPLES = 10**12
"""Largest number of samples that is read at all; no log may hold as many."""


@dataclass(frozen=True, config=STRICT)
class EquilibriumStudy:
    """The equilibrium of the arm under its tensions."""

    kind: Literal["equilibrium"] = "equilibrium"


@dataclass(frozen=True, config=STRICT)
class RampStudy:
    """Equilibria of the arm under one set of tensions and load factors after another."""

    path: Annotated[
        Literal["stable", "arc_length"],
        Field(
            description='"stable": each is a stable equilibrium, searched from the one before; "arc_length": '
            "the path of equilibria from the first one on, through its folds, stable or not"
        ),
    ] = "stable"
    kind: Literal["ramp"] = "ramp"


@dataclass(frozen=True, config=STRICT)
class MotionStudy:
    """The motion of the arm from the equilibrium of the profiles' first tensions."""

    duration: Annotated[Positive, Field(description="length of the motion, s")]
    samples: Annotated[
        int, Field(ge=2, le=MAX_SAMPLES, description="number of samples: uniform, with both ends included")
    ] = 1001
    static_path: Annotated[
        bool, Field(description="whether the equilibrium of every sample's tensions is asked for as well")
    ] = False
    kind: Literal["motion"] = "motion"


@dataclass(frozen=True, config=STRICT)
class StepResponseStudy(MotionStudy):
    """The motion of the arm, and whether it settles to the equilibrium of the last tensions.

    Settled means: tip within ``settled_within`` of that equilibrium's, and slower than that distance per
    second.
    """

    settled_within: Annotated[
        Positive | None,
        Field(
            description="distance of the tip from its final equilibrium below which it has settled, m; "
            "by default 1e-3 of the arm's length"
        ),
    ] = None
    kind: Literal["step_response"] = "step_response"  # pyright: ignore[reportIncompatibleVariableOverride]


Study = EquilibriumStudy | RampStudy | MotionStudy | StepResponseStudy
STUDIES: dict[str, type[Study]] = {
    "equilibrium": EquilibriumStudy,
    "ramp": RampStudy,
    "motion": MotionStudy,
    "step_response": StepResponseStudy,
}
