"""Groups of a log, with each member and attribute examined once, since this takes most of the reading."""

from functools import cached_property
from typing import Any

import h5py
import numpy as np

SMALL = 16_000_000
"""Largest size of a log's datasets, bytes, if its file is small."""
PLAIN_FILTERS = {h5py.h5z.FILTER_DEFLATE, h5py.h5z.FILTER_SHUFFLE, h5py.h5z.FILTER_FLETCHER32}
"""Compression and checksums that HDF5 has built in; others would load libraries."""

_TYPES = {h5py.Group: h5py.h5o.TYPE_GROUP, h5py.Dataset: h5py.h5o.TYPE_DATASET}


class Opened:
    """A group, or the file."""

    def __init__(self, group: h5py.Group) -> None:
        self.group = group
        self._members: dict[str, tuple[Any, str]] = {}
        self._attributes: dict[str, Any] = {}

    @cached_property
    def names(self) -> list[str]:
        """Names of its members."""
        return list(self.group)

    def group_of(self, name: str) -> tuple["Opened | None", str]:
        """The group of that name, and the fault in it, like ``dataset_of``."""
        return self._member(name, h5py.Group)

    def dataset_of(self, name: str) -> tuple[Any, str]:
        """The dataset of that name, and the fault in it; None if it is missing or faulty.

        Links that lead elsewhere are not followed.
        """
        return self._member(name, h5py.Dataset)

    def attribute(self, name: str) -> Any:
        """One of its attributes, like ``attribute``."""
        if name not in self._attributes:
            self._attributes[name] = attribute(self.group, name)
        return self._attributes[name]

    def _member(self, name: str, kind: type) -> tuple[Any, str]:
        if name not in self._members:
            found, wrong = member(self.group, name, kind)
            opened = Opened(found) if isinstance(found, h5py.Group) else found
            self._members[name] = opened, wrong
        return self._members[name]


def attribute(place: h5py.Group | h5py.Dataset, name: str) -> Any:
    """Read an attribute: a text, a number or a truth value; None if it is missing or of another kind."""
    attributes = place.attrs
    if name not in attributes:
        return None
    kind = attributes.get_id(name)
    if kind.shape != () or h5py.check_ref_dtype(kind.dtype) or kind.get_storage_size() > SMALL:
        return None
    value = attributes[name]
    if isinstance(value, np.generic):
        value = value.item()
    return value.decode() if isinstance(value, bytes) else value


def member(group: h5py.Group, name: str, kind: type) -> tuple[Any, str]:
    """The member of a group, and the fault in it, like ``Opened.dataset_of``."""
    if name not in group:
        return None, ""
    place, key = f"{(group.name or '').rstrip('/')}/{name}", name.encode("utf-8", "surrogateescape")
    if group.id.links.get_info(key).type != h5py.h5l.TYPE_HARD:
        return None, f"{place}: a link to elsewhere; links are not followed"
    if h5py.h5o.get_info(group.id, key).type != _TYPES[kind]:
        return None, f"{place}: a {kind.__name__.lower()} is expected"
    if kind is h5py.Group:
        return h5py.Group(h5py.h5o.open(group.id, key)), ""
    found = h5py.Dataset(h5py.h5o.open(group.id, key), readonly=True)
    wrong = _stored_elsewhere(found)
    return (None if wrong else found), wrong


def _stored_elsewhere(dataset: h5py.Dataset) -> str:
    properties = dataset.id.get_create_plist()
    if properties.get_layout() == h5py.h5d.VIRTUAL or properties.get_external_count():
        return f"{dataset.name}: its values are in other files, which are not opened"
    filters = {properties.get_filter(number)[0] for number in range(properties.get_nfilters())}
    return (
        ""
        if filters <= PLAIN_FILTERS
        else f"{dataset.name}: compressed with a filter that is not part of HDF5"
    )
