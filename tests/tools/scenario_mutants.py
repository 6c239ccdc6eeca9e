"""Scenario files gone wrong at random: their text spoiled, or their tables changed and written again.

A mutant follows from a seed alone, so one that is found can be made again.
"""

import copy
import json
import math
import tomllib
from collections.abc import Callable, Sequence
from functools import cache
from random import Random
from typing import Any

NUMBERS = (
    *(0, 0.0, -0.0, 1, -1, 2, 0.5, -1e-3, 1e-300, -1e-300, 5e-324, 1e-30, 1e30, 1e300, -1e300, 1e308),
    *(math.nan, math.inf, -math.inf, 10, 1000, 9999, 10_000, 10_001, 10**9, -(10**9), 2**31, 2**63, 10**400),
)
OTHER_TYPES = (
    *(True, False, "", "1.0", "auto", "nan", "\x00", "\x1b[2J", "é" * 50, "x" * 10_000, "a\nb"),
    *("../" * 8 + "etc/passwd", "/dev/zero", ".", "slow_ramp.csv"),
    *([], {}, [[]], [{}], [0.1, "a"], {"profile": "step"}),
    *({"profile": "table", "file": "."}, {"profile": "table", "file": "slow_ramp.csv"}),
)
TOKENS = (
    *("nan", "-inf", "1e999", "9" * 400, "0x7fffffffffffffff", "1979-05-27T07:32:00Z", "07:32:00", "true"),
    *('"""', "'''", "[[", "]]", "{", "}", "=", "#", "\n", "\r", "\x00", "\\u0000", "\ufeff", "open('x')"),
    *("[" * 3000, "{a=" * 3000, "a." * 3000 + "b = 1\n", "[arm]\n", "[[cables]]\n", "[study]\n"),
)
Tables = dict[str, Any]


def mutant(rng: Random, texts: Sequence[str]) -> str:
    """One of the texts after one to four changes to its characters or to its tables."""
    text = rng.choice(texts)
    if rng.random() < 0.3:
        return spoiled(rng, text)
    content = copy.deepcopy(_tables_of(text))
    for _ in range(rng.randint(1, 4)):
        rng.choice(TABLE_CHANGES)(rng, content)
    return written(content)


@cache
def _tables_of(text: str) -> Tables:
    return tomllib.loads(text)


def spoiled(rng: Random, text: str) -> str:
    """The text after one to three changes to its characters."""
    for _ in range(rng.randint(1, 3)):
        text = rng.choice(TEXT_CHANGES)(rng, text)
    return text


def written(content: Tables) -> str:
    """The tables as TOML: each on a line of its own, all that is inside them inline."""
    return "".join(f"{json.dumps(key)} = {_inline(value)}\n" for key, value in content.items())


def _inline(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {_inline(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, float):
        return repr(value)
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _cut(rng: Random, text: str) -> str:
    start = rng.randrange(len(text) + 1)
    return text[:start] + text[start + rng.randint(1, 40) :]


def _truncate(rng: Random, text: str) -> str:
    return text[: rng.randrange(len(text) + 1)]


def _put_in(rng: Random, text: str) -> str:
    start = rng.randrange(len(text) + 1)
    return text[:start] + rng.choice(TOKENS) + text[start:]


def _spoil_a_character(rng: Random, text: str) -> str:
    start = rng.randrange(len(text) + 1)
    return text[:start] + chr(rng.choice((rng.randrange(128), rng.randrange(0xD800)))) + text[start + 1 :]


def _swap_lines(rng: Random, text: str) -> str:
    lines = text.splitlines(keepends=True)
    if lines:
        one, other = rng.randrange(len(lines)), rng.randrange(len(lines))
        lines[one], lines[other] = lines[other], lines[one]
    return "".join(lines)


def _repeat_a_line(rng: Random, text: str) -> str:
    lines = text.splitlines(keepends=True)
    if lines:
        lines.insert(rng.randrange(len(lines)), rng.choice(lines))
    return "".join(lines)


TEXT_CHANGES: tuple[Callable[[Random, str], str], ...] = (
    *(_cut, _truncate, _put_in, _spoil_a_character, _swap_lines, _repeat_a_line),
)


def _places(content: Any) -> list[tuple[Any, Any]]:
    """Every value of the tables: what holds it, and its key or number there."""
    found, holders = [], [content]
    while holders:
        holder = holders.pop()
        keys = list(holder) if isinstance(holder, dict) else range(len(holder))
        for key in keys:
            found.append((holder, key))
            if isinstance(holder[key], dict | list):
                holders.append(holder[key])
    return found


def _change_a_number(rng: Random, content: Tables) -> None:
    numbers = [(holder, key) for holder, key in _places(content) if type(holder[key]) in (int, float)]
    if numbers:
        holder, key = rng.choice(numbers)
        small = abs(holder[key]) < 1e300
        near = (holder[key] * rng.choice((2, 0.5, -1, 1e3, 1e-3)), holder[key] + 1) if small else (0,)
        holder[key] = rng.choice((*near, rng.choice(NUMBERS)))


def _change_a_type(rng: Random, content: Tables) -> None:
    holder, key = _any_place(rng, content)
    wrapped = ([holder[key]], [holder[key]] * 5, {"a": holder[key]})
    holder[key] = copy.deepcopy(rng.choice((*OTHER_TYPES, *wrapped)))


def _misspell_a_key(rng: Random, content: Tables) -> None:
    holder, key = _any_place(rng, content)
    if isinstance(holder, dict):
        place = rng.randrange(len(key) + 1)
        holder[key[:place] + rng.choice(("", "x", "_", " ", "é")) + key[place + 1 :]] = holder.pop(key)


def _swap_values(rng: Random, content: Tables) -> None:
    (one, its), (other, others) = _any_place(rng, content), _any_place(rng, content)
    values = copy.deepcopy((one[its], other[others]))
    one[its] = values[1]
    other[others] = values[0]


def _move_a_value(rng: Random, content: Tables) -> None:
    (holder, key), (other, _) = _any_place(rng, content), _any_place(rng, content)
    if isinstance(other, dict):
        other[str(key)] = copy.deepcopy(holder[key])


def _remove(rng: Random, content: Tables) -> None:
    holder, key = _any_place(rng, content)
    del holder[key]


def _repeat(rng: Random, content: Tables) -> None:
    lists = [holder[key] for holder, key in _places(content) if isinstance(holder[key], list) and holder[key]]
    if lists:
        chosen = rng.choice(lists)
        chosen.extend(copy.deepcopy(chosen) * (rng.choice((1, 1, 1, 30)) if len(chosen) < 50 else 1))


def _lengthen(rng: Random, content: Tables) -> None:
    holder, key = _any_place(rng, content)
    holder[key] = rng.choice(([0.5] * 4000, [1] * 4, [holder[key]] * 2, [1.0] * 5))


def _nest(rng: Random, content: Tables) -> None:
    holder, key = _any_place(rng, content)
    value = copy.deepcopy(holder[key])
    for _ in range(rng.choice((1, 10, 90))):
        value = rng.choice(([value], {"a": value}, {str(key): value}))
    holder[key] = value


def _any_place(rng: Random, content: Tables) -> tuple[Any, Any]:
    return rng.choice(_places(content) or [({"": 0}, "")])


TABLE_CHANGES: tuple[Callable[[Random, Tables], None], ...] = (
    *(_change_a_number,) * 6,
    *(_change_a_type, _misspell_a_key, _swap_values, _move_a_value, _remove, _repeat, _lengthen, _nest),
)
