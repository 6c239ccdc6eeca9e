"""From sympy steps to the text of one readable kernel module.

Every symbol that a step uses is a number that it is handed (``carried``), an element of an array
(coordinates, inputs, parameters), or was computed by an earlier step; then it becomes a column of
``chain``. What nothing asks for is not generated.
"""

import ast
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import sympy as sp
from sympy.printing.pycode import PythonCodePrinter

from statics.recursion import Step
from statics.segment import symbol
from statics.sigma import Sigma, ladder_source
from statics.virtual_work import SceneForces

HEADER = '''"""{title}

Generated; a change made here is lost. Coordinates of a segment: {coordinates}.
Effects: {effects}.
Arguments: q, u, w (n, coordinates): coordinates, rates, accelerations; inputs (INPUTS,): {inputs};
segments (n, SEGMENT_COLUMNS), disks (n, DISK_COLUMNS): parameters; chain (n, CHAIN_COLUMNS): what one
sweep leaves for the next. SI units.
"""

import math

import numpy as np
from numba import njit

compiled = njit(error_model="numpy", nogil=True)
inlined = njit(inline="always", error_model="numpy")'''

OPTIONAL = {"measure_cables", "measure_moving_cables", "measure_changes", "count_held"}
"""Sweeps that only scenes with coupled cables need."""


@dataclass
class _Body:
    """A step with only the lines that are needed, and what it needs from elsewhere."""

    step: Step
    lines: list[tuple[tuple[sp.Symbol, ...], Any]]
    carried: dict[str, tuple[float, Any]]
    needs: set[sp.Symbol]

    @property
    def start(self) -> list[Any]:
        """What the step is handed before the first segment."""
        return [value for value, _ in (self.step.results | self.carried).values()]


def compose(
    title: str, forces: SceneForces, effects: Sequence[str], steps: Sequence[Step], sources: Iterable[Path]
) -> str:
    """The whole module: constants, generated steps, and the functions of the source files.

    A call of one of ``OPTIONAL`` is left out where none of the sources defines it.
    """
    bodies = _resolve(steps)
    columns = _columns(forces, steps, bodies)
    ladders: set[int] = set()
    functions = [_print_step(body, columns, ladders) for body in bodies]
    parts = [
        HEADER.format(
            title=title,
            coordinates=", ".join(map(str, forces.segment.coordinates)),
            effects=", ".join(effects),
            inputs=", ".join(forces.inputs) or "none",
        ),
        _constants(forces, bodies, columns),
        *(_compiled(_start(body, columns)) for body in bodies if _starts_from_inputs(body)),
        *(_inlined(ladder_source(order)) for order in sorted(ladders)),
        *map(_inlined, functions),
        *_functions_of(sources),
    ]
    return "\n\n".join(parts) + "\n"


@dataclass(frozen=True)
class _Columns:
    text: dict[sp.Symbol, str]
    segments: list[str]
    disks: list[str]
    chain: list[sp.Symbol]
    owner: dict[sp.Symbol, str]


def _resolve(steps: Sequence[Step]) -> list[_Body]:
    """Keep what results, stores and later steps need; later steps are resolved first."""
    bodies: list[_Body] = []
    wanted: set[sp.Symbol] = set()
    owner = _owners(steps)
    for step in reversed(steps):
        body = _prune(step, {s for s in wanted if owner.get(s) == step.name})
        wanted |= body.needs | _symbols(body.start)
        bodies.insert(0, body)
    return bodies


def _owners(steps: Sequence[Step]) -> dict[sp.Symbol, str]:
    """Name of the first step that computes each symbol: its value there is what later steps read."""
    return {s: step.name for step in reversed(steps) for symbols, _ in step.trace.lines for s in symbols}


def _prune(step: Step, wanted: set[sp.Symbol]) -> _Body:
    fixed = [value for _, value in step.results.values()]
    fixed += [value for values in step.stores.values() for value in values]
    fixed += list(wanted)
    carried: dict[str, tuple[float, Any]] = {}
    while True:
        lines, needs = _live(step, [*fixed, *(value for _, value in carried.values())])
        more = {n: v for n, v in step.carried.items() if symbol(n) in needs and n not in carried}
        if not more:
            own = {symbol(name) for name in (*step.results, *carried)}
            return _Body(step, lines, {n: v for n, v in step.carried.items() if n in carried}, needs - own)
        carried |= more


