"""Warnings about results: strains, tolerances above the travel, samples too far apart."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from continuum_dyn.integrators.choice import choose
from continuum_dyn.integrators.methods import METHODS
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import cut_into_intervals
from continuum_dyn.warnings.sampling import describe_coarse_samples
from continuum_dyn.warnings.units import core_radius

if TYPE_CHECKING:
    from continuum_dyn.simulation.run import Run

LARGEST_STRAIN = 0.02
"""Bending strain above which few cores stay elastic."""
STILL = 1e-9
"""Travel over the arm's length below which nothing moves: rounding leaves some."""


def bending_strain(run: "Run") -> float | None:
    """Largest bending strain of a round core in all that was computed; None if its radius is not known."""
    arm = run.scenario.scene.arm
    radius = core_radius(arm)
    curvatures = [point.curvature[None] for point in run.equilibria if point.found]
    if run.trajectory is not None and run.trajectory.time.size:
        curvatures.append(run.trajectory.curvature)
    if radius is None or not curvatures:
        return None
    rest = np.repeat(arm.per_disk("reference_curvature"), arm.subsegments)
    strains = np.repeat(radius, arm.subsegments) * np.abs(np.concatenate(curvatures) - rest)
    return float(strains.max())


def strained(run: "Run") -> Iterator[str]:
    """Warn of strains at which a core yields."""
    strain = bending_strain(run)
    if strain is not None and strain > LARGEST_STRAIN:
        yield (
            f"the core bends to a strain of {100 * strain:.3g} %; few materials stay elastic above "
            f"{100 * LARGEST_STRAIN:g} %. A thinner core of the same stiffness has less strain."
        )


def coarser_than_the_travel(run: "Run") -> Iterator[str]:
    """Warn of tolerances that are larger than all that moves."""
    scenario = run.scenario
    if run.trajectory is None or not run.outcome.answered:
        return
    if run.trajectory.travel < STILL * scenario.scene.arm.total_length:
        return
    travel = run.trajectory.travel
    named = []
    if scenario.study.settles:
        named.append(("settled_within", scenario.settled_within))
    if scenario.accuracy is not None:
        named.append(("[accuracy] tip", scenario.accuracy.tip))
    for name, distance in named:
        if distance > travel:
            in_mm = f" {distance:g} mm are {distance / 1e3:g} m." if distance / 1e3 < travel else ""
            yield (
                f"{name} = {distance:.3g} m is longer than the whole motion, {travel:.3g} m, and checks "
                f"nothing.{in_mm} Give less than {travel:.1g}."
            )


def samples_too_far_apart(run: "Run") -> Iterator[str]:
    """Warn of samples between which the arm swings unseen."""
    moved = run.trajectory
    if moved is not None and (coarse := describe_coarse_samples(vars(moved))):
        yield f"samples are {coarse}."


def explicit_on_a_stiff_arm(run: "Run") -> Iterator[str]:
    """Warn of a method whose steps a stiff arm keeps short."""
    solver, study = run.scenario.solver, run.scenario.study.motion
    if run.trajectory is None or study is None or solver.chooses_method or METHODS[solver.method].implicit:
        return
    dynamics, start = Dynamics(run.scenario.scene), run.equilibria[0].coordinates
    interval = cut_into_intervals(run.scenario.profiles, study.duration).first
    better = choose(dynamics, dynamics.state(start), interval, study.duration)
    if better.method == "chain":
        yield f'method "{solver.method}" is explicit, and {better.reason}. Try method = "chain".'
