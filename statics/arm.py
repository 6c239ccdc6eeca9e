"""The arm as data: its core, its disks, its cables; and the arm of Rone's Table 1.

Positive senses, everywhere in the program::

      y ^            hole at +hole_offset
        |        .---o---.                 bend_angle > 0 : the tip turns counter-clockwise,
        |        | disk 1|                                  towards +y
    ----+========|===+===|=========...     elongation > 0 : the segment is longer than disk_spacing
     base   seg. 1   |   |   seg. 2        tension    > 0 : the cable pulls
        |        '-------'                 disk_theta > 0 : the disk has turned counter-clockwise
        +-----------------------> x

A cable on the +y side bends the arm towards +y. Segment i ends in the centre of disk i;
segments and disks count from 1 at the base.
"""

from collections import Counter
from dataclasses import field
from math import pi
from typing import Annotated, Any

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass

from statics.checked import STRICT, Positive
from statics.errors import InputError, did_you_mean

MAX_DISKS = 10_000

DiskNumber = Annotated[int, Field(ge=1, le=MAX_DISKS)]


@dataclass(frozen=True, config=STRICT)
class Cable:
    """A cable through a hole of every disk up to its anchor; ``anchor=None`` is the last disk."""

    name: str
    hole_offset: float
    anchor: DiskNumber | None = None


RONE2012: dict[str, Any] = {
    # Rone and Ben-Tzvi 2012, Table 1. In-plane rotation is about a disk's diameter: I_xx, not I_zz.
    "disks": 4,  # n
    "disk_spacing": 0.02,  # L_0
    "youngs_modulus": 2.10e11,  # E
    "area": 5.027e-7,  # A
    "second_moment": 2.011e-14,  # J_xx
    "disk_mass": 7.782e-4,  # m
    "disk_inertia": 2.029e-8,  # I_xx
}
PRESETS: dict[str, dict[str, Any]] = {"rone2012": RONE2012}

RONE2012_HOLE_OFFSET = 0.008
"""r_h of Table 1, m."""


@dataclass(frozen=True, config=STRICT)
class Arm:
    """A planar arm of equal segments. A number may stay None where no effect of the scene needs it.

    Raises ``InputError`` for cables that do not fit, ``pydantic.ValidationError`` (a ``ValueError``)
    for numbers of the wrong kind or sign.
    """

    disks: DiskNumber
    disk_spacing: Positive
    youngs_modulus: Positive | None = None
    area: Positive | None = None
    second_moment: Positive | None = None
    disk_mass: Positive | None = None
    disk_inertia: Positive | None = None
    reference_curvature: float = 0.0
    cables: Annotated[tuple[Cable, ...], Field(strict=False)] = field(default=())

    def __post_init__(self) -> None:
        for cable in self.cables:
            self._check(cable)
        for name, count in Counter(cable.name for cable in self.cables).items():
            if count > 1:
                raise InputError(f"{count} cables are named '{name}'. Give each its own name.")

    def _check(self, cable: Cable) -> None:
        if cable.anchor is not None and cable.anchor > self.disks:
            raise InputError(
                f"cable '{cable.name}': anchor {cable.anchor} is beyond the arm. "
                f"Allowed: disks 1 to {self.disks}."
            )
        if abs(self.reference_curvature * cable.hole_offset) >= 1:
            raise InputError(
                f"cable '{cable.name}': reference_curvature x hole_offset is "
                f"{self.reference_curvature * cable.hole_offset:g}, so its holes meet in the unloaded arm. "
                "Allowed: between -1 and 1. Lessen reference_curvature or hole_offset."
            )

    @classmethod
    def preset(cls, name: str, **changes: Any) -> "Arm":
        """An arm from the literature; what is given in ``changes`` beats the preset.

        Raises ``InputError`` for a name that is not a preset.
        """
        if name not in PRESETS:
            raise InputError(f"unknown preset '{name}'.{did_you_mean(name, PRESETS)}")
        return cls(**{**PRESETS[name], **changes})

    @staticmethod
    def round_core(radius: float) -> dict[str, float]:
        """Area and second moment of a round core of that radius (m), as arguments of ``Arm``."""
        return {"area": pi * radius**2, "second_moment": pi * radius**4 / 4}

    @property
    def rest_length(self) -> float:
        """Undeformed length of one segment, L0, m."""
        return self.disk_spacing

    @property
    def total_length(self) -> float:
        """Undeformed length of the whole arm, m."""
        return self.disks * self.disk_spacing

    @property
    def cable_names(self) -> tuple[str, ...]:
        """Names of the cables, in the order of the tensions."""
        return tuple(cable.name for cable in self.cables)

    def segment_columns(self) -> dict[str, np.ndarray | float]:
        """What the arm knows of each segment, by glossary name: scalars, or shape (disks,)."""
        columns: dict[str, np.ndarray | float | None] = {
            "rest_length": self.rest_length,
            "bending_stiffness": _product(self.youngs_modulus, self.second_moment),
            "axial_stiffness": _product(self.youngs_modulus, self.area),
            "reference_curvature": self.reference_curvature,
        }
        segment = np.arange(1, self.disks + 1)
        for number, cable in enumerate(self.cables, start=1):
            columns[f"hole_offset_{number}"] = cable.hole_offset
            columns[f"cable_passes_{number}"] = (segment <= (cable.anchor or self.disks)).astype(float)
        return _known(columns)

    def disk_columns(self) -> dict[str, np.ndarray | float]:
        """What the arm knows of each disk, by glossary name: scalars, or shape (disks,)."""
        return _known({"disk_mass": self.disk_mass, "disk_inertia": self.disk_inertia})


def _product(first: float | None, second: float | None) -> float | None:
    return None if first is None or second is None else first * second


def _known(columns: dict[str, np.ndarray | float | None]) -> dict[str, np.ndarray | float]:
    return {name: value for name, value in columns.items() if value is not None}
