"""Check of a log against the format: a message for every difference.

A file supplies numbers and texts alone: nothing of it is run, imported or unpickled, no other file is
opened, and no more memory is taken than the file's size warrants.
"""

from collections.abc import Iterator, Mapping
from math import prod
from typing import Any

import h5py
import numpy as np

from continuum_dyn.record.log_format import (
    ATTRIBUTES,
    COUNTERS,
    FORMAT,
    FORMAT_VERSION,
    GROUPS,
    OPTIONAL_ATTRIBUTES,
    Column,
    Kind,
)
from continuum_dyn.record.opened import SMALL, Opened, attribute
from statics.outcome import Outcome
from statics.quantities import QUANTITIES

MOST_EXPANSION = 100
"""Largest size of a log's datasets over that of its file, which may be compressed, if it is large."""
LARGEST = 8_000_000_000
"""Largest size of a log's datasets, bytes: more than the study with the most samples stores."""
MOST_NAMES, LONGEST_NAME = 1000, 1000
"""Largest number of names of cables, and length of one, bytes."""

_SCALARS = {str: "a text", float: "a finite number", int: "a whole number", bool: "true or false"}


def departures(file: Opened) -> Iterator[str]:
    """Differences that prevent reading: wrong names, types, shapes and links of required parts.

    Nothing else is checked if the format or its version is another one.
    """
    found = list(_other_format(file))
    if found:
        yield from found
        return
    yield from _wrong_attributes(file, ATTRIBUTES, OPTIONAL_ATTRIBUTES)
    yield from _wrong_outcome(file)
    for name in ("tables", "arm"):
        if file.group.get(name, getlink=True) is None:
            yield f"group {name} is missing"
    yield from _wrong_tables(file)
    for name, known in GROUPS.items():
        yield from _wrong_group(file, name, known)
    yield from _wrong_arm(file)
    too_large = list(_too_large(file))
    yield from too_large or _wrong_names(file)


def _other_format(file: Opened) -> Iterator[str]:
    if file.attribute("format") != FORMAT:
        yield "an HDF5 file, but not a log of continuum-dyn"
    elif (read := file.attribute("format_version")) != FORMAT_VERSION:
        yield f"log format {str(read)[:40]}; this program reads format {FORMAT_VERSION}"


def _is(value: Any, kind: type) -> bool:
    if kind is float:
        return type(value) in (float, int) and bool(np.isfinite(value))
    return type(value) is kind


def _wrong_attributes(
    place: Opened, needed: Mapping[str, type], optional: Mapping[str, type]
) -> Iterator[str]:
    for name, kind in {**needed, **optional}.items():
        value = place.attribute(name)
        if value is None and name not in place.group.attrs:
            if name in needed:
                yield f"attribute {name} is missing"
        elif not _is(value, kind):
            read = _form_of(place.group.attrs.get_id(name))
            yield f"attribute {name}: {_SCALARS[kind]} is expected; read {read}"


def _form_of(attribute_id: h5py.h5a.AttrID) -> str:
    return f"one of type {attribute_id.dtype} and shape {attribute_id.shape}"


def _wrong_outcome(file: Opened) -> Iterator[str]:
    outcome = file.attribute("outcome")
    if isinstance(outcome, str) and outcome not in set(Outcome):
        yield f"attribute outcome: read {outcome[:40]!r}. Allowed: {', '.join(Outcome)}"


def _wrong_tables(file: Opened) -> Iterator[str]:
    group, wrong = file.group_of("tables")
    if wrong:
        yield wrong
    if group is None:
        return
    for name in group.names:
        table, wrong = group.dataset_of(name)
        if wrong:
            yield wrong
        elif table is not None and (table.dtype != np.uint8 or table.ndim != 1):
            yield f"{table.name}: bytes over one dimension are expected; read {_form(table)}"
        elif table is not None and not isinstance(attribute(table, "file"), str):
            yield f"{table.name}: its attribute file, the name of the table, is missing"


def _wrong_group(file: Opened, name: str, known: Mapping[str, Column]) -> Iterator[str]:
    group, wrong = file.group_of(name)
    if wrong:
        yield wrong
    if group is None:
        return
    if name == "trajectory":
        yield from _wrong_attributes(group, {}, dict.fromkeys(COUNTERS, int))
    datasets = {}
    for dataset, column in known.items():
        found, wrong = group.dataset_of(dataset)
        if found is not None:
            datasets[dataset] = found
            wrong = _wrong_type(found, column)
        elif not wrong and column.required:
            wrong = f"/{name}/{dataset} is missing"
        if wrong:
            yield wrong
    growing = name == "trajectory" and not file.attribute("complete")
    yield from _wrong_shapes(datasets, known, growing)


def _wrong_arm(file: Opened) -> Iterator[str]:
    arm = file.group_of("arm")[0]
    if arm is None:
        return
    spacing = {} if "disk_spacing" in arm.group else {"disk_spacing": float}
    for wrong in _wrong_attributes(arm, {"disks": int, "subsegments": int, **spacing}, {}):
        yield f"/arm: {wrong}"


def _wrong_type(dataset: h5py.Dataset, column: Column) -> str:
    if kind_of(dataset) is column.kind:
        return ""
    return f"{dataset.name}: {column.kind} is expected; read {_form(dataset)}"


