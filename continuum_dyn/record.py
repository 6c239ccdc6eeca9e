"""Logs: HDF5 files that hold a run, and what is needed to understand it.

Groups ``trajectory`` (samples of a motion), ``equilibria`` (points) and ``arm`` (cables). Every dataset
carries ``units`` and ``long_name`` from the glossary and dimension scales, so that xarray opens a group
as it is. A log is complete or not there: it is written beside its place and then moved.
"""

import platform
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from continuum_dyn.cost import Cost, MeshPrice
from continuum_dyn.simulation import Run
from continuum_dyn.study import MotionStudy, Scenario
from continuum_dyn.trajectory import Trajectory
from statics.equilibria import Equilibrium
from statics.errors import LogError
from statics.interruption import held
from statics.outcome import Outcome
from statics.quantities import QUANTITIES

FORMAT = "continuum-dyn log"
FORMAT_VERSION = 2

_DIMENSIONS = {
    **dict.fromkeys(("bend_angle", "bend_angle_rate", "elongation", "elongation_rate"), "segment"),
    **dict.fromkeys(("curvature", "length"), "segment"),
    **dict.fromkeys(("disk_x", "disk_y", "disk_theta"), "disk"),
    "tension": "cable",
    "cable_displacement": "cable",
    "load_factor": "load",
}
"""Second dimension of datasets that have one."""

_PER_POINT = (
    "tension",
    "cable_displacement",
    "load_factor",
    "bend_angle",
    "elongation",
    "curvature",
    "length",
    "disk_x",
    "disk_y",
    "disk_theta",
    "elastic_energy",
    "gravity_energy",
    "stable",
    "unstable_directions",
    "critical",
    "jumped",
    "residual",
    "base_x",
    "base_y",
    "base_theta",
)


@dataclass(frozen=True)
class Log:
    """A log read back: arrays by glossary name; ``trajectory`` is empty where nothing moved.

    ``scenario`` is the text of the scenario's file, ``tables`` those of the CSV files that it names.
    """

    path: Path
    title: str
    outcome: Outcome
    message: str
    scenario: str
    tables: Mapping[str, str]
    attributes: Mapping[str, Any]
    cables: tuple[str, ...]
    arm: Mapping[str, np.ndarray]
    trajectory: Mapping[str, np.ndarray]
    equilibria: Mapping[str, np.ndarray]


def write_log(run: Run, path: Path) -> None:
    """Write a run. Raises ``LogError`` if the file cannot be written; then nothing is left behind."""
    with _whole_file(path) as file:
        _write(file, run)


def read_log(path: Path) -> Log:
    """Read a whole log. Raises ``LogError`` for a file that is not one, or of another format version."""
    try:
        with h5py.File(path, "r") as file:
            return _read(file, path)
    except FileNotFoundError as error:
        raise LogError(f"{path}: no such file.") from error
    except (OSError, KeyError) as error:
        raise LogError(f"{path}: not a log of continuum-dyn: {error}") from error


def write_cost(cost: Cost, path: Path) -> None:
    """Write what accuracy costs as the group ``cost`` of a file of its own. Raises ``LogError``."""
    prices = cost.prices
    columns = {
        "method": np.array([p.method for p in prices], h5py.string_dtype()),
        "rtol": np.array([p.rtol for p in prices]),
        "tip_error": np.array([p.error for p in prices]),
        "solve_time": np.array([p.seconds for p in prices]),
        "steps": np.array([p.steps for p in prices]),
        "segment_evaluations": np.array([p.segment_evaluations for p in prices]),
    }
    with _whole_file(path) as file:
        file.attrs.update({"title": cost.scenario.title, "scenario": cost.scenario.text})
        group = file.create_group("cost")
        group.attrs["reference_gap"] = cost.reference_gap
        _write_scale(group, "price", np.arange(1, len(prices) + 1))
        for name, values in columns.items():
            _write_dataset(group, name, values, ["price"])
        if cost.meshes:
            _write_meshes(file.create_group("mesh"), cost.meshes)


def _write_meshes(group: h5py.Group, meshes: Sequence[MeshPrice]) -> None:
    _write_scale(group, "subsegments", np.array([mesh.subsegments for mesh in meshes]))
    columns = {
        "tip_error": [mesh.tip_error for mesh in meshes],
        "angle_error": [mesh.angle_error for mesh in meshes],
        "solve_time": [mesh.seconds for mesh in meshes],
        "segment_evaluations": [mesh.segment_evaluations for mesh in meshes],
    }
    for name, values in columns.items():
        _write_dataset(group, name, np.array(values), ["subsegments"])


