"""Assertions about figures: ``--assert "settling_time_2 < 0.8"``. They are parsed, not evaluated as code."""

import operator
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import typer

from continuum_dyn.commands.terminal.show import plain_table
from statics.errors import InputError, did_you_mean
from statics.quantities import QUANTITIES

NOT_HELD = 1
"""Exit status if an assertion does not hold."""
COMPARISONS: dict[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
GRAMMAR = re.compile(r"\s*(\w+)\s*(<=|>=|<|>)\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*", re.ASCII)
"""NAME, a comparison, NUMBER."""
HELP = 'Exit with 1 if this does not hold, e.g. "{}"; NAME < NUMBER, or <=, >, >=; SI units. Repeatable.'


class Assertion(NamedTuple):
    """An assertion that a figure is less or more than a bound, in SI units."""

    name: str
    comparison: str
    bound: float

    def __str__(self) -> str:
        return f"{self.name} {self.comparison} {self.bound:g}"


class Verdict(NamedTuple):
    """An assertion, the value that was found, and whether it holds; it does not if there is no value."""

    assertion: Assertion
    value: float | None
    holds: bool

    @property
    def record(self) -> dict[str, Any]:
        """The verdict as ``--json`` prints it."""
        return {"assert": str(self.assertion), "value": self.value, "holds": self.holds}


def parse(texts: Sequence[str], known: Sequence[str]) -> list[Assertion]:
    """Parse assertions. Raises ``InputError`` if a text is not one, or names an unknown figure."""
    return [_parse(text, known) for text in texts]


def _parse(text: str, known: Sequence[str]) -> Assertion:
    found = GRAMMAR.fullmatch(text)
    if found is None:
        raise InputError(
            f"--assert takes NAME < NUMBER, or <=, >, >=, in SI units; read: '{text[:60]}'. "
            f"Try: --assert '{known[0]} < 0.1'. Known names: {', '.join(known)}."
        )
    name, comparison, bound = found.groups()
    if name not in known:
        raise InputError(f"--assert: there is no figure '{name[:60]}'.{did_you_mean(name, known)}")
    return Assertion(name, comparison, float(bound))


def judge(assertions: Sequence[Assertion], figures: Mapping[str, float | None]) -> list[Verdict]:
    """Judge each assertion by the figure that was found."""
    found = [(assertion, figures[assertion.name]) for assertion in assertions]
    return [
        Verdict(
            assertion, value, value is not None and COMPARISONS[assertion.comparison](value, assertion.bound)
        )
        for assertion, value in found
    ]


def verdict_table(verdicts: Sequence[Verdict], missing: Mapping[str, str]) -> Any:
    """A table of assertions: whether each holds, and the value found."""
    table = plain_table("\nChecks", "assertion", "holds", "found")
    table.columns[2].justify, table.columns[2].overflow = "left", "fold"
    for assertion, value, holds in verdicts:
        unit = QUANTITIES[assertion.name].unit
        value_text = (
            f"nothing: {missing[assertion.name]}"
            if value is None
            else f"{value:.6g}{'' if unit == '1' else ' ' + unit}"
        )
        table.add_row(str(assertion), "yes" if holds else "no", value_text)
    return table


def exit_unless_held(verdicts: Sequence[Verdict]) -> None:
    """Exit with ``NOT_HELD`` if an assertion does not hold."""
    if not all(verdict.holds for verdict in verdicts):
        raise typer.Exit(NOT_HELD)
