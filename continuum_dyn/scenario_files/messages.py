"""Messages about mistakes in a scenario file, one line for each place.

A line names the place in the file's own words, what was read, what is allowed there and the nearest match.
"""

from dataclasses import fields as dataclass_fields
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from continuum_dyn.scenario.profiles import PROFILES
from continuum_dyn.scenario.solver import Accuracy, Solver
from continuum_dyn.scenario.studies import STUDIES
from continuum_dyn.scenario_files.tables import (
    OF_EFFECTS,
    ArmTable,
    BaseTable,
    CableTable,
    EffectsTable,
    LoadTable,
    ScenarioFile,
    TableFile,
)
from statics.arm import Payload
from statics.errors import did_you_mean

MAX_SHOWN = 12
"""Largest number of mistakes that a message lists."""

_KEYS: dict[str, Any] = {
    "": ScenarioFile,
    "arm": ArmTable,
    "base": BaseTable,
    "effects": EffectsTable,
    "cables": CableTable,
    "loads": LoadTable,
    "payloads": Payload,
    "solver": Solver,
    "accuracy": Accuracy,
    **{f"study.{name}": study for name, study in STUDIES.items()},
    **{f"effects.{name}": effect for name, effect in OF_EFFECTS.items()},
    **{
        f"{place}.{name}": TableFile if name == "table" else profile
        for place in (
            *("cables.tension", "cables.cable_displacement", "loads.factor"),
            *("base.x", "base.y", "base.angle"),
        )
        for name, profile in PROFILES.items()
    },
}


def explain(path: Path, error: ValidationError) -> str:
    """The text of the error: at most ``MAX_SHOWN`` places of the file, and how many more there are."""
    found = [_one(detail) for detail in error.errors(include_url=False)]
    lines = [f"{path} {line}" for line in found[:MAX_SHOWN]]
    if len(found) > MAX_SHOWN:
        lines.append(f"and {len(found) - MAX_SHOWN} more.")
    return "\n".join(lines)


def _one(detail: Any) -> str:
    place = [str(part) for part in detail["loc"]]
    kind, key = detail["type"], place[-1] if place else ""
    inside = _section(place[:-1])
    if kind in ("extra_forbidden", "unexpected_keyword_argument"):
        what = "effect" if inside == "effects" else "key"
        return f"{_where(place[:-1])}: unknown {what} {_short(repr(key))}.{did_you_mean(key, _known(inside))}"
    if kind in ("missing", "missing_argument"):
        return f"{_where(place[:-1])}: missing '{key}'. Known: {', '.join(_known(inside))}."
    if kind == "union_tag_invalid":
        tag = str(detail["ctx"]["tag"])
        return f"{_where(place)}: unknown kind {_short(repr(tag))}.{did_you_mean(tag, STUDIES)}"
    if kind == "union_tag_not_found":
        return f"{_where(place)}: missing 'kind'. Known: {', '.join(STUDIES)}."
    read = _short(repr(detail["input"]))
    if kind == "string_pattern_mismatch":
        return f"{_where(place)}: unknown profile {read}.{did_you_mean(str(detail['input']), PROFILES)}"
    message = detail["msg"][0].lower() + detail["msg"][1:]
    return f"{_where(place)}: {message}; read {read}."


def _short(read: str) -> str:
    """The value that was read, cut after 60 characters."""
    return read if len(read) <= 60 else f"{read[:57]}..."


def _where(place: list[str]) -> str:
    """The place as it is written in the file: [arm] disks, [[cables]] number 1 tension."""
    if not place:
        return "(top level)"
    head, *rest = place
    if rest and rest[0].isdigit():
        rest[0] = f"number {int(rest[0]) + 1}"
        return f"[[{head}]] {' '.join(rest)}"
    return f"[{head}] {' '.join(rest)}".rstrip()


def _section(place: list[str]) -> str:
    return ".".join(part for part in place if not part.isdigit())


def _known(section: str) -> list[str]:
    owner = _KEYS.get(section, ScenarioFile)
    if isinstance(owner, type) and issubclass(owner, BaseModel):
        return list(owner.model_fields)
    return [field.name for field in dataclass_fields(owner)]
