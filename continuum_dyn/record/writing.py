"""Writing of a run as a log in one step: the log is complete or missing."""

import platform
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np

from continuum_dyn.record.datasets import TEXT, whole_file, write_columns
from continuum_dyn.record.log_format import FORMAT, FORMAT_VERSION, GROUPS
from continuum_dyn.scenario.scenario import Scenario

if TYPE_CHECKING:
    from continuum_dyn.simulation import Run
    from continuum_dyn.simulation.trajectory import Trajectory
    from statics.equilibria import Equilibrium


def write_log(run: "Run", path: str | Path) -> None:
    """Write a run. Raises ``LogError`` if the file cannot be written; then nothing is left behind."""
    with whole_file(Path(path)) as file:
        file.attrs.update(attributes_of(run))
        write_scenario(file, run.scenario)
        write_equilibria(file, run)
        if run.trajectory is not None:
            group = file.create_group("trajectory")
            group.attrs.update(run.trajectory.counters)
            columns = columns_of(run.trajectory)
            scales = {"time": columns.pop("time")} | scales_of(run.scenario, columns)
            write_columns(group, scales, columns, GROUPS["trajectory"])


def attributes_of(run: "Run", complete: bool = True) -> dict[str, Any]:
    """Attributes of the file: the study, its outcome, and the versions of the program."""
    attributes: dict[str, Any] = {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "NX_class": "NXroot",
        "title": run.scenario.title,
        "scenario": run.scenario.text,
        "study": run.scenario.study.kind,
        "outcome": str(run.outcome),
        "message": run.message,
        "complete": complete,
        "solve_time": run.solve_time,
        "versions": _versions(),
    }
    if run.trajectory is not None or not complete:
        attributes["default"] = "trajectory"
    elif any(point.found for point in run.equilibria):
        attributes["default"] = "equilibria"
    if run.scenario.study.motion is not None:
        attributes |= (run.solver or run.scenario.solver).settings
    if run.warnings:
        attributes["warnings"] = "\n".join(run.warnings)
    for name in ("tip_error", "static_gap", "bending_strain"):
        if getattr(run, name) is not None:
            attributes[name] = getattr(run, name)
    if run.rest is not None and len(run.rests) > 1:
        attributes |= {"rest_x": run.rest[0], "rest_y": run.rest[1]}
    if run.mesh is not None:
        attributes |= {"mesh_error": run.mesh.estimate, "mesh_extrapolated": run.mesh.extrapolated}
    return attributes


@cache
def _versions() -> str:
    packages = ("continuum-dyn", "numpy", "scipy", "sympy", "llvmlite", "h5py")
    return ", ".join(["python " + platform.python_version(), *(f"{p} {version(p)}" for p in packages)])


def write_scenario(file: h5py.File, scenario: Scenario) -> None:
    """Write the scenario's tables and its arm."""
    _write_tables(file.create_group("tables"), scenario.tables)
    _write_arm(file.create_group("arm"), scenario)


def _write_tables(group: h5py.Group, tables: Mapping[str, str]) -> None:
    """Write each text in UTF-8, as it was read; its name in the scenario, perhaps a path, is an attribute."""
    for number, (name, text) in enumerate(tables.items(), start=1):
        dataset = group.create_dataset(str(number), data=np.frombuffer(text.encode(), dtype=np.uint8))
        dataset.attrs["file"] = name


def _write_arm(group: h5py.Group, scenario: Scenario) -> None:
    arm = scenario.scene.arm
    each = {name: values for name, values in vars(arm.each).items() if values is not None}
    given = {name: value for name, value in vars(arm).items() if name not in each}
    group.attrs.update({name: value for name, value in given.items() if isinstance(value, int | float)})
    cables = arm.cables[: scenario.scene.cables]
    scales = {
        "cable": _names(scenario),
        "hole": np.arange(arm.disks + 1),
        "disk": np.arange(1, arm.disks + 1),
    }
    columns = {
        "hole_offset": np.array([cable.holes(arm.disks) for cable in cables]).reshape(-1, arm.disks + 1),
        "anchor": np.array([cable.anchor or arm.disks for cable in cables], dtype=int),
        "start": np.array([cable.start or 0 for cable in cables], dtype=int),
        "friction": np.array([cable.friction for cable in cables], dtype=float),
        "cable_stiffness": np.array([cable.cable_stiffness or 0.0 for cable in cables], dtype=float),
        **{name: np.array(values, dtype=float) for name, values in each.items()},
    }
    write_columns(group, scales, columns, GROUPS["arm"])


def write_equilibria(file: h5py.File, run: "Run") -> None:
    """Write the equilibria that were found, with their numbers in the study, and in a motion their times.

    Unstable ones that a search has left precede the one that it found, with the same number.
    """
    asked = run.static_path or run.equilibria
    rows = [
        (number, row) for number, point in enumerate(asked) if point.found for row in (*point.left, point)
    ]
    if not rows:
        return
    numbers, points = np.array([number for number, _ in rows]), [row for _, row in rows]
    names = [name for name in GROUPS["equilibria"] if hasattr(points[0], name)]
    columns = {name: values for name in names if (values := _stack(points, name)) is not None}
    if (study := run.scenario.study.motion) is not None:
        ends = np.array([0.0, study.duration])
        columns["time"] = (run.trajectory.time if run.static_path and run.trajectory else ends)[numbers]
    scales = {"point": numbers + 1} | scales_of(run.scenario, columns)
    write_columns(file.create_group("equilibria"), scales, columns, GROUPS["equilibria"])


def _stack(points: Sequence["Equilibrium"], name: str) -> np.ndarray | None:
    """The values of all points; None if one of them has none."""
    values = [getattr(point, name) for point in points]
    return None if any(value is None for value in values) else np.array(values)


def columns_of(trajectory: "Trajectory") -> dict[str, np.ndarray]:
    """A motion's samples by glossary name, its time among them."""
    columns = {name: value for name, value in vars(trajectory).items() if isinstance(value, np.ndarray)}
    del columns["tip_speed"], columns["inputs"]
    return columns | trajectory.ledger


def scales_of(scenario: Scenario, columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The scales of the datasets' dimensions after the first one."""
    arm = scenario.scene.arm
    scales = {
        "segment": np.arange(1, arm.segments + 1),
        "disk": np.arange(1, arm.disks + 1),
        "cable": _names(scenario),
    }
    if "load_factor" in columns:
        scales["load"] = np.arange(1, scenario.scene.driven_loads + 1)
    return scales


def _names(scenario: Scenario) -> np.ndarray:
    return np.array(scenario.scene.arm.cable_names[: scenario.scene.cables], dtype=TEXT)
