"""From functions of ordinary modules to LLVM's language: searches, stages and steps, which know no scene.

They keep to a part of Python whose types show. A number is a float, an integer or a bool, told by the
parameter's annotation or by what is first assigned; an array holds floats, row by row without gaps; a tuple
holds any of these, and travels as its parts. There are assignments, ``if``, ``while``, ``for ... in range``,
returns of numbers, and calls of other such functions, of passes by ``run``, and of a part of ``math``.
``array[i]`` and ``array[a:b]`` are views; ``np.empty`` and ``np.zeros`` make workspaces, which end with the
function. Anything else is refused by name.

Nothing is checked when it runs: not an index, and a negative one does not count from the end. Additions are
neither reordered nor contracted, so bits agree with Python's.
"""

import ast
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from statics.kernels.calling import run
from statics.kernels.lowering import (
    COMPARISONS,
    INTRINSICS,
    LARGEST_POWER,
    LIBRARY,
    OPERATIONS,
    LoweringError,
    constant_number,
    float_text,
)

FLOAT, INT, BOOL = "double", "i64", "i1"
SCALAR_KINDS = {bool: BOOL, int: INT, float: FLOAT}
"""LLVM's types of numbers, by the annotations that name them."""
NAMES = {FLOAT: "a float", INT: "an integer", BOOL: "a bool"}
INTEGER_OPERATIONS = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul"}
INTEGER_COMPARISONS = {
    ast.Gt: "sgt",
    ast.Lt: "slt",
    ast.GtE: "sge",
    ast.LtE: "sle",
    ast.Eq: "eq",
    ast.NotEq: "ne",
}
FLOAT_COMPARISONS = COMPARISONS | {ast.Eq: "oeq", ast.NotEq: "une"}
ALLOCATIONS = (np.empty, np.zeros)
RUNTIME = """\
declare double @llvm.sqrt.f64(double)
declare double @llvm.fabs.f64(double)
declare double @pow(double, double) nounwind willreturn memory(none)
declare ptr @calloc(i64, i64)
declare void @free(ptr)
"""
NUMBER_BYTES = 8


@dataclass(frozen=True)
class ArrayKind:
    """Kind of an array of floats: its number of axes."""

    axes: int


@dataclass(frozen=True)
class TupleKind:
    """Kind of a tuple: those of its parts, and their names if it has such."""

    parts: "tuple[Kind, ...]"
    names: tuple[str, ...] = ()


Kind = str | ArrayKind | TupleKind


def cells(kind: Kind) -> list[str]:
    """LLVM's types of what a value is made of: an array of its address and its shape."""
    match kind:
        case ArrayKind(axes):
            return ["ptr", *[INT] * axes]
        case TupleKind(parts):
            return [cell for part in parts for cell in cells(part)]
    return [kind]


@dataclass(frozen=True)
class Value:
    """A value in the making: its kind, and LLVM's names of its cells."""

    kind: Kind
    cells: tuple[str, ...]

    @property
    def parts(self) -> "list[Value]":
        """The parts of a tuple."""
        assert isinstance(self.kind, TupleKind)
        found, start = [], 0
        for kind in self.kind.parts:
            end = start + len(cells(kind))
            found.append(Value(kind, self.cells[start:end]))
            start = end
        return found


@dataclass(frozen=True)
class Function:
    """A function of an ordinary module: its tree, the names it sees, and what its annotations say."""

    name: str
    file: str
    tree: ast.FunctionDef
    names: dict[str, Any]

    @classmethod
    def of(cls, function: Callable[..., Any]) -> "Function":
        """The function as it stands in its file."""
        code = function.__code__
        tree = _definitions(code.co_filename)[code.co_firstlineno]
        return cls(function.__name__, code.co_filename, tree, function.__globals__)


@cache
def _definitions(file: str) -> dict[int, ast.FunctionDef]:
    """Functions of a file by their first line, decorators included."""
    nodes = ast.walk(ast.parse(Path(file).read_text(encoding="utf-8")))
    functions = [node for node in nodes if isinstance(node, ast.FunctionDef)]
    return {min(part.lineno for part in (node, *node.decorator_list)): node for node in functions}


