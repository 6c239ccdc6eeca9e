"""A scene: an arm and its effects."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from statics.arm import Arm, CableKind
from statics.core_mass import FRACTIONS
from statics.effects import DiskLoads, Effect
from statics.effects.cables import Poses, cable_lengths
from statics.errors import InputError, did_you_mean
from statics.structure import Structure

MAX_ALIKE = 20
"""Largest number of cables, of changing loads, or of payloads on one disk: each takes time to derive."""
BASE_POSE = ("base_x", "base_y", "base_theta")
BASE_MOTION = (
    *("base_velocity_x", "base_velocity_y", "base_angular_velocity"),
    *("base_acceleration_x", "base_acceleration_y", "base_angular_acceleration"),
)
"""The first and the second derivatives of the base's pose."""


@dataclass(frozen=True)
class Scene:
    """An arm and its effects, in an order that does not matter.

    Raises ``InputError`` if an effect is given twice or needs a number that the arm does not have.
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
        alike = (
            (self.cables, "cables"),
            (self.driven_loads, "driven loads"),
            (self.payloads, "payloads on a disk"),
        )
        for count, what in alike:
            if count > MAX_ALIKE:
                raise InputError(f"{count} {what}: each adds its own equations. Allowed: {MAX_ALIKE}.")
        if self.has("cable_friction") and not self.has("cables"):
            raise InputError("effect 'cable_friction' needs effect 'cables'. Add 'cables', or leave it out.")

    def _check(self, effect: Effect) -> None:
        for quantity in effect.arm_quantities:
            if getattr(self.arm, quantity) == () or not self.arm.has(quantity):
                raise InputError(
                    f"effect '{effect.name}' needs the arm's {quantity}, which is not given. "
                    f"Give {quantity}, or leave '{effect.name}' out."
                )
        effect.columns(self.arm)

    @cached_property
    def structure(self) -> Structure:
        """Structure that the scene's equations are derived from."""
        return Structure(
            effects=tuple(type(effect) for effect in self.effects),
            coordinates=self.coordinates,
            inputs=self.inputs,
            cable_kinds=self.cable_kinds,
            holes_differ=self.holes_differ,
            has_subsegments=self.has_subsegments,
            payloads=self.payloads,
            followers_among_driven=self.followers_among_driven,
            has_followers=self.has_followers,
            core_fractions=FRACTIONS if self.core_has_mass else (),
            base_moves=self.arm.base_moves,
        )

    @property
    def at_rest(self) -> "Scene":
        """This scene with only those effects that act at rest, on a base that does not move."""
        arm = self.arm
        if arm.base is not None and arm.base.moves:
            arm = replace(arm, base=replace(arm.base, moves=False))
        return Scene(arm, (effect for effect in self.effects if effect.acts_at_rest))

    def without(self, name: str) -> "Scene":
        """This scene without the effect of that name; without cables none can rub, either."""
        gone = {name, "cable_friction"} if name == "cables" else {name}
        return Scene(self.arm, (effect for effect in self.effects if effect.name not in gone))

    @cached_property
    def coordinates(self) -> tuple[str, ...]:
        """Names of one segment's coordinates: ``bend_angle``, and ``elongation`` if it can extend."""
        return ("bend_angle", *(name for effect in self.effects for name in effect.coordinates))

    @cached_property
    def cables(self) -> int:
        """Number of cables in play: none unless the scene has the effect ``cables``."""
        return len(self.arm.cables) if self.has("cables") else 0

    @cached_property
    def cable_kinds(self) -> tuple[CableKind, ...]:
        """Kinds of the equations of each cable in play."""
        rubs = self.has("cable_friction")
        cables = self.arm.cables[: self.cables]
        return tuple(CableKind(cable.driven_by_length, rubs and cable.friction > 0) for cable in cables)

    @cached_property
    def _loads(self) -> DiskLoads:
        return next((effect for effect in self.effects if isinstance(effect, DiskLoads)), DiskLoads())

    @cached_property
    def driven_loads(self) -> int:
        """Number of the loads that change in time."""
        return len(self._loads.driven)

    @property
    def followers_among_driven(self) -> tuple[bool, ...]:
        """Flags of the loads that change in time: whether each turns with its disk."""
        return tuple(load.follower for load in self._loads.driven)

    @property
    def has_followers(self) -> bool:
        """Whether some load that does not change in time turns with its disk."""
        return self._loads.has_followers

    @property
    def without_potential(self) -> tuple[str, ...]:
        """Loads that do work without a potential, in words; friction, which has none, only dissipates."""
        follows = self.has_followers or any(self.followers_among_driven)
        return ("follower loads",) if follows else ()

    @property
    def path_hindrances(self) -> tuple[str, ...]:
        """Effects that keep paths from being followed: stability is unknown, or depends on history."""
        friction = ("friction",) if any(kind.rubs for kind in self.cable_kinds) else ()
        return (*self.without_potential, *friction)

    def check_followable(self) -> None:
        """Raise ``InputError`` if paths of equilibria cannot be followed by arc length."""
        if self.path_hindrances:
            raise InputError(
                f'path = "arc_length" needs a potential; without one: {" and ".join(self.path_hindrances)}. '
                'Give path = "stable".'
            )

    @cached_property
    def inputs(self) -> tuple[str, ...]:
        """Names of the numbers that drive the scene.

        Of its cables the tensions, or displacements where those are given, factors of driven loads, the pose
        of a base if the arm has one, the rates of those displacements, and the motion of a base that moves.
        """
        tensions = (
            f"{'cable_displacement' if kind.driven_by_length else 'tension'}_{number}"
            for number, kind in enumerate(self.cable_kinds, start=1)
        )
        factors = (f"load_factor_{number}" for number in range(1, self.driven_loads + 1))
        pose = () if self.arm.base is None else BASE_POSE
        rates = (f"cable_displacement_rate_{number + 1}" for number in self.driven_by_length)
        return (*tensions, *factors, *pose, *rates, *(BASE_MOTION if self.arm.base_moves else ()))

    @property
    def _numbers_without_rates(self) -> int:
        """Number of those inputs that are no rates or accelerations: they stand before the others."""
        return self.cables + self.driven_loads + (0 if self.arm.base is None else len(BASE_POSE))

    @property
    def driven_by_length(self) -> list[int]:
        """Places, from 0 on, of the cables whose displacement is given."""
        return [number for number, kind in enumerate(self.cable_kinds) if kind.driven_by_length]

    def with_zero_rates(self, inputs: np.ndarray) -> np.ndarray:
        """Inputs with zero rates and accelerations of all that moves."""
        still = inputs.copy()
        still[..., self._numbers_without_rates :] = 0.0
        return still

    def driven_by(
        self, inputs: np.ndarray, disk_x: np.ndarray, disk_y: np.ndarray, disk_theta: np.ndarray
    ) -> dict[str, Any]:
        """Inputs, shape (..., inputs), by glossary name, and what follows from the poses, (..., disks).

        ``tension`` and ``cable_displacement`` have shape (..., cables); ``load_factor`` (..., driven loads)
        and the base's pose (...,) are None if the scene has none.
        """
        cables, loads = self.cables, self.cables + self.driven_loads
        known: dict[str, Any] = {"load_factor": inputs[..., cables:loads] if self.driven_loads else None}
        base: Any = np.zeros((3, *inputs.shape[:-1]))
        if self.arm.base:
            base = np.moveaxis(inputs[..., loads : self._numbers_without_rates], -1, 0)
            known |= zip(BASE_POSE, base, strict=True)
        disks = zip(base, (disk_x, disk_y, disk_theta), strict=True)
        x, y, theta = (np.concatenate([start[..., np.newaxis], values], axis=-1) for start, values in disks)
        return known | self._cables_driven_by(inputs[..., :cables], (x, y, theta))

    @cached_property
    def _cable_rest_lengths(self) -> tuple[float, ...]:
        return tuple(map(self.arm.cable_rest_length, self.arm.cables[: self.cables]))

    def _cables_driven_by(self, drives: np.ndarray, poses: Poses) -> dict[str, np.ndarray]:
        """Tension at the base and displacement of every cable, one of which is given."""
        tension, displacement = drives.copy(), drives.copy()
        for number, cable in enumerate(self.arm.cables[: self.cables]):
            drawn_in = self._cable_rest_lengths[number] - cable_lengths(cable, poses).sum(axis=-1)
            if cable.cable_stiffness is None:
                displacement[..., number] = drawn_in
            else:
                stretch = drives[..., number] - drawn_in
                tension[..., number] = cable.cable_stiffness * np.maximum(0.0, stretch)
        return {"tension": tension, "cable_displacement": displacement}

    @property
    def payloads(self) -> int:
        """Largest number of payloads on one disk."""
        return self.arm.payloads_on_a_disk

    @property
    def core_has_mass(self) -> bool:
        """Whether the core's own mass counts: the arm has its density, and some effect acts on masses."""
        return self.arm.core_density is not None and any(effect.site == "mass" for effect in self.effects)

    @property
    def has_subsegments(self) -> bool:
        """Whether cables run past nodes that are not disks: then they join poses further apart."""
        return self.cables > 0 and self.arm.subsegments > 1

    @property
    def holes_differ(self) -> bool:
        """Whether a cable in play has holes of different offsets."""
        return self.cables > 0 and self.arm.holes_differ

    def has(self, name: str) -> bool:
        """Whether the scene has the effect of that name."""
        return any(effect.name == name for effect in self.effects)

    def table(self, site: str, columns: Iterable[str]) -> np.ndarray:
        """The run-time numbers of a kernel, shape (segments, columns), for "segment" or "disk" (nodes).

        A span's stand on its segments. Raises ``InputError`` for what neither the arm nor an effect knows.
        """
        known: dict[str, np.ndarray | float] = {}
        known.update(self.arm.segment_columns() if site == "segment" else self.arm.node_columns())
        for effect in self.effects:
            known.update(effect.columns(self.arm))
        names = list(columns)
        for name in names:
            if name not in known:
                raise InputError(f"'{name}' has no value on each {site}.{did_you_mean(name, known)}")
        table = np.empty((self.arm.segments, len(names)))
        for number, name in enumerate(names):
            table[:, number] = known[name]
        return table

    def check_tension(self, tension: object) -> np.ndarray:
        """Inputs of the scene at rest under these tensions, shape (cables,), N.

        The factors of driven loads are 1, and the base is where it starts.

        Of a cable that is driven by its length it is the displacement, m. Raises ``InputError`` unless there
        is one finite number for each cable, and no negative tension.
        """
        values = np.atleast_1d(np.asarray([] if tension is None else tension, dtype=float))
        if values.shape != (self.cables,):
            raise InputError(
                f"{values.size} tensions given; the scene needs {self.cables}, one for each cable."
            )
        pulls = [not kind.driven_by_length for kind in self.cable_kinds]
        if not (np.isfinite(values).all() and (values[pulls] >= 0).all()):
            raise InputError(f"tensions must be finite, and 0 or more; given: {values.tolist()}.")
        pose = [] if self.arm.base is None else self.arm.base_pose
        known = np.concatenate([values, np.ones(self.driven_loads), pose])
        return np.pad(known, (0, len(self.inputs) - known.size))
