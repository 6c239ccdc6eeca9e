"""From functions of ordinary modules to LLVM's language: searches, stages and steps, which know no scene.

They keep to a part of Python whose types show. A number is a float, an integer or a bool, told by the
parameter's annotation or by what is first assigned; an array holds floats, row by row without gaps; a tuple
holds any of these, and travels as its parts. There are assignments, ``if``, ``while``, ``for ... in range``,
returns of numbers, and calls of other such functions, of passes by ``run``, and of a part of ``math``.
``array[i]`` and ``array[a:b]`` are views; ``np.empty`` and ``np.zeros`` make workspaces, which end with the
function. Anything else is refused by name.

A float parameter makes a float of an integer. Nothing is checked when it runs: indices and the ends of slices
lie within the array, and negative ones do not count from its end; integers have 64 bits, and 53 where they
are divided or compared with floats; no integer is divided by zero, and a float by zero gives what the
processor does. Additions are neither reordered nor contracted, so bits agree with Python's.
"""

import ast
import inspect
import math
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import numpy as np

from statics.kernels.calling import run
from statics.kernels.kinds import (
    BOOL,
    FLOAT,
    INT,
    NAMES,
    SCALAR_KINDS,
    ArrayKind,
    Kind,
    TupleKind,
    Value,
    cells,
    named,
)
from statics.kernels.lowering import (
    COMPARISONS,
    INTRINSICS,
    LARGEST_POWER,
    LIBRARY,
    OPERATIONS,
    LoweringError,
    declarations,
    float_text,
)

INTEGER_OPERATIONS = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul"}
FLOAT_COMPARISONS = {ast.Eq: "fcmp oeq", ast.NotEq: "fcmp une"} | {
    comparison: f"fcmp {how}" for comparison, how in COMPARISONS.items()
}
INTEGER_COMPARISONS = {ast.Eq: "icmp eq", ast.NotEq: "icmp ne"} | {
    comparison: f"icmp s{how[1:]}" for comparison, how in COMPARISONS.items()
}
NUMBERS = {"abs": 1, "float": 1, "isfinite": 1} | dict.fromkeys(INTRINSICS, 1) | LIBRARY
"""Number of arguments of each function that takes numbers and returns a float or a bool."""
BUILTINS = {function.__name__: function for function in (min, max, abs, int, float, len, range)}
FUNCTIONS = BUILTINS | {name: getattr(math, name) for name in ("isfinite", *INTRINSICS, *LIBRARY)}
LARGEST_INTEGER = 2**63 - 1
NUMBER_BYTES = 8
LONG = 100
"""Lines of a function above which it stays one: a copy at every call would only take time to compile."""
RUNTIME = [
    *declarations(),
    "declare double @pow(double, double) nobuiltin nounwind willreturn memory(none)",  # else not Python's
    "declare ptr @calloc(i64, i64)",
    "declare void @free(ptr)",
]
ALLOWED = (
    "Allowed: floats, integers, bools, arrays, tuples of these; assignments, if, while, for over a range, "
    "return of numbers, arithmetic and comparisons, indices and slices without gaps, reshape, np.empty and "
    "np.zeros outside of loops, min, max, abs, int, float, len, math, and calls of compiled functions."
)


def declared_kinds(function: Callable[..., Any]) -> dict[str, str | None]:
    """Kinds of the parameters that are annotated as numbers; None of those that are seen by their values.

    Raises ``LoweringError`` for a function with parameters of other sorts.
    """
    code = function.__code__
    if code.co_flags & (inspect.CO_VARARGS | inspect.CO_VARKEYWORDS) or code.co_kwonlyargcount:
        raise _refusal(
            function, code.co_firstlineno, code.co_name, "has parameters other than positional ones"
        )
    annotations = function.__annotations__
    return {name: SCALAR_KINDS.get(annotations.get(name)) for name in code.co_varnames[: code.co_argcount]}


