"""Warnings about requests without effect: unused quantities, drives without a change, studies in vain."""

import tomllib
from collections.abc import Iterator
from math import inf
from typing import Any

import numpy as np

from continuum_dyn.scenario.profiles import Profile, change_times
from continuum_dyn.scenario.scenario import Scenario, dissipated_by
from statics.arm import RONE2012, Arm
from statics.materials import MATERIALS

USED_BY = {
    "youngs_modulus": ("bending", "extension"),
    "second_moment": ("bending",),
    "area": ("extension", "bending"),  # bending's strain follows from both
    "disk_mass": ("gravity", "inertia", "mass_damping"),
    "disk_inertia": ("rotary_inertia", "mass_damping"),
    "core_density": ("gravity", "inertia", "mass_damping"),
}
"""The effects that use a number of the arm."""
USED_OF_PAYLOADS = {
    "mass": ("gravity", "inertia", "mass_damping"),
    "inertia": ("rotary_inertia", "mass_damping"),
}
"""The effects that use a number of a payload."""


def unused_numbers(scenario: Scenario) -> Iterator[str]:
    """Warn of given numbers of the arm that no effect uses; those of a preset or of a material may stay."""
    scene, arm, given = scenario.scene, scenario.scene.arm, _given(scenario)
    for name, effects in USED_BY.items():
        preset = getattr(arm, name) == RONE2012.get(name)
        of_core = name == "area" and arm.core_density is not None
        each = getattr(arm.each, name, None)
        is_zero = not np.any(getattr(arm, name) if each is None else each)
        if name in given and not is_zero and not (preset or of_core or any(map(scene.has, effects))):
            yield _unused(f"[arm] {name}", effects)
    for name, effects in USED_OF_PAYLOADS.items():
        if any(getattr(payload, name) for payload in arm.payloads) and not any(map(scene.has, effects)):
            yield _unused(f"[[payloads]] {name}", effects)


def _given(scenario: Scenario) -> set[str]:
    """The numbers that the table [arm] of a file gives itself; without a file, all known ones."""
    arm = scenario.scene.arm
    known = set(filter(arm.has, USED_BY))
    core = arm.youngs_modulus, arm.core_density
    if any(core == (each.youngs_modulus, each.density) for each in MATERIALS.values()):
        known.discard("core_density")
    return known & tomllib.loads(scenario.text)["arm"].keys() if scenario.text else known


def _unused(name: str, effects: tuple[str, ...]) -> str:
    """Message about a number without effect."""
    if len(effects) == 1:
        return f"{name} has no effect: only {effects[0]} uses it. Add that to [effects], or leave it out."
    would = f"{', '.join(effects[:-1])} and {effects[-1]}"
    return f"{name} has no effect: only {would} use it. Add one to [effects], or leave it out."


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
    if study.settles and not any(changes for _, changes in drives):
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
