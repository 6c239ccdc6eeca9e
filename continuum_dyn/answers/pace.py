"""Scenarios driven faster or slower."""

from dataclasses import replace
from typing import Any

from continuum_dyn.scenario.profiles import Constant, Profile, Ramp, Sine, SmoothRamp, Step, Table
from continuum_dyn.scenario.scenario import Scenario


def at_pace(scenario: Scenario, factor: float) -> Scenario:
    """The scenario with all its inputs, and its duration, ``factor`` times as fast.

    Raises ``InputError`` for a study without motion.
    """
    study = scenario.require_motion("only a motion can be run at other rates")
    return replace(
        scenario,
        drives=tuple(_faster(profile, factor) for profile in scenario.drives),
        load_factors=tuple(_faster(profile, factor) for profile in scenario.load_factors),
        base_motion=tuple(_faster(profile, factor) for profile in scenario.base_motion),
        study=replace(study, duration=study.duration / factor),
    )


def _faster(profile: Any, factor: float) -> Profile:
    match profile:
        case Constant():
            return profile
        case Step():
            return replace(profile, at=profile.at / factor)
        case Ramp() | SmoothRamp():
            return replace(profile, start=profile.start / factor, end=profile.end / factor)
        case Sine():
            return replace(profile, frequency=profile.frequency * factor)
        case Table():
            return replace(profile, time=tuple(t / factor for t in profile.time))
    raise TypeError(f"not a profile: {profile!r}")
