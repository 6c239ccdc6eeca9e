"""Choice of the method that suits a motion, and a check whether a method can integrate it."""

from typing import NamedTuple

import numpy as np

from continuum_dyn.integrators.methods import METHODS
from continuum_dyn.modes import rates
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Interval
from continuum_dyn.scenario.scenario import dissipated_by
from continuum_dyn.scenario.solver import Method
from statics.errors import InputError
from statics.scene import Scene

STIFF = 10.0
"""Ratio of fastest to slowest rate above which implicit steps cost less: measured on arms of 1 to 8 disks."""
FEW = 64
"""Largest number of coordinates whose rates are computed: the ratio grows with its square."""
MANY_PERIODS = 1000.0
"""Periods of the slowest mode above which the energy of an undamped motion matters more than its phase."""


class Choice(NamedTuple):
    """A method and the reason for it, as a sentence."""

    method: Method
    reason: str


def choose(
    dynamics: Dynamics, start: np.ndarray, interval: Interval, duration: float, exact: bool = False
) -> Choice:
    """The method for ``method = "auto"``, from the modes of the motion linearized at its start.

    ``exact`` says that an accuracy in metres is requested.
    """
    scene = dynamics.scene
    if scene.arm.massless_nodes:
        return Choice(
            "chain", "some nodes have no mass, and all other methods need the inverse of the mass matrix"
        )
    if any(kind.rubs for kind in scene.cable_kinds):
        return Choice("chain", "cables have friction, which is stiff while they stick")
    if dissipated_by(scene) and dynamics.size > FEW:
        return Choice("chain", f"the scene is damped, and stiff because of its {dynamics.size} coordinates")
    if dissipated_by(scene):
        slowest, fastest = rates(dynamics, start, interval)
        found = f"with rates from {slowest:.3g} to {fastest:.3g} 1/s"
        if fastest > STIFF * slowest:
            return Choice("chain", f"the scene is damped and stiff, {found}: fast modes need not be resolved")
        return Choice("explicit", f"the scene is not stiff, {found}: explicit steps are cheapest")
    slowest = rates(dynamics, start, interval)[0] if dynamics.size <= FEW else dynamics.frequency
    periods = duration * slowest / (2.0 * np.pi)
    if periods > MANY_PERIODS and not exact and not scene.without_potential:
        return Choice(
            "midpoint",
            f"the scene is undamped, and over about {periods:.0g} periods its energy must not drift",
        )
    return Choice("explicit", "the scene is undamped: all modes last, and must be resolved")


def check(scene: Scene, method: Method) -> None:
    """Raise ``InputError`` if the method cannot integrate the scene."""
    damping = dissipated_by(scene)
    of_core = [effect for effect in scene.effects if effect.site == "segment" and effect.name in damping]
    if scene.arm.massless_nodes and not (METHODS[method].moves_massless_nodes and of_core):
        raise InputError(
            'some nodes have no mass: they need damping of the core, and method "chain"; this is '
            f'{"a damped" if of_core else "an undamped"} motion by "{method}". '
            'Give the arm\'s core_density, or material_damping and method "chain".'
        )