def kind_of(dataset: h5py.Dataset) -> Kind | None:
    """The type of a dataset's values; None if the format does not know it."""
    dtype = dataset.dtype
    if h5py.check_string_dtype(dtype) is not None:
        return Kind.TEXT
    kinds = {("f", 8): Kind.FLOAT, ("i", 8): Kind.INTEGER, ("b", 1): Kind.TRUTH}
    return kinds.get((dtype.kind, dtype.itemsize))


def _form(dataset: h5py.Dataset) -> str:
    return f"{str(dataset.dtype)[:40]} of shape {dataset.shape}"


def _wrong_shapes(
    datasets: Mapping[str, h5py.Dataset], known: Mapping[str, Column], growing: bool
) -> Iterator[str]:
    sizes = {name: found.shape[0] for name, found in datasets.items() if found.shape and found.ndim == 1}
    for name, found in datasets.items():
        dimensions = known[name].dimensions
        missing = [scale for scale in dimensions if scale not in sizes]
        if missing:
            yield f"{found.name}: its dimension {missing[0]} is missing, or not one-dimensional"
            continue
        expected = tuple(sizes[scale] for scale in dimensions)
        first = int(growing and dimensions[0] == "time")
        if (
            found.shape is None
            or len(found.shape) != len(expected)
            or found.shape[first:] != expected[first:]
        ):
            yield f"{found.name}: shape {expected} of {dimensions} is expected; read {_form(found)}"


def _too_large(file: Opened) -> Iterator[str]:
    """Datasets declared larger than the file can hold, by themselves or by the chunks they are read in."""
    size = file.group.file.id.get_filesize()
    allowed = min(max(SMALL, MOST_EXPANSION * size), LARGEST)
    declared = 0
    groups = [file.group_of(name)[0] for name in ("tables", *GROUPS)]
    for group in filter(None, groups):
        for name in group.names:
            found = group.dataset_of(name)[0]
            if found is not None and found.shape is not None:
                shapes = [found.shape] if found.chunks is None else [found.shape, found.chunks]
                counts = list(map(prod, shapes))
                declared += (max(counts) if counts[0] else 0) * found.dtype.itemsize
    if declared > allowed:
        yield f"datasets of {declared:.3g} bytes in a file of {size:.3g}: damaged, not read"


def _wrong_names(file: Opened) -> Iterator[str]:
    """Names of cables that are too many or too long; read one by one: all may be one long text."""
    arm = file.group_of("arm")[0]
    names = None if arm is None else arm.dataset_of("cable")[0]
    if names is None or kind_of(names) is not Kind.TEXT or names.ndim != 1:
        return
    if names.size > MOST_NAMES:
        yield f"{names.name}: {names.size} names; at most {MOST_NAMES} are read"
        return
    for number in range(names.size):
        length = len(names[number])
        if length > LONGEST_NAME:
            yield f"{names.name}: a name of {length} characters; at most {LONGEST_NAME} are read"
            return


def oddities(file: Opened) -> Iterator[str]:
    """Differences that do not prevent reading: units, meanings and scales unlike the format's."""
    for name, known in GROUPS.items():
        group = file.group_of(name)[0]
        if group is None:
            continue
        for dataset in group.names:
            if dataset not in known:
                yield f"/{name}/{dataset}: not a name of the format"
                continue
            found = group.dataset_of(dataset)[0]
            if found is not None:
                yield from _odd_words(found, dataset)
        yield from _odd_scales(group.group, known)
    for name in file.names:
        if name not in GROUPS and name != "tables":
            yield f"/{name}: not a name of the format"


def _odd_words(found: h5py.Dataset, name: str) -> Iterator[str]:
    quantity = QUANTITIES[name]
    for key, expected in (("units", quantity.unit), ("long_name", quantity.meaning)):
        read = attribute(found, key)
        if read != expected:
            yield f"{found.name}: {key} {expected!r} is expected; read {str(read)[:60]!r}"


def _odd_scales(group: h5py.Group, known: Mapping[str, Column]) -> Iterator[str]:
    """Dimensions without their scale, by the scales' own lists of references."""
    attached: dict[str, set[tuple[str, int]]] = {}
    for name, column in known.items():
        if column.dimensions == (name,) and name in group:
            if attribute(group[name], "CLASS") != "DIMENSION_SCALE":
                yield f"{group.name}/{name}: is not a dimension scale"
            attached[name] = set(_attachments(group[name]))
    for name, column in known.items():
        for axis, scale in enumerate(column.dimensions):
            if name in group and name != scale and (name, axis) not in attached.get(scale, ()):
                yield f"{group.name}/{name}: {scale} is not attached to its axis {axis} as a scale"


def _attachments(scale: h5py.Dataset) -> Iterator[tuple[str, int]]:
    """Names of the datasets that a scale is attached to, and which of their axes."""
    if "REFERENCE_LIST" not in scale.attrs:
        return
    if scale.attrs.get_id("REFERENCE_LIST").get_storage_size() > SMALL:
        return
    places = scale.attrs["REFERENCE_LIST"]
    if getattr(places.dtype, "names", None) != ("dataset", "dimension"):
        return
    for reference, axis in places:
        if isinstance(reference, h5py.Reference) and reference:
            name = h5py.h5i.get_name(h5py.h5r.dereference(reference, scale.id)) or b""
            yield name.decode("utf-8", "surrogateescape").rpartition("/")[2], int(axis)
