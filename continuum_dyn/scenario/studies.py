"""Kinds of study: equilibrium, ramp, motion, step response."""

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass

from continuum_dyn.scenario.profiles import Constant
from statics.arm import MAX_SEGMENTS, Arm
from statics.errors import InputError
from statics.support.checked import STRICT, Positive

if TYPE_CHECKING:
    from continuum_dyn.scenario.scenario import Scenario

MAX_SAMPLES = 10**12
"""Largest number of samples that is read at all; ``MAX_STORED`` limits what is stored."""
MAX_STORED = 20_000_000
"""Largest number of segments times samples that a log may hold."""


class StudyKind(ABC):
    """Base of the studies, with defaults for an arm at rest."""

    takes_lists: ClassVar[bool] = False
    """Whether drives are lists of values; otherwise they are profiles."""
    settles: ClassVar[bool] = False
    """Whether the run ends with a verdict: settled or not settled."""

    @property
    def motion(self) -> "MotionStudy | None":
        """The study itself if the arm moves in it, otherwise None."""
        return None

    @property
    def follows_path(self) -> bool:
        """Whether equilibria are followed through folds, by arc length."""
        return False

    @abstractmethod
    def check(self, scenario: "Scenario") -> None:
        """Raise ``InputError`` if the study does not accept the scenario."""

    def input_rows(self, scenario: "Scenario") -> np.ndarray:
        """Inputs of each equilibrium, shape (points, inputs), in the order of ``Scene.inputs``."""
        return scenario.initial_inputs[None, :]

    def max_subsegments(self, arm: Arm) -> int:
        """Largest number of segments from disk to disk that the study allows."""
        return MAX_SEGMENTS // arm.disks


@dataclass(frozen=True, config=STRICT)
class EquilibriumStudy(StudyKind):
    """The equilibrium under the given tensions."""

    kind: Literal["equilibrium"] = "equilibrium"

    def check(self, scenario: "Scenario") -> None:
        """Raise ``InputError`` unless every drive is one number."""
        given = scenario.profiles[: len(scenario.drives) + len(scenario.load_factors)]
        if not all(isinstance(profile, Constant) for profile in given):
            raise InputError(
                'an "equilibrium" study takes one number for each tension, displacement and load factor.'
            )


@dataclass(frozen=True, config=STRICT)
class RampStudy(StudyKind):
    """Equilibria at a sequence of tensions and load factors."""

    takes_lists: ClassVar[bool] = True

    path: Annotated[
        Literal["stable", "arc_length"],
        Field(
            description='"stable": each is a stable equilibrium, searched from the one before; "arc_length": '
            "the path of equilibria from the first one, through its folds, stable or not"
        ),
    ] = "stable"
    kind: Literal["ramp"] = "ramp"

    @property
    def follows_path(self) -> bool:
        """Whether equilibria are followed through folds, by arc length."""
        return self.path == "arc_length"

    def check(self, scenario: "Scenario") -> None:
        """Raise ``InputError`` if the lists differ in length, or the scene has no path to follow."""
        if self.follows_path:
            scenario.scene.check_followable()
        if len({len(values) for values in scenario.ramps}) > 1:
            counts = ", ".join(str(len(values)) for values in scenario.ramps)
            raise InputError(
                f"tensions and load factors of a ramp must be lists of equal length; they have {counts} "
                "entries."
            )

    def input_rows(self, scenario: "Scenario") -> np.ndarray:
        """Inputs of each point of the ramp, shape (points, inputs)."""
        ramps = np.array(scenario.ramps).T if scenario.ramps else np.empty((1, 0))
        constant = scenario.initial_inputs[ramps.shape[1] :]
        return np.hstack([ramps, np.tile(constant, (len(ramps), 1))])


@dataclass(frozen=True, config=STRICT)
class MotionStudy(StudyKind):
    """A motion from the equilibrium under the profiles' first tensions."""

    duration: Annotated[Positive, Field(description="length of the motion, s")]
    samples: Annotated[
        int, Field(ge=2, le=MAX_SAMPLES, description="number of equally spaced samples, both ends included")
    ] = 1001
    static_path: Annotated[
        bool, Field(description="whether to compute the equilibrium at every sample, too")
    ] = False
    kind: Literal["motion"] = "motion"

    @property
    def motion(self) -> "MotionStudy":
        """The study itself: the arm moves in it."""
        return self

    def max_subsegments(self, arm: Arm) -> int:
        """Largest number of segments from disk to disk whose samples can be stored."""
        return min(super().max_subsegments(arm), MAX_STORED // (arm.disks * self.samples))

    def check(self, scenario: "Scenario") -> None:
        """Raise ``InputError`` if the scene has no inertia, or the samples are too many to store."""
        scene = scenario.scene
        if not scene.has("inertia"):
            raise InputError(f'a "{self.kind}" study needs inertia. Add inertia = {{}} to [effects].')
        stored = self.samples * scene.arm.segments
        if stored > MAX_STORED:
            raise InputError(
                f"{self.samples} samples of {scene.arm.segments} segments would store {stored:.3g} "
                f"shapes. Allowed: {MAX_STORED:.3g}. Give fewer samples."
            )


@dataclass(frozen=True, config=STRICT)
class StepResponseStudy(MotionStudy):
    """A motion, and whether it has settled to the equilibrium under the last tensions.

    Settled means: tip within ``settled_within`` of that equilibrium's, and slower than that distance per
    second.
    """

    settles: ClassVar[bool] = True

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
