"""The cost of accuracy as an HDF5 file."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import h5py
import numpy as np

from continuum_dyn.experiments.cost import Cost, MeshPrice
from continuum_dyn.record.datasets import TEXT, whole_file, write_dataset, write_scale


def write_cost(cost: Cost, path: Path) -> None:
    """Write the group ``cost``, and ``mesh`` if meshes were tried. Raises ``LogError``."""
    prices = cost.prices
    columns = {
        "method": np.array([p.method for p in prices], TEXT),
        "rtol": np.array([p.rtol for p in prices]),
        "tip_error": np.array([p.error for p in prices]),
        "solve_time": np.array([p.seconds for p in prices]),
        "steps": np.array([p.steps for p in prices]),
        "segment_evaluations": np.array([p.segment_evaluations for p in prices]),
    }
    with whole_file(path) as file:
        file.attrs.update({"title": cost.scenario.title, "scenario": cost.scenario.text})
        group = file.create_group("cost")
        group.attrs["reference_gap"] = cost.reference_gap
        _write(group, "price", np.arange(1, len(prices) + 1), columns)
        if cost.meshes:
            _write_meshes(file.create_group("mesh"), cost.meshes)


def _write_meshes(group: h5py.Group, meshes: Sequence[MeshPrice]) -> None:
    columns = {
        "tip_error": np.array([mesh.tip_error for mesh in meshes]),
        "angle_error": np.array([mesh.angle_error for mesh in meshes]),
        "solve_time": np.array([mesh.seconds for mesh in meshes]),
        "segment_evaluations": np.array([mesh.segment_evaluations for mesh in meshes]),
    }
    _write(group, "subsegments", np.array([mesh.subsegments for mesh in meshes]), columns)


def _write(group: h5py.Group, along: str, numbers: np.ndarray, columns: Mapping[str, np.ndarray]) -> None:
    scale = write_scale(group, along, numbers)
    for name, values in columns.items():
        write_dataset(group, name, values, scale)
