"""Warnings about requests without effect: unused quantities, drives without a change, studies in vain."""

from collections.abc import Iterator
from math import inf
from typing import Any

import numpy as np

from continuum_dyn.scenario.profiles import Profile, change_times
from continuum_dyn.scenario.scenario import Scenario, dissipated_by
from statics.arm import RONE2012, Arm

USED_BY = {
    "youngs_modulus": ("bending", "extension"),
    "second_moment": ("bending",),
    "area": ("extension",),
    "disk_mass": ("gravity", "inertia", "mass_damping"),
    "disk_inertia": ("rotary_inertia",),
    "core_density": ("gravity", "inertia", "mass_damping"),
}
"""The effects that use a number of the arm."""


def unused_numbers(scenario: Scenario) -> Iterator[str]:
    """Warn of numbers of the arm that no effect of the scene uses; a preset's own may stay."""
    scene, arm = scenario.scene, scenario.scene.arm
    for name, effects in USED_BY.items():
        preset = getattr(arm, name) == RONE2012.get(name)
        of_core = name == "area" and arm.core_density is not None
        each = getattr(arm.each, name, None)
        is_zero = not np.any(getattr(arm, name) if each is None else each)
        if arm.has(name) and not is_zero and not (preset or of_core or any(map(scene.has, effects))):
            would = " or ".join(filter(None, (", ".join(effects[:-1]), effects[-1])))
            yield f"[arm] {name} has no effect: only {would} use it. Add one to [effects], or leave it out."


def core_counted_twice(scenario: Scenario) -> Iterator[str]:
    """Warn of a core's own mass beside disks that hold it already."""
    arm: Arm = scenario.scene.arm
    if arm.core_density is not None and arm.disk_mass == RONE2012["disk_mass"]:
        yield (
            "the core's mass counts twice: by core_density, and in the preset's disk_mass, "
            f"{arm.disk_mass:g} kg. Give the disks' own disk_mass."
        )


def drives_without_a_change(scenario: Scenario) -> Iterator[str]:
    """Warn of changes after the end of the run, and of a step response in which nothing steps."""
    study = scenario.study.motion
    if study is None:
        return
    drives = [(name, change_times(profile)) for name, profile in _named_drives(scenario)]
    for name, changes in drives:
        if changes is not None and changes[0] >= study.duration:
            yield (
                f"{name} changes at {changes[0]:g} s, after the end of the run at {study.duration:g} s. "
                "Make the [study] longer, or the change earlier."
            )
        elif changes is not None and study.duration < changes[1] < inf:
            yield (
                f"{name} changes until {changes[1]:g} s, after the end of the run at {study.duration:g} s."
            )
    if study.settles and drives and not any(changes for _, changes in drives):
        yield 'a step response with constant inputs. Give a tension with profile = "step".'
    if study.settles and not dissipated_by(scenario.scene):
        yield (
            "without damping the motion cannot settle. Add material_damping, "
            "linear_drag or mass_damping to [effects]."
        )


def _named_drives(scenario: Scenario) -> list[tuple[str, Profile]]:
    cables = (f"the drive of cable '{cable.name}'" for cable in scenario.scene.arm.cables)
    loads = (f"load factor {number}" for number in range(1, len(scenario.load_factors) + 1))
    base = (f"[base] {name}" for name in ("x", "y", "angle"))
    named: list[Any] = []
    profiles = scenario.drives, scenario.load_factors, scenario.base_motion
    for names, given in zip((cables, loads, base), profiles, strict=True):
        named += zip(names, given, strict=False)
    return named
