"""Checks a log against the format: every place where it departs from it, in words.

A file supplies numbers and texts alone: nothing of it is run, imported or unpickled, no other file is
opened, and no more memory is taken than the file's size warrants.
"""

from collections.abc import Iterator, Mapping
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
from statics.outcome import Outcome
from statics.quantities import QUANTITIES

SMALL = 16_000_000
"""Largest size of a log's datasets, bytes, if its file is small."""
MOST_EXPANSION = 100
"""Largest size of a log's datasets over that of its file, which may be compressed, if it is large."""
LARGEST = 8_000_000_000
"""Largest size of a log's datasets, bytes: more than the study with the most samples stores."""
MOST_NAMES, LONGEST_NAME = 1000, 1000
"""Largest number of names of cables, and length of one, bytes."""
PLAIN_FILTERS = {h5py.h5z.FILTER_DEFLATE, h5py.h5z.FILTER_SHUFFLE, h5py.h5z.FILTER_FLETCHER32}
"""Compression and checksums that HDF5 has built in; others would load libraries."""

_SCALARS = {str: "a text", float: "a finite number", int: "a whole number", bool: "true or false"}


def departures(file: h5py.File) -> Iterator[str]:
    """Departures that prevent reading: wrong names, types, shapes and links of required parts.

    Nothing else is checked if the format or its version is another one.
    """
    found = list(_other_format(file))
    if found:
        yield from found
        return
    yield from _wrong_attributes(file, ATTRIBUTES, OPTIONAL_ATTRIBUTES)
    yield from _wrong_outcome(file)
    for name in ("tables", "arm"):
        if file.get(name, getlink=True) is None:
            yield f"group {name} is missing"
    yield from _wrong_tables(file)
    for name, known in GROUPS.items():
        yield from _wrong_group(file, name, known)
    yield from _wrong_arm(file)
    too_large = list(_too_large(file))
    yield from too_large or _wrong_names(file)


def _other_format(file: h5py.File) -> Iterator[str]:
    if attribute(file, "format") != FORMAT:
        yield "an HDF5 file, but not a log of continuum-dyn"
    elif attribute(file, "format_version") != FORMAT_VERSION:
        read = attribute(file, "format_version")
        yield f"log format {str(read)[:40]}; this program reads format {FORMAT_VERSION}"


def attribute(place: h5py.Group | h5py.Dataset, name: str) -> Any:
    """Read an attribute: a text, a number or a truth value; None if it is missing or of another kind."""
    if name not in place.attrs:
        return None
    kind = place.attrs.get_id(name)
    if kind.shape != () or h5py.check_ref_dtype(kind.dtype) or kind.get_storage_size() > SMALL:
        return None
    value = place.attrs[name]
    if isinstance(value, np.generic):
        value = value.item()
    return value.decode() if isinstance(value, bytes) else value


def _is(value: Any, kind: type) -> bool:
    if kind is float:
        return type(value) in (float, int) and bool(np.isfinite(value))
    return type(value) is kind


def _wrong_attributes(
    place: h5py.Group, needed: Mapping[str, type], optional: Mapping[str, type]
) -> Iterator[str]:
    for name, kind in {**needed, **optional}.items():
        value = attribute(place, name)
        if name not in place.attrs:
            if name in needed:
                yield f"attribute {name} is missing"
        elif not _is(value, kind):
            read = _form_of(place.attrs.get_id(name))
            yield f"attribute {name}: {_SCALARS[kind]} is expected; read {read}"


def _form_of(attribute_id: h5py.h5a.AttrID) -> str:
    return f"one of type {attribute_id.dtype} and shape {attribute_id.shape}"


def _wrong_outcome(file: h5py.File) -> Iterator[str]:
    outcome = attribute(file, "outcome")
    if isinstance(outcome, str) and outcome not in set(Outcome):
        yield f"attribute outcome: read {outcome[:40]!r}. Allowed: {', '.join(Outcome)}"


def _wrong_tables(file: h5py.File) -> Iterator[str]:
    group, wrong = member(file, "tables", h5py.Group)
    if wrong:
        yield wrong
    for name in group or ():
        table, wrong = member(group, name, h5py.Dataset)
        if wrong:
            yield wrong
        elif table is not None and (table.dtype != np.uint8 or table.ndim != 1):
            yield f"{table.name}: bytes over one dimension are expected; read {_form(table)}"
        elif table is not None and not isinstance(attribute(table, "file"), str):
            yield f"{table.name}: its attribute file, the name of the table, is missing"


def member(group: h5py.Group, name: str, kind: type) -> tuple[Any, str]:
    """The member of a group, and the fault in it; None if it is missing or faulty.

    Links that lead elsewhere are not followed.
    """
    link = group.get(name, getlink=True)
    place = f"{group.name.rstrip('/')}/{name}"
    if link is None:
        return None, ""
    if not isinstance(link, h5py.HardLink):
        return None, f"{place}: a link that leads elsewhere; it is not followed"
    if group.get(name, getclass=True) is not kind:
        return None, f"{place}: a {kind.__name__.lower()} is expected"
    found = group[name]
    wrong = _stored_elsewhere(found) if kind is h5py.Dataset else ""
    return (None if wrong else found), wrong


