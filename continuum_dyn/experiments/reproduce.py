"""The numbers of a paper, computed by its printed equations, by the program, and by the exact rod."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from statics.arm import RONE2012_HOLE_OFFSET, Arm, Cable
from statics.effects import Bending, Cables, Extension, Gravity
from statics.equilibria import Equilibrium, StaticSolver
from statics.errors import InputError, did_you_mean
from statics.judges.exact_rod import RodShape, exact_rod
from statics.judges.rone2012 import PrintedArm, PrintedShape
from statics.scene import Scene

PAPERS = ("rone2012",)

TABLE_2_VIRTUAL_WORK = np.array(
    [[1.999e-2, -5.7854e-5], [3.9999e-2, -2.0610e-4], [5.9998e-2, -4.0136e-4], [7.9997e-2, -6.1469e-4]]
)
"""Unactuated x and y of disks 1 to 4, m; Rone 2012, Table 2. The first x lacks a digit there."""
TABLE_2_FINITE_ELEMENTS = np.array(
    [[1.9999e-2, -5.8970e-5], [3.9999e-2, -2.0347e-4], [5.9998e-2, -3.9055e-4], [7.9997e-2, -5.9276e-4]]
)
"""x and y of the same disks by finite elements, m; Rone 2012, Table 2."""
TABLE_2_PERCENT_ERROR = np.array([2.8268e-5, 3.6533e-5, 5.7060e-5, 6.9687e-5])
"""Error of each disk's distance from the base against finite elements, %; Rone 2012, Table 2."""

FIGURE_4_TENSIONS = (0.05, 0.1, 0.5, 1.0, 2.0)
"""Tensions of Rone 2012, Fig. 4, N. The text names 0.05, 0.1, 0.5 and 2."""
RAMP_TENSIONS = np.linspace(0.0, 2.0, 21)
CORE_RADIUS = 4e-4
"""Radius of the core, m; Table 1's A and J_xx are rounded from it."""
CORE_DENSITY = 7850.0
"""Density of steel, kg/m^3; Table 1's E is its modulus."""


@dataclass(frozen=True)
class Shapes:
    """The arm under one tension (N) by each law."""

    tension: float
    program: Equilibrium
    printed: PrintedShape
    rod: RodShape

    @property
    def by_law(self) -> dict[str, Equilibrium | PrintedShape | RodShape]:
        """The three shapes by their names in tables and files."""
        return {"printed": self.printed, "program": self.program, "exact rod": self.rod}

    @property
    def tip_y(self) -> dict[str, float]:
        """The tip's height by each law, m."""
        return {law: shape.tip[1] for law, shape in self.by_law.items()}

    @property
    def differ_in_sign(self) -> bool:
        """Whether the tip is above the base by one law and below it by another."""
        return min(self.tip_y.values()) < 0 < max(self.tip_y.values())


@dataclass(frozen=True)
class CoreSpread:
    """The unactuated arm with the core's mass distributed along the core instead of in the disks."""

    program: Equilibrium
    rod: RodShape


@dataclass(frozen=True)
class Rone2012:
    """All numerical results of Rone and Ben-Tzvi 2012, recomputed.

    ``unactuated`` is Fig. 3 and Table 2, ``figure_4`` has its tensions, ``ramp`` many from 0 to 2 N;
    ``unrounded`` is the unactuated arm with A and J of a core of 0.4 mm radius instead of Table 1's,
    ``core_spread`` the one whose core has its own mass.
    ``level_tension`` (N) is where the tip is as high as the base, by each law.
    """

    unactuated: Shapes
    unrounded: Equilibrium
    core_spread: CoreSpread
    figure_4: tuple[Shapes, ...]
    ramp: tuple[Shapes, ...]
    level_tension: dict[str, float]

    @property
    def of_opposite_sign(self) -> tuple[Shapes, ...]:
        """The shapes of Fig. 4 whose tip is above the base by one law and below it by another."""
        return tuple(shapes for shapes in self.figure_4 if shapes.differ_in_sign)


class PaperArm:
    """The arm of Table 1 under any tension of its cable, by each law."""

    def __init__(self) -> None:
        arm = Arm.preset("rone2012", cables=(Cable("upper", RONE2012_HOLE_OFFSET),))
        self.scene = Scene(arm, (Bending(), Extension(), Gravity(), Cables()))
        self.printed = PrintedArm(self.scene)
        self.program = StaticSolver(self.scene)

    def shapes(self, tension: float) -> Shapes:
        """The arm by all three laws under one tension, N."""
        return Shapes(
            tension=float(tension),
            program=self.program.solve(np.array([tension])),
            printed=self.printed.solve(tension),
            rod=exact_rod(self.scene, tension),
        )

    def level_tensions(self) -> dict[str, float]:
        """Tension at which the tip is as high as the base, by each law, N."""
        tip_y: dict[str, Callable[[float], float]] = {
            "printed": lambda tension: self.printed.solve(tension).tip[1],
            "program": lambda tension: self.program.solve(np.array([tension])).tip[1],
            "exact rod": lambda tension: exact_rod(self.scene, tension).tip[1],
        }
        return {law: brentq(height, 0.05, 0.5, xtol=1e-7) for law, height in tip_y.items()}


def with_core_spread(scene: Scene) -> Scene:
    """The scene with its core's mass along the core, taken from the disks' effective one."""
    arm = scene.arm
    heavy = replace(arm, core_density=CORE_DENSITY)
    of_disks = (arm.total_mass - heavy.core_masses.sum()) / arm.disks
    return Scene(replace(heavy, disk_mass=float(of_disks)), scene.effects)


def reproduce(paper: str, progress: Callable[[str], None] = lambda _: None) -> Rone2012:
    """Recompute every number of a paper; ``progress`` receives the current step.

    Raises ``InputError`` if the paper is not known.
    """
    if paper not in PAPERS:
        raise InputError(f"unknown paper '{paper}'.{did_you_mean(paper, PAPERS)}")
    progress("kernels, loaded or compiled")
    arm = PaperArm()
    spread = with_core_spread(arm.scene)
    unrounded = Arm.preset("rone2012", cables=arm.scene.arm.cables, **Arm.round_core(CORE_RADIUS))
    progress("Table 2")
    unactuated = arm.shapes(0.0)
    core_spread = CoreSpread(StaticSolver(spread).solve(np.zeros(1)), exact_rod(spread, 0.0))
    progress("Fig. 3 and 4")
    return Rone2012(
        unactuated=unactuated,
        unrounded=StaticSolver(Scene(unrounded, arm.scene.effects)).solve(np.zeros(1)),
        core_spread=core_spread,
        figure_4=tuple(arm.shapes(tension) for tension in FIGURE_4_TENSIONS),
        ramp=tuple(arm.shapes(tension) for tension in RAMP_TENSIONS),
        level_tension=arm.level_tensions(),
    )
