"""From sympy steps to the text of one readable module of steps.

Every symbol that a step uses is a number that it is given or that is carried along the chain, an element of
an array (coordinates, inputs, parameters), or was computed by an earlier pass; then it becomes a column of
``chain``. What nothing reads is not generated.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

import sympy as sp
from sympy.printing.pycode import PythonCodePrinter

from statics.derivation.segment import symbol
from statics.derivation.sigma import Sigma, ladder_source
from statics.derivation.step import Step
from statics.derivation.steps.pivots import PIVOT_SOURCES
from statics.derivation.virtual_work import SceneForces
from statics.kernels.liveness import Body, Owners, live_bodies, owners_of, symbols_of

HEADER = '''"""{title}

Generated; a change made here is lost. Coordinates of a segment: {coordinates}.
Effects: {effects}.
A pass begins with what NAME_start returns and takes NAME_step from segment to segment.
Arguments: q, u, w (n, coordinates): coordinates, rates, accelerations; inputs (INPUTS,): {inputs};
segments (n, SEGMENT_COLUMNS), disks (n, DISK_COLUMNS): parameters; chain (n, CHAIN_COLUMNS): what one
pass leaves for the next. SI units.
"""

import math'''


def module_text(title: str, forces: SceneForces, effects: Sequence[str], steps: Sequence[Step]) -> str:
    """The whole module: constants, and the start and the step of every pass."""
    owners = owners_of(steps)
    bodies = live_bodies(steps, owners)
    columns = _columns(forces, steps, bodies, owners)
    called: dict[str, str] = {}
    functions = [text for body in bodies for text in (_start(body, columns), _step(body, columns, called))]
    header = HEADER.format(
        title=title,
        coordinates=", ".join(map(str, forces.segment.coordinates)),
        effects=", ".join(effects),
        inputs=", ".join(forces.inputs) or "none",
    )
    parts = [
        header,
        _constants(forces, bodies, columns),
        *(called[name] for name in sorted(called)),
        *functions,
    ]
    return "\n\n".join(parts) + "\n"


@dataclass(frozen=True)
class _Columns:
    text: dict[sp.Symbol, str]
    segments: list[str]
    disks: list[str]
    chain: list[sp.Symbol]
    owners: Owners


def _columns(forces: SceneForces, steps: Sequence[Step], bodies: list[Body], owners: Owners) -> _Columns:
    """Find the array and column of every symbol that a step needs from elsewhere."""
    text: dict[sp.Symbol, str] = {}
    for array, symbols in (
        ("q", forces.segment.coordinates),
        ("u", forces.segment.rates),
        ("w", forces.segment.accelerations),
    ):
        text |= {s: f"{array}[i, {k}]" for k, s in enumerate(symbols)}
        text |= {symbol(f"{s}_change"): f"{array}_change[i, {k}]" for k, s in enumerate(symbols)}
    text |= {symbol(name): f"inputs[{k}]" for k, name in enumerate(forces.inputs)}
    for step in steps:
        for array, values in step.stores.items():
            text |= {symbol(f"{array}_{k}"): f"{array}[i, {k}]" for k in range(len(values))}
    needed = set().union(*(body.needs | symbols_of(body.start) for body in bodies)) - set(text)
    chain = sorted((s for s in needed if s in owners), key=lambda s: (owners[s], s.name))
    text |= {s: f"chain[i, {k}]" for k, s in enumerate(chain)}
    of_disk = symbols_of([forces.on_disk.force, *forces.on_disk.energies.values()])
    parameters = sorted((s for s in needed if s not in owners), key=str)
    segments = [s.name for s in parameters if s not in of_disk]
    disks = [s.name for s in parameters if s in of_disk]
    text |= {symbol(name): f"segments[i, {k}]" for k, name in enumerate(segments)}
    text |= {symbol(name): f"disks[i, {k}]" for k, name in enumerate(disks)}
    return _Columns(text, segments, disks, chain, owners)


def _constants(forces: SceneForces, bodies: list[Body], columns: _Columns) -> str:
    """Constants for the caller: names of the columns, widths of the arrays, and every pass."""
    dofs = len(forces.segment.coordinates)
    widths = dict.fromkeys(("q", "u", "w", "q_change", "u_change", "change"), dofs)
    for body in bodies:
        widths |= {array: len(values) for array, values in body.step.stores.items()}
    widths |= {"segments": len(columns.segments), "disks": len(columns.disks), "chain": len(columns.chain)}
    lines = [
        f"INPUTS = {tuple(forces.inputs)!r}",
        f"CONSERVATIVE = {forces.conservative}",
        f"SEGMENT_COLUMNS = {tuple(columns.segments)!r}",
        f"DISK_COLUMNS = {tuple(columns.disks)!r}",
        f"CHAIN_COLUMNS = {tuple(s.name for s in columns.chain)}",
        f"WIDTHS = {widths!r}",
        "PASSES = {  # name: (direction, what the caller gives, what it gets, arrays)",
        *(f"    {body.step.name!r}: {_signature(body.step)!r}," for body in bodies),
        "}",
    ]
    return "\n".join(lines)


def _signature(step: Step) -> tuple[str, tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    return step.direction, step.given, tuple(step.results), step.arrays


def _start(body: Body, columns: _Columns) -> str:
    """Source of the function that returns what the first segment is given; what is a segment's is its own."""
    loads = sorted(symbols_of(body.start), key=lambda s: _by_place(columns.text[s]))
    lines = [f"{s} = {columns.text[s].replace('[i,', '[0,')}" for s in loads]
    signature = f"def {body.step.name}_start(inputs, segments, chain):"
    doc = f'"""Values of {body.step.name}_step before the first segment."""'
    return "\n    ".join([signature, doc, *lines, f"return {_tuple(map(_start_value, body.start))}"])


