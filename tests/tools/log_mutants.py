"""Logs spoiled at random: in their bytes, or in what they hold, by way of HDF5 itself.

``python tests/tools/log_mutants.py --count 10000 --seed 0`` reads so many, each in a process of its own.
Whatever ends other than in a log or in a ``LogError``, takes longer than ``SECONDS`` or more than ``MEMORY``
is printed, and the exit status is 1.
"""

import argparse
import gc
import os
import resource
import signal
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from pathlib import Path
from random import Random
from typing import Any

import h5py
import numpy as np

from continuum_dyn import load_scenario, simulate
from continuum_dyn.integrators import Budget
from continuum_dyn.record import read_log, write_log
from continuum_dyn.record.comparison import compare
from continuum_dyn.record.logged_scenario import logged_scenario
from continuum_dyn.record.reading import list_departures
from continuum_dyn.record.resuming import resumption_of
from statics.errors import LogError

SCENARIOS = Path(__file__).parents[2] / "scenarios"
SECONDS = 20
"""Longest time of the processor that one mutant may take."""
MEMORY = 500_000_000
"""Most address space that reading one may take beside what the program has."""
SECRET = "what lies in another file"


def spoil_bytes(path: Path, rng: Random) -> None:
    """Change, cut or move some bytes."""
    content = bytearray(path.read_bytes())
    kind = rng.choice(["flip", "flip", "flip", "cut", "zero", "copy"])
    at = rng.randrange(min(len(content), rng.choice([100, 5000, len(content)])))
    length = rng.choice([1, 8, 100, 5000])
    if kind == "flip":
        for _ in range(rng.choice([1, 3, 30])):
            content[rng.randrange(at, min(at + 200, len(content)))] = rng.randrange(256)
    elif kind == "cut":
        del content[at:]
    elif kind == "zero":
        content[at : at + length] = bytes(len(content[at : at + length]))
    else:
        start = rng.randrange(len(content))
        content[at : at + length] = content[start : start + length]
    path.write_bytes(content)


def spoil_content(path: Path, rng: Random) -> None:
    """Change one thing of the file, as a program that means harm or knows no better would."""
    with h5py.File(path, "r+") as file:
        places: list[Any] = [file]
        file.visititems(lambda _, found: places.append(found))
        if rng.random() < 0.4:
            _spoil_attribute(rng.choice(places), rng)
        else:
            _spoil_dataset(file, rng.choice([each.name for each in places[1:]]), rng)


def _spoil_attribute(place: Any, rng: Random) -> None:
    names = list(place.attrs)
    if not names:
        return
    name = rng.choice(names)
    kind = rng.randrange(12)
    value = place.attrs[name]
    del place.attrs[name]
    others = [
        *(7, -1, 1e300, float("nan"), True, "", "9" * 100_000, b"\xff\xfe\x00", "Infinity"),
        np.arange(5.0),
        h5py.Empty("f8"),
        place.ref,
        np.array([("a", 1)], dtype=[("x", "S3"), ("y", "i4")]),
        np.array(["a", "b"], dtype=h5py.string_dtype()),
    ]
    if kind == 0:
        return
    if kind == 1:
        place.attrs[name + "_"] = value
    else:
        place.attrs[name] = rng.choice(others)


def _spoil_dataset(file: h5py.File, name: str, rng: Random) -> None:
    group, _, last = name.rpartition("/")
    parent = file[group or "/"]
    found = file[name]
    values = np.asarray(
        found[()] if isinstance(found, h5py.Dataset) and (found.size or 0) < 10**6 else np.arange(3.0)
    )
    kind = rng.randrange(16)
    if kind == 0:
        parent.move(last, last + "_")
        return
    del parent[last]
    others = {
        2: lambda: parent.create_dataset(
            last, data=values.astype(object).astype(str), dtype=h5py.string_dtype()
        ),
        3: lambda: parent.create_dataset(last, data=np.resize(values, (3, 5))),
        4: lambda: parent.create_dataset(
            last, data=np.zeros(values.shape, rng.choice(["f4", "i2", "u8", "c16", ">f8"]))
        ),
        5: lambda: parent.create_dataset(last, shape=(2**40, 4), chunks=(512, 4), dtype="f8"),
        6: lambda: parent.create_dataset(
            last, shape=(2**30,), chunks=(2**10,), dtype="f8", compression="gzip"
        ),
        7: lambda: parent.create_dataset(last, data=h5py.Empty("f8")),
        8: lambda: parent.create_dataset(
            last, shape=values.shape, dtype="f8", external=[("secret.txt", 0, h5py.h5f.UNLIMITED)]
        ),
        9: lambda: parent.__setitem__(last, h5py.ExternalLink("secret.h5", "/")),
        10: lambda: parent.__setitem__(last, h5py.SoftLink(rng.choice(["/", "/none", name, "/arm/disk"]))),
        11: lambda: _virtual(parent, last, values.shape or (3,)),
        12: lambda: parent.create_dataset(
            last, data=np.full(values.shape, rng.choice([np.nan, np.inf, 1e308]))
        ),
        13: lambda: parent.create_group(last),
        14: lambda: parent.create_dataset(
            last,
            shape=values.shape,
            dtype=rng.choice(
                [h5py.ref_dtype, h5py.vlen_dtype("f8"), np.dtype("V7"), h5py.enum_dtype({"a": 1})]
            ),
        ),
        15: lambda: parent.create_dataset(last, data=np.zeros((0, *values.shape[1:]))),
    }
    if kind in others:
        others[kind]()