def _stored_elsewhere(dataset: h5py.Dataset) -> str:
    if dataset.is_virtual or dataset.external:
        return f"{dataset.name}: its values lie in other files; they are not opened"
    properties = dataset.id.get_create_plist()
    filters = {properties.get_filter(number)[0] for number in range(properties.get_nfilters())}
    return (
        "" if filters <= PLAIN_FILTERS else f"{dataset.name}: packed with a filter that HDF5 has not built in"
    )


def _wrong_group(file: h5py.File, name: str, known: Mapping[str, Column]) -> Iterator[str]:
    group, wrong = member(file, name, h5py.Group)
    if wrong:
        yield wrong
    if group is None:
        return
    if name == "trajectory":
        yield from _wrong_attributes(group, {}, dict.fromkeys(COUNTERS, int))
    datasets = {}
    for dataset, column in known.items():
        found, wrong = member(group, dataset, h5py.Dataset)
        if found is not None:
            datasets[dataset] = found
            wrong = _wrong_type(found, column)
        elif not wrong and column.required:
            wrong = f"/{name}/{dataset} is missing"
        if wrong:
            yield wrong
    yield from _wrong_shapes(group, datasets, known)


def _wrong_arm(file: h5py.File) -> Iterator[str]:
    arm = member(file, "arm", h5py.Group)[0]
    if arm is None:
        return
    spacing = {} if "disk_spacing" in arm else {"disk_spacing": float}
    for wrong in _wrong_attributes(arm, {"disks": int, "subsegments": int, **spacing}, {}):
        yield f"/arm: {wrong}"


def _wrong_type(dataset: h5py.Dataset, column: Column) -> str:
    if kind_of(dataset) is column.kind:
        return ""
    return f"{dataset.name}: {column.kind} is expected; read {_form(dataset)}"


def kind_of(dataset: h5py.Dataset) -> Kind | None:
    """The type of a dataset's values; None if the format does not know it."""
    if h5py.check_string_dtype(dataset.dtype) is not None:
        return Kind.TEXT
    kinds = {("f", 8): Kind.FLOAT, ("i", 8): Kind.INTEGER, ("b", 1): Kind.TRUTH}
    return kinds.get((dataset.dtype.kind, dataset.dtype.itemsize))


def _form(dataset: h5py.Dataset) -> str:
    return f"{str(dataset.dtype)[:40]} of shape {dataset.shape}"


def _wrong_shapes(
    group: h5py.Group, datasets: Mapping[str, h5py.Dataset], known: Mapping[str, Column]
) -> Iterator[str]:
    sizes = {name: found.shape[0] for name, found in datasets.items() if found.shape and found.ndim == 1}
    growing = not attribute(group.file, "complete") and group.name == "/trajectory"
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


def _too_large(file: h5py.File) -> Iterator[str]:
    """Datasets declared larger than the file can hold, by themselves or by the chunks they are read in."""
    allowed = min(max(SMALL, MOST_EXPANSION * file.id.get_filesize()), LARGEST)
    groups = [member(file, name, h5py.Group)[0] for name in ("tables", *GROUPS)]
    declared = 0
    for group in groups:
        for name in group or ():
            found = member(group, name, h5py.Dataset)[0]
            if found is not None and found.shape is not None:
                shapes = [found.shape] if found.chunks is None else [found.shape, found.chunks]
                counts = [int(np.prod(shape, dtype=object)) for shape in shapes]
                declared += (max(counts) if counts[0] else 0) * found.dtype.itemsize
    if declared > allowed:
        yield f"datasets of {declared:.3g} bytes in a file of {file.id.get_filesize():.3g}: not read"


def _wrong_names(file: h5py.File) -> Iterator[str]:
    """Names of cables that are too many or too long; read one by one: all may be one long text."""
    arm = member(file, "arm", h5py.Group)[0]
    names = None if arm is None else member(arm, "cable", h5py.Dataset)[0]
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


def oddities(file: h5py.File) -> Iterator[str]:
    """Departures that do not prevent reading: units, meanings and scales unlike the format's."""
    for name, known in GROUPS.items():
        group = member(file, name, h5py.Group)[0]
        if group is None:
            continue
        for dataset in group:
            if dataset not in known:
                yield f"/{name}/{dataset}: not a name of the format"
                continue
            found = member(group, dataset, h5py.Dataset)[0]
            if found is not None:
                yield from _odd_words(found, dataset)
        yield from _odd_scales(group, known)
    for name in file:
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
                yield f"{group.name}/{name}: not made a dimension scale"
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
            yield (scale.file[reference].name or "").rpartition("/")[2], int(axis)