def _start_value(value: Any) -> str:
    return repr(value) if isinstance(value, float) else _code(value)


def _tuple(parts: Any) -> str:
    parts = list(parts)
    return f"({', '.join(parts)}{',' if len(parts) == 1 else ''})"


def _step(body: Body, columns: _Columns, called: dict[str, str]) -> str:
    """Source of a step; the functions that it calls go into ``called``, by name."""
    step = body.step
    loads = sorted(body.needs, key=lambda s: _by_place(columns.text[s]))
    stored = [s for s in columns.chain if columns.owners[s] == step.name]
    outputs = [value for values in step.stores.values() for value in values]
    targets = [f"{array}[i, {k}]" for array, values in step.stores.items() for k in range(len(values))]
    lines = [
        f"{', '.join(names)}{',' if len(names) == 1 else ''} = {source}"
        for names, source in (
            (list(body.passed_on), "carried"),
            (list(step.given), "given"),
        )
        if names
    ]
    lines += [f"{s} = {columns.text[s]}" for s in loads]
    lines += _assignments(body.lines, called)
    lines += [f"{columns.text[s]} = {s}" for s in stored]
    lines += [f"{target} = {_code(value)}" for target, value in zip(targets, outputs, strict=True)]
    lines.append(f"return {_tuple(_code(value) for _, value in body.passed_on.values())}")
    signature = f"def {step.name}_step(i, carried, given, {', '.join(step.arrays)}):"
    return "\n    ".join([signature, f'"""{step.doc}"""', *lines])


def _by_place(text: str) -> tuple[str, int]:
    array, _, column = text.rstrip("]").partition("[")
    return array, int(column.removeprefix("i, "))


def _assignments(lines: list[Any], called: dict[str, str]) -> list[str]:
    text, known = [], {}
    for number, (argument, calls) in enumerate(_calls_by_argument(lines)):
        order = max(1, *(int(call.args[0]) for call in calls))
        called[f"sigma_ladder_{order}"] = ladder_source(order)
        suffix = f"_at_{number}" if number else ""
        names = {n: f"sigma_{'minus_1' if n == -1 else n}{suffix}" for n in range(-1, order + 1)}
        text.append(f"{', '.join(names.values())} = sigma_ladder_{order}({_code(argument)})")
        known |= {call: symbol(names[int(call.args[0])]) for call in calls}
    named = tuple((s, value.xreplace(known)) for s, value in lines)
    for symbols, value in _without_repetition(named):
        called |= {name: PIVOT_SOURCES[name] for name in _called(value)}
        text.append(f"{', '.join(map(str, symbols))} = {_code(value)}")
    return text


def _calls_by_argument(lines: list[Any]) -> list[tuple[Any, set[Any]]]:
    """The sigma_n in these lines: the segment's own half angle first, then parts of it."""
    calls: dict[Any, set[Any]] = {}
    for _, value in lines:
        for call in value.atoms(Sigma):
            calls.setdefault(call.args[1], set()).add(call)
    return sorted(calls.items(), key=lambda item: str(item[0]))


@cache
def _without_repetition(lines: tuple[Any, ...]) -> list[Any]:
    """Common subexpressions named once, each just before its first use."""
    replacements, reduced = sp.cse([value for _, value in lines], order="none")
    pending = dict(replacements)
    result: list[Any] = []

    def place(value: Any) -> None:
        for part in sorted(value.free_symbols & set(pending), key=str):
            if part in pending:
                expression = pending.pop(part)
                place(expression)
                result.append(((part,), expression))

    for (symbols, _), value in zip(lines, reduced, strict=True):
        place(value)
        result.append((symbols, value))
    return result


def _called(value: Any) -> set[str]:
    return {call.func.__name__ for call in value.atoms(sp.core.function.AppliedUndef)}


class _Printer(PythonCodePrinter):
    """Python text; calls of the module's own functions under their own names, small powers as products."""

    def _print_Pow(self, expression: Any, rational: bool = False, sqrt: str = "math.sqrt") -> str:  # noqa: N802
        base, exponent = expression.args
        if base.is_Symbol and exponent.is_Integer and 2 <= exponent <= 4:
            square = f"{base}*{base}"
            return (
                f"({square})" if exponent == 2 else f"({base if exponent == 3 else f'({square})'}*({square}))"
            )
        return super()._print_Pow(expression, rational=rational)

    def _print_AppliedUndef(self, call: Any) -> str:  # noqa: N802 (sympy's name)
        return f"{call.func.__name__}({', '.join(map(self._print, call.args))})"

    def _print_Heaviside(self, expression: Any) -> str:  # noqa: N802
        return f"(1.0 if {self._print(expression.args[0])} > 0.0 else 0.0)"

    def _print_sign(self, expression: Any) -> str:
        text = self._print(expression.args[0])
        return f"(1.0 if {text} > 0.0 else (-1.0 if {text} < 0.0 else 0.0))"

    def _print_Max(self, expression: Any) -> str:  # noqa: N802
        return f"max({', '.join(map(self._print, expression.args))})"

    def _print_Min(self, expression: Any) -> str:  # noqa: N802
        return f"min({', '.join(map(self._print, expression.args))})"


_PRINTER = _Printer()


@lru_cache(maxsize=None, typed=True)
def _code(value: Any) -> str:
    return _PRINTER.doprint(sp.sympify(value))
