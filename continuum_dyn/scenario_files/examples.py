"""An example for each key of a scenario file."""

import re
from functools import cache
from importlib.resources import files

_TABLES = files("continuum_dyn.scenario_files") / "examples.toml"
_HEADER, _ASSIGNMENT = re.compile(r"\[(\S+)\]"), re.compile(r"(\w+) = (.+)")


@cache
def examples() -> dict[str, dict[str, str]]:
    """Examples by table and key, as they are written in a file: "2.1e11"."""
    found: dict[str, dict[str, str]] = {}
    table: dict[str, str] = {}
    for line in _TABLES.read_text(encoding="utf-8").splitlines():
        if header := _HEADER.fullmatch(line):
            table = found.setdefault(header[1], {})
        elif assignment := _ASSIGNMENT.fullmatch(line):
            table[assignment[1]] = assignment[2]
    return found
