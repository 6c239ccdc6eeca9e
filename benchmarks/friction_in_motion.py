"""Steps and errors of motions with rubbing cables, over friction, tension and tolerance.

An arm is pulled slowly, an arm swings, an endoscope's two wires are driven by their length. Printed are steps
and the tip's largest error in tolerances, against the same motion at rtol 1e-10. Exit status: 1 if a motion
is not completed, is wrong by more than 30 tolerances (motions without friction: up to 55), or takes more
than 3 times the steps of a tighter tolerance.
"""

import sys
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from continuum_dyn import Scenario, simulate
from continuum_dyn.effects import Inertia, MaterialDamping, RotaryInertia
from continuum_dyn.scenario.profiles import Profile, Sine, SmoothRamp, Step
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.scenario.studies import MotionStudy
from statics import Arm, Bending, Cable, CableFriction, Cables, Extension, Gravity, Outcome, Scene
from statics.effects.effect import Effect

TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)
REFERENCE = 1e-10
FRICTIONS = (0.01, 0.03, 0.1, 0.3, 1.0)
PULLS = ((1.0, 0.8), (5.0, 4.0), (10.0, 9.0), (15.0, 14.0), (20.0, 1.0), (20.0, 19.0))
"""Mean and amplitude of a tension, N."""
ALLOWED = 30.0
"""Largest error of the tip, in tolerances of a step."""
MORE_STEPS = 3.0
"""Largest number of steps, over that of a tighter tolerance."""


def scenario(
    arm: Arm, effects: tuple[Effect, ...], drives: tuple[Profile, ...], duration: float, retardation: float
) -> Scenario:
    """A motion under bending, gravity, friction, damping and these effects."""
    moves = (Inertia(), RotaryInertia(), MaterialDamping(retardation))
    scene = Scene(arm, (Bending(), Gravity(), Cables(), CableFriction(), *effects, *moves))
    return Scenario(scene, drives, MotionStudy(duration, samples=211), Solver("chain"))


def pulled(friction: float, mean: float, amplitude: float) -> Scenario:
    """The paper's arm, its tension a slow sine."""
    arm = Arm.preset("rone2012", cables=(Cable("upper", 0.008, friction=friction),))
    return scenario(arm, (), (Sine(mean, amplitude, 0.25),), 1.05, 1.2e-3)


def swinging(friction: float) -> Scenario:
    """The paper's arm, its tension a step to 1 N."""
    arm = Arm.preset("rone2012", cables=(Cable("upper", 0.008, friction=friction),))
    return scenario(arm, (Extension(),), (Step(0.0, 1.0),), 0.5, 1.2e-3)


def endoscope(friction: float) -> Scenario:
    """A thin arm of 20 disks, its two wires held by motors."""
    wires = [
        Cable(name, offset, friction=friction, cable_stiffness=5e3)
        for name, offset in (("up", 1.6e-3), ("down", -1.6e-3))
    ]
    arm = Arm(
        disks=20,
        disk_spacing=0.003,
        youngs_modulus=60e9,
        area=1.2566e-7,
        second_moment=2.670e-15,
        disk_mass=3e-5,
        disk_inertia=3e-11,
        cables=tuple(wires),
    )
    drives = tuple(SmoothRamp(before=0.0, after=after, start=0.0, end=0.2) for after in (2.5e-3, -2.5e-3))
    return scenario(arm, (Extension(),), drives, 0.5, 3e-4)


def cases() -> Iterator[tuple[str, Scenario]]:
    """Every motion by name."""
    for friction in FRICTIONS:
        for mean, amplitude in PULLS:
            yield f"{mean:g} +- {amplitude:g} N, friction {friction:g}", pulled(friction, mean, amplitude)
        yield f"swing, friction {friction:g}", swinging(friction)
        yield f"endoscope, friction {friction:g}", endoscope(friction)


def tips(case: Scenario, rtol: float) -> tuple[np.ndarray, int, bool]:
    """Tip positions (m) at all samples, steps, and whether the motion is completed."""
    solver = replace(case.solver, max_steps=100_000).with_rtol(rtol)
    run = simulate(replace(case, solver=solver))
    motion = run.trajectory
    assert motion is not None
    tip = np.stack([motion.disk_x[:, -1], motion.disk_y[:, -1]], axis=1)
    return tip, motion.counters["steps"], run.outcome is Outcome.COMPLETED


def judge(case: Scenario) -> tuple[list[str], bool]:
    """A row of the table, and whether all its motions are right."""
    right, _, good = tips(case, REFERENCE)
    cells, counts = [], []
    for rtol in TOLERANCES:
        tip, steps, completed = tips(case, rtol)
        tolerance = case.solver.with_rtol(rtol).tolerance(case.scene.arm.total_length)
        error = np.abs(tip - right).max() / tolerance if completed else np.inf
        good &= bool(error <= ALLOWED)
        cells.append(f"{steps:5d} {error:5.1f}")
        counts.append(steps)
    tighter = np.minimum.accumulate(counts[::-1])[::-1]
    return cells, good and bool(np.all(counts <= MORE_STEPS * tighter))


def main() -> int:
    """Print the table; the exit status."""
    wrong = 0
    print(f"{'steps, error in tolerances':>32} |", " | ".join(f"rtol {rtol:6.0e}" for rtol in TOLERANCES))
    for name, case in cases():
        cells, good = judge(case)
        wrong += not good
        print(f"{name:>32} |", " | ".join(cells), "" if good else "| WRONG", flush=True)
    print("all right" if not wrong else f"{wrong} rows are wrong")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
