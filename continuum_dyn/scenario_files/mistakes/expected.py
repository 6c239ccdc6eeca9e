"""Words for what is expected at a place of a scenario file, in place of pydantic's."""

from collections.abc import Callable
from typing import Any

from continuum_dyn.scenario_files.toml_text import inline_toml

SHORT = 60
"""Largest number of characters of a value that is shown as it was read."""


def expected(detail: Any) -> str:
    """Text of what is expected where pydantic has found the error ``detail``, and what was read there."""
    wanted = _WANTED.get(detail["type"])
    words = _stated(detail) if wanted is None else wanted(detail.get("ctx", {}))
    unquoted = isinstance(detail["input"], str) and "number" in words and '"' not in words
    hint = ", without quotes and unit" if unquoted else ""
    return f"{words} is expected{hint}; read {as_read(detail['input'])}."


def as_read(value: Any) -> str:
    """A value as TOML has it, cut after ``SHORT`` characters."""
    text = inline_toml(value)
    return text if len(text) <= SHORT else f"{text[: SHORT - 3]}..."


def _bound(words: str, name: str) -> Callable[[dict[str, Any]], str]:
    return lambda context: f"a number {words} {context[name]:g}"


def _just(words: str) -> Callable[[dict[str, Any]], str]:
    return lambda _: words


def _stated(detail: Any) -> str:
    """The words of a check of this program, or no more than that something else is expected."""
    error = detail.get("ctx", {}).get("error")
    return "something else" if error is None else str(error).removesuffix(" is expected")


_WANTED: dict[str, Callable[[dict[str, Any]], str]] = {
    **dict.fromkeys(("float_type", "float_parsing"), _just("a number")),
    **dict.fromkeys(
        ("int_type", "int_parsing", "int_from_float", "int_parsing_size"), _just("a whole number")
    ),
    "finite_number": _just("a finite number"),
    **dict.fromkeys(("bool_type", "bool_parsing"), _just("true or false")),
    "string_type": _just("a text in quotes"),
    **dict.fromkeys(("list_type", "tuple_type"), _just("a list in [ ]")),
    **dict.fromkeys(
        ("model_type", "model_attributes_type", "dataclass_type", "dict_type"), _just("a table in { }")
    ),
    "greater_than": _bound("greater than", "gt"),
    "greater_than_equal": _bound("greater than or equal to", "ge"),
    "less_than": _bound("less than", "lt"),
    "less_than_equal": _bound("less than or equal to", "le"),
    "string_too_short": lambda context: f"a text of at least {context['min_length']} characters",
    "string_too_long": lambda context: f"a text of at most {context['max_length']} characters",
    "too_short": lambda context: f"a list of at least {context['min_length']} values",
    "too_long": lambda context: f"a list of at most {context['max_length']} values",
    **dict.fromkeys(("literal_error", "enum"), lambda context: f"one of {context['expected']}"),
}
"""Words for the expected value, from the context of pydantic's error, by its type."""