def lower_function(function: Callable[..., Any], kinds: Sequence[Kind]) -> tuple[str, Kind | None]:
    """LLVM's text of a function for arguments of these kinds, and the kind of its result.

    The text holds ``void entry(ptr arguments, ptr results)``: both point to cells of 8 bytes.
    Raises ``LoweringError`` for what cannot be lowered.
    """
    unit = _Unit()
    name, result = unit.lower(function, kinds)
    lines, arguments = [], ["ptr %results"]
    for number, cell in enumerate(cell for kind in kinds for cell in cells(kind)):
        lines.append(f"  %at_{number} = getelementptr i64, ptr %arguments, i64 {number}")
        lines.append(f"  %cell_{number} = load {cell}, ptr %at_{number}")
        arguments.append(f"{cell} %cell_{number}")
    lines += [f"  call void @{name}({', '.join(arguments)})", "  ret void", "}"]
    head = "define void @entry(ptr %arguments, ptr %results) nounwind {"
    return "\n".join([RUNTIME, *unit.declarations(), *unit.texts, head, *lines]), result


class _Unit:
    """One module of LLVM's text in the making: a function, and all that it calls."""

    def __init__(self) -> None:
        self.texts: list[str] = []
        self.known: dict[tuple[Any, tuple[Kind, ...]], tuple[str, Kind | None] | None] = {}
        self.library: set[str] = set()

    def declarations(self) -> list[str]:
        """Functions of the mathematical library that are called."""
        return [
            f"declare double @{name}({', '.join(['double'] * count)}) nounwind willreturn memory(none)"
            for name, count in LIBRARY.items()
            if name in self.library
        ]

    def lower(self, function: Callable[..., Any], kinds: Sequence[Kind]) -> tuple[str, Kind | None]:
        """Name and kind of the result of a function for arguments of these kinds, lowered at first sight."""
        key = (function, tuple(kinds))
        if key not in self.known:
            self.known[key] = None
            name = f"{function.__name__}_{len(self.known)}"
            code = _Code(self, Function.of(function), kinds)
            self.texts.append(code.text(name))
            self.known[key] = name, code.result
        found = self.known[key]
        if found is None:
            raise LoweringError(f"'{function.__name__}' calls itself, which cannot be lowered.")
        return found


