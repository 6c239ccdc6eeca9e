"""A scene: an arm and the effects that it calls for."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from statics.arm import Arm
from statics.effects import DiskLoads, Effect
from statics.errors import InputError


@dataclass(frozen=True)
class Scene:
    """An arm and its effects, in an order that does not matter.

    Raises ``InputError`` where an effect is given twice or needs a number that the arm does not have.
    """

    arm: Arm
    effects: tuple[Effect, ...]

    def __init__(self, arm: Arm, effects: Iterable[Effect]) -> None:
        object.__setattr__(self, "arm", arm)
        object.__setattr__(self, "effects", tuple(sorted(effects, key=lambda effect: effect.name)))
        for name, count in Counter(effect.name for effect in self.effects).items():
            if count > 1:
                raise InputError(f"effect '{name}' is given {count} times. Give it once.")
        for effect in self.effects:
            self._check(effect)

    def _check(self, effect: Effect) -> None:
        for quantity in effect.arm_quantities:
            if getattr(self.arm, quantity) == () or not self.arm.knows(quantity):
                raise InputError(
                    f"effect '{effect.name}' needs the arm's {quantity}, which is not given. "
                    f"Give {quantity}, or leave '{effect.name}' out."
                )
        effect.columns(self.arm)

    @property
    def at_rest(self) -> "Scene":
        """The same scene with only those effects that act at rest."""
        return Scene(self.arm, (effect for effect in self.effects if effect.acts_at_rest))

    def without(self, name: str) -> "Scene":
        """The same scene without the effect of that name."""
        return Scene(self.arm, (effect for effect in self.effects if effect.name != name))

    @cached_property
    def coordinates(self) -> tuple[str, ...]:
        """Names of one segment's coordinates: ``bend_angle``, and ``elongation`` if it can extend."""
        return ("bend_angle", *(name for effect in self.effects for name in effect.coordinates))

    @property
    def cables(self) -> int:
        """Number of cables in play: none unless the scene has the effect ``cables``."""
        return len(self.arm.cables) if self.has("cables") else 0

    @property
    def driven_loads(self) -> int:
        """Number of the loads that change in time."""
        return sum(effect.driven for effect in self.effects if isinstance(effect, DiskLoads))

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of the numbers that drive the scene: tensions of its cables, then factors of driven loads."""
        tensions = (f"tension_{number}" for number in range(1, self.cables + 1))
        factors = (f"load_factor_{number}" for number in range(1, self.driven_loads + 1))
        return (*tensions, *factors)

    @property
    def payloads(self) -> int:
        """Largest number of payloads on one disk."""
        return self.arm.payloads_on_a_disk

    @property
    def core_has_mass(self) -> bool:
        """Whether the core's own mass counts: the arm has its density, and some effect acts on masses."""
        return self.arm.core_density is not None and any(effect.place == "mass" for effect in self.effects)

    @property
    def spans(self) -> bool:
        """Whether cables run past nodes that are not disks: then they join poses further apart."""
        return self.cables > 0 and self.arm.subsegments > 1

    @property
    def holes_differ(self) -> bool:
        """Whether a cable in play has holes of different offsets."""
        return self.cables > 0 and self.arm.holes_differ

    def has(self, name: str) -> bool:
        """Whether the scene calls for the effect of that name."""
        return any(effect.name == name for effect in self.effects)

    def table(self, place: str, columns: Iterable[str]) -> np.ndarray:
        """The run-time numbers of a kernel, shape (segments, columns), for "segment" or "disk" (nodes)."""
        known: dict[str, np.ndarray | float] = {}
        known.update(self.arm.segment_columns() if place == "segment" else self.arm.node_columns())
        for effect in self.effects:
            known.update(effect.columns(self.arm))
        names = list(columns)
        table = np.empty((self.arm.segments, len(names)))
        for number, name in enumerate(names):
            table[:, number] = known[name]
        return table

    def check_tension(self, tension: object) -> np.ndarray:
        """Inputs of the scene at these tensions, shape (cables,), N; the factors of driven loads are 1.

        Raises ``InputError`` unless there is one finite, non-negative number for each cable.
        """
        values = np.atleast_1d(np.asarray([] if tension is None else tension, dtype=float))
        if values.shape != (self.cables,):
            raise InputError(f"{values.size} tensions given; the scene has {self.cables} cables in play.")
        if not (np.isfinite(values).all() and (values >= 0).all()):
            raise InputError(f"tensions must be finite and not negative; given: {values.tolist()}.")
        return np.append(values, np.ones(self.driven_loads))
