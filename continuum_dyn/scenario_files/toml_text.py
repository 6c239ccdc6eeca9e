"""TOML written from the content of a TOML file: Python's standard library only reads it."""

import json
import re
import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

MAX_DEPTH = 32
"""Largest number of words of a key: reading it takes a time in the square of it."""
_WORD_AND_DOT = r"""(?<![\w-])(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+"""
_DEEP_KEY = re.compile(f"(?:{_WORD_AND_DOT}){{{MAX_DEPTH}}}")
LARGEST_DECIMAL = 1 << 64
"""Largest size of an integer that is written in decimal digits, of which Python writes no thousands."""
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def read_toml(text: str) -> dict[str, Any]:
    """Read TOML. Raises ``tomllib.TOMLDecodeError``, also for keys and numbers that would take too long."""
    if _DEEP_KEY.search(text):
        raise tomllib.TOMLDecodeError(f"a key of more than {MAX_DEPTH} words with dots between them")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except ValueError as error:  # Python refuses integers of some thousand digits
        raise tomllib.TOMLDecodeError("a number of too many digits to compute with") from error


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
    return (f"{_key(name)} = {_inline(value)}" for name, value in table.items())


def _key(name: str) -> str:
    return name if _BARE_KEY.fullmatch(name) else _quote(name)


def _inline(value: Any) -> str:
    if isinstance(value, dict):
        return f"{{ {', '.join(_assignments(value))} }}" if value else "{}"
    if isinstance(value, list):
        return f"[{', '.join(map(_inline, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return _quote(value)
    return hex(value) if isinstance(value, int) and abs(value) > LARGEST_DECIMAL else str(value)


def _quote(text: str) -> str:
    """JSON's escapes are TOML's, but for the character that JSON does not escape."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