class _Code:
    """Lines of one function, with its variables on the stack: LLVM turns them into registers."""

    def __init__(self, unit: _Unit, function: Function, kinds: Sequence[Kind]) -> None:
        self.unit, self.function = unit, function
        self.lines: list[str] = []
        self.stack: list[str] = []
        self.variables: dict[str, Value] = {}
        self.count = 0
        self.loops: list[tuple[str, str]] = []
        self.ended = False
        self.results: list[Kind | None] = []
        self.workspaces: list[str] = []
        arguments = ["ptr %results"]
        for argument, kind in zip(function.tree.args.args, kinds, strict=True):
            names = tuple(f"%{argument.arg}_{k}" for k in range(len(cells(kind))))
            arguments += [f"{cell} {name}" for cell, name in zip(cells(kind), names, strict=True)]
            self.set_name(argument.arg, Value(kind, names))
        self.arguments = ", ".join(arguments)
        self.statements(function.tree.body)
        if not self.ended:
            self.give_back(None)

    @property
    def result(self) -> Kind | None:
        """Kind of what the function returns."""
        return self.results[0]

    def text(self, name: str) -> str:
        """The function's text."""
        head = f"define internal void @{name}({self.arguments}) nounwind {{"
        return "\n".join([head, "entry:", *self.stack, *self.lines, "}"])

    # lines

    def assign(self, operation: str) -> str:
        """The name of a new value."""
        self.count += 1
        self.lines.append(f"  %v{self.count} = {operation}")
        return f"%v{self.count}"

    def slot(self, kind: str, start: str = "") -> str:
        """A place on the stack for one cell."""
        self.count += 1
        self.stack.append(f"  %s{self.count} = alloca {kind}")
        if start:
            self.stack.append(f"  store {kind} {start}, ptr %s{self.count}")
        return f"%s{self.count}"

    def labels(self, *names: str) -> list[str]:
        """New labels of blocks."""
        self.count += 1
        return [f"{name}_{self.count}" for name in names]

    def block(self, label: str) -> None:
        """Begin a block, where what came before may go on."""
        self.go(label)
        self.begin(label)

    def begin(self, label: str) -> None:
        """Begin a block that is only gone to."""
        self.lines.append(f"{label}:")
        self.ended = False

    def never(self) -> None:
        """End a block that is never gone to."""
        self.lines.append("  unreachable")
        self.ended = True

    def go(self, label: str) -> None:
        """End a block that has not ended yet."""
        if not self.ended:
            self.lines.append(f"  br label %{label}")
        self.ended = True

    def fork(self, condition: str, first: str, second: str) -> None:
        """End a block one way or the other."""
        self.lines.append(f"  br i1 {condition}, label %{first}, label %{second}")
        self.ended = True

    def refusal(self, node: ast.AST, why: str = "cannot be lowered") -> LoweringError:
        """An error that says where and what."""
        place = f"{Path(self.function.file).name}, line {getattr(node, 'lineno', 0)}"
        return LoweringError(f"{place}: '{ast.unparse(node)}' {why}. {ALLOWED}")

    # statements

    def statements(self, nodes: Sequence[ast.stmt]) -> None:
        """Lower statements up to one that never goes on to the next."""
        for node in nodes:
            if self.ended:
                return
            self.statement(node)

    def statement(self, node: ast.stmt) -> None:
        """Lower one statement; a docstring is passed over."""
        match node:
            case ast.Expr(value=ast.Constant()):
                pass
            case ast.Expr(value=ast.Call() as call):
                self.call(call)
            case ast.Assign(targets=[target], value=value):
                self.set(target, self.value(value))
            case ast.AugAssign(target=ast.Name() | ast.Subscript() as target, op=operation, value=value):
                before = ast.copy_location(ast.BinOp(_loaded(target), operation, value), node)
                self.set(target, self.value(before))
            case ast.If():
                self.branch(node)
            case ast.While(test=test, body=body, orelse=[]):
                head, inside, after = self.labels("while", "body", "after")
                self.block(head)
                self.fork(self.truth(test), inside, after)
                self.loop(inside, body, head, after)
                if isinstance(test, ast.Constant) and not _breaks(body):
                    self.never()
            case ast.For(target=ast.Name(id=name), iter=ast.Call(func=ast.Name(id="range")), orelse=[]):
                self.count_over(name, node)
            case ast.Break() if self.loops:
                self.go(self.loops[-1][1])
            case ast.Continue() if self.loops:
                self.go(self.loops[-1][0])
            case ast.Return(value=value):
                self.give_back(None if value is None else self.value(value))
            case _:
                raise self.refusal(node)

    def branch(self, node: ast.If) -> None:
        """Lower an ``if``."""
        first, second, after = self.labels("then", "else", "end")
        self.fork(self.truth(node.test), first, second)
        all_ended = True
        for label, body in ((first, node.body), (second, node.orelse)):
            self.begin(label)
            self.statements(body)
            all_ended = all_ended and self.ended
            self.go(after)
        self.begin(after)
        if all_ended:
            self.never()

    def loop(self, label: str, body: Sequence[ast.stmt], again: str, after: str) -> None:
        """Lower a loop's body, which goes on at one label and ends at another."""
        self.loops.append((again, after))
        self.begin(label)
        self.statements(body)
        self.go(again)
        self.loops.pop()
        self.begin(after)

    def count_over(self, name: str, node: ast.For) -> None:
        """Lower ``for name in range(...)``, with a step of a constant size."""
        assert isinstance(node.iter, ast.Call)
        arguments = node.iter.args
        change = constant_number(arguments[2]) if len(arguments) == 3 else 1
        if not change or node.iter.keywords:
            raise self.refusal(node.iter)
        first = self.integer(arguments[0]) if len(arguments) > 1 else "0"
        bound = self.integer(arguments[min(1, len(arguments) - 1)])
        head, inside, again, after = self.labels("for", "body", "next", "after")
        counter = self.slot(INT)
        self.lines.append(f"  store i64 {first}, ptr {counter}")
        self.block(head)
        now = self.assign(f"load i64, ptr {counter}")
        more = self.assign(f"icmp {'slt' if change > 0 else 'sgt'} i64 {now}, {bound}")
        self.fork(more, inside, after)
        self.begin(inside)
        self.set_name(name, Value(INT, (now,)))
        inside = self.labels("inside")[0]
        self.go(inside)
        self.loop(inside, node.body, again, after)
        tail = self.lines.pop()
        self.lines.append(f"{again}:")
        following = self.assign(f"add nsw i64 {now}, {int(change)}")
        self.lines += [f"  store i64 {following}, ptr {counter}", f"  br label %{head}", tail]

    def give_back(self, value: Value | None) -> None:
        """Return numbers, or nothing; workspaces end."""
        kind = None if value is None else value.kind
        kinds = [] if value is None else cells(value.kind)
        nested = isinstance(kind, TupleKind) and not all(isinstance(part, str) for part in kind.parts)
        if nested or "ptr" in kinds or any(kind != other for other in self.results):
            raise LoweringError(
                f"'{self.function.name}' may only return numbers, of the same kinds at every return."
            )
        self.results.append(kind)
        for number, (cell, kept) in enumerate(zip(kinds, value.cells if value else (), strict=True)):
            place = self.assign(f"getelementptr i64, ptr %results, i64 {number}")
            widened = self.assign(f"zext i1 {kept} to i64") if cell == BOOL else kept
            self.lines.append(f"  store {INT if cell == BOOL else cell} {widened}, ptr {place}")
        for workspace in self.workspaces:
            pointer = self.assign(f"load ptr, ptr {workspace}")
            self.lines.append(f"  call void @free(ptr {pointer})")
        self.lines.append("  ret void")
        self.ended = True

    # assignments

    def set(self, target: ast.expr, value: Value) -> None:
        """Assign to a name, to an array's number, or to several of these."""
        match target:
            case ast.Name(id="_"):
                pass
            case ast.Name(id=name):
                self.set_name(name, value, target)
            case ast.Tuple(elts=parts) if isinstance(value.kind, TupleKind):
                if len(parts) != len(value.kind.parts):
                    raise self.refusal(target)
                for part, given in zip(parts, value.parts, strict=True):
                    self.set(part, given)
            case ast.Subscript():
                array = self.value(target.value)
                viewed = self.view(array, target)
                if viewed.kind != ArrayKind(0):
                    raise self.refusal(target, "is no single number")
                self.lines.append(
                    f"  store double {self.converted(value, FLOAT, target)}, ptr {viewed.cells[0]}"
                )
            case _:
                raise self.refusal(target)

    def set_name(self, name: str, value: Value, node: ast.AST | None = None) -> None:
        """Assign to a variable, whose kind is that of its first value."""
        if name not in self.variables:
            slots = tuple(self.slot(cell) for cell in cells(value.kind))
            self.variables[name] = Value(value.kind, slots)
        variable = self.variables[name]
        if variable.kind == FLOAT and value.kind == INT and node is not None:
            value = Value(FLOAT, (self.converted(value, FLOAT, node),))
        if variable.kind != value.kind:
            assert node is not None
            raise self.refusal(node, f"was {_named(variable.kind)} before, and is given {_named(value.kind)}")
        for kind, given, slot in zip(cells(value.kind), value.cells, variable.cells, strict=True):
            self.lines.append(f"  store {kind} {given}, ptr {slot}")

    # values

    def value(self, node: ast.expr) -> Value:
        """The value of an expression."""
        match node:
            case ast.Constant(value=bool() | int() | float() as constant):
                return _constant(constant)
            case ast.Name(id=name) if name in self.variables:
                variable = self.variables[name]
                kinds = zip(cells(variable.kind), variable.cells, strict=True)
                return Value(
                    variable.kind, tuple(self.assign(f"load {kind}, ptr {slot}") for kind, slot in kinds)
                )
            case ast.Name() | ast.Attribute(value=ast.Name()) if (
                type(known := self.known(node)) in SCALAR_KINDS
            ):
                return _constant(known)
            case ast.Attribute(value=owner, attr=name):
                return self.attribute(node, self.value(owner), name)
            case ast.Tuple(elts=parts):
                values = [self.value(part) for part in parts]
                kind = TupleKind(tuple(value.kind for value in values))
                return Value(kind, tuple(cell for value in values for cell in value.cells))
            case ast.Subscript():
                return self.subscript(node)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                value = self.number(operand)
                zero = "fneg double" if value.kind == FLOAT else "sub i64 0,"
                return Value(value.kind, (self.assign(f"{zero} {value.cells[0]}"),))
            case ast.BinOp():
                return self.arithmetic(node)
            case ast.Compare() | ast.BoolOp() | ast.UnaryOp(op=ast.Not()):
                return Value(BOOL, (self.truth(node),))
            case ast.IfExp(test=test, body=body, orelse=other):
                return self.choice(
                    self.truth(test), lambda: self.value(body), lambda: self.value(other), node
                )
            case ast.Call():
                value = self.call(node)
                if value is not None:
                    return value
        raise self.refusal(node)

    def known(self, node: ast.expr) -> Any:
        """What a name, or one of a module's, stands for outside of the function; None if for nothing."""
        match node:
            case ast.Name(id=name):
                return self.function.names.get(name, _BUILTINS.get(name))
            case ast.Attribute(value=ast.Name(id=owner), attr=name) if owner not in self.variables:
                return getattr(self.function.names.get(owner), name, None)
        return None

    def attribute(self, node: ast.expr, owner: Value, name: str) -> Value:
        """A field of a named tuple, or an array's shape or size."""
        if isinstance(owner.kind, TupleKind) and name in owner.kind.names:
            return owner.parts[owner.kind.names.index(name)]
        if isinstance(owner.kind, ArrayKind) and name == "shape":
            return Value(TupleKind((INT,) * owner.kind.axes), owner.cells[1:])
        if isinstance(owner.kind, ArrayKind) and name == "size":
            return Value(INT, (self.product(owner.cells[1:]),))
        raise self.refusal(node)

    def subscript(self, node: ast.Subscript) -> Value:
        """A part of a tuple, a number of an array, or a view of it."""
        owner = self.value(node.value)
        if isinstance(owner.kind, TupleKind):
            number = constant_number(node.slice)
            if number is None or not 0 <= number < len(owner.kind.parts):
                raise self.refusal(node)
            return owner.parts[int(number)]
        viewed = self.view(owner, node)
        if viewed.kind == ArrayKind(0):
            return Value(FLOAT, (self.assign(f"load double, ptr {viewed.cells[0]}"),))
        return viewed

    def view(self, array: Value, node: ast.Subscript) -> Value:
        """What is left of an array after indices, and one slice at their end."""
        indices = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        if not isinstance(array.kind, ArrayKind) or len(indices) > array.kind.axes:
            raise self.refusal(node)
        pointer, *shape = array.cells
        for number, index in enumerate(indices):
            sliced = isinstance(index, ast.Slice)
            if sliced and (index.step is not None or number < len(indices) - 1):
                raise self.refusal(node, "is not without gaps")
            lower = index.lower if sliced else index
            first = self.integer(lower) if lower is not None else "0"
            inner = self.product([first, *shape[1:]])
            pointer = self.assign(f"getelementptr inbounds double, ptr {pointer}, i64 {inner}")
            if sliced:
                end = self.integer(index.upper) if index.upper is not None else shape[0]
                shape = [self.assign(f"sub nsw i64 {end}, {first}"), *shape[1:]]
            else:
                shape = shape[1:]
        return Value(ArrayKind(len(shape)), (pointer, *shape))

    def product(self, factors: Sequence[str]) -> str:
        """The product of integers; 1 of none."""
        result = factors[0] if factors else "1"
        for factor in factors[1:]:
            result = self.assign(f"mul nsw i64 {result}, {factor}")
        return result

    def number(self, node: ast.expr) -> Value:
        """The value of an expression that is a float or an integer."""
        value = self.value(node)
        if value.kind not in (FLOAT, INT):
            raise self.refusal(node, "is no number")
        return value

    def integer(self, node: ast.expr) -> str:
        """The value of an expression that is an integer."""
        value = self.value(node)
        if value.kind != INT:
            raise self.refusal(node, "is no integer")
        return value.cells[0]

    def converted(self, value: Value, kind: str, node: ast.AST) -> str:
        """A number as one of that kind: an integer may become a float."""
        if value.kind == kind:
            return value.cells[0]
        if (value.kind, kind) == (INT, FLOAT):
            return self.assign(f"sitofp i64 {value.cells[0]} to double")
        raise self.refusal(node, f"is {_named(value.kind)}, and should be {_named(kind)}")

    def alike(self, values: Sequence[Value], node: ast.AST) -> tuple[str, list[str]]:
        """Numbers as floats, or as integers if all are; and which."""
        kind = INT if all(value.kind == INT for value in values) else FLOAT
        return kind, [self.converted(value, kind, node) for value in values]

    def arithmetic(self, node: ast.BinOp) -> Value:
        """A sum, a product, ..."""
        if isinstance(node.op, ast.Pow):
            return Value(FLOAT, (self.power(node),))
        kind, (first, second) = self.alike([self.number(node.left), self.number(node.right)], node)
        operation = type(node.op)
        if kind == INT and operation in INTEGER_OPERATIONS:
            return Value(INT, (self.assign(f"{INTEGER_OPERATIONS[operation]} nsw i64 {first}, {second}"),))
        if kind == INT and operation in (ast.FloorDiv, ast.Mod):
            return Value(INT, (self.floored(first, second, operation is ast.Mod),))
        if operation not in OPERATIONS:
            raise self.refusal(node)
        if kind == INT:
            first, second = (self.assign(f"sitofp i64 {value} to double") for value in (first, second))
        return Value(FLOAT, (self.assign(f"{OPERATIONS[operation]} double {first}, {second}"),))

    def floored(self, first: str, second: str, remainder: bool) -> str:
        """Quotient of integers rounded down, or what it leaves, which has the divisor's sign."""
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

    def power(self, node: ast.BinOp) -> str:
        """A small whole power by repeated squaring, as of a pass; any other by the library."""
        base, exponent = self.converted(self.number(node.left), FLOAT, node), constant_number(node.right)
        if exponent is None or exponent % 1 or not 0 < exponent <= LARGEST_POWER:
            other = self.converted(self.number(node.right), FLOAT, node)
            return self.assign(f"call double @pow(double {base}, double {other})")
        result, square, left = "", base, int(exponent)
        while left:
            if left & 1:
                result = self.assign(f"fmul double {result}, {square}") if result else square
            left >>= 1
            if left:
                square = self.assign(f"fmul double {square}, {square}")
        return result

    def choice(
        self, condition: str, first: Callable[[], Value], second: Callable[[], Value], node: ast.expr
    ) -> Value:
        """One of two numbers, of which only that one is computed."""
        labels = self.labels("first", "second", "chosen")
        self.fork(condition, *labels[:2])
        found: list[tuple[Value, int]] = []
        for label, make in zip(labels, (first, second), strict=False):
            self.begin(label)
            found.append((make(), len(self.lines)))
            self.go(labels[2])
        kind = FLOAT if FLOAT in (found[0][0].kind, found[1][0].kind) else found[0][0].kind
        slot = self.slot(str(kind))
        for value, line in reversed(found):
            ending, self.lines[line:] = self.lines[line:], []
            self.lines.append(f"  store {kind} {self.converted(value, str(kind), node)}, ptr {slot}")
            self.lines += ending
        self.begin(labels[2])
        return Value(kind, (self.assign(f"load {kind}, ptr {slot}"),))

    # truths

    def truth(self, node: ast.expr) -> str:
        """The value of a condition."""
        match node:
            case ast.Compare(left=left, ops=[operation], comparators=[right]):
                return self.compared(type(operation), self.number(left), self.number(right), node)
            case ast.BoolOp(op=operation, values=[first, *others]):
                rest = others[0] if len(others) == 1 else ast.BoolOp(operation, others)
                fixed = Value(BOOL, ("false" if isinstance(operation, ast.And) else "true",))
                go_on, end = (lambda: Value(BOOL, (self.truth(rest),))), (lambda: fixed)
                ways = (go_on, end) if isinstance(operation, ast.And) else (end, go_on)
                return self.choice(self.truth(first), *ways, node).cells[0]
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return self.assign(f"xor i1 {self.truth(operand)}, true")
        value = self.value(node)
        if value.kind != BOOL:
            raise self.refusal(node, "is neither true nor false")
        return value.cells[0]

    def compared(self, operation: type[ast.cmpop], left: Value, right: Value, node: ast.expr) -> str:
        """Whether a comparison of two numbers holds."""
        kind, (first, second) = self.alike([left, right], node)
        if operation not in FLOAT_COMPARISONS:
            raise self.refusal(node)
        if kind == INT:
            return self.assign(f"icmp {INTEGER_COMPARISONS[operation]} i64 {first}, {second}")
        return self.assign(f"fcmp {FLOAT_COMPARISONS[operation]} double {first}, {second}")

    # calls

    def call(self, node: ast.Call) -> Value | None:
        """The result of a call, None of one that returns nothing."""
        function = self.known(node.func)
        if isinstance(node.func, ast.Attribute) and node.func.attr == "reshape" and len(node.args) == 1:
            pointer, shape = self.value(node.func.value).cells[0], self.shape(node.args[0])
            return Value(ArrayKind(len(shape)), (pointer, *shape))
        if function is None or node.keywords:
            raise self.refusal(node)
        if function in ALLOCATIONS:
            return self.workspace(node)
        values = [self.value(argument) for argument in node.args]
        if function is run:
            return self.run_pass(values)
        if hasattr(function, "python"):
            return self.call_function(node, function.python, values)
        return self.call_builtin(node, function, values)

    def call_builtin(self, node: ast.Call, function: Any, values: list[Value]) -> Value:
        """The result of one of Python's own functions, or of a mathematical one."""
        name = getattr(function, "__name__", "")
        if function is len and isinstance(values[0].kind, ArrayKind):
            return Value(INT, values[0].cells[1:2])
        kind, numbers = self.alike(values, node)
        if function in (min, max) and len(values) > 1:
            return Value(kind, (self.extreme(kind, numbers, "gt" if function is max else "lt"),))
        if function is abs and len(values) == 1:
            if kind == FLOAT:
                return Value(FLOAT, (self.assign(f"call double @llvm.fabs.f64(double {numbers[0]})"),))
            negative = self.assign(f"sub i64 0, {numbers[0]}")
            return Value(INT, (self.extreme(INT, [numbers[0], negative], "gt"),))
        if function is int and len(values) == 1:
            return Value(
                INT, (self.assign(f"fptosi double {numbers[0]} to i64") if kind == FLOAT else numbers[0],)
            )
        floats = [self.converted(Value(kind, (number,)), FLOAT, node) for number in numbers]
        if function is float and len(values) == 1:
            return Value(FLOAT, (floats[0],))
        if function is math.isfinite and len(values) == 1:
            size = self.assign(f"call double @llvm.fabs.f64(double {floats[0]})")
            return Value(BOOL, (self.assign(f"fcmp olt double {size}, {float_text(math.inf)}"),))
        if name in INTRINSICS and len(values) == 1 and function is getattr(math, name):
            return Value(FLOAT, (self.assign(f"call double @{INTRINSICS[name]}.f64(double {floats[0]})"),))
        if LIBRARY.get(name) == len(values) and function is getattr(math, name):
            self.unit.library.add(name)
            arguments = ", ".join(f"double {number}" for number in floats)
            return Value(FLOAT, (self.assign(f"call double @{name}({arguments})"),))
        raise self.refusal(node)

    def extreme(self, kind: str, numbers: Sequence[str], how: str) -> str:
        """The largest or smallest of some numbers, as Python finds it."""
        result = numbers[0]
        for number in numbers[1:]:
            compare = f"fcmp o{how} double" if kind == FLOAT else f"icmp s{how} i64"
            better = self.assign(f"{compare} {number}, {result}")
            result = self.assign(f"select i1 {better}, {kind} {number}, {kind} {result}")
        return result

    def call_function(
        self, node: ast.Call, function: Callable[..., Any], values: list[Value]
    ) -> Value | None:
        """The result of another function of an ordinary module."""
        declared = declared_kinds(function)
        if len(values) != len(declared):
            raise self.refusal(node)
        given = []
        for value, kind in zip(values, declared, strict=True):
            given.append(value if kind is None else Value(kind, (self.converted(value, kind, node),)))
        name, result = self.unit.lower(function, [value.kind for value in given])
        kinds = [] if result is None else cells(result)
        results = self.slot(f"[{max(1, len(kinds))} x i64]")
        arguments = [f"ptr {results}"]
        for value in given:
            arguments += [f"{cell} {part}" for cell, part in zip(cells(value.kind), value.cells, strict=True)]
        self.lines.append(f"  call void @{name}({', '.join(arguments)})")
        if result is None:
            return None
        found = []
        for number, kind in enumerate(kinds):
            place = self.assign(f"getelementptr i64, ptr {results}, i64 {number}")
            loaded = self.assign(f"load {INT if kind == BOOL else kind}, ptr {place}")
            found.append(self.assign(f"trunc i64 {loaded} to i1") if kind == BOOL else loaded)
        return Value(result, tuple(found))

    def run_pass(self, values: list[Value]) -> None:
        """Call a pass by its address, with the addresses of its arrays."""
        address, n, *arrays = values
        function = self.assign(f"inttoptr i64 {address.cells[0]} to ptr")
        arguments = [f"i64 {n.cells[0]}", *(f"ptr {array.cells[0]}" for array in arrays)]
        self.lines.append(f"  call void {function}({', '.join(arguments)})")

    def workspace(self, node: ast.Call) -> Value:
        """A new array, which ends with the function."""
        if self.loops or len(node.args) != 1:
            raise self.refusal(node, "may only stand outside of loops")
        shape, slot = self.shape(node.args[0]), self.slot("ptr", "null")
        self.workspaces.append(slot)
        pointer = self.assign(f"call ptr @calloc(i64 {self.product(shape)}, i64 {NUMBER_BYTES})")
        self.lines.append(f"  store ptr {pointer}, ptr {slot}")
        return Value(ArrayKind(len(shape)), (pointer, *shape))

    def shape(self, node: ast.expr) -> list[str]:
        """The shape that an integer or a tuple of integers gives."""
        value = self.value(node)
        if any(cell != INT for cell in cells(value.kind)):
            raise self.refusal(node, "is no shape")
        return list(value.cells)