def lower_function(function: Callable[..., Any], kinds: Sequence[Kind]) -> tuple[str, Kind | None]:
    """LLVM's text of a function for arguments of these kinds, and the kind of its result.

    The text holds ``void entry(ptr arguments, ptr results)``: cells as in C's structures.
    Raises ``LoweringError`` for what cannot be lowered.
    """
    unit = _Unit()
    try:
        name, result = unit.lower(function, kinds)
    except RecursionError:
        line = function.__code__.co_firstlineno
        raise _refusal(function, line, function.__name__, "is nested too deeply") from None
    given = _parameters(kinds)
    whole = _struct(cells(given.kind))
    parts = [f"  {cell} = extractvalue {whole} %given, {k}" for k, cell in enumerate(given.cells)]
    call = f"call {_returned(result)} @{name}({given.text})"
    called = [f"  %found = {call}", f"  store {_returned(result)} %found, ptr %results"]
    lines = [
        *(*RUNTIME, *unit.texts, "define void @entry(ptr %arguments, ptr %results) nounwind {"),
        *(
            f"  %given = load {whole}, ptr %arguments",
            *parts,
            *(called if result is not None else [f"  {call}"]),
        ),
        *("  ret void", "}"),
    ]
    return "\n".join(lines), result


class _Unit:
    """One module of LLVM's text in the making: a function, and all that it calls."""

    def __init__(self) -> None:
        self.texts: list[str] = []
        self.known: dict[tuple[Any, tuple[Kind, ...]], tuple[str, Kind | None]] = {}
        self.open: set[Callable[..., Any]] = set()

    def lower(self, function: Callable[..., Any], kinds: Sequence[Kind]) -> tuple[str, Kind | None]:
        """Name and kind of the result of a function for arguments of these kinds, lowered at first sight."""
        key = (function, tuple(kinds))
        if key not in self.known:
            self.open.add(function)
            code = _Code(self, function, kinds)
            self.open.remove(function)
            name = f"f{len(self.known)}"
            self.known[key] = name, code.result
            self.texts.append(code.text(name))
        return self.known[key]