@contextmanager
def _whole_file(path: Path) -> Iterator[h5py.File]:
    """A new file that takes its place only when it is complete."""
    part = path.with_name(path.name + ".part")
    with held():
        try:
            with h5py.File(part, "w", libver=("v110", "v110")) as file:
                yield file
            part.replace(path)
        except OSError as error:
            raise LogError(f"cannot write {path}: {error.strerror or error}.") from error
        finally:
            with suppress(OSError):
                part.unlink()


def _write(file: h5py.File, run: Run) -> None:
    file.attrs.update(_root_attributes(run))
    _write_tables(file.create_group("tables"), run.scenario.tables)
    _write_arm(file.create_group("arm"), run.scenario)
    numbers, points, times = _points(run)
    if points:
        group = file.create_group("equilibria")
        columns = {name: _stacked(points, name) for name in _PER_POINT} | {"time": times}
        known = {name: values for name, values in columns.items() if values is not None}
        _write_group(group, "point", numbers, known, run.scenario)
    if run.trajectory is not None:
        group = file.create_group("trajectory")
        group.attrs.update(run.trajectory.counters)
        columns = _trajectory_columns(run.trajectory)
        _write_group(group, "time", columns.pop("time"), columns, run.scenario)


def _root_attributes(run: Run) -> dict[str, Any]:
    packages = ("continuum-dyn", "numpy", "scipy", "sympy", "numba", "h5py")
    attributes: dict[str, Any] = {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "title": run.scenario.title,
        "scenario": run.scenario.text,
        "study": run.scenario.study.kind,
        "outcome": str(run.outcome),
        "message": run.message,
        "solve_time": run.solve_time,
        "versions": ", ".join(
            ["python " + platform.python_version(), *(f"{p} {version(p)}" for p in packages)]
        ),
    }
    if isinstance(run.scenario.study, MotionStudy):
        attributes |= (run.solver or run.scenario.solver).settings
    for name in ("tip_error", "static_gap"):
        if getattr(run, name) is not None:
            attributes[name] = getattr(run, name)
    if run.mesh is not None:
        attributes |= {"mesh_error": run.mesh.estimate, "mesh_extrapolated": run.mesh.extrapolated}
    return attributes


def _write_tables(group: h5py.Group, tables: Mapping[str, str]) -> None:
    """Each text in UTF-8, as it was read; its name in the scenario, which may be a path, as an attribute."""
    for number, (name, text) in enumerate(tables.items(), start=1):
        content = np.frombuffer(text.encode(), dtype=np.uint8)
        dataset = group.create_dataset(str(number), data=content, compression="gzip", shuffle=True)
        dataset.attrs["file"] = name


def _write_arm(group: h5py.Group, scenario: Scenario) -> None:
    arm = scenario.scene.arm
    each = {name: values for name, values in vars(arm.each).items() if values is not None}
    given = {name: value for name, value in vars(arm).items() if name not in each}
    numbers = {name: value for name, value in given.items() if isinstance(value, int | float)}
    group.attrs.update(numbers)
    cables = arm.cables[: scenario.scene.cables]
    _write_scale(group, "cable", _names(scenario))
    _write_scale(group, "hole", np.arange(arm.disks + 1))
    _write_scale(group, "disk", np.arange(1, arm.disks + 1))
    offsets = np.array([cable.holes(arm.disks) for cable in cables]).reshape(-1, arm.disks + 1)
    _write_dataset(group, "hole_offset", offsets, ["cable", "hole"])
    anchors = np.array([cable.anchor or arm.disks for cable in cables], dtype=int)
    _write_dataset(group, "anchor", anchors, ["cable"])
    _write_dataset(group, "friction", np.array([cable.friction for cable in cables], dtype=float), ["cable"])
    stiffness = np.array([cable.cable_stiffness or 0.0 for cable in cables], dtype=float)
    _write_dataset(group, "cable_stiffness", stiffness, ["cable"])
    for name, values in each.items():
        _write_dataset(group, name, np.array(values), ["disk"])