def _live(step: Step, wanted: Iterable[Any]) -> tuple[list[Any], set[sp.Symbol]]:
    needs = _symbols(wanted)
    lines: list[Any] = []
    for symbols, value in reversed(step.trace.lines):
        if needs & set(symbols):
            lines.insert(0, (symbols, value))
            needs |= value.free_symbols
    return lines, needs - {symbol for symbols, _ in lines for symbol in symbols}


def _symbols(values: Iterable[Any]) -> set[sp.Symbol]:
    return set().union(*(sp.sympify(value).free_symbols for value in values))


def _columns(forces: SceneForces, steps: Sequence[Step], bodies: list[_Body]) -> _Columns:
    """Where every symbol that a step needs from elsewhere is found."""
    text: dict[sp.Symbol, str] = {}
    for array, symbols in (
        ("q", forces.segment.coordinates),
        ("u", forces.segment.rates),
        ("w", forces.segment.accelerations),
    ):
        text |= {s: f"{array}[i, {k}]" for k, s in enumerate(symbols)}
        text |= {symbol(f"{s}_change"): f"{array}_change[i, {k}]" for k, s in enumerate(symbols)}
    text |= {symbol(name): f"inputs[{k}]" for k, name in enumerate(forces.inputs)}
    owner = _owners(steps)
    for step in steps:
        for array, values in step.stores.items():
            text |= {symbol(f"{array}_{k}"): f"{array}[i, {k}]" for k in range(len(values))}
    needed = set().union(*(body.needs | _symbols(body.start) for body in bodies)) - set(text)
    chain = sorted((s for s in needed if s in owner), key=lambda s: (owner[s], s.name))
    text |= {s: f"chain[i, {k}]" for k, s in enumerate(chain)}
    of_disk = _symbols([forces.on_disk.force, *forces.on_disk.energies.values()])
    parameters = sorted((s for s in needed if s not in owner), key=str)
    segments = [s.name for s in parameters if s not in of_disk]
    disks = [s.name for s in parameters if s in of_disk]
    text |= {symbol(name): f"segments[i, {k}]" for k, name in enumerate(segments)}
    text |= {symbol(name): f"disks[i, {k}]" for k, name in enumerate(disks)}
    return _Columns(text, segments, disks, chain, owner)


def _constants(forces: SceneForces, bodies: list[_Body], columns: _Columns) -> str:
    lines = [
        f"INPUTS = {len(forces.inputs)}",
        f"COUPLED = {bool(forces.coupled)}",
        f"SEGMENT_COLUMNS = {tuple(columns.segments)!r}",
        f"DISK_COLUMNS = {tuple(columns.disks)!r}",
        f"CHAIN_COLUMNS = {len(columns.chain)}",
    ]
    for body in bodies:
        if not _starts_from_inputs(body):
            lines.append(f"{body.step.name.removesuffix('_step').upper()}_START = {tuple(body.start)!r}")
        if "pivots" in body.step.stores:
            lines.append(f"PIVOT_COLUMNS = {len(body.step.stores['pivots'])}")
    return "\n".join(lines)


def _starts_from_inputs(body: _Body) -> bool:
    """Whether what a sweep starts with may depend on the inputs: then it is a function of them."""
    return "inputs" in body.step.arrays


def _start(body: _Body, columns: _Columns) -> str:
    """Source of the function that returns what the step is handed before the first segment.

    What belongs to segments is the first one's.
    """
    loads = sorted(_symbols(body.start), key=lambda s: _by_place(columns.text[s]))
    lines = [f"{s} = {columns.text[s].replace('[i,', '[0,')}" for s in loads]
    signature = f"def {body.step.name.removesuffix('_step')}_start(inputs, segments, chain):"
    doc = f'"""What {body.step.name} is handed before the first segment."""'
    return "\n    ".join([signature, doc, *lines, f"return ({', '.join(map(_start_value, body.start))},)"])


def _start_value(value: Any) -> str:
    return repr(value) if isinstance(value, float) else _code(value)