class _Code:
    """Lines of one function, with its variables on the stack: LLVM turns them into registers."""

    def __init__(self, unit: _Unit, function: Callable[..., Any], kinds: Sequence[Kind]) -> None:
        self.unit, self.function = unit, function
        code = function.__code__
        self.local = {*code.co_varnames, *code.co_cellvars, *code.co_freevars}
        self.stack: list[str] = []
        self.lines: list[str] = []
        self.count = 0
        self.variables: dict[str, Value] = {}
        self.loops: list[tuple[str, str]] = []
        self.reached: set[str] = set()
        self.ended = False
        self.results: list[Kind | None] = []
        self.workspaces: list[str] = []
        tree, self.parameters = _definition(function), _parameters(kinds)
        for name, value in zip(declared_kinds(function), self.parameters.parts, strict=True):
            self.set_name(name, value, tree)
        self.statements(tree.body)
        if not self.ended:
            self.give_back(None, tree.body[-1])

    @property
    def result(self) -> Kind | None:
        """Kind of what the function returns."""
        return self.results[0] if self.results else None

    def text(self, name: str) -> str:
        """The function's text."""
        how = "nounwind noinline" if len(self.lines) > LONG else "nounwind"
        head = f"define internal {_returned(self.result)} @{name}({self.parameters.text}) {how} {{"
        return "\n".join([head, *self.stack, *self.lines, "}"])

    # lines

    def emit(self, line: str) -> None:
        """Add a line."""
        self.lines.append(f"  {line}")

    def assign(self, operation: str) -> str:
        """The name of a new cell."""
        self.count += 1
        self.emit(f"%v{self.count} = {operation}")
        return f"%v{self.count}"

    def new(self, kind: str, operation: str) -> Value:
        """A new number."""
        return Value(kind, (self.assign(operation),))

    def slot(self, kind: str) -> str:
        """A place on the stack for one cell."""
        self.count += 1
        self.stack.append(f"  %s{self.count} = alloca {kind}")
        return f"%s{self.count}"

    def label(self) -> str:
        """A new label."""
        self.count += 1
        return f"b{self.count}"

    def begin(self, label: str) -> None:
        """Begin a block, where what came before may go on; if nothing goes to it, there is none."""
        self.go(label)
        self.ended = label not in self.reached
        if not self.ended:
            self.lines.append(f"{label}:")

    def go(self, label: str) -> None:
        """End a block that has not ended yet."""
        if not self.ended:
            self.emit(f"br label %{label}")
            self.reached.add(label)
        self.ended = True

    def fork(self, condition: str, first: str, second: str) -> None:
        """End a block with one of two branches."""
        self.emit(f"br i1 {condition}, label %{first}, label %{second}")
        self.reached |= {first, second}
        self.ended = True

    def refusal(self, node: ast.AST, why: str = "cannot be lowered") -> LoweringError:
        """An error that says where and what."""
        return _refusal(self.function, getattr(node, "lineno", 0), ast.unparse(node).split("\n")[0], why)

    # statements

    def statements(self, nodes: Sequence[ast.stmt]) -> None:
        """Lower statements up to one that never goes on to the next."""
        for node in nodes:
            if not self.ended:
                self.statement(node)

    def statement(self, node: ast.stmt) -> None:
        """Lower one statement; a docstring is passed over."""
        match node:
            case ast.Expr(value=ast.Constant()) | ast.Pass():
                pass
            case ast.Expr(value=ast.Call() as call):
                self.call(call)
            case ast.Assign(targets=[target], value=value):
                self.set(target, self.value(value))
            case ast.AugAssign(target=ast.Name() as target):
                self.set(target, self.arithmetic(node, self.value(target), self.value(node.value)))
            case ast.AugAssign(target=ast.Subscript() as target):
                place = self.place(target)
                before = self.new(FLOAT, f"load double, ptr {place}")
                self.store(place, self.arithmetic(node, before, self.value(node.value)), node)
            case ast.If():
                self.branch(node)
            case ast.While(orelse=[]):
                self.repeat(node)
            case ast.For(target=ast.Name(), iter=ast.Call(func=function, args=arguments, keywords=[])) if (
                self.known(function) is range and not node.orelse
            ):
                self.count_over(node, arguments)
            case ast.Break() | ast.Continue():
                again, after = self.loops[-1]
                self.go(after if isinstance(node, ast.Break) else again)
            case ast.Return(value=None | ast.Constant(value=None)):
                self.give_back(None, node)
            case ast.Return(value=ast.expr() as value):
                self.give_back(self.value(value), node)
            case _:
                raise self.refusal(node)

    def branch(self, node: ast.If) -> None:
        """Lower an ``if``."""
        first, second, after = self.label(), self.label(), self.label()
        self.fork(self.truth(node.test), first, second)
        for label, body in ((first, node.body), (second, node.orelse)):
            self.begin(label)
            self.statements(body)
            self.go(after)
        self.begin(after)

    def repeat(self, node: ast.While) -> None:
        """Lower a ``while``."""
        head, inside, after = self.label(), self.label(), self.label()
        self.loops.append((head, after))
        self.begin(head)
        if not (isinstance(node.test, ast.Constant) and node.test.value is True):
            self.fork(self.truth(node.test), inside, after)
        self.begin(inside)
        self.rest_of_loop(node.body)

    def count_over(self, node: ast.For, arguments: Sequence[ast.expr]) -> None:
        """Lower ``for name in range(...)``, with a step of a constant size."""
        values = [self.value(argument) for argument in arguments]
        values = [*([_constant(0)] if len(values) == 1 else []), *values, _constant(1)]
        step = values[2].literal if len(arguments) in (1, 2, 3) else None
        if not step:
            raise self.refusal(node.iter, "must count up or down by a constant")
        first, end = (self.converted(value, INT, node.iter) for value in values[:2])
        head, inside, after = self.label(), self.label(), self.label()
        self.set_name(f"counter {head}", Value(INT, (first,)), node)
        self.loops.append((head, after))
        self.begin(head)
        now = self.variable(f"counter {head}")
        more = self.assign(f"icmp {'slt' if step > 0 else 'sgt'} i64 {now.cells[0]}, {end}")
        self.fork(more, inside, after)
        self.begin(inside)
        self.set_name(f"counter {head}", self.new(INT, f"add nsw i64 {now.cells[0]}, {step}"), node)
        self.set(node.target, now)
        self.rest_of_loop(node.body)

    def rest_of_loop(self, body: Sequence[ast.stmt]) -> None:
        """Lower a loop's body and its jump back."""
        again, after = self.loops[-1]
        self.statements(body)
        self.go(again)
        self.loops.pop()
        self.begin(after)

    def give_back(self, value: Value | None, node: ast.AST) -> None:
        """Return numbers, or nothing; workspaces end."""
        kind = None if value is None else value.kind
        parts = kind.parts if isinstance(kind, TupleKind) else (kind,)
        if not all(part in NAMES for part in parts) or self.results not in ([], [kind]):
            why = f"returns {named(kind)}: every return must give numbers, of the same kinds, or nothing"
            raise self.refusal(node, why)
        self.results = [kind]
        for workspace in self.workspaces:
            pointer = self.assign(f"load ptr, ptr {workspace}")
            self.emit(f"call void @free(ptr {pointer})")
        whole = ["undef"]
        for number, (cell, given) in enumerate(value.typed if value is not None else ()):
            whole.append(self.assign(f"insertvalue {_returned(kind)} {whole[-1]}, {cell} {given}, {number}"))
        self.emit("ret void" if value is None else f"ret {_returned(kind)} {whole[-1]}")
        self.ended = True

    # assignments

    def set(self, target: ast.expr, value: Value) -> None:
        """Assign to a name, to an array's number, or to several of these."""
        match target:
            case ast.Name(id=name):
                self.set_name(name, value, target)
            case ast.Tuple(elts=parts) if parts and len(parts) == len(value.parts):
                for part, given in zip(parts, value.parts, strict=True):
                    self.set(part, given)
            case ast.Subscript():
                self.store(self.place(target), value, target)
            case _:
                raise self.refusal(target, f"cannot be assigned {named(value.kind)}")

    def set_name(self, name: str, value: Value, node: ast.AST) -> None:
        """Assign to a variable, whose kind is that of its first value; ``_`` is none."""
        if name == "_":
            return
        if name not in self.variables:
            self.variables[name] = Value(value.kind, tuple(map(self.slot, cells(value.kind))))
        variable = self.variables[name]
        if variable.kind != value.kind:
            raise self.refusal(node, f"is {named(value.kind)}, where {named(variable.kind)} was before")
        for (cell, given), slot in zip(value.typed, variable.cells, strict=True):
            self.emit(f"store {cell} {given}, ptr {slot}")

    def variable(self, name: str) -> Value:
        """The value of a variable."""
        kept = self.variables[name]
        return Value(kept.kind, tuple(self.assign(f"load {cell}, ptr {slot}") for cell, slot in kept.typed))

    def place(self, target: ast.Subscript) -> str:
        """Address of an array's number."""
        viewed = self.view(self.value(target.value), target)
        if viewed.kind != ArrayKind(0):
            raise self.refusal(target, "is not a single number")
        return viewed.cells[0]

    def store(self, place: str, value: Value, node: ast.AST) -> None:
        """Set an array's number."""
        self.emit(f"store double {self.converted(value, FLOAT, node)}, ptr {place}")

    # values

    def value(self, node: ast.expr) -> Value:
        """The value of an expression."""
        match node:
            case ast.Name(id=name) if name in self.variables:
                return self.variable(name)
            case ast.Name(id=name) if name in self.local:
                raise self.refusal(
                    node, "is read before it is assigned, or is not a variable of the function"
                )
            case ast.Constant() | ast.Name() | ast.Attribute() if _is_number(known := self.known(node)):
                return _constant(known)
            case ast.Attribute(value=owner, attr=name):
                return self.attribute(node, self.value(owner), name)
            case ast.Tuple(elts=parts):
                values = [self.value(part) for part in parts]
                kind = TupleKind(tuple(value.kind for value in values))
                return Value(kind, tuple(cell for value in values for cell in value.cells))
            case ast.Subscript():
                return self.subscript(node)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return self.new(BOOL, f"xor i1 {self.truth(operand)}, true")
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return self.negative(self.value(operand), node)
            case ast.BinOp(left=left, right=right):
                return self.arithmetic(node, self.value(left), self.value(right))
            case ast.Compare(left=left, ops=[operation], comparators=[right]):
                return self.compared(type(operation), self.value(left), self.value(right), node)
            case ast.BoolOp():
                return self.joined(node)
            case ast.IfExp():
                return self.choice(node)
            case ast.Call():
                value = self.call(node)
                if value is not None:
                    return value
        raise self.refusal(node)

    def known(self, node: ast.expr) -> Any:
        """The value that a constant, a name or a module's name has outside of the function; else None."""
        match node:
            case ast.Constant(value=value):
                return value
            case ast.Name(id=name) if name not in self.local:
                return self.function.__globals__.get(name, BUILTINS.get(name))
            case ast.Attribute(value=ast.Name() as owner, attr=name):
                module = self.known(owner)
                return getattr(module, name, None) if isinstance(module, ModuleType) else None
        return None

    def attribute(self, node: ast.expr, owner: Value, name: str) -> Value:
        """A field of a named tuple, or an array's shape or size."""
        match owner.kind, name:
            case TupleKind(names=names), _ if name in names:
                return owner.parts[names.index(name)]
            case ArrayKind(axes), "shape":
                return Value(TupleKind((INT,) * axes), owner.cells[1:])
            case ArrayKind(), "size":
                return Value(INT, (self.product(owner.cells[1:]),))
        raise self.refusal(node)

    def subscript(self, node: ast.Subscript) -> Value:
        """A part of a tuple, a number of an array, or a view of it."""
        owner = self.value(node.value)
        if isinstance(owner.kind, TupleKind):
            number = None if isinstance(node.slice, ast.Slice) else self.value(node.slice).literal
            if number is None or not 0 <= number < len(owner.parts):
                raise self.refusal(node)
            return owner.parts[number]
        viewed = self.view(owner, node)
        if viewed.kind == ArrayKind(0):
            return self.new(FLOAT, f"load double, ptr {viewed.cells[0]}")
        return viewed

    def view(self, array: Value, node: ast.Subscript) -> Value:
        """The part of an array at some indices, and one slice at their end."""
        indices = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        if not isinstance(array.kind, ArrayKind) or len(indices) > array.kind.axes:
            raise self.refusal(node)
        pointer, *shape = array.cells
        for index in indices:
            kept = []
            if not isinstance(index, ast.Slice):
                first = self.counted(index)
            elif index.step is None and index is indices[-1]:
                first = self.counted(index.lower or ast.Constant(0))
                end = self.counted(index.upper) if index.upper is not None else shape[0]
                kept = [self.assign(f"sub nsw i64 {end}, {first}")]
            else:
                raise self.refusal(node, "is not without gaps")
            inner = self.product([first, *shape[1:]])
            pointer = self.assign(f"getelementptr inbounds double, ptr {pointer}, i64 {inner}")
            shape = [*kept, *shape[1:]]
        return Value(ArrayKind(len(shape)), (pointer, *shape))

    def counted(self, node: ast.expr, given: Value | None = None) -> str:
        """An index, the end of a slice, or a length: an integer that is not seen to be negative."""
        value = given or self.value(node)
        if value.kind != INT or (value.literal or 0) < 0:
            raise self.refusal(node, "is not an integer of 0 or more")
        return value.cells[0]

    def shaped(self, pointer: str, node: ast.Call) -> Value:
        """An array there, of the shape that a call's only argument gives: an integer or a tuple of them."""
        value = self.value(node.args[0])
        lengths = value.parts if isinstance(value.kind, TupleKind) else [value]
        shape = [self.counted(node.args[0], length) for length in lengths]
        return Value(ArrayKind(len(shape)), (pointer, *shape))

    def product(self, factors: Sequence[str]) -> str:
        """The product of integers; 1 of none."""
        result = factors[0] if factors else "1"
        for factor in factors[1:]:
            result = self.assign(f"mul nsw i64 {result}, {factor}")
        return result

    def converted(self, value: Value, kind: str, node: ast.AST) -> str:
        """A number as one of that kind: an integer may become a float."""
        if value.kind == kind:
            return value.cells[0]
        if (value.kind, kind) == (INT, FLOAT):
            return self.assign(f"sitofp i64 {value.cells[0]} to double")
        raise self.refusal(node, f"takes {named(kind)} where {named(value.kind)} is given")

    def alike(self, values: Sequence[Value], node: ast.AST) -> tuple[str, list[str]]:
        """Numbers as integers if all are, else as floats; and which."""
        kind = INT if all(value.kind == INT for value in values) else FLOAT
        return kind, [self.converted(value, kind, node) for value in values]

    def negative(self, value: Value, node: ast.AST) -> Value:
        """A number with the other sign."""
        if value.literal is not None:
            return _constant(-value.literal)
        kind, (number,) = self.alike([value], node)
        return Value(
            kind, (self.assign(f"fneg double {number}" if kind == FLOAT else f"sub i64 0, {number}"),)
        )

    def arithmetic(self, node: ast.BinOp | ast.AugAssign, left: Value, right: Value) -> Value:
        """A sum, a product, ..."""
        operation = type(node.op)
        if operation is ast.Pow:
            return self.power(node, left, right)
        kind, (first, second) = self.alike([left, right], node)
        if kind == INT and operation in INTEGER_OPERATIONS:
            return self.new(INT, f"{INTEGER_OPERATIONS[operation]} nsw i64 {first}, {second}")
        if kind == INT and operation in (ast.FloorDiv, ast.Mod):
            return Value(INT, (self.floored(first, second, operation is ast.Mod),))
        if operation not in OPERATIONS:
            raise self.refusal(node)
        if kind == INT:
            first, second = (self.assign(f"sitofp i64 {value} to double") for value in (first, second))
        return self.new(FLOAT, f"{OPERATIONS[operation]} double {first}, {second}")

    def floored(self, first: str, second: str, remainder: bool) -> str:
        """Quotient of integers rounded down, or the remainder, which has the divisor's sign."""
        left = self.assign(f"srem i64 {first}, {second}")
        unlike = self.assign(f"icmp slt i64 {self.assign(f'xor i64 {left}, {second}')}, 0")
        uneven = self.assign(f"icmp ne i64 {left}, 0")
        mend = self.assign(f"and i1 {unlike}, {uneven}")
        if remainder:
            other = self.assign(f"add i64 {left}, {second}")
        else:
            left = self.assign(f"sdiv i64 {first}, {second}")
            other = self.assign(f"sub i64 {left}, 1")
        return self.assign(f"select i1 {mend}, i64 {other}, i64 {left}")

    def power(self, node: ast.AST, base: Value, exponent: Value) -> Value:
        """A small whole power, which stands in the text, by repeated squaring; any other by the library."""
        left = exponent.literal
        if left is None or not 0 < left <= LARGEST_POWER:
            if base.kind == exponent.kind == INT:
                raise self.refusal(node, "is not a power with a small integer literal")
            _, (first, second) = self.alike([base, exponent], node)
            return self.new(FLOAT, f"call double @pow(double {first}, double {second})")
        kind, (square,) = self.alike([base], node)
        times, result = "fmul double" if kind == FLOAT else "mul nsw i64", ""
        while left:
            if left & 1:
                result = self.assign(f"{times} {result}, {square}") if result else square
            left >>= 1
            if left:
                square = self.assign(f"{times} {square}, {square}")
        return Value(kind, (result,))

    # truths and choices

    def truth(self, node: ast.expr) -> str:
        """The value of a condition."""
        value = self.value(node)
        if value.kind != BOOL:
            raise self.refusal(node, "is neither true nor false")
        return value.cells[0]

    def compared(self, operation: type[ast.cmpop], left: Value, right: Value, node: ast.expr) -> Value:
        """Whether a comparison of two numbers holds."""
        kind, (first, second) = self.alike([left, right], node)
        how = (INTEGER_COMPARISONS if kind == INT else FLOAT_COMPARISONS).get(operation)
        if how is None:
            raise self.refusal(node)
        return self.new(BOOL, f"{how} {kind} {first}, {second}")

    def joined(self, node: ast.BoolOp) -> Value:
        """Whether all hold, or any: the rest is not computed once that is known."""
        end = self.label()
        for operand in node.values:
            truth, more = self.truth(operand), self.label()
            self.set_name(f"joined {end}", Value(BOOL, (truth,)), operand)
            self.fork(truth, *((more, end) if isinstance(node.op, ast.And) else (end, more)))
            self.begin(more)
        self.begin(end)
        return self.variable(f"joined {end}")

    def choice(self, node: ast.IfExp) -> Value:
        """One of two values of the same kind, of which only that one is computed."""
        first, second, end = self.label(), self.label(), self.label()
        self.fork(self.truth(node.test), first, second)
        for label, part in ((first, node.body), (second, node.orelse)):
            self.begin(label)
            self.set_name(f"chosen {end}", self.value(part), part)
            self.go(end)
        self.begin(end)
        return self.variable(f"chosen {end}")

    # calls

    def call(self, node: ast.Call) -> Value | None:
        """The result of a call, None of one that returns nothing."""
        function = self.known(node.func)
        if node.keywords:
            raise self.refusal(node, "has keyword arguments, which cannot be lowered")
        if function is np.empty or function is np.zeros:
            return self.workspace(node)
        if function is None and isinstance(node.func, ast.Attribute) and node.func.attr == "reshape":
            array = self.value(node.func.value)
            if isinstance(array.kind, ArrayKind) and len(node.args) == 1:
                return self.shaped(array.cells[0], node)
        values = [self.value(argument) for argument in node.args]
        if function is run:
            return self.run_pass(node, values)
        python = getattr(function, "python", None)
        if isinstance(python, FunctionType):
            return self.call_function(node, python, values)
        for name, known in FUNCTIONS.items():
            if known is function:
                return self.call_builtin(node, name, values)
        raise self.refusal(node)

    def call_builtin(self, node: ast.Call, name: str, values: list[Value]) -> Value:
        """The result of one of Python's own functions, or of a mathematical one."""
        kinds = [value.kind for value in values]
        match name, kinds:
            case "len", [ArrayKind(axes)] if axes > 0:
                return Value(INT, values[0].cells[1:2])
            case "min" | "max", [("i64" | "double") as kind, _, *_] if len(set(kinds)) == 1:
                numbers = [value.cells[0] for value in values]
                return self.extreme(kind, numbers, "gt" if name == "max" else "lt")
            case "abs", ["i64"]:
                return self.extreme(INT, [values[0].cells[0], *self.negative(values[0], node).cells], "gt")
            case "int", ["i64"]:
                return values[0]
            case "int", ["double"]:
                return self.new(INT, f"fptosi double {values[0].cells[0]} to i64")
        if NUMBERS.get(name) != len(values):
            raise self.refusal(node)
        floats = [self.converted(value, FLOAT, node) for value in values]
        if name == "float":
            return Value(FLOAT, (floats[0],))
        if name in ("abs", "isfinite"):
            size = self.assign(f"call double @llvm.fabs.f64(double {floats[0]})")
            if name == "abs":
                return Value(FLOAT, (size,))
            return self.new(BOOL, f"fcmp olt double {size}, {float_text(math.inf)}")
        symbol = f"{INTRINSICS[name]}.f64" if name in INTRINSICS else name
        arguments = ", ".join(f"double {number}" for number in floats)
        return self.new(FLOAT, f"call double @{symbol}({arguments})")

    def extreme(self, kind: str, numbers: Sequence[str], how: str) -> Value:
        """The largest or smallest of some numbers, as Python finds it."""
        result, compare = numbers[0], "fcmp o" if kind == FLOAT else "icmp s"
        for number in numbers[1:]:
            better = self.assign(f"{compare}{how} {kind} {number}, {result}")
            result = self.assign(f"select i1 {better}, {kind} {number}, {kind} {result}")
        return Value(kind, (result,))

    def call_function(
        self, node: ast.Call, function: Callable[..., Any], values: list[Value]
    ) -> Value | None:
        """The result of another function of an ordinary module."""
        declared = declared_kinds(function)
        if len(values) != len(declared):
            raise self.refusal(node, f"gives {len(values)} arguments, not {len(declared)}")
        if function in self.unit.open:
            raise self.refusal(node, "is a recursive call, which cannot be lowered")
        given = [
            value if kind is None else Value(kind, (self.converted(value, kind, node),))
            for value, kind in zip(values, declared.values(), strict=True)
        ]
        name, result = self.unit.lower(function, [value.kind for value in given])
        call = f"call {_returned(result)} @{name}({', '.join(value.text for value in given if value.cells)})"
        if result is None:
            return self.emit(call)
        whole, count = self.assign(call), len(cells(result))
        parts = (self.assign(f"extractvalue {_returned(result)} {whole}, {k}") for k in range(count))
        return Value(result, tuple(parts))

    def run_pass(self, node: ast.Call, values: list[Value]) -> None:
        """Call a pass by its address, with the addresses of its arrays."""
        match [value.kind for value in values]:
            case ["i64", "i64", ArrayKind(), *arrays] if all(isinstance(kind, ArrayKind) for kind in arrays):
                function = self.assign(f"inttoptr i64 {values[0].cells[0]} to ptr")
                arguments = [f"i64 {values[1].cells[0]}", *(f"ptr {value.cells[0]}" for value in values[2:])]
                self.emit(f"call void {function}({', '.join(arguments)})")
            case _:
                raise self.refusal(node, "does not give an address, a number of segments, and arrays")

    def workspace(self, node: ast.Call) -> Value:
        """A new array, which ends with the function."""
        if self.loops or len(node.args) != 1:
            raise self.refusal(node, "has arguments besides its shape, or is in a loop")
        slot = self.slot("ptr")
        self.stack.append(f"  store ptr null, ptr {slot}")
        self.workspaces.append(slot)
        shape = self.shaped("", node).cells[1:]
        pointer = self.assign(f"call ptr @calloc(i64 {self.product(shape)}, i64 {NUMBER_BYTES})")
        self.emit(f"store ptr {pointer}, ptr {slot}")
        return Value(ArrayKind(len(shape)), (pointer, *shape))


