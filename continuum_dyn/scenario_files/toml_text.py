"""TOML written from the content of a TOML file: Python's standard library only reads it."""

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


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
    return _quote(value) if isinstance(value, str) else str(value)


def _quote(text: str) -> str:
    """JSON's escapes are TOML's, but for the character that JSON does not escape."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
