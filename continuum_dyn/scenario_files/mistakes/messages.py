"""Messages about mistakes in a scenario file, one line for each place.

A line names the place in the file's own words, what was read, what is allowed there and the nearest match.
"""

from collections.abc import Iterable, Sequence
from dataclasses import MISSING
from dataclasses import fields as dataclass_fields
from difflib import get_close_matches
from pathlib import Path
from typing import Any, NamedTuple, get_args, get_origin

from pydantic import BaseModel, ValidationError

from continuum_dyn.scenario.profiles import PROFILES
from continuum_dyn.scenario.solver import Accuracy, Method, Solver
from continuum_dyn.scenario.studies import STUDIES
from continuum_dyn.scenario_files.mistakes.expected import as_read, expected
from continuum_dyn.scenario_files.mistakes.synonyms import meant_by
from continuum_dyn.scenario_files.tables import (
    OF_EFFECTS,
    REFUSED,
    UNKNOWN_PROFILE,
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
from statics.quantities import QUANTITIES

MAX_SHOWN = 12
"""Largest number of mistakes that a message lists."""
METHODS = get_args(Method)
LISTS = [name for name, field in ScenarioFile.model_fields.items() if get_origin(field.annotation) is list]
"""Lists of tables, which a file may leave out."""
TAGS = {"number", "list", "word", UNKNOWN_PROFILE, *PROFILES, *STUDIES}
"""Parts of a place that only tell which kind of value was read."""
TABLE_ERRORS = {"model_type", "model_attributes_type", "dataclass_type", "dict_type", "list_type"}
"""Types of pydantic's errors about a value in place of a table, or of a list of them."""
TABLE_MEANINGS = {
    "arm": ' with the arm\'s numbers, or preset = "rone2012"',
    "effects": ", and in it a line for each effect, such as bending = {}",
    "study": ' with a kind, such as kind = "equilibrium"',
}
"""Advice for a missing table, for each of those that every file has."""

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


class Mistake(NamedTuple):
    """Place of a mistake in the file, such as ("cables", "0", "anchor"), and the message about it.

    ``mark`` stands between the file's name and a message that does not begin with its place.
    """

    place: tuple[str, ...]
    message: str
    mark: str = ""


def explain(path: Path, mistakes: Iterable[Mistake], content: Iterable[str]) -> str:
    """The text of an error: at most ``MAX_SHOWN`` mistakes of the file, and how many more there are.

    They are in the order of the file, whose ``content`` has its tables by name.
    """
    tables = list(content)

    def position(mistake: Mistake) -> tuple[int, int]:
        head, number = (*mistake.place[:2], "", "")[:2]
        return tables.index(head) if head in tables else len(tables), _index(number) or 0

    ordered = sorted(mistakes, key=position)
    lines = list(dict.fromkeys(f"{path}{mistake.mark} {mistake.message}" for mistake in ordered))
    more = [f"and {len(lines) - MAX_SHOWN} more."] if len(lines) > MAX_SHOWN else []
    return "\n".join(lines[:MAX_SHOWN] + more)


def mistakes_of(error: ValidationError) -> list[Mistake]:
    """Each mistake that the check of a file's tables has found; known keys are listed once for each table."""
    listed: set[str] = set()
    return [
        Mistake(tuple(map(str, detail["loc"])), _one(detail, listed))
        for detail in error.errors(include_url=False)
    ]


def _one(detail: Any, listed: set[str]) -> str:
    place = [str(part) for part in detail["loc"]]
    kind, key = detail["type"], place[-1] if place else ""
    inside, given = _section(place[:-1]), detail["input"]
    if kind in ("extra_forbidden", "unexpected_keyword_argument"):
        return f"{where(place[:-1])}: {_unknown(key, inside, listed)}"
    if kind in ("missing", "missing_argument"):
        return _missing(place, inside, given)
    if kind == "union_tag_invalid":
        tag = given["kind"]
        read = _short(repr(tag)) if isinstance(tag, str) else as_read(tag)
        return f"{where(place)}: unknown kind {read}.{_nearest(str(tag), 'kinds', STUDIES)}"
    if kind == "union_tag_not_found":
        return f"{where(place)}: missing 'kind'. Known: {', '.join(STUDIES)}."
    if kind == "string_pattern_mismatch":
        known = _nearest(str(given), "profiles", PROFILES)
        return f"{where(place[:-1])}: unknown profile {_short(repr(given))}.{known}"
    if kind == REFUSED:
        message = detail["ctx"]["message"]
        return message if message.startswith("[") else f"{where(place)}: {message}"
    if kind == "literal_error" and inside == "solver":
        return f"{where(place)}: unknown {key} {as_read(given)}.{did_you_mean(str(given), METHODS)}"
    return f"{where(place)}: {expected(detail)}{_advice(place, given) if kind in TABLE_ERRORS else ''}"


def _unknown(key: str, inside: str, listed: set[str]) -> str:
    """Message about a key that its table does not have: what to write, or the nearest of those it has."""
    what, known = "effect" if inside == "effects" else "key", _known(inside)
    instead = meant_by(key, _kind_of_table(inside))
    nearest = f" Did you mean '{close[0]}'?" if (close := get_close_matches(key, known, 1, 0.5)) else ""
    if instead and not (nearest and close[0] in instead):
        nearest = f" Write {instead}."
    elif inside and key in ScenarioFile.model_fields:
        nearest = f" It is a table of its own: {_header(key)}."
    names = "" if inside in listed else f" Known: {', '.join(known)}."
    listed.add(inside)
    return f"unknown {what} {_short(repr(key))}.{nearest}{names}"


def _nearest(word: str, kinds: str, known: Iterable[str]) -> str:
    """The known word that is meant or nearest, and the list of them all."""
    instead = meant_by(word, kinds)
    return f" Write '{instead}'. Known: {', '.join(known)}." if instead else did_you_mean(word, known)


def _missing(place: list[str], inside: str, given: Any) -> str:
    """Message about a table or a key that is not there, with its meaning."""
    key = place[-1]
    if key.isdigit():
        return f"{where(place[:-1])}: a list of two numbers is expected; read {as_read(given)}."
    if len(place) == 1 and key in ScenarioFile.model_fields:
        text = TABLE_MEANINGS.get(key, "")
        return f"(top level): missing '{key}'. Add a table {_header(key)}{text}."
    if key == "profile":
        return f"{where(place[:-1])}: missing 'profile'. Known: {', '.join(PROFILES)}."
    quantity = QUANTITIES.get(key)
    unit = "" if quantity is None or quantity.unit == "1" else f", in {quantity.unit}"
    meaning = f": {quantity.meaning}{unit}" if quantity is not None else ""
    return f"{where(place[:-1])}: missing '{key}'{meaning}."


def _advice(place: list[str], given: Any) -> str:
    """Advice for a table in place of a list of tables or the reverse, or for a value in place of a table."""
    key = place[-1]
    if place[0] == "effects" and len(place) == 2:
        required = ", ".join(f"{name} = ..." for name in _required(OF_EFFECTS[key]))
        return f" Write {key} = {{ {required} }}." if required else f" Write {key} = {{}}."
    if len(place) == 1:
        below = "" if isinstance(given, dict | list) else ", and its keys on lines below"
        return f" Write {_header(key)}{below}."
    return ""


def _required(table: type) -> list[str]:
    """Names of the fields that a table must have; the first one where any of them will do."""
    if issubclass(table, BaseModel):
        return list(table.model_fields)[:1]
    return [
        field.name
        for field in dataclass_fields(table)
        if field.default is MISSING and field.default_factory is MISSING
    ]


def _header(name: str) -> str:
    """The header of a table; of a list of tables in double brackets."""
    return f"[[{name}]]" if name in LISTS else f"[{name}]"


def _short(read: str) -> str:
    """The value that was read, cut after 60 characters."""
    return read if len(read) <= 60 else f"{read[:57]}..."


def where(place: Sequence[str]) -> str:
    """The place as it is written in the file: [arm] disks, [[cables]] number 1 tension."""
    if not place:
        return "(top level)"
    head, *rest = place
    numbered = ((part, _index(part)) for part in rest if part not in TAGS)
    words = [part if index is None else f"number {index + 1}" for part, index in numbered]
    return " ".join([_header(head) if head in LISTS and rest else f"[{head}]", *words])


def _index(part: str) -> int | None:
    """The index in a list that a part of a place is; None for a key, which may have digits of any script."""
    return int(part) if part.isascii() and part.isdigit() and len(part) < 10 else None


def _section(place: list[str]) -> str:
    return ".".join(part for part in place if not part.isdigit())


def _kind_of_table(section: str) -> str:
    """The table for which synonyms are known: those of all profiles are the same."""
    return "profile" if section.rpartition(".")[2] in PROFILES else section


def _known(section: str) -> list[str]:
    owner = _KEYS.get(section, ScenarioFile)
    if isinstance(owner, type) and issubclass(owner, BaseModel):
        return list(owner.model_fields)
    return [field.name for field in dataclass_fields(owner)]
