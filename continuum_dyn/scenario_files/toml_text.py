"""TOML written from the content of a TOML file: Python's standard library only reads it."""

import json
import re
import tomllib
from collections.abc import Iterator, Mapping
from textwrap import shorten
from typing import Any

MAX_DEPTH = 32
"""Largest number of words of a key: reading it takes a time in the square of it."""
_WORD_AND_DOT = r"""(?<![\w-])(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+"""
_DEEP_KEY = re.compile(f"(?:{_WORD_AND_DOT}){{{MAX_DEPTH}}}")
LARGEST_DECIMAL = 1 << 64
"""Largest size of an integer that is written in decimal digits, of which Python writes no thousands."""
_PLACE = re.compile(r"\(at line (\d+), column (\d+)\)$")
LONGEST_SHOWN = 60
"""Largest number of characters of a line that is shown as it was read."""
MISTAKES = {
    "Invalid value": 'no value after =, such as 1.0, true, "text in quotes" or a list in [ ]',
    "Invalid statement": "neither KEY = VALUE nor a [table]",
    "Expected newline": "more than one value; units are left out; numbers have a decimal point, not a comma",
    "Expected '='": "a key without = and a value",
    "Expected ']'": "a [table] without its last bracket",
    "Cannot overwrite": "a key given before",
    "Cannot declare": "a table defined before; give it once, or [[NAME]] for each of a list",
    "Cannot mutate": "a table that is already complete",
    "Unclosed inline": "a table in { } that does not end on its line",
    "Unclosed": "a list without its last bracket",
    "Unterminated": "a text without its last quote",
    "Duplicate": "a key given before",
    "Illegal character": "a character that a text on one line cannot hold",
}
"""Words for the mistakes that Python's reader of TOML names, by how its messages begin."""
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


class TooLongError(tomllib.TOMLDecodeError):
    """A key or a number in a file that would take too long to read."""


def read_toml(text: str) -> dict[str, Any]:
    """Read TOML. Raises ``tomllib.TOMLDecodeError``, or its ``TooLongError``."""
    if _DEEP_KEY.search(text):
        raise TooLongError(f"a key of more than {MAX_DEPTH} words with dots between them")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except ValueError as error:  # Python refuses integers of some thousand digits
        raise TooLongError("a number of too many digits to compute with") from error


def toml_mistake(text: str, error: tomllib.TOMLDecodeError) -> str:
    """Message about text that is not TOML: the line, and what is wrong with it."""
    message = str(error)
    place = _PLACE.search(message)
    what = next((words for start, words in MISTAKES.items() if message.startswith(start)), "")
    lines = text.splitlines()
    if place is None or not 0 < int(place[1]) <= len(lines):
        return f"not a TOML file: {what or message}."
    line = shorten(lines[int(place[1]) - 1], LONGEST_SHOWN, placeholder=" ...")
    return f"not a TOML file, line {place[1]}: {what or 'not TOML from column ' + place[2]}; read {line}"


def toml_text(content: Mapping[str, Any]) -> str:
    """The text that ``tomllib`` reads as this content: a header for each table, a line for each key."""
    tables = {name: value for name, value in content.items() if _has_headers(value)}
    single = {name: value for name, value in content.items() if name not in tables}
    blocks = ["\n".join(_assignments(single))] if single else []
    for name, value in tables.items():
        header = f"[{_key(name)}]" if isinstance(value, dict) else f"[[{_key(name)}]]"
        inside = [value] if isinstance(value, dict) else value
        blocks += ["\n".join([header, *_assignments(table)]) for table in inside]
    return "\n\n".join(blocks) + "\n"


def _has_headers(value: Any) -> bool:
    """Whether it is a table or a list of tables."""
    is_list = isinstance(value, list) and bool(value)
    return isinstance(value, dict) or (is_list and all(isinstance(entry, dict) for entry in value))


def _assignments(table: Mapping[str, Any]) -> Iterator[str]:
    return (f"{_key(name)} = {inline_toml(value)}" for name, value in table.items())


def _key(name: str) -> str:
    return name if _BARE_KEY.fullmatch(name) else _quote(name)


def inline_toml(value: Any) -> str:
    """A value on one line."""
    if isinstance(value, dict):
        return f"{{ {', '.join(_assignments(value))} }}" if value else "{}"
    if isinstance(value, list):
        return f"[{', '.join(map(inline_toml, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return _quote(value)
    return hex(value) if isinstance(value, int) and abs(value) > LARGEST_DECIMAL else str(value)


def _quote(text: str) -> str:
    """JSON's escapes are TOML's, but for the character that JSON does not escape."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
