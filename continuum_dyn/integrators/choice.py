"""Which method suits a motion, and why; and which cannot do it."""

from typing import NamedTuple

import numpy as np

from continuum_dyn.dynamics import Dynamics
from continuum_dyn.profiles import Span
from continuum_dyn.study import Method
from statics.effects import Effect
from statics.errors import InputError
from statics.scene import Scene

STIFF = 10.0
"""Ratio of fastest to slowest rate above which implicit steps cost less: measured on arms of 1 to 8 disks."""
FEW = 64
"""Coordinates above which an arm is stiff without asking: the ratio grows with the square of their number."""


class Choice(NamedTuple):
    """A method and the reason for it, as a sentence."""

    method: Method
    reason: str


def choose(dynamics: Dynamics, start: np.ndarray, span: Span) -> Choice:
    """The method for ``method = "auto"``, from the modes of the motion linearized at its start."""
    scene = dynamics.scene
    if scene.arm.massless_nodes:
        return Choice("chain", "nodes between disks carry no mass, which no other method can do with")
    if is_damped(scene) and dynamics.size > FEW:
        return Choice("chain", f"the scene is damped, and {dynamics.size} coordinates make it stiff")
    if is_damped(scene):
        slowest, fastest = rates(dynamics, start, span)
        found = f"its rates go from {slowest:.3g} to {fastest:.3g} 1/s"
        if fastest > STIFF * slowest:
            return Choice("chain", f"the scene is stiff, {found}, and damped: fast modes need no resolving")
        return Choice("explicit", f"the scene is not stiff, {found}: explicit steps are the cheapest")
    return Choice("explicit", "nothing is damped: every mode lasts, and has to be resolved")


def rates(dynamics: Dynamics, y: np.ndarray, span: Span) -> tuple[float, float]:
    """Smallest and largest absolute eigenvalue (1/s) of the motion linearized at ``y``."""
    size = 2 * dynamics.size
    found = np.abs(np.linalg.eigvals(dynamics.jacobian(span.start, y, span)[:size, :size]))
    return float(found.min()), float(found.max())


def check(scene: Scene, method: Method) -> None:
    """Raises ``InputError`` where the method cannot integrate the scene."""
    if scene.arm.massless_nodes and (method != "chain" or not is_damped(scene)):
        raise InputError(
            "the nodes between disks carry no mass: only damping can move them, and only method "
            f'"chain"; this is a {"damped" if is_damped(scene) else "free"} motion by "{method}". '
            "Give the arm's core_density, or effect material_damping and that method."
        )


def is_damped(scene: Scene) -> bool:
    """Whether some effect of the scene takes energy out of it."""
    return any(_dissipates(scene, effect) for effect in scene.effects)


def _dissipates(scene: Scene, effect: Effect) -> bool:
    return effect.account == "dissipated_power" and any(map(np.any, effect.columns(scene.arm).values()))
