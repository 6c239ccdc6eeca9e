"""The format of logs, as data: the datasets of each group, their dimensions and types.

``docs/reference/log_format.md`` describes it in words. Units and meanings are the glossary's.
"""

from dataclasses import dataclass, fields
from enum import StrEnum

from statics.arm import PerDisk

FORMAT = "continuum-dyn log"
FORMAT_VERSION = 2
UNFINISHED = ".part"
"""Suffix of a log while its run goes on, and after a run that was killed."""


class Kind(StrEnum):
    """Types of values, as messages call them."""

    FLOAT = "64-bit floating point"
    INTEGER = "64-bit integer"
    TRUTH = "boolean"
    TEXT = "text"


@dataclass(frozen=True)
class Column:
    """A dataset: its dimensions, each a dataset of the same group, and the type of its values."""

    dimensions: tuple[str, ...]
    kind: Kind = Kind.FLOAT
    required: bool = True


def _scales(**kinds: Kind) -> dict[str, Column]:
    return {name: Column((name,), kind) for name, kind in kinds.items()}


def _columns(names: str, *dimensions: str, required: bool = True) -> dict[str, Column]:
    return {name: Column(dimensions, Kind.FLOAT, required) for name in names.split()}


_ARM_SCALES = _scales(segment=Kind.INTEGER, disk=Kind.INTEGER, cable=Kind.TEXT)
_LOAD = {"load": Column(("load",), Kind.INTEGER, required=False)}


def _shapes(along: str) -> dict[str, Column]:
    """Datasets that a motion's samples and equilibria have in common."""
    return {
        **_ARM_SCALES,
        **_LOAD,
        **_columns("bend_angle curvature length", along, "segment"),
        **_columns("elongation", along, "segment", required=False),
        **_columns("disk_x disk_y disk_theta", along, "disk"),
        **_columns("tension cable_displacement", along, "cable"),
        **_columns("load_factor", along, "load", required=False),
        **_columns("base_x base_y base_theta", along, required=False),
        **_columns("elastic_energy gravity_energy", along),
    }


GROUPS: dict[str, dict[str, Column]] = {
    "trajectory": {
        **_scales(time=Kind.FLOAT),
        **_shapes("time"),
        **_columns("bend_angle_rate", "time", "segment"),
        **_columns("elongation_rate", "time", "segment", required=False),
        **_columns(
            "step_size kinetic_energy input_power dissipated_power input_work dissipated_energy", "time"
        ),
    },
    "equilibria": {
        **_scales(point=Kind.INTEGER),
        **_shapes("point"),
        **_columns("residual", "point"),
        "critical": Column(("point",), Kind.INTEGER),
        "jumped": Column(("point",), Kind.TRUTH),
        "stable": Column(("point",), Kind.TRUTH, required=False),
        "unstable_directions": Column(("point",), Kind.INTEGER, required=False),
        **_columns("time", "point", required=False),
    },
    "arm": {
        **_scales(cable=Kind.TEXT, hole=Kind.INTEGER, disk=Kind.INTEGER),
        **_columns("hole_offset", "cable", "hole"),
        **_columns("friction cable_stiffness", "cable"),
        "anchor": Column(("cable",), Kind.INTEGER),
        "start": Column(("cable",), Kind.INTEGER, required=False),
        **_columns(" ".join(field.name for field in fields(PerDisk)), "disk", required=False),
    },
}
"""Datasets by group; the first is the group's own scale. A log without a motion has no ``trajectory``, one
without an equilibrium no ``equilibria``."""

PLOTTED = {"trajectory": "disk_y", "equilibria": "disk_y"}
"""The dataset of a group that a viewer of HDF5 files plots first."""

ATTRIBUTES: dict[str, type] = {
    "title": str,
    "scenario": str,
    "study": str,
    "outcome": str,
    "message": str,
    "versions": str,
    "complete": bool,
    "solve_time": float,
}
"""Attributes of the file, beside its format and version."""

OPTIONAL_ATTRIBUTES: dict[str, type] = {
    "method": str,
    "rtol": float,
    "atol": float,
    "step": float,
    "static_gap": float,
    "rest_x": float,
    "rest_y": float,
    "tip_error": float,
    "bending_strain": float,
    "warnings": str,
    "mesh_error": float,
    "mesh_extrapolated": bool,
}
"""Attributes of the file that not every run has."""

COUNTERS = (
    *("steps", "segment_evaluations", "rejections", "newton_iterations"),
    *("evaluations", "jacobians", "decompositions"),
)
"""Attributes of the trajectory: what its solver counted, integers."""
