"""The speeds of the package on ``PYTHONPATH``, in seconds, as one JSON object: what two commits are held by.

Only public names are used, so that the same text measures any commit. A speed is the least of some repeats.
"""

import json
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from continuum_dyn import Run, load_scenario, simulate
from statics import StaticSolver, equilibrium

SCENARIOS = Path(__file__).parents[1] / "scenarios"
SEGMENTS = {4: 50.0, 64: 5.0, 1024: 0.2}
"""Segments, and duration of the motion (s) whose Newton iterations are timed."""
PULL = np.array([2.0])
ENOUGH = 0.2
"""Seconds that a speed is measured for, at least."""
DRIVEN = """
title = "An arm pulled up and down without rest"
[arm]
preset = "rone2012"
disks = {disks}
disk_spacing = {spacing}
disk_mass = {mass}
disk_inertia = {inertia}
[effects]
bending = {{}}
extension = {{}}
gravity = {{ acceleration = [0.0, -9.81] }}
inertia = {{}}
rotary_inertia = {{}}
material_damping = {{ retardation_time = 1.2e-3 }}
[[cables]]
name = "upper"
hole_offset = 0.008
tension = {{ profile = "sine", mean = 1.0, amplitude = 0.9, frequency = 20.0 }}
[study]
kind = "motion"
duration = {duration}
samples = 3
[solver]
method = "chain"
"""
"""The paper's arm, its length, mass and inertia spread over so many disks."""


def repeated(work: Callable[[], float]) -> float:
    """Least of what enough repeats return."""
    found, started = [work()], time.perf_counter()
    while len(found) < 3 or time.perf_counter() - started < ENOUGH:
        found.append(work())
    return min(found)


def timed(work: Callable[[], object]) -> Callable[[], float]:
    """The work, made to return the seconds that it takes."""

    def seconds() -> float:
        started = time.perf_counter()
        work()
        return time.perf_counter() - started

    return seconds


def driven(disks: int, duration: float) -> Path:
    """A scenario's file."""
    shares = {"spacing": 0.08 / disks, "mass": 3.1128e-3 / disks, "inertia": 8.116e-8 / disks}
    with tempfile.NamedTemporaryFile("w", suffix=".toml", delete=False) as file:
        file.write(DRIVEN.format(disks=disks, duration=duration, **shares))
    return Path(file.name)


def iteration(run: Run) -> float:
    """Seconds of solving to each Newton iteration and segment of a motion."""
    assert run.trajectory is not None
    work = run.trajectory.counters["newton_iterations"] * run.scenario.scene.arm.segments
    return run.solve_time / work


def speeds() -> dict[str, float]:
    """All speeds by what they are of."""
    found: dict[str, float] = {}
    for disks, duration in SEGMENTS.items():
        path = driven(disks, duration)
        scenario = load_scenario(path)
        path.unlink()
        found[f"Newton iteration, a segment of {disks}"] = repeated(lambda: iteration(simulate(scenario)))  # noqa: B023
        if disks == 64:
            continue
        scene, solver = scenario.scene, StaticSolver(scenario.scene)
        found[f"equilibrium, {disks} segments"] = repeated(timed(lambda: equilibrium(scene, PULL)))  # noqa: B023
        found[f"the same of one solver, {disks} segments"] = repeated(timed(lambda: solver.solve(PULL)))  # noqa: B023
    exact = load_scenario(SCENARIOS / "step_response_within_1_um.toml")
    return found | {"step response within 1 um": repeated(lambda: simulate(exact).solve_time)}


if __name__ == "__main__":
    print(json.dumps(speeds()))