def _virtual(parent: h5py.Group, name: str, shape: tuple[int, ...]) -> None:
    layout = h5py.VirtualLayout(shape=shape, dtype="f8")
    layout[...] = h5py.VirtualSource("secret.h5", "values", shape=shape)
    parent.create_virtual_dataset(name, layout)


def mutant(original: bytes, path: Path, rng: Random) -> None:
    """Write a spoiled copy of a log."""
    path.write_bytes(original)
    if rng.random() < 0.5:
        spoil_bytes(path, rng)
        return
    for _ in range(rng.choice([1, 1, 3])):
        try:
            spoil_content(path, rng)
        except (OSError, KeyError, ValueError, TypeError, RuntimeError, MemoryError):
            return  # HDF5 would not make it, or the one before is in its way


def outcome_of(path: Path) -> str:
    """How reading ends: "refused" or "read". Raises what it should not."""
    try:
        list_departures(path)
    except LogError as error:
        _check(str(error))
    try:
        log = read_log(path)
    except LogError as error:
        _check(str(error))
        return "refused"
    compare(log, log)
    try:
        resumption_of(log, logged_scenario(log))
    except LogError as error:
        _check(str(error))
    return "read"


def _check(told: str) -> None:
    assert len(told) < 5000, told[:5000]
    assert SECRET not in told


def outcome_in_child(path: Path) -> str:
    """The same in a process of its own, with bounds on its time and memory."""
    read, told = os.pipe()
    child = os.fork()
    if child == 0:
        gc.freeze()  # what collects garbage would copy the parent's memory page by page
        os.close(read)
        ended = "child broke"
        try:
            signal.setitimer(signal.ITIMER_PROF, SECONDS)
            signal.alarm(10 * SECONDS)  # what sleeps takes no time of the processor
            size = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
            resource.setrlimit(resource.RLIMIT_AS, (size + MEMORY, size + MEMORY))
            warnings.simplefilter("error")
            ended = outcome_of(path)
        except BaseException:
            ended = traceback.format_exc()[-3000:]
        finally:
            os.write(told, ended.encode())
            os._exit(0)
    os.close(told)
    with os.fdopen(read, errors="replace") as answer:
        ended = answer.read()
    _, status = os.waitpid(child, 0)
    return ended if status == 0 else f"ended by signal {status}"


def originals(folder: Path) -> list[bytes]:
    """A settled motion, a ramp, a motion that ended early with a table; beside them what none may read."""
    (folder / "secret.txt").write_text(SECRET * 10_000)
    with h5py.File(folder / "secret.h5", "w") as secret:
        secret["values"] = np.zeros(2000)
        secret.attrs["format"] = SECRET
    made = []
    for name, budget in (("step_response", None), ("tension_ramp", None), ("slow_ramp", Budget(steps=20))):
        write_log(simulate(load_scenario(SCENARIOS / f"{name}.toml"), budget=budget), folder / "log.h5")
        made.append((folder / "log.h5").read_bytes())
    return made


def try_mutant(made: list[bytes], folder: Path, seed: str) -> str:
    """How one of the logs, spoiled in a way that the seed decides, ends."""
    rng, path = Random(seed), folder / "mutant.h5"
    mutant(rng.choice(made), path, rng)
    return outcome_in_child(path)


def main() -> int:
    """Exit status: 1 if any mutant failed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    asked = parser.parse_args()
    found: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        made = originals(Path(name))
        for number in range(asked.first, asked.first + asked.count):
            ended = try_mutant(made, Path(name), f"{asked.seed} {number}")
            if ended not in ("read", "refused"):
                print(f"--- seed {asked.seed}, mutant {number}\n{ended}", flush=True)
                ended = "failed"
            found[ended] += 1
    print(f"{asked.count} mutants of seed {asked.seed}:", dict(found))
    return int(found["failed"] > 0)


if __name__ == "__main__":
    sys.exit(main())
