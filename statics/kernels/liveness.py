"""Keep of every step the lines that results, stores and later passes need, and find who computes a symbol."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from statics.derivation.segment import symbol
from statics.derivation.step import Step


@dataclass
class Body:
    """A step with only the lines that are needed, and what it needs from elsewhere."""

    step: Step
    lines: list[tuple[tuple[sp.Symbol, ...], Any]]
    carried: dict[str, tuple[Any, Any]]
    needs: set[sp.Symbol]

    @property
    def passed_on(self) -> dict[str, tuple[Any, Any]]:
        """Results and what is carried: before the first segment, and after each one."""
        return self.step.results | self.carried

    @property
    def start(self) -> list[Any]:
        """Values that the first segment is given."""
        return [value for value, _ in self.passed_on.values()]


Owners = dict[sp.Symbol, str]
"""Name of the first step that computes each symbol: its value there is what later passes read."""


def owners_of(steps: Sequence[Step]) -> Owners:
    """The steps whose value of a symbol later passes read."""
    return {s: step.name for step in reversed(steps) for symbols, _ in step.trace.lines for s in symbols}


def live_bodies(steps: Sequence[Step], owners: Owners) -> list[Body]:
    """Steps without the lines that nothing needs; later passes are resolved first."""
    bodies: list[Body] = []
    wanted: set[sp.Symbol] = set()
    for step in reversed(steps):
        body = _prune(step, {s for s in wanted if owners.get(s) == step.name})
        wanted |= body.needs | symbols_of(body.start)
        bodies.insert(0, body)
    return bodies


def symbols_of(values: Iterable[Any]) -> set[sp.Symbol]:
    """All symbols of some expressions."""
    return set().union(*(sp.sympify(value).free_symbols for value in values))


def _prune(step: Step, wanted: set[sp.Symbol]) -> Body:
    fixed = [value for _, value in step.results.values()]
    fixed += [value for values in step.stores.values() for value in values]
    fixed += list(wanted)
    carried: dict[str, tuple[Any, Any]] = {}
    while True:
        lines, needs = _live(step, [*fixed, *(value for _, value in carried.values())])
        more = {n: v for n, v in step.carried.items() if symbol(n) in needs and n not in carried}
        if not more:
            own = {symbol(name) for name in (*step.results, *carried, *step.given)}
            return Body(step, lines, {n: v for n, v in step.carried.items() if n in carried}, needs - own)
        carried |= more


def _live(step: Step, wanted: Iterable[Any]) -> tuple[list[Any], set[sp.Symbol]]:
    needs = symbols_of(wanted)
    lines: list[Any] = []
    for symbols, value in reversed(step.trace.lines):
        if needs & set(symbols):
            lines.insert(0, (symbols, value))
            needs |= value.free_symbols
    return lines, needs - {symbol for symbols, _ in lines for symbol in symbols}
