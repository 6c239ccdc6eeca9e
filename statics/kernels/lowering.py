"""From the text of a module of steps to LLVM's language: one function a pass, its loop included.

The text is a small language: assignments, + - * / **, numbers, reads and writes of ``array[i, column]``,
``min``, ``max``, ``abs``, some of ``math``, a conditional expression, calls of functions that stand above,
and in those an ``if`` with two arms, of which the names live on that both assign. Anything else is refused
by name.

A pass becomes

    void NAME(int64 n, double *scalars, double *array, ...)

which reads what it is given from ``scalars`` and leaves its results there, each at the slot of its name.
Additions are neither reordered nor contracted, so bits agree with Python's. With ``lanes`` every number is a
vector of 4 or 8 arms, and the lane is the last axis of all arrays.
"""

import ast
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from statics.errors import ContinuumError

INTRINSICS = {"sqrt": "llvm.sqrt", "fabs": "llvm.fabs"}
"""Functions that take vectors as they are."""
LIBRARY = {"sin": 1, "cos": 1, "tanh": 1, "exp": 1, "atan": 1, "atan2": 2, "hypot": 2, "log": 1}
"""Functions of the mathematical library, with their numbers of arguments; one call for each lane."""
OPERATIONS = {ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv"}
COMPARISONS = {ast.Gt: "ogt", ast.Lt: "olt", ast.GtE: "oge", ast.LtE: "ole"}
LARGEST_POWER = 64


class LoweringError(ContinuumError):
    """A text that uses more of Python than can be lowered."""


@dataclass(frozen=True)
class PassSignature:
    """Signature of a pass: names of what it is given, of its results, and of its arrays in order."""

    direction: str
    given: tuple[str, ...]
    results: tuple[str, ...]
    arrays: tuple[str, ...]


def lower(
    tree: ast.Module,
    passes: Mapping[str, PassSignature],
    widths: Mapping[str, int],
    slots: Mapping[str, int],
    lanes: int = 1,
) -> str:
    """LLVM's text of the passes of a module.

    ``widths`` are the arrays' columns, ``slots`` the places in ``scalars``.
    Raises ``LoweringError`` for what the language does not have.
    """
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    unit = _Unit(functions, widths, slots, lanes)
    bodies = [unit.pass_function(name, signature) for name, signature in passes.items()]
    return "\n".join([*declarations(lanes), *bodies])


def declarations(lanes: int = 1) -> list[str]:
    """Every function that may be called from outside a module."""
    kind, suffix = ("double", "f64") if lanes == 1 else (f"<{lanes} x double>", f"v{lanes}f64")
    lines = [f"declare {kind} @{name}.{suffix}({kind})" for name in INTRINSICS.values()]
    lines += [
        f"declare double @{name}({', '.join(['double'] * count)}) nounwind willreturn memory(none)"
        for name, count in LIBRARY.items()
    ]
    if lanes > 1:
        lines.append(f"declare i1 @llvm.vector.reduce.and.v{lanes}i1(<{lanes} x i1>)")
    return lines


class _Unit:
    """One module of LLVM's text in the making."""

    def __init__(
        self,
        functions: Mapping[str, ast.FunctionDef],
        widths: Mapping[str, int],
        slots: Mapping[str, int],
        lanes: int,
    ) -> None:
        self.functions, self.widths, self.slots, self.lanes = functions, widths, slots, lanes
        self.type = "double" if lanes == 1 else f"<{lanes} x double>"
        self.flag = "i1" if lanes == 1 else f"<{lanes} x i1>"

    def constant(self, value: float) -> str:
        """A number, the same in every lane."""
        text = float_text(value)
        return text if self.lanes == 1 else f"<{', '.join([f'double {text}'] * self.lanes)}>"

    def pass_function(self, name: str, signature: PassSignature) -> str:
        """A pass: its start, its loop over the segments, its results."""
        code = _Code(self)
        start = self.functions[f"{name}_start"]
        code.scope = {arg.arg: arg.arg for arg in start.args.args}
        code.index = "0"
        begin = code.body(start.body)
        step = self.functions[f"{name}_step"]
        given = [code.load("scalars", str(self.slots[given])) for given in signature.given]
        outward = signature.direction == "outward"
        code.lines += ["  %last = sub i64 %n, 1", "  %entered = icmp sgt i64 %n, 0"]
        entry = code.label
        code.lines.append("  br i1 %entered, label %loop, label %done")
        code.block("loop")
        first, change = ("0", "1") if outward else ("%last", "-1")
        head = len(code.lines)
        code.scope = {arg.arg: arg.arg for arg in step.args.args} | {"carried": [], "given": given}
        carried = [f"%carried_{k}" for k in range(len(begin))]
        code.scope["carried"] = carried
        code.index = "%i"
        after = code.body(step.body)
        code.lines += [
            f"  %next = add i64 %i, {change}",
            "  %more = icmp slt i64 %next, %n" if outward else "  %more = icmp sge i64 %next, 0",
            "  br i1 %more, label %loop, label %done",
        ]
        latch = code.label
        phis = [f"  %i = phi i64 [ {first}, %{entry} ], [ %next, %{latch} ]"]
        phis += [
            f"  {phi} = phi {self.type} [ {old}, %{entry} ], [ {new}, %{latch} ]"
            for phi, old, new in zip(carried, begin, after, strict=True)
        ]
        code.lines[head:head] = phis
        code.block("done")
        for k, result in enumerate(signature.results):
            value = code.assign(f"phi {self.type} [ {begin[k]}, %{entry} ], [ {after[k]}, %{latch} ]")
            code.results.append((value, result))
        for value, result in code.results:
            code.store("scalars", str(self.slots[result]), value)
        arguments = ", ".join(["i64 %n", "ptr %scalars", *(f"ptr %{array}" for array in signature.arrays)])
        return "\n".join(
            [f"define void @{name}({arguments}) nounwind {{", "entry:", *code.lines, "  ret void", "}"]
        )


class _Code:
    """Lines of one function, and what its names stand for."""

    def __init__(self, unit: _Unit) -> None:
        self.unit = unit
        self.lines: list[str] = []
        self.results: list[tuple[str, str]] = []
        self.scope: dict[str, Any] = {}
        self.open: list[str] = []
        self.index = "%i"
        self.label = "entry"
        self.count = 0

    def assign(self, operation: str) -> str:
        """The name of a new value."""
        self.count += 1
        self.lines.append(f"  %v{self.count} = {operation}")
        return f"%v{self.count}"

    def block(self, label: str) -> None:
        """Begin a block."""
        self.lines.append(f"{label}:")
        self.label = label

    def address(self, array: str, place: str) -> str:
        return self.assign(f"getelementptr inbounds {self.unit.type}, ptr %{array}, i64 {place}")

    def load(self, array: str, place: str) -> str:
        """A number of an array."""
        return self.assign(f"load {self.unit.type}, ptr {self.address(array, place)}, align 8")

    def store(self, array: str, place: str, value: str) -> None:
        """Set a number of an array."""
        self.lines.append(f"  store {self.unit.type} {value}, ptr {self.address(array, place)}, align 8")

    def body(self, statements: Sequence[ast.stmt]) -> list[str]:
        """Lower statements up to a return; the values that it returns."""
        for statement in statements:
            if isinstance(statement, ast.Return):
                if statement.value is None:
                    break
                several = isinstance(statement.value, ast.Tuple)
                return self.several(statement.value) if several else [self.value(statement.value)]
            self.statement(statement)
        raise LoweringError("a function that returns nothing cannot be lowered")

    def statement(self, statement: ast.stmt) -> None:
        """Lower an assignment or an ``if``; a docstring is passed over."""
        if isinstance(statement, ast.Assign) and len(statement.targets) == 1:
            self.set(statement.targets[0], statement.value)
        elif isinstance(statement, ast.If):
            self.branch(statement)
        elif not (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)):
            raise _refusal(statement)

    def set(self, target: ast.expr, value: ast.expr) -> None:
        """Lower an assignment to a name, to an array's element, or to a tuple of names."""
        if isinstance(target, ast.Name):
            self.scope[target.id] = self.value(value)
        elif isinstance(target, ast.Subscript):
            array, place = self.place(target)
            self.store(array, place, self.value(value))
        elif isinstance(target, ast.Tuple):
            values = self.several(value)
            if len(values) != len(target.elts):
                raise _refusal(target)
            for part, found in zip(target.elts, values, strict=True):
                if not isinstance(part, ast.Name):
                    raise _refusal(part)
                self.scope[part.id] = found
        else:
            raise _refusal(target)

    def several(self, node: ast.expr) -> list[str]:
        """Values of a tuple, of what is carried or given, or of a call of a function above."""
        if isinstance(node, ast.Name) and isinstance(self.scope.get(node.id), list):
            return list(self.scope[node.id])
        if isinstance(node, ast.Tuple):
            return [self.value(part) for part in node.elts]
        return self.inlined(node, of_several=True)

    def inlined(self, node: ast.expr, of_several: bool) -> list[str]:
        """The results of a call of a function of the text, whose body is put here."""
        name = node.func.id if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else ""
        function = self.unit.functions.get(name)
        if not isinstance(node, ast.Call) or function is None or node.keywords:
            raise _refusal(node)
        returned = next((part.value for part in function.body if isinstance(part, ast.Return)), None)
        if len(node.args) != len(function.args.args) or isinstance(returned, ast.Tuple) != of_several:
            raise _refusal(node)
        if name in self.open:
            raise _refusal(node, "is a recursive call and ")
        outside = self.scope
        values = [self.value(argument) for argument in node.args]
        self.scope = dict(zip((arg.arg for arg in function.args.args), values, strict=True))
        self.open.append(name)
        results = self.body(function.body)
        self.open.pop()
        self.scope = outside
        return results

    def branch(self, node: ast.If) -> None:
        """Two arms that assign the same names; a vector takes the second for all lanes if any needs it."""
        condition = self.condition(node.test)
        self.count += 1
        here, number, lanes = self.label, self.count, self.unit.lanes
        before = dict(self.scope)
        if lanes > 1:
            first = self.arm(node.body)
            reduced = self.assign(f"call i1 @llvm.vector.reduce.and.v{lanes}i1({self.unit.flag} {condition})")
            here = self.label
            self.lines.append(f"  br i1 {reduced}, label %join_{number}, label %second_{number}")
        else:
            self.lines.append(f"  br i1 {condition}, label %first_{number}, label %second_{number}")
            self.block(f"first_{number}")
            first = self.arm(node.body)
            here = self.label
            self.lines.append(f"  br label %join_{number}")
        self.scope = dict(before)
        self.block(f"second_{number}")
        second = self.arm(node.orelse)
        shared = [name for name in first if name in second]  # what only one arm assigns ends with it
        if lanes > 1:
            second = {name: self.select(condition, first[name], second[name]) for name in shared}
        there = self.label
        self.lines.append(f"  br label %join_{number}")
        self.block(f"join_{number}")
        self.scope = dict(before)
        for name in shared:
            self.scope[name] = self.assign(
                f"phi {self.unit.type} [ {first[name]}, %{here} ], [ {second[name]}, %{there} ]"
            )

    def arm(self, statements: Sequence[ast.stmt]) -> dict[str, str]:
        """Names that an arm of an ``if`` assigns, with their values."""
        names = [
            target.id
            for statement in statements
            if isinstance(statement, ast.Assign)
            for target in statement.targets
            if isinstance(target, ast.Name)
        ]
        if len(names) != len(statements):
            raise LoweringError("a branch of an if may only assign to names")
        for statement in statements:
            self.statement(statement)
        return {name: str(self.scope[name]) for name in names}

    def place(self, node: ast.Subscript) -> tuple[str, str]:
        """Array and place of ``array[i, column]``, ``array[0, column]`` or ``array[column]``."""
        array = self.scope.get(node.value.id) if isinstance(node.value, ast.Name) else None
        if not isinstance(array, str) or _is_number(array):
            raise _refusal(node)
        match node.slice:
            case ast.Constant(value=int() as column) if array not in self.unit.widths:
                return array, str(column)
            case ast.Tuple(elts=[row_part, ast.Constant(value=int() as column)]):
                width = self.unit.widths.get(array, 0)
            case _:
                raise _refusal(node)
        if column >= width:
            raise _refusal(node)
        if isinstance(row_part, ast.Constant) and row_part.value == 0:
            return array, str(column)
        if not isinstance(row_part, ast.Name) or self.scope.get(row_part.id) != "i":
            raise _refusal(node)
        row = self.assign(f"mul nsw i64 {self.index}, {width}")
        return array, self.assign(f"add nsw i64 {row}, {column}")

    def value(self, node: ast.expr) -> str:
        """The value of an expression."""
        match node:
            case ast.Constant(value=int() | float() as number):
                return self.unit.constant(float(number))
            case ast.Name(id=name) if _is_number(self.scope.get(name)):
                return str(self.scope[name])
            case ast.Subscript():
                return self.load(*self.place(node))
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return self.assign(f"fneg {self.unit.type} {self.value(operand)}")
            case ast.BinOp(op=ast.Pow(), left=base, right=exponent):
                return self.power(self.value(base), exponent)
            case ast.BinOp(op=operation, left=left, right=right) if type(operation) in OPERATIONS:
                first, second = self.value(left), self.value(right)
                return self.assign(f"{OPERATIONS[type(operation)]} {self.unit.type} {first}, {second}")
            case ast.IfExp(test=test, body=body, orelse=other):
                condition = self.condition(test)
                return self.select(condition, self.value(body), self.value(other))
            case ast.Call():
                return self.call(node)
        raise _refusal(node)

    def condition(self, node: ast.expr) -> str:
        """The value of a comparison."""
        if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in COMPARISONS:
            first, second = self.value(node.left), self.value(node.comparators[0])
            return self.compare(COMPARISONS[type(node.ops[0])], first, second)
        raise _refusal(node)

    def compare(self, how: str, first: str, second: str) -> str:
        return self.assign(f"fcmp {how} {self.unit.type} {first}, {second}")

    def select(self, condition: str, first: str, second: str) -> str:
        kind = self.unit.type
        return self.assign(f"select {self.unit.flag} {condition}, {kind} {first}, {kind} {second}")

    def power(self, base: str, exponent: ast.expr) -> str:
        """A constant power by repeated squaring; a negative one as 1 over it; half ones through a root."""
        value = constant_number(exponent)
        if value is None or abs(value) > LARGEST_POWER or (2 * value) % 1:
            raise _refusal(exponent, "as an exponent ")
        if value < 0:
            positive = self.power(base, ast.Constant(-value))
            return self.assign(f"fdiv {self.unit.type} {self.unit.constant(1.0)}, {positive}")
        result, square, left = "", base, int(value)
        while left:
            if left & 1:
                result = self.times(result, square)
            left >>= 1
            if left:
                square = self.times(square, square)
        if value % 1:
            result = self.times(result, self.intrinsic("sqrt", base))
        return result or self.unit.constant(1.0)

    def times(self, first: str, second: str) -> str:
        return self.assign(f"fmul {self.unit.type} {first}, {second}") if first else second

    def intrinsic(self, name: str, value: str) -> str:
        kind = self.unit.type
        suffix = "f64" if self.unit.lanes == 1 else f"v{self.unit.lanes}f64"
        return self.assign(f"call {kind} @{INTRINSICS[name]}.{suffix}({kind} {value})")

    def call(self, node: ast.Call) -> str:
        """The value of a call: of a function above, of one of a few numbers, of ``min`` and ``max``."""
        if isinstance(node.func, ast.Name) and node.func.id in self.unit.functions:
            return self.inlined(node, of_several=False)[0]
        if node.keywords or not node.args:
            raise _refusal(node)
        values = [self.value(argument) for argument in node.args]
        match node.func:
            case ast.Name(id="max" | "min" as name):
                result = values[0]
                for value in values[1:]:
                    chosen = self.compare("ogt" if name == "max" else "olt", value, result)
                    result = self.select(chosen, value, result)
                return result
            case ast.Name(id="abs") if len(values) == 1:
                return self.intrinsic("fabs", values[0])
            case ast.Attribute(value=ast.Name(id="math"), attr=name) if (
                name in INTRINSICS and len(values) == 1
            ):
                return self.intrinsic(name, values[0])
            case ast.Attribute(value=ast.Name(id="math"), attr=name) if LIBRARY.get(name) == len(values):
                return self.library(name, values)
        raise _refusal(node)

    def library(self, name: str, values: list[str]) -> str:
        """A function of the mathematical library, lane by lane."""
        if self.unit.lanes == 1:
            return self.assign(f"call double @{name}({', '.join(f'double {value}' for value in values)})")
        result = "poison"
        for lane in range(self.unit.lanes):
            parts = [self.assign(f"extractelement {self.unit.type} {value}, i32 {lane}") for value in values]
            one = self.assign(f"call double @{name}({', '.join(f'double {part}' for part in parts)})")
            result = self.assign(f"insertelement {self.unit.type} {result}, double {one}, i32 {lane}")
        return result


def _is_number(value: Any) -> bool:
    """Whether what a name stands for is a number, and no array, index or tuple."""
    return isinstance(value, str) and value.startswith(("%", "<", "0x"))


def float_text(value: float) -> str:
    """A float as LLVM reads it, to the last bit."""
    return f"0x{struct.pack('>d', value).hex().upper()}"


def constant_number(node: ast.expr) -> float | None:
    """A constant, with a sign, or a quotient of two such."""
    match node:
        case ast.Constant(value=int() | float() as number):
            return float(number)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            value = constant_number(operand)
            return None if value is None else -value
        case ast.BinOp(op=ast.Div(), left=left, right=right):
            first, second = constant_number(left), constant_number(right)
            return None if first is None or second is None else first / second
    return None


def _refusal(node: ast.AST, role: str = "") -> LoweringError:
    line = getattr(node, "lineno", 0)
    return LoweringError(
        f"line {line}: '{ast.unparse(node)}' {role}cannot be lowered. Allowed: assignments, + - * / **, "
        f"array[i, column], min, max, abs, {', '.join(f'math.{name}' for name in (*INTRINSICS, *LIBRARY))}, "
        "a conditional expression, an if with two branches, and calls of functions above."
    )
