"""Changes to a scenario from the command line: ``arm.disks=16``.

An override is a line of TOML: a dotted key, and a value. Its key leads through the tables of the file, and
through a list such as [[cables]] by the names of its tables.
"""

import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import shorten
from typing import Any

from continuum_dyn.scenario_files.mistakes.messages import LISTS
from continuum_dyn.scenario_files.toml_text import TooLongError, inline_toml, read_toml, toml_text
from statics.errors import InputError, did_you_mean
from statics.support.checked import LONGEST_LINE

_KEY_AND_VALUE = re.compile(r"""((?:"[^"]*"|'[^']*'|[^"'=])+)=(.+)""")
_WORD = re.compile(r"[A-Za-z][\w./-]*")
"""Text that needs no quotes, which a shell would remove."""


@dataclass(frozen=True)
class Override:
    """A change: the tables that it leads through, the key in the last of them, its new value."""

    text: str
    tables: tuple[str, ...]
    key: str
    value: Any


def apply_overrides(text: str, name: str, overrides: Sequence[str]) -> str:
    """Apply changes to the text of the scenario ``name``: rewritten TOML, with the changes in a comment.

    They are also appended to its title, unless a change sets it. Raises ``InputError`` for text that is not
    an override or names no table, ``tomllib.TOMLDecodeError`` for a scenario that is not TOML.
    """
    if not overrides:
        return text
    content = read_toml(text)
    title = f"{content.pop('title', name)}, {', '.join(overrides)}"
    content = {"title": shorten(title, LONGEST_LINE, placeholder=" ...")} | content
    for change in map(_parse, overrides):
        _table_to_change(content, change)[change.key] = change.value
    return "\n".join([f"# {name}, with", *(f"#   {override}" for override in overrides), toml_text(content)])


def _short(text: str) -> str:
    """The text that was read, cut after 80 characters."""
    return text if len(text) <= 80 else f"{text[:77]}..."


def _parse(text: str) -> Override:
    parts = _KEY_AND_VALUE.fullmatch(text) if text.isprintable() else None
    if parts is None:
        raise InputError(
            f"--set {_short(text)!r}: not KEY=VALUE. Try such as arm.disks=16, or "
            "cables.upper.tension.after=2."
        )
    *tables, key = _words(parts[1].strip(), text)
    return Override(text, tuple(tables), key, _value(parts[2].strip(), text))


def _words(key: str, text: str) -> list[str]:
    """The words of a dotted key, some of which may be quoted."""
    words: list[str] = []
    try:
        inside: Any = read_toml(f"{key} = 0")
    except TooLongError as error:
        raise InputError(f"--set {_short(text)}: {error}.") from error
    except tomllib.TOMLDecodeError as error:
        raise InputError(
            f"--set {_short(text)}: {_short(key)!r} is not a key. A key has words of letters, digits, - "
            "and _ with dots between them, and other words in quotes: cables.'left one'.tension."
        ) from error
    while isinstance(inside, dict):
        ((word, inside),) = inside.items()
        words.append(word)
    return words


def _value(value: str, text: str) -> Any:
    try:
        return read_toml(f"value = {value}")["value"]
    except TooLongError as error:
        raise InputError(f"--set {_short(text)}: {error}.") from error
    except tomllib.TOMLDecodeError as error:
        if _WORD.fullmatch(value):
            return value
        raise InputError(
            f"--set {_short(text)}: {_short(value)!r} is not a value. Try such as 2, 1e-3, true, [0.0, 1.0], "
            """chain, '"two words"' and '{ profile = "step", before = 0, after = 2 }'."""
        ) from error


def _table_to_change(content: dict[str, Any], change: Override) -> dict[str, Any]:
    """The table whose key is changed; missing tables on the path to it are added."""
    place: Any = content
    for depth, word in enumerate(change.tables):
        if isinstance(place, dict):
            place = place.setdefault(word, [] if depth == 0 and word in LISTS else {})
        elif _holds_tables(place):
            place = _find_table(word, place, change, depth)
        else:
            raise _no_table(change, depth, place)
    if not isinstance(place, dict):
        raise _no_table(change, len(change.tables), place)
    return place


def _holds_tables(place: Any) -> bool:
    return isinstance(place, list) and all(isinstance(entry, dict) for entry in place)


def _no_table(change: Override, depth: int, place: Any) -> InputError:
    where = ".".join(change.tables[:depth])
    if _holds_tables(place):
        return InputError(
            f"--set {_short(change.text)}: {where} is a list of tables. Name a table and its key."
        )
    return InputError(
        f"--set {_short(change.text)}: {where} is {_short(inline_toml(place))}, without keys. "
        f"Set it as a whole: {where}=..."
    )


def _find_table(word: str, tables: list[Any], change: Override, depth: int) -> dict[str, Any]:
    """Find the table of that name in a list; one without a name is called cable_1, load_2 or the like."""
    header = change.tables[depth - 1]
    kind = header.removesuffix("s")
    known = {
        str(table.get("name", f"{kind}_{number}")): table for number, table in enumerate(tables, start=1)
    }
    if not known:
        raise InputError(f"--set {_short(change.text)}: the scenario has no [[{header}]].")
    if word not in known:
        raise InputError(
            f"--set {_short(change.text)}: no {kind} is named '{_short(word)}'.{did_you_mean(word, known)}"
        )
    return known[word]