def _print_step(body: _Body, columns: _Columns, ladders: set[int]) -> str:
    step = body.step
    handed = [*step.results, *body.carried]
    loads = sorted(body.needs, key=lambda s: _by_place(columns.text[s]))
    lines = [f"{s} = {columns.text[s]}" for s in loads]
    stored = [s for s in columns.chain if columns.owner[s] == step.name]
    returned = [value for _, value in (step.results | body.carried).values()]
    outputs = [value for values in step.stores.values() for value in values]
    lines += _assignments(body.lines, ladders)
    lines += [f"{columns.text[s]} = {s}" for s in stored]
    targets = [f"{array}[i, {k}]" for array, values in step.stores.items() for k in range(len(values))]
    lines += [f"{target} = {_code(value)}" for target, value in zip(targets, outputs, strict=True)]
    if handed:
        lines.insert(0, f"{', '.join(handed)}{',' if len(handed) == 1 else ''} = carried")
        lines.append(f"return ({', '.join(map(_code, returned))}{',' if len(returned) == 1 else ''})")
    else:
        lines.append("return carried")
    signature = f"def {step.name}(i, carried, {', '.join(step.arrays)}):"
    return "\n    ".join([signature, f'"""{step.doc}"""', *lines])


def _by_place(text: str) -> tuple[str, int]:
    array, _, column = text.rstrip("]").partition("[")
    return array, int(column.removeprefix("i, "))


def _assignments(lines: list[Any], ladders: set[int]) -> list[str]:
    text, known = [], {}
    for number, (argument, calls) in enumerate(_calls_by_argument(lines)):
        order = max(1, *(int(call.args[0]) for call in calls))
        ladders.add(order)
        suffix = f"_at_{number}" if number else ""
        names = {n: f"sigma_{'minus_1' if n == -1 else n}{suffix}" for n in range(-1, order + 1)}
        text.append(f"{', '.join(names.values())} = sigma_ladder_{order}({_code(argument)})")
        known |= {call: symbol(names[int(call.args[0])]) for call in calls}
    for symbols, value in _without_repetition([(s, value.xreplace(known)) for s, value in lines]):
        text.append(f"{', '.join(map(str, symbols))} = {_code(value)}")
    return text


def _calls_by_argument(lines: list[Any]) -> list[tuple[Any, set[Any]]]:
    """The sigma_n in these lines: the segment's own half angle first, then parts of it."""
    calls: dict[Any, set[Any]] = {}
    for _, value in lines:
        for call in value.atoms(Sigma):
            calls.setdefault(call.args[1], set()).add(call)
    return sorted(calls.items(), key=lambda item: str(item[0]))


def _without_repetition(lines: list[Any]) -> list[Any]:
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


class _Printer(PythonCodePrinter):
    """Python text; calls of the module's own functions under their own names."""

    def _print_AppliedUndef(self, call: Any) -> str:  # noqa: N802 (sympy's name)
        return f"{call.func.__name__}({', '.join(map(self._print, call.args))})"

    def _print_Heaviside(self, expression: Any) -> str:  # noqa: N802
        return f"(1.0 if {self._print(expression.args[0])} > 0.0 else 0.0)"

    def _print_Max(self, expression: Any) -> str:  # noqa: N802
        return f"max({', '.join(map(self._print, expression.args))})"

    def _print_Min(self, expression: Any) -> str:  # noqa: N802
        return f"min({', '.join(map(self._print, expression.args))})"


def _code(value: Any) -> str:
    return _Printer().doprint(sp.sympify(value))


def _compiled(function: str) -> str:
    return f"@compiled\n{function}"


def _inlined(function: str) -> str:
    """A step within its sweep's loop: as a call it would hand its many results over in memory."""
    return f"@inlined\n{function}"


def _functions_of(sources: Iterable[Path]) -> list[str]:
    """Constants and functions of the source files, as they stand there but for sweeps that nothing needs."""
    texts = [path.read_text(encoding="utf-8") for path in sources]
    nodes = [(text, node) for text in texts for node in ast.parse(text).body]
    defined = {node.name for _, node in nodes if isinstance(node, ast.FunctionDef)}
    parts = []
    for text, node in nodes:
        if isinstance(node, ast.FunctionDef):
            parts.append(_compiled(_without_calls(text, node, OPTIONAL - defined)))
        elif isinstance(node, ast.Assign):
            parts.append(ast.get_source_segment(text, node) or "")
    return parts


def _without_calls(text: str, function: ast.FunctionDef, names: Iterable[str]) -> str:
    """Source of a function without the statements that are calls of these names."""
    lines, left_out = text.splitlines(), set[int]()
    for node in ast.walk(function):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
            called = node.value.func
            if isinstance(called, ast.Name) and called.id in names:
                left_out |= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    own = range(function.lineno, (function.end_lineno or function.lineno) + 1)
    return "\n".join(lines[number - 1] for number in own if number not in left_out)
