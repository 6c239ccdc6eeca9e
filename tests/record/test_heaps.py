"""Heaps of texts in logs: damaged ones are refused; numbers whose bytes spell a heap's mark are numbers."""

import struct
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import SCENARIOS

from continuum_dyn import Run, load_scenario, simulate
from continuum_dyn.record import StreamedLog, read_log, write_log
from continuum_dyn.record.datasets import VERSIONS
from continuum_dyn.record.heaps import SIGNATURE, has_damaged_heaps
from statics.errors import LogError

(MARK,) = struct.unpack("<d", SIGNATURE)
"""The number that spells a heap's mark: 2.75e-314."""


@pytest.fixture(scope="module")
def run() -> Run:
    return simulate(load_scenario(SCENARIOS / "step_response.toml"))


def marked(run: Run, rows: slice) -> Run:
    """The run with that number in the samples of its cable's displacement."""
    assert run.trajectory is not None
    values = run.trajectory.cable_displacement.copy()
    values[rows] = MARK
    return replace(run, trajectory=replace(run.trajectory, cable_displacement=values))


@pytest.mark.parametrize("rows", [slice(0, 1), slice(1, None, 2), slice(None)])
def test_number_that_spells_the_mark_of_a_heap_is_read_as_a_number(
    run: Run, tmp_path: Path, rows: slice
) -> None:
    given = marked(run, rows)
    write_log(given, tmp_path / "whole.h5")
    with StreamedLog(tmp_path / "log.h5") as sink:
        assert given.trajectory is not None
        sink.begin(replace(given, trajectory=None))
        sink.add(given.trajectory.first(600))
        unfinished = read_log(sink.part)
        sink.finish(given)
    assert unfinished.trajectory["time"].size == 600
    for name in ("whole.h5", "log.h5"):
        assert (read_log(tmp_path / name).trajectory["cable_displacement"][rows] == MARK).all()


def test_mark_in_an_attribute_is_a_number(run: Run, tmp_path: Path) -> None:
    write_log(run, tmp_path / "log.h5")
    with h5py.File(tmp_path / "log.h5", "r+", libver=VERSIONS) as file:
        file["arm"].attrs["disk_spacing"] = MARK
    assert read_log(tmp_path / "log.h5").arm["disk_spacing"] == MARK


def lengthen_first_object(content: bytearray, heap: int) -> None:
    struct.pack_into("<Q", content, heap + 24, 1 << 40)


def cut_short(content: bytearray, heap: int) -> None:
    struct.pack_into("<Q", content, heap + 8, 40)


def lose_its_size(content: bytearray, heap: int) -> None:
    struct.pack_into("<Q", content, heap + 8, 1 << 60)


@pytest.mark.parametrize("damage", [lengthen_first_object, cut_short, lose_its_size])
@pytest.mark.parametrize("with_marks", [False, True])
def test_damaged_heap_that_is_referenced_is_refused(
    run: Run, tmp_path: Path, damage: Callable[[bytearray, int], None], with_marks: bool
) -> None:
    path = tmp_path / "log.h5"
    write_log(marked(run, slice(None)) if with_marks else run, path)
    content = bytearray(path.read_bytes())
    damage(content, content.find(SIGNATURE))
    path.write_bytes(content)
    with pytest.raises(LogError, match="the texts in it are damaged"):
        read_log(path)


def test_heaps_within_heaps_are_refused_at_once(tmp_path: Path) -> None:
    """Each of them is sound; to walk them all would take a time in the square of the file's size."""
    path = tmp_path / "log.h5"
    with h5py.File(path, "w", libver=VERSIONS) as file:
        file["numbers"] = np.zeros(1)
        file.create_group("texts").attrs["text"] = "a"
    count = 50_000
    heaps = [SIGNATURE + struct.pack("<Q", 32 * (count - number)) for number in range(count)]
    objects = struct.pack("<HHIQ", 1, 1, 0, 16)
    path.write_bytes(path.read_bytes() + b"".join(heap + objects for heap in heaps))
    with h5py.File(path, "r", locking=False) as file:
        assert has_damaged_heaps(path, file)