def _points(run: Run) -> tuple[np.ndarray, list[Equilibrium], np.ndarray | None]:
    """The equilibria that were found, their numbers in the study, and in a motion their times.

    Unstable ones that a search has left stand before the one that it found, under the same number.
    """
    asked = run.static_path or run.equilibria
    rows = [
        (number, row) for number, point in enumerate(asked) if point.found for row in (*point.left, point)
    ]
    numbers, times = np.array([number for number, _ in rows], dtype=int), None
    if run.trajectory is not None:
        assert isinstance(run.scenario.study, MotionStudy)
        ends = np.array([0.0, run.scenario.study.duration])
        times = (run.trajectory.time if run.static_path else ends)[numbers]
    return numbers + 1, [row for _, row in rows], times


def _stacked(points: Sequence[Equilibrium], name: str) -> np.ndarray | None:
    values = [getattr(point, name) for point in points]
    return None if values[0] is None else np.array(values)


def _trajectory_columns(trajectory: Trajectory) -> dict[str, np.ndarray]:
    columns = {name: value for name, value in vars(trajectory).items() if isinstance(value, np.ndarray)}
    del columns["tip_speed"], columns["inputs"]
    return columns | trajectory.ledger


def _names(scenario: Scenario) -> np.ndarray:
    names = scenario.scene.arm.cable_names[: scenario.scene.cables]
    return np.array(names, dtype=h5py.string_dtype())


def _write_group(
    group: h5py.Group, first: str, along: np.ndarray, columns: Mapping[str, np.ndarray], scenario: Scenario
) -> None:
    """Datasets whose first axis is ``first``, with the scales of all axes beside them."""
    arm = scenario.scene.arm
    scales = {
        first: along,
        "segment": np.arange(1, arm.segments + 1),
        "disk": np.arange(1, arm.disks + 1),
        "cable": _names(scenario),
    }
    if "load_factor" in columns:
        scales["load"] = np.arange(1, scenario.scene.driven_loads + 1)
    for name, values in scales.items():
        _write_scale(group, name, values)
    for name, values in columns.items():
        _write_dataset(group, name, values, [first, _DIMENSIONS[name]] if values.ndim == 2 else [first])


def _write_scale(group: h5py.Group, name: str, values: np.ndarray) -> None:
    group.create_dataset(name, data=values).make_scale(name)
    _describe(group[name], name)


def _write_dataset(group: h5py.Group, name: str, values: np.ndarray, dimensions: Sequence[str]) -> None:
    if values.dtype.kind == "f" and not np.isfinite(values).all():
        raise LogError(f"{group.name}/{name} holds numbers that are not finite; they belong in no log.")
    packed = {"compression": "gzip", "shuffle": True, "fletcher32": True} if values.size > 1000 else {}
    dataset = group.create_dataset(name, data=values, **packed)
    for axis, scale in enumerate(dimensions):
        dataset.dims[axis].attach_scale(group[scale])
    _describe(dataset, name)


def _describe(dataset: h5py.Dataset, name: str) -> None:
    quantity = QUANTITIES[name]
    dataset.attrs["units"] = quantity.unit
    dataset.attrs["long_name"] = quantity.meaning


def _read(file: h5py.File, path: Path) -> Log:
    attributes = dict(file.attrs)
    if attributes.get("format") != FORMAT:
        raise LogError(f"{path}: an HDF5 file, but not a log of continuum-dyn.")
    if attributes["format_version"] != FORMAT_VERSION:
        raise LogError(
            f"{path}: log format {attributes['format_version']}; this program reads format {FORMAT_VERSION}."
        )
    return Log(
        path=path,
        title=attributes["title"],
        outcome=Outcome(attributes["outcome"]),
        message=attributes["message"],
        scenario=attributes["scenario"],
        tables={table.attrs["file"]: table[()].tobytes().decode() for table in file["tables"].values()},
        attributes=attributes,
        cables=tuple(name.decode() for name in file["arm/cable"][()]),
        arm=dict(file["arm"].attrs) | _arrays(file["arm"]),
        trajectory=_arrays(file.get("trajectory")),
        equilibria=_arrays(file.get("equilibria")),
    )


def _arrays(group: h5py.Group | None) -> dict[str, np.ndarray]:
    return {} if group is None else {name: dataset[()] for name, dataset in group.items() if name != "cable"}
