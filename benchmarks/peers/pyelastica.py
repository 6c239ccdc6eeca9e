"""PyElastica: a Cosserat rod that bends where this arm's hinges would, with cable and damping of our own.

Two elements make a segment. The node between them takes the segment's whole bending, the node at a disk is
nearly rigid and carries the disk's mass: so a coarse rod does best against segments of constant curvature.
The cable from hole to hole and the core's viscosity are a forcing compiled by numba, for PyElastica has
neither. The axial stiffness is lowered, for its explicit steps must resolve the rod's axial waves.
"""

# pyright: reportMissingImports=false

from collections.abc import Iterator
from functools import partial
from typing import Any

import elastica
import numpy as np
from numba import njit

from .case import PAPER_DISKS, Answer, Case, timed

PACKAGES = ("pyelastica",)
LACKS = (
    "cables, disks and a core's viscosity of its own; implicit steps: so it is softer axially, damped "
    "otherwise there, and has 1 % of the disks' mass between them"
)
BETWEEN = 0.01
"""Share of a disk's mass that the node in the middle of a segment has."""
RIGID = 300.0
"""How much stiffer the node at a disk is than the one in the middle of a segment."""
AXIAL_DAMPING = 0.2
"""Of sqrt(stiffness times mass) between the nodes; the core's own would ask for far smaller steps."""
SETTINGS = ((1000, 100), (100, 100), (100, 200), (10, 500))
"""How many times softer than the core the rod is along its axis, and steps between samples (1 ms)."""
SETTINGS_IF_FINER = {16: (10, 1250), 64: (10, 15000)}
"""The same by the number of disks. The viscous bending of a light element bounds the step, as 1 / disks^2."""
REPEATS = 3


class Simulator(elastica.BaseSystemCollection, elastica.Constraints, elastica.Forcing, elastica.CallBacks):
    """What PyElastica is asked to do."""


class CoreDamping(elastica.NoForces):
    """Viscosity of the core in bending, and a little along its axis."""

    def __init__(self, case: Case, softer: float) -> None:
        super().__init__()
        stiffness = case.EA / softer / (case.L0 / 2)
        self.axial = AXIAL_DAMPING * np.sqrt(stiffness * BETWEEN * case.mass)
        self.bending = case.retardation * case.EJ / case.L0

    def apply_forces(self, system: Any, time: Any = 0.0) -> None:
        """Forces between nodes, torques between elements."""
        del time
        rates = (system.velocity_collection, system.omega_collection, system.director_collection)
        _damp(self.axial, self.bending, *rates, system.external_forces, system.external_torques)


class Cable(elastica.NoForces):
    """A cable straight from hole to hole, the first in the base."""

    def __init__(self, case: Case) -> None:
        super().__init__()
        self.tension, self.hole = case.tension, case.hole

    def apply_forces(self, system: Any, time: Any = 0.0) -> None:
        """Pulls at the disks' nodes, their moments on the elements on either side."""
        del time
        places = (system.position_collection, system.director_collection)
        _pull(self.tension, self.hole, *places, system.external_forces, system.external_torques)


# Rows of a director are z, the other normal and the axis: row 0 of local torques and rates is about z.


@njit(cache=True)
def _damp(axial: Any, bending: Any, v: Any, omega: Any, director: Any, force: Any, torque: Any) -> None:
    elements = omega.shape[1]
    for k in range(elements):
        along_x, along_y = director[2, 0, k], director[2, 1, k]
        drag = axial * ((v[0, k + 1] - v[0, k]) * along_x + (v[1, k + 1] - v[1, k]) * along_y)
        force[0, k] += drag * along_x
        force[1, k] += drag * along_y
        force[0, k + 1] -= drag * along_x
        force[1, k + 1] -= drag * along_y
        if k + 1 < elements:
            moment = bending * (omega[0, k + 1] - omega[0, k])
            torque[0, k] += moment
            torque[0, k + 1] -= moment


@njit(cache=True)
def _pull(tension: Any, hole: Any, x: Any, director: Any, force: Any, torque: Any) -> None:
    near_x, near_y, last = 0.0, hole, director.shape[2] - 1
    arm_x, arm_y = 0.0, hole
    for node in range(2, last + 2, 2):
        before, after = node - 1, min(node, last)
        across = -0.5 * (director[2, 1, before] + director[2, 1, after])
        up = 0.5 * (director[2, 0, before] + director[2, 0, after])
        near_arm_x, near_arm_y = arm_x, arm_y
        arm_x, arm_y = hole * across / np.hypot(across, up), hole * up / np.hypot(across, up)
        way_x, way_y = x[0, node] + arm_x - near_x, x[1, node] + arm_y - near_y
        pull_x = tension * way_x / np.hypot(way_x, way_y)
        pull_y = tension * way_y / np.hypot(way_x, way_y)
        _load(force, torque, node, -pull_x, -pull_y, arm_x, arm_y)
        _load(force, torque, node - 2, pull_x, pull_y, near_arm_x, near_arm_y)
        near_x, near_y = x[0, node] + arm_x, x[1, node] + arm_y


