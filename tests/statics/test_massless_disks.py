"""Disks without mass: the limit of light ones, and what is refused."""

from dataclasses import replace

import pytest
from conftest import motion, moving, rone2012

from continuum_dyn import Scenario, Trajectory
from continuum_dyn.scenario.profiles import Step
from continuum_dyn.scenario.solver import Method, Solver
from continuum_dyn.scenario.studies import MotionStudy
from continuum_dyn.simulation.accuracy import tip_distance
from statics import InputError, PerDisk, Scene

TIP = 3e-3
"""Mass of the last disk, kg."""


def heavy_at_the_tip(others: float) -> Scene:
    """The paper's arm with that mass (kg) on each disk before the last."""
    scene = moving(rone2012())
    each = PerDisk(disk_mass=(others, others, others, TIP), disk_inertia=(0.0, 0.0, 0.0, 1e-7))
    return Scene(replace(scene.arm, each=each), scene.effects)


def stepped(scene: Scene, method: Method = "chain") -> Trajectory:
    study = MotionStudy(0.1, samples=101)
    return motion(Scenario(scene, (Step(0.0, 1.0),), study, Solver(method, 1e-10, 1e-13)))


def test_disks_without_mass_are_the_limit_of_light_ones() -> None:
    massless = stepped(heavy_at_the_tip(0.0))
    apart = [tip_distance(massless, stepped(heavy_at_the_tip(mass))) for mass in (1e-7, 1e-9)]
    assert apart[0] == pytest.approx(100 * apart[1], rel=0.1)
    assert apart[1] < 1e-8


@pytest.mark.parametrize(("others", "massless"), [(0.0, True), (1e-9, False)])
def test_an_arm_knows_whether_all_its_nodes_have_mass(others: float, massless: bool) -> None:
    arm = heavy_at_the_tip(others).arm
    assert arm.massless_nodes is massless
    assert not replace(arm, core_density=7850.0).massless_nodes


def test_disks_without_mass_leave_the_chain_alone() -> None:
    with pytest.raises(InputError, match=r'some nodes have no mass: .* method "chain"'):
        stepped(heavy_at_the_tip(0.0), "Radau")


def test_an_arm_without_any_mass_is_refused() -> None:
    scene = rone2012()
    with pytest.raises(InputError, match="nothing of the arm has mass"):
        moving(Scene(replace(scene.arm, disk_mass=0.0), scene.effects))
