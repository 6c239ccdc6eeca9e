"""Warnings about numbers that may be in another unit."""

from collections.abc import Iterator
from itertools import chain
from math import hypot, pi, radians

import numpy as np

from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.profiles import Sine
from continuum_dyn.scenario.scenario import Scenario
from statics.arm import Arm

THICK, THIN = 0.5, 1e-4
"""Core radii over the disk spacing between which a core is an ordinary one."""
BEYOND_BENDING = 1e3
"""Largest ordinary load over EJ / L^2, what bends the arm by about a rad."""
SOFT = 1e7
"""Young's modulus (Pa) below which a number may have been meant in GPa."""
FIRST_MODE = 3.516
"""Angular frequency of a uniform cantilever's first mode, over sqrt(EJ / (m L^3))."""


def core_radius(arm: Arm) -> np.ndarray | None:
    """Radius of the core before each disk (m) if it is round, from its area and second moment."""
    if not (arm.has("area") and arm.has("second_moment")):
        return None
    return 2.0 * np.sqrt(arm.per_disk("second_moment") / arm.per_disk("area"))


def odd_core(scenario: Scenario) -> Iterator[str]:
    """Warn of a core that is as thick as its disks are apart, or as thin as a spider's thread."""
    arm = scenario.scene.arm
    radius = core_radius(arm)
    if radius is None:
        return
    part = radius / arm.per_disk("disk_spacing")
    for odd, than in ((part > THICK, "above half"), (part < THIN, f"below {THIN:g} of")):
        if odd.any():
            disk = int(odd.argmax())
            spacing = arm.per_disk("disk_spacing")[disk]
            yield (
                f"a round core of this area and second_moment has a radius of {radius[disk]:.3g} m, {than} "
                f"the disk_spacing, {spacing:.3g} m. Lengths are in m, areas in m^2, second moments in m^4: "
                f"{radius[disk]:.3g} mm are {radius[disk] / 1e3:.3g} m."
            )


def far_holes(scenario: Scenario) -> Iterator[str]:
    """Warn of cable holes that are farther from the core than the arm is long."""
    arm = scenario.scene.arm
    for cable in arm.cables:
        offset = float(np.abs(cable.holes(arm.disks)).max())
        if offset > arm.total_length:
            yield (
                f"cable '{cable.name}': a hole_offset of {offset:g} m is longer than the arm, "
                f"{arm.total_length:g} m. {offset:g} mm are {offset / 1e3:g} m."
            )


def turns_in_degrees(scenario: Scenario) -> Iterator[str]:
    """Warn of angles beyond a full turn."""
    base = scenario.scene.arm.base
    named = [] if base is None else [("[base] angle", base.angle)]
    profiles = chain(scenario.drives, scenario.load_factors, scenario.base_motion)
    named += [("phase of a sine", profile.phase) for profile in profiles if isinstance(profile, Sine)]
    for name, angle in named:
        if abs(angle) > 2.0 * pi:
            yield (
                f"{name}: {angle:g} rad is more than a full turn. {angle:g} degrees are "
                f"{radians(angle):.5g} rad."
            )


def beyond_bending(scenario: Scenario) -> Iterator[str]:
    """Warn of loads far beyond what the core's bending carries."""
    scene, arm = scenario.scene, scenario.scene.arm
    if not scene.has("bending"):
        yield ("nothing resists bending, so the arm hangs like a chain. Add bending = {} to [effects].")
        return
    stiffness = float(np.min(arm.segment_columns()["bending_stiffness"]))
    carried = stiffness / arm.total_length**2
    for name, force in _loads(scenario):
        if force > BEYOND_BENDING * carried:
            modulus = float(np.min(arm.per_disk("youngs_modulus")))
            unit = f": {modulus:g} GPa are {1e9 * modulus:g} Pa" if modulus < SOFT else ""
            yield (
                f"{name}, {force:.3g} N, is {force / carried:.1g} times EJ / L^2 = {carried:.3g} N, which "
                f"bends the arm by a rad. youngs_modulus is read as {modulus:g} Pa{unit}."
            )


def _loads(scenario: Scenario) -> Iterator[tuple[str, float]]:
    """The arm's weight and its largest tensions, N, by name."""
    scene = scenario.scene
    for effect in scene.effects:
        if effect.name == "gravity":
            x, y = getattr(effect, "acceleration", (0.0, 0.0))
            yield "the arm's weight", scene.arm.total_mass * hypot(x, y)
    rows = scenario.study.input_rows(scenario)
    for number, cable in enumerate(scene.arm.cables[: scene.cables]):
        if not cable.driven_by_length:
            yield f"the tension of cable '{cable.name}'", float(np.abs(rows[:, number]).max())


def slow_damping(scenario: Scenario) -> Iterator[str]:
    """Warn of a retardation time beyond the first mode's period: the arm creeps, and does not swing."""
    scene = scenario.scene
    if not (scene.has("inertia") and scene.has("bending")):
        return
    first = FIRST_MODE * Dynamics(scene).frequency
    for effect in scene.effects:
        time = getattr(effect, "retardation_time", 0.0)
        if time * first > 1.0:
            yield (
                f"[effects] {effect.name}: a retardation_time of {time:g} s is longer than the first mode's "
                f"time, about {1.0 / first:.2g} s: the arm creeps. {time:g} ms are {time / 1e3:g} s."
            )
