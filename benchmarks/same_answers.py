"""Whether two commits give the same answers to every scenario, hard ones among them.

``same_answers.py write FOLDER [NAME ...]`` answers them by the package on ``PYTHONPATH`` and keeps the logs;
``same_answers.py compare FOLDER FOLDER`` holds two such folders together. Numbers are held against the
largest of their dataset. What wall-clock time decides is left out. Exit status: 1 where answers differ.
"""

import argparse
import json
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from processes import RUN, SCENARIOS, ended

ALLOWED = 1e-12
"""Largest difference of numbers, in parts of the largest in their dataset."""
ROUNDING = {"residual"}
"""Datasets that are what rounding leaves: only their bits are compared."""
SECONDS = 300.0
"""After which a scenario is given up, compilation included."""
WHERE = "import statics; print(statics.__path__[0])"
MAX_SHOWN = 200
"""Characters of an error that are shown."""


def files(names: list[str]) -> dict[str, Path]:
    """The scenarios' files by name, all of them unless some are named."""
    every = {path.stem: path for path in sorted([*SCENARIOS.glob("*.toml"), *SCENARIOS.glob("hard/*.toml")])}
    unknown = set(names) - every.keys()
    if unknown:
        sys.exit(f"no scenario is named {', '.join(sorted(unknown))}")
    return {name: every[name] for name in names or every}


def write(folder: Path, names: list[str], within: float) -> int:
    """Answer scenarios, each into a log and a note of how its run ended."""
    folder.mkdir(parents=True, exist_ok=True)
    print(f"answers of {ended('-c', WHERE).output.strip()}", flush=True)
    for name, path in files(names).items():
        log = folder / f"{name}.h5"
        log.unlink(missing_ok=True)
        done = ended(*RUN, path, "--out", folder, "--json", within=within)
        log.with_suffix(".rrd").unlink(missing_ok=True)
        note = {"status": done.status, "errors": "" if log.exists() else done.errors, "seconds": done.wall}
        log.with_suffix(".json").write_text(json.dumps(note, indent=1), encoding="utf-8")
        print(f"{name}: {'given up' if done.status is None else done.status}, {done.wall:.1f} s", flush=True)
    return 0


@dataclass
class Verdict:
    """What a scenario's two answers have in common: their largest difference and where it is."""

    difference: float = 0.0
    place: str = ""
    bits: bool = True
    wrong: list[str] = field(default_factory=list)
    not_compared: str = ""

    @property
    def same(self) -> bool:
        """Nothing wrong, and no difference above what is allowed."""
        return not self.wrong and self.difference <= ALLOWED

    def hold(self, place: str, first: np.ndarray, second: np.ndarray) -> None:
        """Take two datasets into account."""
        if first.shape != second.shape or first.dtype != second.dtype:
            self.wrong.append(f"{place}: {first.dtype}{first.shape} and {second.dtype}{second.shape}")
            return
        numbers = first.dtype.kind in "fib"
        equal = first.tobytes() == second.tobytes() if numbers else np.array_equal(first, second)
        self.bits &= equal
        if equal or place.rpartition("/")[2] in ROUNDING:
            return
        if first.dtype.kind != "f":
            self.wrong.append(f"{place}: other values")
            return
        apart = relative_difference(first, second)
        if apart > self.difference:
            self.difference, self.place = apart, place


def relative_difference(first: np.ndarray, second: np.ndarray) -> float:
    """Largest difference over the largest magnitude; infinite where only one is finite."""
    finite = np.isfinite(first) & np.isfinite(second)
    if not np.array_equal(first[~finite], second[~finite], equal_nan=True):
        return np.inf
    apart = np.abs(first - second, where=finite, out=np.zeros_like(first))
    largest = np.abs(np.stack([first[finite], second[finite]])).max(initial=0.0)
    return float(apart.max(initial=0.0) / largest) if largest else 0.0


def attributes(place: h5py.Group) -> dict[str, Any]:
    """What a log's trajectory counts, or its file says of outcome and method."""
    if place.name == "/":
        return {name: place.attrs.get(name) for name in ("scenario", "study", "outcome", "method")}
    return {name: value for name, value in place.attrs.items() if isinstance(value, np.integer)}