def _refusal(function: Callable[..., Any], line: int, text: str, why: str) -> LoweringError:
    file = Path(function.__code__.co_filename).name
    return LoweringError(f"{file}, line {line}: '{text}' {why}. {ALLOWED}")


def _definition(function: Callable[..., Any]) -> ast.FunctionDef:
    """The function as it stands in its file."""
    code = function.__code__
    try:
        tree = _definitions(code.co_filename)[code.co_firstlineno]
    except (OSError, ValueError, SyntaxError, KeyError):
        tree = None
    if tree is None or tree.name != code.co_name:
        raise _refusal(function, code.co_firstlineno, code.co_name, "is not a function found in that file")
    return tree


@cache
def _definitions(file: str) -> dict[int, ast.FunctionDef]:
    """Functions of a file by their first line, decorators included."""
    nodes = ast.walk(ast.parse(Path(file).read_bytes()))
    functions = [node for node in nodes if isinstance(node, ast.FunctionDef)]
    return {min(part.lineno for part in (node, *node.decorator_list)): node for node in functions}


def _is_number(value: Any) -> bool:
    """Whether a module's value, or a constant, is a number that has a kind."""
    return type(value) in SCALAR_KINDS and not (type(value) is int and abs(value) > LARGEST_INTEGER)


def _constant(value: float) -> Value:
    kind = SCALAR_KINDS[type(value)]
    return Value(kind, (float_text(value) if kind == FLOAT else str(value).lower(),))


def _struct(types: Sequence[str]) -> str:
    return f"{{ {', '.join(types)} }}"


def _returned(kind: Kind | None) -> str:
    """LLVM's type of what a function returns."""
    return "void" if kind is None else _struct(cells(kind))


def _parameters(kinds: Sequence[Kind]) -> Value:
    kind = TupleKind(tuple(kinds))
    return Value(kind, tuple(f"%p{number}" for number in range(len(cells(kind)))))