@njit(cache=True)
def _load(force: Any, torque: Any, node: Any, f_x: Any, f_y: Any, arm_x: Any, arm_y: Any) -> None:
    moment = arm_x * f_y - arm_y * f_x
    force[0, node] += f_x
    force[1, node] += f_y
    torque[0, max(node - 1, 0)] += 0.5 * moment
    torque[0, min(node, torque.shape[1] - 1)] += 0.5 * moment


def answers(case: Case) -> Iterator[Answer]:
    """Position Verlet at the steps that the axial stiffness allows."""
    papers = case.disks == PAPER_DISKS
    finer = SETTINGS_IF_FINER.get(case.disks, (10, 5 * case.disks**2))
    for softer, count in SETTINGS if papers else (finer,):
        answer = timed(partial(_solve, case, softer, count), REPEATS if papers else 1)
        settings = f"PositionVerlet, EA / {softer}, step {1e6 * case.samples[1] / count:.3g} us"
        yield Answer("rod", settings, *answer, LACKS)


def _solve(case: Case, softer: float, count: int) -> np.ndarray:
    """Build, step, and return the tip at the samples."""
    rod, simulator = _rod(case, softer), Simulator()
    simulator.append(rod)
    simulator.constrain(rod).using(
        elastica.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,)
    )
    gravity = np.array([*case.gravity, 0.0])
    simulator.add_forcing_to(rod).using(elastica.GravityForces, acc_gravity=gravity)
    simulator.add_forcing_to(rod).using(CoreDamping, case=case, softer=softer)
    simulator.add_forcing_to(rod).using(Cable, case=case)
    simulator.finalize()
    stepper, tip, now = elastica.PositionVerlet(), np.empty((case.samples.size, 2)), np.float64(0.0)
    step = np.float64(case.samples[1] / count)
    tip[0] = rod.position_collection[:2, -1]
    for sample in range(1, case.samples.size):
        for _ in range(count):
            now = stepper.step(simulator, now, step)
        tip[sample] = rod.position_collection[:2, -1]
    return tip


def _rod(case: Case, softer: float) -> Any:
    """The rod at rest without tension, disks' masses and inertias put on it."""
    elements, half = 2 * case.disks, case.L0 / 2
    rod = elastica.CosseratRod.straight_rod(
        elements,
        np.zeros(3),
        np.array([1.0, 0.0, 0.0]),
        np.array([0.0, 0.0, 1.0]),
        case.disks * case.L0,
        1e-3,
        1000.0,
        youngs_modulus=1e9,
        shear_modulus=4e8,
    )
    rod.mass[1::2] = BETWEEN * case.mass
    rod.mass[2::2] = (1 - BETWEEN) * case.mass
    rod.mass[-1] += BETWEEN / 2 * case.mass
    share = np.append(np.full(elements - 1, 0.5), 1.0) * case.inertia
    for axis in range(3):
        rod.mass_second_moment_of_inertia[axis, axis] = share
        rod.inv_mass_second_moment_of_inertia[axis, axis] = 1 / share
        rod.shear_matrix[axis, axis] = case.EA / softer
        rod.bend_matrix[axis, axis, 0::2] = case.EJ * half / case.L0
        rod.bend_matrix[axis, axis, 1::2] = RIGID * case.EJ * half / case.L0
    _lay(case, rod)
    return rod


def _lay(case: Case, rod: Any) -> None:
    """Put the rod where its hinges balance the weights of the disks."""
    elements = 2 * case.disks
    angles, places = np.zeros(elements), np.zeros((2, elements + 1))
    for _ in range(50):
        places[:, 1:] = case.L0 / 2 * np.cumsum([np.cos(angles), np.sin(angles)], axis=1)
        weight = case.gravity[1] * rod.mass[1:]
        hinges = places[0, 1::2]
        levers = np.maximum(places[0, 1:] - hinges[:, None], 0.0)
        bends = (levers * weight).sum(axis=1) / (case.EJ / case.L0)
        angles[1:] = np.repeat(np.cumsum(bends), 2)[: elements - 1]
    rod.position_collection[:2] = places
    rod.director_collection[2, 0], rod.director_collection[2, 1] = np.cos(angles), np.sin(angles)
    rod.director_collection[1, 0], rod.director_collection[1, 1] = np.sin(angles), -np.cos(angles)
