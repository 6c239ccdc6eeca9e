"""Which method suits a scene, and why."""

from typing import NamedTuple

from continuum_dyn.study import Method, dissipates
from statics.scene import Scene


class Choice(NamedTuple):
    """A method and the reason for it, as a sentence."""

    method: Method
    reason: str


def choose(scene: Scene) -> Choice:
    """The method for ``method = "auto"``."""
    if any(dissipates(scene, effect) for effect in scene.effects):
        return Choice("chain", "the scene is damped: its fast modes die out and need not be resolved")
    return Choice(
        "DOP853",
        "nothing is damped: an implicit method would damp the fast modes, an explicit one keeps their energy",
    )
