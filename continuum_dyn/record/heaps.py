"""The heaps in which an HDF5 file keeps its texts, checked before HDF5 reads them.

They are the one part of its structure without a checksum, and HDF5 may follow a damaged one without end
(HDF5 File Format Specification, version 3.0, sec. III.E, global heap).
"""

import mmap
import struct
from collections.abc import Iterator
from pathlib import Path

SIGNATURE = b"GCOL\x01\x00\x00\x00"
HEADER = 16
"""Size of the header of a heap, and of each object in it, bytes."""


def has_damaged_heaps(path: Path) -> bool:
    """Whether any heap of the file is damaged. Raises ``OSError``."""
    if path.stat().st_size == 0:
        return False
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        return not all(_is_sound(content, at) for at in _heap_offsets(content))


def _heap_offsets(content: mmap.mmap) -> Iterator[int]:
    at = content.find(SIGNATURE)
    while at >= 0:
        yield at
        at = content.find(SIGNATURE, at + HEADER)


def _is_sound(content: mmap.mmap, start: int) -> bool:
    """Whether its objects fill it, one after the other, with free space at the end alone."""
    if start + HEADER > len(content):
        return False
    (size,) = struct.unpack_from("<Q", content, start + 8)
    at, end = start + HEADER, start + size
    if end > len(content):
        return False
    while at + HEADER <= end:
        number, _, _, length = struct.unpack_from("<HHIQ", content, at)
        if number == 0:
            return at + length == end
        at += HEADER + -(-length // 8) * 8
    return at <= end
