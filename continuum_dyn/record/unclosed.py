"""Opening of HDF5 files that were never closed, as left by a killed run.

Their first bytes, the superblock, say that a writer is at work. HDF5 then opens them for readers beside a
writer, who wait for it without end if the file is damaged. Here the whole file is read into memory and
its superblock corrected there, as the tool h5clear does on disk (HDF5 File Format Specification, version
3.0, sec. II.A). Nothing that was flushed by a writer for such readers is lost by that.
"""

import io
import struct
from pathlib import Path

import h5py

SIGNATURE = b"\x89HDF\r\n\x1a\n"
VERSION, FLAGS, END_OF_FILE, CHECKSUM = 8, 11, 28, 44
"""Byte offsets in a superblock of version 3 whose addresses have 8 bytes."""
SIZE = CHECKSUM + 4


def is_unclosed(path: Path) -> bool:
    """Whether a file is an HDF5 file that its writer has not closed."""
    with path.open("rb") as file:
        start = file.read(SIZE)
    known = len(start) == SIZE and start.startswith(SIGNATURE) and start[VERSION:FLAGS] == b"\x03\x08\x08"
    return known and start[FLAGS] != 0


def open_unclosed(path: Path) -> h5py.File:
    """Open a copy of the file in memory. Raises ``OSError`` if HDF5 finds it damaged."""
    content = bytearray(path.read_bytes())
    if _checksum(bytes(content[:CHECKSUM])) != int.from_bytes(content[CHECKSUM:SIZE], "little"):
        raise OSError("its superblock is damaged")
    content[FLAGS] = 0
    struct.pack_into("<Q", content, END_OF_FILE, len(content))
    struct.pack_into("<I", content, CHECKSUM, _checksum(bytes(content[:CHECKSUM])))
    return h5py.File(io.BytesIO(content), "r")


def _checksum(key: bytes) -> int:
    """Jenkins's lookup3, "hashlittle", with which HDF5 checks its metadata (Jenkins 2006)."""
    a = b = c = (0xDEADBEEF + len(key)) & 0xFFFFFFFF
    words = struct.unpack(f"<{-(-len(key) // 12) * 3}I", key.ljust(-(-len(key) // 12) * 12, b"\0"))
    for start in range(0, len(words) - 3, 3):
        a, b, c = (_sum(*pair) for pair in zip((a, b, c), words[start : start + 3], strict=True))
        a, b, c = _mix(a, b, c)
    a, b, c = (_sum(*pair) for pair in zip((a, b, c), words[-3:], strict=True))
    return _mix_finally(a, b, c)


def _mix(a: int, b: int, c: int) -> tuple[int, int, int]:
    for bits in (4, 6, 8, 16, 19, 4):
        a = _difference(a, c) ^ _rotate_left(c, bits)
        c = _sum(c, b)
        a, b, c = b, c, a
    return a, b, c


def _mix_finally(a: int, b: int, c: int) -> int:
    for bits in (14, 11, 25, 16, 4, 14, 24):
        c = _difference(c ^ b, _rotate_left(b, bits))
        a, b, c = b, c, a
    return b


def _sum(x: int, y: int) -> int:
    return (x + y) & 0xFFFFFFFF


def _difference(x: int, y: int) -> int:
    return (x - y) & 0xFFFFFFFF


def _rotate_left(x: int, by: int) -> int:
    return ((x << by) | (x >> (32 - by))) & 0xFFFFFFFF