def compare_logs(first: Path, second: Path) -> Verdict:
    """Every dataset of two logs, their outcomes and what their solvers counted."""
    verdict = Verdict()
    with h5py.File(first) as one, h5py.File(second) as other:
        places: tuple[dict[str, Any], dict[str, Any]] = ({"": one}, {"": other})
        for file, found in zip((one, other), places, strict=True):
            file.visititems(found.__setitem__)
        if places[0].keys() != places[1].keys():
            verdict.wrong.append(f"only in one: {', '.join(sorted(places[0].keys() ^ places[1].keys()))}")
        for name in places[0].keys() & places[1].keys():
            here, there = places[0][name], places[1][name]
            if isinstance(here, h5py.Dataset):
                verdict.hold(name, here[()], there[()])
                continue
            told = attributes(here), attributes(there)
            verdict.wrong += [
                f"{name}/{key}: {str(told[0].get(key))[:40]} and {str(told[1].get(key))[:40]}"
                for key in told[0].keys() | told[1].keys()
                if told[0].get(key) != told[1].get(key)
            ]
    return verdict


def compared(name: str, folders: tuple[Path, Path]) -> Verdict:
    """A scenario's two answers held together, be they logs or errors."""
    notes = [folder / f"{name}.json" for folder in folders]
    if not all(note.exists() for note in notes):
        return Verdict(not_compared="answered in one folder only")
    ends = [json.loads(note.read_text(encoding="utf-8")) for note in notes]
    if any(end["status"] is None for end in ends):
        return Verdict(not_compared=f"given up after {max(end['seconds'] for end in ends):.0f} s")
    logs = [folder / f"{name}.h5" for folder in folders]
    verdict = compare_logs(*logs) if all(log.exists() for log in logs) else Verdict()
    for key in ("status", "errors"):
        if ends[0][key] != ends[1][key]:
            told = " and ".join(repr(end[key])[:MAX_SHOWN] for end in ends)
            verdict.wrong.append(f"{key}: {told}")
    return verdict


def compare(folders: tuple[Path, Path]) -> int:
    """Print a row for each scenario; the exit status."""
    names = sorted({note.stem for folder in folders for note in folder.glob("*.json")})
    verdicts = {name: compared(name, folders) for name in names}
    width = max(map(len, names), default=0)
    for name, verdict in verdicts.items():
        if verdict.not_compared:
            continue
        bits = "same bits" if verdict.bits else f"{verdict.difference:.1e} {verdict.place}"
        print(f"{name:{width}}  {'the same' if verdict.same else 'DIFFERS '}  {bits}")
        for wrong in verdict.wrong:
            print(f"{'':{width}}  {wrong}")
    for name, verdict in verdicts.items():
        if verdict.not_compared:
            print(f"{name:{width}}  not compared: {verdict.not_compared}")
    differing = sum(not verdict.same for verdict in verdicts.values())
    held = sum(not verdict.not_compared for verdict in verdicts.values())
    alike = sum(verdict.bits and verdict.same and not verdict.not_compared for verdict in verdicts.values())
    print(f"{held} of {len(names)} scenarios compared: {alike} to the last bit, {differing} differ")
    return int(differing > 0 or held == 0)


def main() -> int:
    """Do what the command line asks; the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    writes = commands.add_parser("write", help="answer scenarios")
    writes.add_argument("folder", type=Path)
    writes.add_argument("names", nargs="*", metavar="NAME", help="by default all")
    writes.add_argument("--seconds", type=float, default=SECONDS, help="after which a scenario is given up")
    compares = commands.add_parser("compare", help="hold two folders of answers together")
    compares.add_argument("folders", nargs=2, type=Path, metavar="FOLDER")
    asked = parser.parse_args()
    if asked.command == "write":
        return write(asked.folder.resolve(), asked.names, asked.seconds)
    return compare(tuple(asked.folders))


if __name__ == "__main__":
    sys.exit(main())
