"""The heaps in which an HDF5 file keeps its texts, checked before HDF5 reads them.

They are the one part of its structure without a checksum, and HDF5 may follow a damaged one without end
(HDF5 File Format Specification, version 3.0, sec. III.E, global heap). Numbers may spell a heap's mark, too.
HDF5 follows none but heaps that are referenced, so a mark in a dataset of numbers, or one that nothing
refers to, is left alone.
"""

import mmap
import struct
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np

SIGNATURE = b"GCOL\x01\x00\x00\x00"
HEADER = 16
"""Size of the header of a heap, and of each object in it, bytes."""
ADDRESS, REFERENCE = 8, 12
"""Size of a heap's address in the file, and of a reference: the address and the number of an object."""
MAX_OBJECTS = 0xFFFF
"""Largest number of an object in a heap."""
NUMBERS = "fiub"
"""Kinds of NumPy types that hold no reference."""
BLOCK = 1 << 23
"""Number of bytes that are searched for references at a time."""


def has_damaged_heaps(path: Path, file: h5py.File) -> bool:
    """Whether any heap that may be referenced is damaged, in the file that is open. Raises ``OSError``."""
    if path.stat().st_size == 0:
        return False
    with path.open("rb") as raw, mmap.mmap(raw.fileno(), 0, access=mmap.ACCESS_READ) as content:
        damaged = _damaged_heaps(content)
        if not damaged:
            return damaged is None
        heaps = _outside_numbers(file, np.array(damaged))
        return heaps.size > 0 and _any_is_referenced(content, heaps)


def _damaged_heaps(content: mmap.mmap) -> list[int] | None:
    """Offsets of marks without a valid heap; None if heaps overlap, which HDF5 never writes."""
    damaged, left = [], len(content) // HEADER
    for start in _marks(content):
        sound, objects = _walk(content, start, left)
        left -= objects
        if left < 0:
            return None
        if not sound:
            damaged.append(start)
    return damaged


def _marks(content: mmap.mmap) -> Iterator[int]:
    at = content.find(SIGNATURE)
    while at >= 0:
        yield at
        at = content.find(SIGNATURE, at + len(SIGNATURE))


def _walk(content: mmap.mmap, start: int, most: int) -> tuple[bool, int]:
    """Whether its objects fill a heap, one after the other, with free space at the end alone; their count.

    The walk stops after ``most`` objects.
    """
    if start + HEADER > len(content):
        return False, 0
    (size,) = struct.unpack_from("<Q", content, start + 8)
    at, end, objects = start + HEADER, start + size, 0
    if end > len(content):
        return False, 0
    while at + HEADER <= end and objects <= most:
        number, _, _, length = struct.unpack_from("<HHIQ", content, at)
        objects += 1
        if number == 0:
            return at + length == end, objects
        at += HEADER + -(-length // 8) * 8
    return at <= end, objects


def _outside_numbers(file: h5py.File, offsets: np.ndarray) -> np.ndarray:
    """The offsets, in rising order, that lie in no dataset of numbers."""
    pieces: list[tuple[int, int]] = []

    def add(_: str, found: h5py.Group | h5py.Dataset) -> None:
        if not isinstance(found, h5py.Dataset) or found.dtype.kind not in NUMBERS or found.is_virtual:
            return
        if found.chunks is not None:
            found.id.chunk_iter(lambda chunk: pieces.append((chunk.byte_offset, chunk.size)))
        elif found.id.get_offset() is not None:
            pieces.append((found.id.get_offset(), found.id.get_storage_size()))

    file.visititems(add)
    if not pieces:
        return offsets
    starts, sizes = np.array(sorted(pieces), dtype=np.uint64).T
    piece = np.searchsorted(starts, offsets.astype(np.uint64), side="right") - 1
    inside = (piece >= 0) & (offsets < (starts + sizes)[piece])
    return offsets[~inside]


def _any_is_referenced(content: mmap.mmap, heaps: np.ndarray) -> bool:
    """Whether a reference to any of these offsets lies anywhere in the file, aligned or not."""
    for first in range(0, len(content), BLOCK):
        block = content[first : first + BLOCK + REFERENCE]
        for shift in range(ADDRESS):
            count = (len(block) - shift - REFERENCE) // ADDRESS + 1
            if count < 1:
                continue
            addresses = np.frombuffer(block, "<u8", count, shift)
            near = np.flatnonzero((addresses >= heaps[0]) & (addresses <= heaps[-1]))
            for place in near[np.isin(addresses[near], heaps)]:
                (number,) = struct.unpack_from("<I", block, shift + ADDRESS * int(place) + ADDRESS)
                if 1 <= number <= MAX_OBJECTS:
                    return True
    return False
