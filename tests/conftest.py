"""Scenes that the tests share: each new structure costs seconds to compile, so there are few."""

import os
import signal
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # its threads spin: on small matrices they only cost

import numpy as np
import pytest
from hypothesis import settings
from hypothesis.internal.conjecture import providers

from continuum_dyn import Scenario, Trajectory, load_scenario, simulate
from continuum_dyn.effects import Inertia, MaterialDamping, RotaryInertia
from continuum_dyn.integrators import METHODS
from continuum_dyn.record import Log, read_log, write_log
from statics import (
    RONE2012_HOLE_OFFSET,
    Arm,
    Bending,
    Cable,
    Cables,
    DiskLoad,
    DiskLoads,
    Equilibrium,
    Extension,
    Gravity,
    PerDisk,
    Scene,
    StaticSolver,
)

settings.register_profile("same_every_time", derandomize=True, deadline=None)
settings.register_profile("explore", derandomize=False, deadline=None, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same_every_time"))
# A shell that starts a command in the background has it and its children ignore Ctrl-C: tests of Ctrl-C
# would wait in vain.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
# Hypothesis also draws the numbers that stand in modules imported so far: then what is drawn would depend on
# the order of tests, and change with any number in the sources.
providers._get_local_constants = lambda: providers._local_constants

SCENARIOS = Path(__file__).parents[1] / "scenarios"
JET = SCENARIOS / "follower_tip.toml"
UPPER = Cable("upper", RONE2012_HOLE_OFFSET)
MOTION = (Inertia(), RotaryInertia(), MaterialDamping(retardation_time=1.2e-3))


ANY_METHOD = [pytest.param(name, marks=pytest.mark.slow) if name == "midpoint" else name for name in METHODS]
"""Every integrator; the one for undamped scenes has structures of its own to compile."""


def rone2012(*, disks: int = 4, stiffness: float = 1.0, gravity: tuple[float, float] = (0.0, -9.81)) -> Scene:
    """The paper's arm and effects: same length and mass for any number of disks, E J as a factor."""
    arm = Arm.preset(
        "rone2012",
        disks=disks,
        disk_spacing=0.08 / disks,
        disk_mass=7.782e-4 * 4 / disks,
        youngs_modulus=2.10e11 * stiffness,
        cables=(UPPER,),
    )
    return Scene(arm, (Bending(), Extension(), Gravity(gravity), Cables()))


def weightless_core(
    *, disks: int, force: tuple[float, float] = (0.0, 0.0), moment: float = 0.0, length: float = 1.0
) -> Scene:
    """A straight, inextensible cantilever with E J = 1 N m^2 under a dead force and a moment at its tip."""
    arm = Arm(disks, length / disks, youngs_modulus=1.0, second_moment=1.0)
    return Scene(arm, (Bending(), DiskLoads(loads=(DiskLoad(disks, force, moment),))))


def moving(scene: Scene, damping: bool = True) -> Scene:
    """The scene with inertia, and with the paper's arm's damping unless it is to go on for ever."""
    return Scene(scene.arm, (*scene.effects, *(MOTION if damping else MOTION[:2])))


def cantilever(disks: int, *loads: DiskLoad, damping: float = 0.0) -> Scene:
    """E J = 1, length 1, mass 1 with half a disk's share at the tip: second order in the number of disks."""
    mass = np.full(disks, 1.0 / disks)
    mass[-1] /= 2
    arm = Arm(
        disks,
        1.0 / disks,
        youngs_modulus=1.0,
        second_moment=1.0,
        each=PerDisk(disk_mass=tuple(mass.tolist())),
    )
    damped = (MaterialDamping(damping),) if damping else ()
    return Scene(arm, (Bending(), DiskLoads(loads), Inertia(), *damped))


def at_rest(scene: Scene) -> Equilibrium:
    """The equilibrium from straight."""
    return StaticSolver(scene).solve(np.empty(0))


def edited(scenario: Path, folder: Path, *changes: tuple[str, str]) -> Scenario:
    """The scenario of a file with these changes to its text, by way of a file in that folder."""
    text = scenario.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path = folder / scenario.name
    path.write_text(text)
    return load_scenario(path)


def motion(scenario: Scenario) -> Trajectory:
    """The trajectory of a scenario that moves."""
    trajectory = simulate(scenario).trajectory
    assert trajectory is not None
    return trajectory


def logged(name: str, folder: Path) -> Log:
    """The log of one of ``scenarios/``, run and written there, read back."""
    path = folder / f"{name}.h5"
    write_log(simulate(load_scenario(SCENARIOS / f"{name}.toml")), path)
    return read_log(path)


@pytest.fixture(scope="session")
def paper_arm() -> Scene:
    """The arm of Table 1 with its four effects at rest."""
    return rone2012()
