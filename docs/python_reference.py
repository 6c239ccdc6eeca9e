"""The public names of both packages in Markdown: signatures and docstrings."""

import inspect
import re
from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import Any

import continuum_dyn.effects
import continuum_dyn.modes
import continuum_dyn.passes.dynamics
import continuum_dyn.scenario.intervals
import continuum_dyn.scenario.profiles
import continuum_dyn.scenario.solver
import continuum_dyn.scenario.studies
import statics
from continuum_dyn.effects import EFFECTS
from continuum_dyn.scenario.profiles import PROFILES
from continuum_dyn.scenario.studies import STUDIES
from statics.effects import STATIC_EFFECTS

PUBLIC: dict[Any, Iterable[str]] = {
    continuum_dyn: continuum_dyn.__all__,
    statics: statics.__all__,
    continuum_dyn.effects: [
        effect.__name__ for name, effect in EFFECTS.items() if name not in STATIC_EFFECTS
    ],
    continuum_dyn.scenario.profiles: [profile.__name__ for profile in PROFILES.values()],
    continuum_dyn.scenario.intervals: ["Interval", "cut_into_intervals"],
    continuum_dyn.scenario.studies: [study.__name__ for study in STUDIES.values()],
    continuum_dyn.scenario.solver: ["Solver", "Accuracy"],
    continuum_dyn.passes.dynamics: ["Dynamics", "Observation"],
    continuum_dyn.modes: ["modes_at_rest", "RestModes", "Mode"],
}
LINE = 100
"""Longest signature on one line, characters."""


def python_names() -> str:
    """The public names of both packages, and of the modules that people use beside them."""
    parts = []
    for module, names in PUBLIC.items():
        parts += [f"## `{module.__name__}`", prose(inspect.getdoc(module) or "")]
        for name in names:
            parts += _documented(name, getattr(module, name))
    return "\n\n".join(parts)


def prose(docstring: str) -> str:
    """A docstring as Markdown: code stays code, and no other character is a mark."""
    paragraphs = re.sub(r"::$", ":", docstring, flags=re.MULTILINE).split("\n\n")
    return "\n\n".join(text if text.startswith("    ") else _escape(text) for text in paragraphs)


def _escape(text: str) -> str:
    parts = text.replace("``", "`").split("`")
    parts[::2] = [re.sub(r"([*<\[\]]|(?<!\w)_|_(?!\w))", r"\\\1", part) for part in parts[::2]]
    return "`".join(parts)


def _documented(name: str, value: Any) -> Iterator[str]:
    """Heading, signature and docstring of a name, and of the public members of a class."""
    yield f"### `{name}`"
    if not callable(value):
        yield f"```text\n{name} = {value!r}\n```"
        return
    yield f"```text\n{_signature(name, value)}\n```"
    yield prose(inspect.getdoc(value) or "")
    if isinstance(value, type):
        yield from (_member(*member) for member in vars(value).items() if _is_documented(*member))


def _is_documented(name: str, value: Any) -> bool:
    members = property, cached_property, staticmethod, classmethod
    is_member = inspect.isfunction(value) or isinstance(value, members)
    return is_member and not name.startswith("_") and bool(value.__doc__)


def _member(name: str, value: Any) -> str:
    is_value = isinstance(value, property | cached_property)
    shown = name if is_value else _signature(name, getattr(value, "__func__", value), method=True)
    text = prose(inspect.cleandoc(value.__doc__ or "")).replace("\n", "\n  ")
    return f"- `{' '.join(shown.split())}`: {text}".replace("\n  \n", "\n\n")


def _signature(name: str, value: Any, method: bool = False) -> str:
    """A call with its arguments and simple defaults; units and shapes stand in the docstrings."""
    try:
        found = list(inspect.signature(value).parameters.values())
    except ValueError:  # of classes that only inherit from built-in ones
        return name
    if method and found and found[0].name in ("self", "cls"):
        found = found[1:]
    shown = [p.replace(annotation=p.empty, default=_Shown.of(p.default)) for p in found]
    text = f"{name}{inspect.Signature(shown)}"
    return (
        text if len(text) <= LINE else text.replace("(", "(\n    ", 1).replace(", ", ",\n    ")[:-1] + ",\n)"
    )


class _Shown:
    """A default that is shown as a given text."""

    def __init__(self, text: str) -> None:
        self.text = text

    def __repr__(self) -> str:
        return self.text

    @classmethod
    def of(cls, default: Any) -> Any:
        """The default as it is typed, or three dots if that would be long."""
        if default is inspect.Parameter.empty:
            return default
        simple = default is None or isinstance(default, bool | int | float | str) or default == ()
        return cls(repr(default) if simple else "...")