ALLOWED = (
    "Allowed: floats, integers, bools, arrays, tuples of these; assignments, if, while, for over a range, "
    "return of numbers, arithmetic and comparisons, indices and slices without gaps, reshape, np.empty and "
    "np.zeros outside of loops, min, max, abs, int, float, len, math, and calls of compiled functions."
)
_BUILTINS: dict[str, Any] = {function.__name__: function for function in (min, max, abs, int, float, len)}


def declared_kinds(function: Callable[..., Any]) -> list[str | None]:
    """Kinds of the parameters that are annotated as numbers; None of those that are seen by their values."""
    code = function.__code__
    annotations = function.__annotations__
    return [SCALAR_KINDS.get(annotations.get(name)) for name in code.co_varnames[: code.co_argcount]]


def _constant(value: float) -> Value:
    kind = SCALAR_KINDS[type(value)]
    return Value(kind, (float_text(value) if kind == FLOAT else str(value).lower(),))


def _named(kind: Kind) -> str:
    match kind:
        case ArrayKind(axes):
            return f"an array with {axes} axes"
        case TupleKind(parts):
            return f"a tuple ({', '.join(map(_named, parts))})"
    return NAMES[kind]


def _breaks(body: Sequence[ast.stmt]) -> bool:
    """Whether a loop's body may end the loop."""
    return any(isinstance(node, ast.Break) for statement in body for node in ast.walk(statement))


def _loaded(target: ast.Name | ast.Subscript) -> ast.expr:
    """A target of an assignment as an expression."""
    if isinstance(target, ast.Name):
        return ast.copy_location(ast.Name(target.id, ast.Load()), target)
    return ast.copy_location(ast.Subscript(target.value, target.slice, ast.Load()), target)
