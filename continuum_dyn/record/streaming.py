"""A motion's log, written while the motion is computed: FILE.h5.part, until the run has ended.

HDF5's mode for a single writer and many readers keeps what was flushed readable whenever the writer is
killed, if no object is created after its start. So the file is created with all its objects and no samples
before it gets its name; blocks of samples are appended; and a copy of it is completed and replaces the log.
"""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Self

import h5py
import numpy as np

from continuum_dyn.record.datasets import (
    CHUNK,
    VERSIONS,
    begin_columns,
    check_finite,
    file_on_disk,
    move_into_place,
    reason,
)
from continuum_dyn.record.log_format import GROUPS, UNFINISHED
from continuum_dyn.record.sole_writer import sole_writer, temporary_name
from continuum_dyn.record.writing import (
    attributes_of,
    columns_of,
    scales_of,
    write_equilibria,
    write_log,
    write_scenario,
)
from statics.errors import LogError
from statics.support.interruption import defer_interruption

if TYPE_CHECKING:
    from continuum_dyn.simulation import Run
    from continuum_dyn.simulation.trajectory import Trajectory

ROOM = 200_000
"""Room kept free beside a block's chunks, for HDF5's own records of them, bytes."""


class StreamedLog:
    """The log of a run at ``path``, written as samples arrive: a ``simulation.Sink``, and a context.

    Within the context no other process writes the same log. Without ``finish`` the unfinished log is kept, if
    there is one. All methods raise ``LogError`` if a file
    cannot be written; it names the file that is left.
    """

    def __init__(self, path: Path) -> None:
        self.path, self.part = path, path.with_name(path.name + UNFINISHED)
        self.run: Run | None = None
        self.rows = 0
        self._file: h5py.File | None = None
        self._tails: dict[str, np.ndarray] = {}

    def __enter__(self) -> Self:
        self._hold = sole_writer(self.path)
        self._hold.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._close()
        self._hold.__exit__(kind, error, traceback)

    def begin(self, run: "Run") -> None:
        """Start a motion. An earlier unfinished log stays until the first block is written."""
        self._close()
        self.run, self.rows, self._tails = run, 0, {}

    def add(self, block: "Trajectory") -> None:
        """Append a block, and flush it."""
        with defer_interruption(), self._os_errors_as_log_errors():
            if self._file is None:
                self._create(block)
            else:
                _keep_room(self.part, self._file, block)
                self._append(self._file, block)
                self._file.flush()

    def finish(self, run: "Run") -> None:
        """Put the finished log in its place, and remove the unfinished one."""
        with defer_interruption(), self._os_errors_as_log_errors():
            if self.rows == 0 or run.trajectory is None or run.scenario.accuracy is not None:
                self._close()
                write_log(run, self.path)
            else:
                self._finish_copy(run, run.trajectory)
            self.part.unlink(missing_ok=True)

    def _create(self, block: "Trajectory") -> None:
        assert self.run is not None
        with self._new() as new:
            with file_on_disk(new) as file:
                file.attrs.update(attributes_of(self.run, complete=False))
                write_scenario(file, self.run.scenario)
                write_equilibria(file, self.run)
                columns = columns_of(block)
                scales = {"time": columns.pop("time")} | scales_of(self.run.scenario, columns)
                begin_columns(file.create_group("trajectory"), scales, columns, GROUPS["trajectory"])
                self._append(file, block)
            move_into_place(new, self.part)
        file = h5py.File(self.part, "r+", libver=VERSIONS, locking=False)
        file.swmr_mode = True
        self._file = file

    def _append(self, file: h5py.File, block: "Trajectory") -> None:
        group, columns = file["trajectory"], columns_of(block)
        for name, values in columns.items():
            check_finite(group, name, values)
        for name, values in columns.items():
            self._tails[name] = _append(group[name], values, self.rows, self._tails.get(name))
        self.rows += block.time.size

    def _finish_copy(self, run: "Run", trajectory: "Trajectory") -> None:
        self._close()
        with self._new() as new:
            shutil.copyfile(self.part, new)
            with h5py.File(new, "r+", libver=VERSIONS, locking=False) as file:
                rest = trajectory.after(self.rows)
                _keep_room(new, file, rest)
                self._append(file, rest)
                file["trajectory"].attrs.update(trajectory.counters)
                del file["equilibria"]
                write_equilibria(file, run)
                file.attrs.update(attributes_of(run))
            move_into_place(new, self.path)

    @contextmanager
    def _new(self) -> Iterator[Path]:
        """Name of a temporary file, which is removed afterwards."""
        new = temporary_name(self.path)
        try:
            yield new
        finally:
            with suppress(OSError):
                new.unlink()

    def _close(self) -> None:
        if self._file is not None:
            file, self._file = self._file, None
            with suppress(OSError, RuntimeError):  # on a full disk; what was flushed is there
                file.close()

    @contextmanager
    def _os_errors_as_log_errors(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            self._close()
            left = ""
            if self.part.exists():
                left = f" All samples so far are in {self.part}: continuum-dyn resume {self.part}"
            raise LogError(f"cannot write {self.path}: {reason(error)}.{left}") from error


def _append(dataset: h5py.Dataset, values: np.ndarray, rows: int, tail: np.ndarray | None) -> np.ndarray:
    """Append values to a dataset of ``rows`` rows, and return the rows that fill no chunk: the new ``tail``.

    Chunks are written as they are, past HDF5's conversions, which take ten times as long. The rows of a
    chunk that is written once more are the same.
    """
    start = rows - rows % CHUNK
    if tail is not None:
        values = np.concatenate([tail, values])
    dataset.id.set_extent((start + len(values), *values.shape[1:]))
    if values[:1].size:
        for first in range(0, len(values), CHUNK):
            piece = np.zeros((CHUNK, *values.shape[1:]), values.dtype)
            piece[: len(values) - first] = values[first : first + CHUNK]
            offset = (start + first, *(0 for _ in values.shape[1:]))
            dataset.id.write_direct_chunk(offset, piece.tobytes())
    return values[len(values) - len(values) % CHUNK :]


def _keep_room(path: Path, file: h5py.File, block: "Trajectory") -> None:
    """Reserve disk space for a block, before HDF5 takes it and gets only a part of it."""
    if not hasattr(os, "posix_fallocate"):
        return
    chunks = block.time.size // CHUNK + 2
    row = sum(values[:1].nbytes for values in columns_of(block).values())
    with path.open("r+b") as same:
        os.posix_fallocate(same.fileno(), file.id.get_filesize(), chunks * CHUNK * row + ROOM)
