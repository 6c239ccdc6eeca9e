"""Reading of logs, and refusal of those that differ from the format."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path

import h5py
import numpy as np

from continuum_dyn.record.checking import LARGEST, departures, oddities
from continuum_dyn.record.heaps import has_damaged_heaps
from continuum_dyn.record.log import Log
from continuum_dyn.record.log_format import ATTRIBUTES, COUNTERS, GROUPS, OPTIONAL_ATTRIBUTES, Kind
from continuum_dyn.record.opened import Opened, attribute
from continuum_dyn.record.unclosed import SIGNATURE, is_unclosed, open_unclosed
from statics.arm import Arm
from statics.errors import LogError
from statics.outcome import Outcome

ARM_NUMBERS = [each.name for each in fields(Arm)]
"""Attributes of the arm that may be numbers; a file may have any others."""
SCENARIO_START = 5000
"""Number of bytes in which a scenario names its arm."""
MAX_SHOWN = 12
"""Largest number of differences from the format that an error lists."""


def is_hdf5(path: Path) -> bool:
    """Whether a file begins as an HDF5 file, whatever its name; False if it cannot be read."""
    try:
        with path.open("rb") as file:
            return file.read(len(SIGNATURE)) == SIGNATURE
    except OSError:
        return False


def read_log(path: str | Path) -> Log:
    """Read a whole log, or an unfinished one up to its last whole sample.

    Raises ``LogError`` for a file that is not a log, or of another format version, or whose names, types or
    shapes are not the format's; it names them.
    """
    path = Path(path)
    with open_log(path) as file:
        opened = Opened(file)
        found = list(departures(opened))
        if found:
            more = [f"and {len(found) - MAX_SHOWN} more"] if len(found) > MAX_SHOWN else []
            raise LogError(f"{path}: " + ".\n  ".join([*found[:MAX_SHOWN], *more]) + ".")
        log = _read(opened, path)
    not_finite = _not_finite(log)
    if not_finite:
        raise LogError(f"{path}: {not_finite[0]} holds numbers that are not finite.")
    return log


def list_departures(path: Path) -> list[str]:
    """List all differences of a file from the format, in words. Raises ``LogError`` like ``open_log``."""
    with open_log(path) as file:
        opened = Opened(file)
        found = list(departures(opened))
        if found:
            return found
        not_finite = [f"{name}: numbers that are not finite" for name in _not_finite(_read(opened, path))]
        return [*oddities(opened), *not_finite]


@contextmanager
def open_log(path: Path) -> Iterator[h5py.File]:
    """Open an HDF5 file to read, also while it is written. Raises ``LogError`` if HDF5 cannot read it."""
    try:
        _refuse_other_files(path)
        if path.stat().st_size > LARGEST:
            raise LogError(f"{path}: larger than {LARGEST / 1e9:g} GB, and no log is.")
        with open_unclosed(path) if is_unclosed(path) else h5py.File(path, "r", locking=False) as file:
            if has_damaged_heaps(path, file):
                raise LogError(f"{path}: the texts in it are damaged. Run its scenario again.")
            yield file
    except LogError:
        raise
    except FileNotFoundError as error:
        raise LogError(f"{path}: no such file.") from error
    except MemoryError as error:
        raise LogError(f"{path}: larger than the available memory.") from error
    except (OSError, KeyError, ValueError, TypeError, RuntimeError, AttributeError, OverflowError) as error:
        number = error.errno if isinstance(error, OSError) else None
        told = f"cannot be read: {os.strerror(number)}" if number else "damaged"
        raise LogError(f"{path}: {told}. If it is a log, run its scenario again.") from error


def _refuse_other_files(path: Path) -> None:
    """Raise ``LogError`` for a file that does not begin as a log does, with what it seems to be."""
    if path.is_dir():
        raise LogError(f"{path}: a folder. Give a log in it, such as {path / 'NAME.h5'}.")
    with path.open("rb") as file:
        start = file.read(SCENARIO_START)
    if start.startswith(SIGNATURE):
        return
    if not start:
        raise LogError(f"{path}: an empty file, not a log.")
    if path.suffix == ".toml" or b"[arm]" in start:
        raise LogError(f"{path}: a scenario, not a log. Run it first: continuum-dyn run {path}")
    raise LogError(f"{path}: not a log of continuum-dyn. Logs are written by continuum-dyn run, as NAME.h5.")


def _read(file: Opened, path: Path) -> Log:
    """Contents of a file that agrees with the format."""
    names = (*ATTRIBUTES, *OPTIONAL_ATTRIBUTES, "format_version")
    attributes = {name: value for name in names if (value := file.attribute(name)) is not None}
    arm, tables, counted = (file.group_of(name)[0] for name in ("arm", "tables", "trajectory"))
    assert arm is not None
    assert tables is not None
    arrays = {name: _arrays(file, name) for name in GROUPS}
    numbers = {name: arm.attribute(name) for name in ARM_NUMBERS if name in arm.group.attrs}
    files = [tables.dataset_of(name)[0] for name in tables.names]
    return Log(
        path=path,
        title=attributes["title"],
        outcome=Outcome(attributes["outcome"]),
        message=attributes["message"],
        scenario=attributes["scenario"],
        tables={attribute(table, "file"): table[()].tobytes().decode() for table in files},
        attributes=attributes,
        cables=tuple(arrays["arm"].pop("cable").tolist()),
        arm={name: value for name, value in numbers.items() if isinstance(value, int | float)}
        | arrays["arm"],
        trajectory=_whole_samples(arrays["trajectory"], attributes["complete"]),
        equilibria=arrays["equilibria"],
        counters={} if counted is None else _counters(counted),
        complete=attributes["complete"],
    )


def _counters(trajectory: Opened) -> dict[str, int]:
    return {name: value for name in COUNTERS if (value := trajectory.attribute(name)) is not None}


def _arrays(file: Opened, name: str) -> dict[str, np.ndarray]:
    """The datasets of a group that the format knows; the names of cables are those of the arm."""
    group = file.group_of(name)[0]
    if group is None:
        return {}
    return {
        dataset: _values(found, column.kind)
        for dataset, column in GROUPS[name].items()
        if (name == "arm" or dataset != "cable") and (found := group.dataset_of(dataset)[0]) is not None
    }


def _values(dataset: h5py.Dataset, kind: Kind) -> np.ndarray:
    values = dataset[()]
    if kind is Kind.TEXT:
        return np.array([name.decode() if isinstance(name, bytes) else name for name in values], dtype=object)
    return values.astype(values.dtype.newbyteorder("="), copy=False)


def _whole_samples(columns: dict[str, np.ndarray], complete: bool) -> dict[str, np.ndarray]:
    """The samples that all columns have: in a log that is not complete some may be a block ahead."""
    if complete or not columns:
        return columns
    along = [name for name in columns if GROUPS["trajectory"][name].dimensions[0] == "time"]
    rows = min(len(columns[name]) for name in along)
    return {name: values[:rows] if name in along else values for name, values in columns.items()}


def _not_finite(log: Log) -> list[str]:
    groups = {"trajectory": log.trajectory, "equilibria": log.equilibria, "arm": log.arm}
    return [
        f"/{group}/{name}"
        for group, columns in groups.items()
        for name, values in columns.items()
        if np.asarray(values).dtype.kind == "f" and not np.isfinite(values).all()
    ]
