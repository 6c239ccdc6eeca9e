"""Datasets in HDF5 files: with units and meanings from the glossary, and the scales of their dimensions."""

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

import h5py
import numpy as np

from continuum_dyn.record.log_format import PLOTTED, Column
from continuum_dyn.record.sole_writer import temporary_name
from statics.errors import LogError
from statics.quantities import QUANTITIES
from statics.support.interruption import defer_interruption

CHUNK = 512
"""Number of rows in a chunk of a growing dataset."""
IMAGE_BLOCK = 1 << 22
"""Steps in which a file that is made in memory grows, bytes."""
VERSIONS = ("v110", "v110")
"""Oldest and newest HDF5 version of the file: the first that can be read while it is written."""
TEXT = h5py.string_dtype()


@contextmanager
def whole_file(path: Path) -> Iterator[h5py.File]:
    """A new file that takes its place only when it is complete. Raises ``LogError``; then none is there."""
    new = temporary_name(path)
    with defer_interruption():
        try:
            with file_on_disk(new) as file:
                yield file
            move_into_place(new, path)
        except OSError as error:
            raise LogError(f"cannot write {path}: {reason(error)}.") from error
        finally:
            with suppress(OSError):
                new.unlink()


@contextmanager
def file_on_disk(new: Path) -> Iterator[h5py.File]:
    """A new file, made in memory and written at the end. Raises ``OSError`` if it cannot be written.

    HDF5 does not recover from a disk that gets full: it ends the program when it closes the file.
    """
    made = {"driver": "core", "backing_store": False, "block_size": IMAGE_BLOCK}
    with h5py.File(new, "w", libver=VERSIONS, **made) as file:
        yield file
        file.flush()
        image = file.id.get_file_image()
    new.write_bytes(image)


def move_into_place(new: Path, path: Path) -> None:
    """Move a file to its place once all of it is on disk."""
    with new.open("rb") as file:
        os.fsync(file.fileno())
    new.replace(path)


def reason(error: OSError) -> str:
    """The reason why a file could not be read or written, in a line: HDF5 adds much else."""
    return os.strerror(error.errno) if error.errno else str(error).splitlines()[0]


def write_scale(group: h5py.Group, name: str, values: np.ndarray) -> h5py.Dataset:
    """A dimension of the group's datasets."""
    scale = group.create_dataset(name, data=values)
    scale.make_scale(name)
    _describe(scale, name)
    return scale


def write_dataset(group: h5py.Group, name: str, values: np.ndarray, *scales: h5py.Dataset) -> None:
    """A dataset over dimensions. Raises ``LogError`` for numbers that are not finite."""
    check_finite(group, name, values)
    _attach(group.create_dataset(name, data=values), name, scales)


def write_columns(
    group: h5py.Group,
    scales: Mapping[str, np.ndarray],
    columns: Mapping[str, np.ndarray],
    known: Mapping[str, Column],
) -> None:
    """Datasets over the dimensions that ``known`` gives them, with a hint how to plot the group."""
    made = {name: write_scale(group, name, values) for name, values in scales.items()}
    for name, values in columns.items():
        write_dataset(group, name, values, *(made[scale] for scale in known[name].dimensions))
    _mark_plot(group, known)


def begin_columns(
    group: h5py.Group,
    scales: Mapping[str, np.ndarray],
    columns: Mapping[str, np.ndarray],
    known: Mapping[str, Column],
) -> None:
    """Datasets without rows that can grow, over dimensions; the first scale grows with them."""
    first, *others = scales
    made = {name: write_scale(group, name, scales[name]) for name in others}
    made[first] = _create_growing(group, first, scales[first])
    made[first].make_scale(first)
    _describe(made[first], first)
    for name, values in columns.items():
        dimensions = tuple(made[scale] for scale in known[name].dimensions)
        _attach(_create_growing(group, name, values), name, dimensions)
    _mark_plot(group, known)


def check_finite(group: h5py.Group, name: str, values: np.ndarray) -> None:
    """Raise ``LogError`` that names the dataset, unless all values are finite."""
    if values.dtype.kind == "f" and not np.isfinite(values).all():
        raise LogError(f"{group.name}/{name} has numbers that are not finite; the log is not written.")


def _create_growing(group: h5py.Group, name: str, values: np.ndarray) -> h5py.Dataset:
    beside = values.shape[1:]
    chunk = (CHUNK, *(max(size, 1) for size in beside))
    most = (None, *(size or None for size in beside))  # no chunk may be larger than an axis of fixed size
    return group.create_dataset(name, shape=(0, *beside), maxshape=most, chunks=chunk, dtype=values.dtype)


def _attach(dataset: h5py.Dataset, name: str, scales: tuple[h5py.Dataset, ...]) -> None:
    for axis, scale in enumerate(scales):
        dataset.dims[axis].attach_scale(scale)
    _describe(dataset, name)


def _describe(dataset: h5py.Dataset, name: str) -> None:
    quantity = QUANTITIES[name]
    dataset.attrs["units"] = quantity.unit
    dataset.attrs["long_name"] = quantity.meaning


def _mark_plot(group: h5py.Group, known: Mapping[str, Column]) -> None:
    """The NeXus attributes by which viewers such as h5web find a plot of the group, and its axes."""
    signal = PLOTTED.get(group.name.rpartition("/")[2])
    if signal is None:
        return
    group.attrs["NX_class"] = "NXdata"
    group.attrs["signal"] = signal
    group.attrs["axes"] = np.array(known[signal].dimensions, dtype=TEXT)
    group[signal].attrs["interpretation"] = "spectrum"
