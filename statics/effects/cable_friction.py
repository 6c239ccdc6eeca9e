"""Friction of the cables at the holes that they slip through."""

from typing import Any, ClassVar

import numpy as np
from pydantic.dataclasses import dataclass

from statics.arm import Arm
from statics.effects.effect import Account, Pair, Site
from statics.support.checked import STRICT

SLIP_PART = 1e-6
"""Slip of a cable at rest, over the arm's length, at which friction is three quarters of its largest."""
FAR = 1e6
"""Lengths of the arm by which a cable that has only been drawn in counts as having been longer."""


@dataclass(frozen=True, config=STRICT)
class CableFriction:
    """Capstan friction: at a hole that turns a cable by beta its tension falls to exp(-mu |beta|) of it.

    It falls in the direction that the cable slips from, so along the arm while the cable is drawn in. What
    is lost of the tension by there pushes along the hole-to-hole length l, against the tension.
    """

    name: ClassVar[str] = "cable_friction"
    site: ClassVar[Site] = "span"
    account: ClassVar[Account] = "dissipated_power"
    acts_at_rest: ClassVar[bool] = True
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ("cables",)
    quantities: ClassVar[tuple[str, ...]] = ("friction", "slip_speed", "slip_length", "length_before")
    source: ClassVar[str] = "Euler 1769 and Eytelwein 1808, belt friction"

    def pairs(self, at: Any) -> list[Pair]:
        """A pair for each cable that rubs: tension lost, hole-to-hole length."""
        return [Pair(cable.tension_lost, cable.length) for cable in at.cables if cable.kind.rubs]

    def columns(self, arm: Arm) -> dict[str, np.ndarray]:
        """Friction of the arm's cables, numbered, and lengths that a cable at rest slips by and from, m.

        ``length_before`` is the cable's length beyond a hole before its last slip; here all have been drawn
        in from far.
        """
        of_all = {"slip_length": SLIP_PART * arm.total_length, "length_before": FAR * arm.total_length}
        return {
            f"{name}_{number}": np.full(arm.segments, value)
            for number, cable in enumerate(arm.cables, start=1)
            for name, value in {"friction": cable.friction, "slip_speed": cable.slip_speed, **of_all}.items()
        }
