"""The scenario: a scene, its inputs over time, a study, and the solver's settings."""

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

from continuum_dyn.scenario.profiles import Constant, Piecewise, Profile, lower_bound
from continuum_dyn.scenario.rates import Rate, check_smooth
from continuum_dyn.scenario.solver import Accuracy, Solver
from continuum_dyn.scenario.studies import MotionStudy, Study
from statics.arm import Cable
from statics.effects import Effect
from statics.errors import InputError
from statics.scene import Scene


def dissipated_by(scene: Scene) -> list[str]:
    """Names of the effects that take energy from the scene's motion."""
    return [effect.name for effect in scene.effects if _dissipates(scene, effect)]


def _dissipates(scene: Scene, effect: Effect) -> bool:
    return effect.account == "dissipated_power" and any(map(np.any, effect.columns(scene.arm).values()))


def check_pull(cable: Cable, drive: Profile | tuple[float, ...]) -> None:
    """Raise ``InputError`` for a profile of a cable's tension that falls below zero."""
    if isinstance(drive, tuple) or cable.driven_by_length or (least := lower_bound(drive)) >= 0:
        return
    raise InputError(
        f"cable '{cable.name}': a cable cannot push, and its tension falls to {least:g} N. "
        "Allowed: 0 or more."
    )


@dataclasses.dataclass(frozen=True)
class Scenario:
    """A scene, the drive of each of its cables, and the study to make of it.

    ``drives`` holds a profile for each cable, or for a ramp study a list for each: of tensions (N), or of
    displacements (m) of a cable that is driven by its length;
    ``text`` is the file that it was read from, ``tables`` those of the CSV files beside it, by name. With
    ``accuracy`` the solver's tolerances are the program's to choose; with ``chooses_mesh`` the number of the
    arm's sub-segments, too. ``load_factors`` has a profile or a list for each driven load,
    ``base_motion`` profiles of x, y (m) and angle
    (rad) of a base that moves. Raises ``InputError`` if these do not fit.
    """

    scene: Scene
    drives: tuple[Profile, ...] | tuple[tuple[float, ...], ...]
    study: Study
    solver: Solver = dataclasses.field(default_factory=Solver)
    accuracy: Accuracy | None = None
    chooses_mesh: bool = False
    load_factors: tuple[Profile, ...] | tuple[tuple[float, ...], ...] = ()
    base_motion: tuple[Profile, ...] = ()
    title: str = ""
    text: str = ""
    tables: Mapping[str, str] = dataclasses.field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        if len(self.drives) != self.scene.cables:
            raise InputError(
                f"{len(self.drives)} tensions or displacements given for {self.scene.cables} cables."
            )
        if len(self.load_factors) != self.scene.driven_loads:
            raise InputError(
                f"{len(self.load_factors)} factors given for {self.scene.driven_loads} driven loads."
            )
        if self.scene.arm.base_moves or self.base_motion:
            self._check_base()
        for cable, drive in zip(self.scene.arm.cables, self.drives, strict=False):
            check_pull(cable, drive)
        if self.chooses_mesh and self.accuracy is None:
            raise InputError('subsegments = "auto" needs an accuracy. Add [accuracy] tip, in m.')
        if self.accuracy is not None and not self.chooses_mesh and self.study.motion is None:
            raise InputError(
                f'[accuracy] belongs to a study of motion, or to subsegments = "auto"; this is '
                f'"{self.study.kind}" with given segments.'
            )
        if self.solver.has_fixed_step:
            self._check_midpoint()
        self.study.check(self)

    def _check_base(self) -> None:
        arm = self.scene.arm
        if not (arm.base_moves and len(self.base_motion) == len(arm.base_pose)):
            raise InputError(
                f"{len(self.base_motion)} profiles given for the motion of "
                f"{'a moving' if arm.base_moves else 'a fixed'} base. Give x, y and angle of a moving one."
            )
        if self.study.motion is None:
            raise InputError(
                f'a moving base belongs to a study of motion; this is "{self.study.kind}". '
                "Give numbers for its x, y and angle."
            )
        for name, unit, start, profile in zip(
            ("x", "y", "angle"), ("m", "m", "rad"), arm.base_pose, self.base_motion, strict=True
        ):
            check_smooth(profile, f"[base] {name}", unit)
            if profile.initial != start:
                raise InputError(
                    f"[base] {name}: the arm's base is at {start:g} {unit}, but its motion starts at "
                    f"{profile.initial:g}. Give one number for both."
                )
        if arm.massless_nodes or (arm.core_density is None and self.chooses_mesh):
            raise InputError(
                "a moving base needs mass at every node, and some have none. "
                "Give the arm's core_density, or disk_mass."
            )

    def _check_midpoint(self) -> None:
        if self.accuracy is not None:
            raise InputError(
                '[accuracy] chooses tolerances, and method = "midpoint" has none. Give [solver] step without '
                "[accuracy], or another method."
            )
        if self.scene.without_potential:
            raise InputError(
                'method = "midpoint" is for scenes with a potential; without one: '
                f'{" and ".join(self.scene.without_potential)}. Give method = "chain" or '
                '"explicit".'
            )
        damping = dissipated_by(self.scene)
        if damping:
            raise InputError(
                f'method = "midpoint" is for scenes without damping; damped by: {", ".join(damping)}. '
                f'Give method = "chain", or leave {" and ".join(damping)} out of [effects].'
            )

    @property
    def profiles(self) -> tuple[Piecewise, ...]:
        """Drives of a motion, or constants for an equilibrium, in the order of ``Scene.inputs``."""
        driven = (*self.drives, *self.load_factors)
        profiles = tuple(p for p in driven if not isinstance(p, tuple))
        if len(profiles) != len(driven):
            raise InputError(
                f'lists of tensions or load factors belong to a "ramp" study; this is "{self.study.kind}".'
            )
        return (*profiles, *self._other_inputs(profiles))

    def _other_inputs(self, driven: tuple[Any, ...]) -> tuple[Piecewise, ...]:
        """The base's motion, and the rates of cables that are driven by length."""
        pose, motion = self._base_inputs
        drawn_in = (driven[number] for number in self.scene.driven_by_length)
        rates = (Constant(0.0) if isinstance(drive, tuple) else Rate(drive) for drive in drawn_in)
        return (*pose, *rates, *motion)

    @property
    def _base_inputs(self) -> tuple[tuple[Piecewise, ...], tuple[Piecewise, ...]]:
        """Pose of the base; and, if it moves, its velocities and accelerations."""
        arm = self.scene.arm
        if not arm.base_moves:
            return (() if arm.base is None else tuple(map(Constant, arm.base_pose))), ()
        velocities = tuple(map(Rate, self.base_motion))
        return self.base_motion, (*velocities, *map(Rate, velocities))

    @property
    def ramps(self) -> tuple[tuple[float, ...], ...]:
        """The lists of a ramp study: of tensions, and then of load factors."""
        driven = (*self.drives, *self.load_factors)
        lists = tuple(values for values in driven if isinstance(values, tuple))
        if len(lists) != len(driven):
            raise InputError('a "ramp" study takes lists of tensions and load factors, or numbers.')
        return lists

    def require_motion(self, reason: str) -> MotionStudy:
        """The study, if the arm moves in it. Raises ``InputError``, with that reason, if it does not."""
        if self.study.motion is None:
            raise InputError(f'{reason}; this is "{self.study.kind}".')
        return self.study.motion

    def with_mesh(self, subsegments: int, tip: float) -> "Scenario":
        """The scenario with that many segments from disk to disk, in motion to within ``tip`` (m)."""
        arm = dataclasses.replace(self.scene.arm, subsegments=subsegments)
        return dataclasses.replace(
            self,
            scene=Scene(arm, self.scene.effects),
            accuracy=None if self.study.motion is None else Accuracy(tip),
            chooses_mesh=False,
        )

    def without(self, effect: str) -> "Scenario":
        """The scenario without the effect of that name, and without the drives that only it used."""
        scene = self.scene.without(effect)
        return dataclasses.replace(
            self,
            scene=scene,
            drives=self.drives if scene.cables else (),
            load_factors=self.load_factors if scene.driven_loads else (),
        )

    @property
    def settled_within(self) -> float:
        """Distance (m) from the final equilibrium, and speed (m/s), below which the tip has settled."""
        asked = getattr(self.study, "settled_within", None)
        return 1e-3 * self.scene.arm.total_length if asked is None else asked

    @property
    def initial_inputs(self) -> np.ndarray:
        """Inputs of the equilibrium that a study starts from, in the order of ``Scene.inputs``."""
        driven = (*self.drives, *self.load_factors)
        given = (*driven, *self._other_inputs(driven))
        return np.array([t[0] if isinstance(t, tuple) else t.initial for t in given], dtype=float)
