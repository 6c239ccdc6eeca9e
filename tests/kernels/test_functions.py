"""Functions of modules as machine code: every construct has the interpreter's bits, or is refused."""

import math
import struct
import sys
import tracemalloc
import weakref
from collections import namedtuple
from collections.abc import Callable
from functools import cache
from pathlib import Path
from resource import RUSAGE_SELF, getrusage
from typing import Any

import constructs as c
import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from statics.kernels.compiled import compiled
from statics.kernels.functions import lower_function
from statics.kernels.kinds import BOOL, FLOAT, INT, ArrayKind
from statics.kernels.lowering import LoweringError

ANY = st.floats()
"""Zeros of both signs, infinities and what is not a number among them."""
MODERATE = st.floats(-1e6, 1e6)
SMALL = st.integers(-12, 12)
INTEGERS = st.integers(-(2**30), 2**30)
LARGE = st.integers(-(2**61), 2**61)

FLOATS = (
    "x + y", "x - y", "x * y", "-x", "-(-x)", "x - y - 0.3", "0.1 * x + y * x",
    "x / (y if y != 0.0 else 1.0)", "min(x, y)", "max(x, y)", "min(x, y, 0.5)", "max(y, x, -0.0)", "abs(x)",
    "math.fabs(y)", "float(x)", "x > y", "x < y", "x >= y", "x <= y", "x == y", "x != y", "not x < y",
    "math.isfinite(x)", "x != x", "x > y and y > 0.0", "x > y or y > 0.0",
    "not (x > y and x > 0.0 and y < 1.0) or x == 1.0", "x if x > y else y",
    "-x if x > 0.0 else (y if x < y else 0.0)", "(x > 0.0) if y > 0.0 else x != y", "i + x", "x - i",
    "i * x", "i / (x if x != 0.0 else 1.0)", "x < i", "i >= x", "x == i", "i != x", "x + 1", "2 * y",
    "x**1", "True", "False", "1e300 * x", "5e-324 + x", "-0.0 * x", "float(i) * y", "max(float(i), x)",
)  # fmt: skip
"""Of any floats, and small integers."""
WHOLE = (
    "i + j", "i - j", "i * j", "-i", "abs(i)", "i // (j if j != 0 else 7)", "i % (j if j != 0 else -7)",
    "i // 3", "i // -3", "i % 5", "i % -5", "i / (j if j != 0 else 1)", "min(i, j)", "max(i, j, 3)",
    "min(i, j, -3, i)", "i == j", "i != j", "i < j", "i > j", "i <= j", "i >= j", "float(i)", "int(i)",
    "int(float(j))", "i**2", "i**1", "i if i > j else j", "i > 0 and j > 0", "i > 0 or not j > 0", "i - -j",
    "2 - -3 * i", "int(i / 3)", "int(-i / 4.0)", "i * 0.5", "(i, j)[1]", "(i, (j, 1.5))[1][0]",
)  # fmt: skip
"""Of integers whose products have 64 bits."""
HUGE = (
    "i + j", "i - j", "-i", "abs(j)", "i == j", "i < j", "i >= j", "max(i, j)", "i // 3", "i % 1000003",
    "i * 2", "i * x", "i + x", "float(i)", "i // (j if j != 0 else 1)", "i % (j if j != 0 else -1)",
    "9223372036854775807 - abs(i)",
)  # fmt: skip
MATHEMATICS = (
    "math.sin(x)", "math.cos(y)", "math.sin(x) * math.cos(x)", "math.tanh(x)", "math.exp(min(x, 700.0))",
    "math.log(abs(x) + 0.1)", "math.atan(x)", "math.atan2(x, y)", "math.sqrt(abs(x))", "sine(y)",
    "m.cos(x)", "math.sqrt(i * i)", "math.sin(i)", "math.pi * x + m.e", "math.isfinite(i)",
    "math.atan2(i, j)", "math.fabs(j)",
)  # fmt: skip
POWERS = {
    "x**1": "x",
    "x**2": "x * x",
    "x**3": "(x * (x * x))",
    "x**4": "(x * x) * (x * x)",
    "x**5": "x * ((x * x) * (x * x))",
    "x**6": "(x * x) * ((x * x) * (x * x))",
    "-x**2": "-(x * x)",
    "x**THREE": "(x * (x * x))",
    "i**3": "i * (i * i)",
    "x**0": "1.0",
}
"""Powers, and the products that they are."""
LIBRARY_POWERS = (
    "x**y", "x**-1", "x**-2", "x**0.5", "x**2.0", "2.0**y", "10.0**y", "2**y", "x**i", "x**65",
    "x**(-0.7 / i)",
)  # fmt: skip
"""Powers by the library."""
HEAD = "import math\nimport math as m\nfrom math import sin as sine\nimport numpy as np\nTHREE = 3\n\n"


def defined(text: str, folder: Path) -> Any:
    """The function f of a module of this text, compiled."""
    path = folder / f"made_{len(list(folder.iterdir()))}.py"
    path.write_text(text)
    module = {"compiled": compiled, "__name__": path.stem}
    exec(compile(text, str(path), "exec"), module)
    return module["f"]


@pytest.fixture(scope="module")
def expressions(tmp_path_factory: pytest.TempPathFactory) -> Callable[[tuple[str, ...]], Any]:
    """Functions that return the values of expressions of floats x, y and integers i, j."""
    folder = tmp_path_factory.mktemp("expressions")

    @cache
    def made(several: tuple[str, ...]) -> Any:
        lines = "".join(f"        {expression},\n" for expression in several)
        head = f"{HEAD}@compiled\ndef f(x: float, y: float, i: int, j: int):\n"
        return defined(f"{head}    return (\n{lines}    )\n", folder)

    return made


def bits(value: Any) -> Any:
    """What tells numbers apart; all that are not a number are alike."""
    match value:
        case tuple():
            return tuple(map(bits, value))
        case np.ndarray():
            return value.shape, [bits(number) for number in value.ravel().tolist()]
        case bool() | np.bool_():
            return "bool", bool(value)
        case float():
            return "float", "nan" if math.isnan(value) else struct.pack("d", value)
    return type(value).__name__, value


def copied(value: Any) -> Any:
    """The same with arrays of their own."""
    if isinstance(value, tuple):
        parts = [copied(part) for part in value]
        return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    return value.copy() if isinstance(value, np.ndarray) else value


def assert_same(function: Any, *arguments: Any) -> None:
    """Results, and what became of arrays, have the interpreter's bits."""
    own, others = copied(arguments), copied(arguments)
    expected = function.python(*own)
    assert bits(function(*others)) == bits(expected)
    assert bits(others) == bits(own)


def rows(*shape: int) -> st.SearchStrategy[np.ndarray]:
    """Arrays of that shape."""
    count = math.prod(shape)
    return st.lists(MODERATE, min_size=count, max_size=count).map(lambda found: np.reshape(found, shape))


@given(x=ANY, y=ANY, i=SMALL)
@example(x=-0.0, y=0.0, i=0)
@example(x=math.nan, y=1.0, i=1)
@example(x=1.0, y=math.nan, i=1)
@example(x=math.inf, y=-math.inf, i=-1)
def test_expressions_of_floats(expressions: Any, x: float, y: float, i: int) -> None:
    assert_same(expressions(FLOATS), x, y, i, 0)


@given(i=INTEGERS | SMALL, j=INTEGERS | SMALL)
def test_expressions_of_integers(expressions: Any, i: int, j: int) -> None:
    """Quotients round down, and remainders have the divisor's sign."""
    assert_same(expressions(WHOLE), 0.0, 0.0, i, j)


@given(i=LARGE, j=LARGE | SMALL, x=MODERATE)
def test_integers_of_62_bits(expressions: Any, i: int, j: int, x: float) -> None:
    assert_same(expressions(HUGE), x, 0.0, i, j)


@given(x=MODERATE, y=MODERATE, i=INTEGERS, j=INTEGERS)
def test_mathematical_functions(expressions: Any, x: float, y: float, i: int, j: int) -> None:
    assert_same(expressions(MATHEMATICS), x, y, i, j)


@given(x=MODERATE, y=MODERATE, n=INTEGERS)
def test_hypot_is_pythons_to_a_unit_in_the_last_place(expressions: Any, x: float, y: float, n: int) -> None:
    """Python's is its own."""
    function = expressions(("math.hypot(x, y)", "math.hypot(i, x)"))
    for found, expected in zip(function(x, y, n, 0), function.python(x, y, n, 0), strict=True):
        assert abs(found - expected) <= math.ulp(expected)


@given(x=st.floats(-1e50, 1e50) | st.just(math.inf) | st.just(math.nan), i=st.integers(-(2**20), 2**20))
def test_small_whole_powers_are_products(expressions: Any, x: float, i: int) -> None:
    found = expressions(tuple(POWERS))(x, 0.0, i, 0)
    assert bits(found) == bits(expressions(tuple(POWERS.values())).python(x, 0.0, i, 0))


@given(x=st.floats(1e-3, 1e3), y=st.floats(-30.0, 30.0), i=st.integers(1, 9))
def test_other_powers_are_the_librarys(expressions: Any, x: float, y: float, i: int) -> None:
    assert_same(expressions(LIBRARY_POWERS), x, y, i, 0)


@given(n=st.integers(-3, 12), m=st.integers(-3, 12))
def test_loops(n: int, m: int) -> None:
    """Also those that are never entered, or end by a break or a return alone."""
    for function in (c.loops, c.tested):
        assert_same(function, n, m)
    for function in (c.after_loop, c.bound_changes, c.collatz, c.broken, c.never):
        assert_same(function, n)


@given(x=ANY)
def test_arms_of_an_if(x: float) -> None:
    assert_same(c.arms, x)
    assert_same(c.assigned_in_arms, x)


@given(row=rows(4), at=st.sampled_from([-(2**40), -1, 0, 3, 4, 2**40]))
def test_what_need_not_be_computed_is_not(row: np.ndarray, at: int) -> None:
    """Far from the array nothing could be read."""
    for function in (c.guarded, c.guarded_or, c.guarded_choice):
        assert_same(function, row, at)


@given(row=rows(4) | st.lists(st.sampled_from([-1.0, 0.0]), min_size=4, max_size=4).map(np.array))
def test_what_is_computed_is_computed_once_and_in_order(row: np.ndarray) -> None:
    assert_same(c.marked, row)
    assert_same(c.changed_once, row)


@given(a=ANY, b=ANY, row=rows(3), table=rows(2, 3), n=INTEGERS)
def test_assignments(a: float, b: float, row: np.ndarray, table: np.ndarray, n: int) -> None:
    assert_same(c.swaps, a, b, row)
    assume(abs(a) < 1e100)  # Python raises an error where a power has no float
    assert_same(c.changes, a, n % 10**6, table)


@given(cube=rows(3, 4, 5), a=st.integers(0, 2), b=st.integers(0, 3))
def test_views(cube: np.ndarray, a: int, b: int) -> None:
    assume(a <= b)
    assert_same(c.views, cube, a, b)


@given(x=MODERATE, n=st.integers(0, 9))
def test_workspaces(x: float, n: int) -> None:
    assert_same(c.workspaces, n, x)
    assert_same(c.no_axes, np.array(x))


@given(x=MODERATE, n=SMALL, row=rows(3))
def test_constants_calls_and_names(x: float, n: int, row: np.ndarray) -> None:
    assert_same(c.constants, x, n)
    assert_same(c.nothing, row, n)
    assert_same(c.numbers, x, n)
    assert_same(c.single, x)
    assert_same(c.fixed)
    assert_same(c.empty, ())
    assert_same(c.entry, x, n, row, x + 1.0, x - 1.0, 5)
    assert_same(c.hides, x, n, 2.0 * x, 3)
    assert_same(c.deep, x, x + n)
    for sure in (True, False):
        assert_same(c.untold, x, n, sure)
        assert_same(c.untold, n, n, sure)
    own = row.copy()
    assert c.calls(x, n, row) == c.calls.python(x, n, own)  # which keeps integers that are given for floats


@given(x=MODERATE, n=SMALL, row=rows(3), sure=st.booleans())
def test_tuples_that_hold_others(x: float, n: int, row: np.ndarray, sure: bool) -> None:
    flat = c.Flat(n, x, sure)
    assert_same(c.tuples, flat, c.Mixed(row, (x, 2), c.Flat(3, -x, not sure)), ((5, x), row + 1.0, sure), n)


def test_a_named_tuple_without_annotations_is_seen_by_its_values(tmp_path: Path) -> None:
    pair = namedtuple("pair", ["n", "row"])
    function = defined("@compiled\ndef f(pair):\n    return pair.row[pair.n] + pair[0]\n", tmp_path)
    assert_same(function, pair(1, np.arange(3.0)))


def test_no_workspace_outlives_its_function() -> None:
    """Each of a hundred thousand calls would leave half a kilobyte."""
    c.workspaces(9, 1.0)
    before = getrusage(RUSAGE_SELF).ru_maxrss
    for number in range(100_000):
        c.workspaces(number % 10, 0.5 - number % 2)
    kilobyte = 1024 if sys.platform == "darwin" else 1
    assert getrusage(RUSAGE_SELF).ru_maxrss - before < 4000 * kilobyte


def test_every_workspace_that_may_not_come_to_be_is_nothing_at_first() -> None:
    """What would be released instead cannot be told."""
    text, _ = lower_function(c.workspaces.python, [INT, FLOAT])
    assert text.count("store ptr null") == text.count("call ptr @calloc") == 5


def test_a_call_leaves_no_object_behind() -> None:
    row = np.ones(3)
    c.calls(0.5, 2, row)
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    for _ in range(1000):
        c.calls(0.5, 2, row)
    after = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    assert after - before < 2000


def test_a_function_without_any_return_can_be_lowered() -> None:
    text, result = lower_function(c.endless.python, [INT])
    assert "define" in text
    assert result is None


def test_sums_of_a_hundred_terms(expressions: Any) -> None:
    assert_same(expressions((" + ".join(f"{k} * x" for k in range(100)),)), 0.1, 0.0, 0, 0)
    nested = "x"
    for _ in range(25):
        nested = f"(x if x > {nested} else 1.0 + x)"
    assert_same(expressions((nested,)), 0.1, 0.0, 0, 0)


REFUSED = {
    "list": ("y = [x, x]", "[x, x]"),
    "comprehension": ("y = [k for k in range(3)]", "[k for k in range(3)]"),
    "generator": ("y = sum(k for k in range(3))", "(k for k in range(3))"),
    "string": ("y = 'words'", "'words'"),
    "formatted string": ("y = f'{x}'", "f'{x}'"),
    "dictionary": ("y = {1: x}", "{1: x}"),
    "set": ("y = {x}", "{x}"),
    "complex": ("y = 1j", "1j"),
    "nothing as a value": ("y = None", "None"),
    "ellipsis as a value": ("y = ...", "..."),
    "integer of more than 64 bits": ("y = 9223372036854775808", "9223372036854775808"),
    "module's integer of more than 64 bits": ("y = HUGE", "HUGE"),
    "module's array": ("y = TABLE[0]", "TABLE"),
    "module's array, called": ("y = TABLE(0)", "TABLE(0)"),
    "module's list": ("y = LIST[0]", "LIST"),
    "module's list, called": ("y = LIST(0)", "LIST(0)"),
    "attribute of an object": ("y = TABLE.size", "TABLE"),
    "slice with a step": ("y = row[0:3:2]", "row[0:3:2]"),
    "slice backwards": ("y = row[::-1]", "row[::-1]"),
    "slice that is not last": ("y = table[:, 0]", "table[:, 0]"),
    "negative index": ("y = row[-1]", "-1"),
    "module's negative index": ("y = row[LAST]", "LAST"),
    "negative index to assign to": ("row[-1] = x", "-1"),
    "negative index to add to": ("row[-1] += x", "-1"),
    "negative end": ("y = row[:-1]", "-1"),
    "negative start": ("y = row[-2:]", "-2"),
    "negative index of a tuple": ("y = (x, x)[-1]", "(x, x)[-1]"),
    "index beyond a tuple": ("y = (x, x)[2]", "(x, x)[2]"),
    "index of a tuple that varies": ("y = (x, x)[n]", "(x, x)[n]"),
    "slice of a tuple": ("y = (x, x)[:1]", "(x, x)[:1]"),
    "float as an index": ("y = row[x]", "x"),
    "bool as an index": ("y = row[True]", "True"),
    "ellipsis as an index": ("y = row[...]", "..."),
    "new axis": ("y = row[None]", "None"),
    "array as an index": ("y = row[row]", "row"),
    "too many indices": ("y = row[0, 0]", "row[0, 0]"),
    "index of a number": ("y = x[0]", "x[0]"),
    "assignment to a row": ("table[0] = x", "table[0]"),
    "assignment of a row": ("table[0] = row", "table[0]"),
    "assignment to a slice": ("row[:] = 0.0", "row[:]"),
    "addition to a slice": ("row[:2] += 1.0", "row[:2]"),
    "assignment to a tuple's part": ("y = (x, x)\n    y[0] = x", "y[0]"),
    "assignment to an attribute": ("row.shape = 3", "row.shape"),
    "assignment of a bool to an array": ("row[0] = x > 0.0", "row[0]"),
    "sum of arrays": ("y = row + row", "row + row"),
    "sum of arrays in place": ("row += row", "row += row"),
    "sum of tuples": ("y = (x, x) + (x,)", "(x, x) + (x,)"),
    "sum of bools": ("y = (x > 0.0) + (x > 1.0)", "(x > 0.0) + (x > 1.0)"),
    "negative bool": ("y = -(x > 0.0)", "-(x > 0.0)"),
    "negative array": ("y = -row", "-row"),
    "comparison of arrays": ("y = row == row", "row == row"),
    "comparison of bools": ("y = (x > 0.0) == (x > 1.0)", "(x > 0.0) == (x > 1.0)"),
    "chained comparison": ("y = 0.0 < x < 1.0", "0.0 < x < 1.0"),
    "is": ("y = x is x", "x is x"),
    "is None": ("y = x is None", "None"),
    "is not": ("y = n is not n", "n is not n"),
    "in": ("y = x in (x, x)", "x in (x, x)"),
    "float quotient rounded down": ("y = x // 2.0", "x // 2.0"),
    "float remainder": ("y = x % 2.0", "x % 2.0"),
    "matrix product": ("y = row @ row", "row @ row"),
    "bits": ("y = n & 1", "n & 1"),
    "shift": ("y = n << 1", "n << 1"),
    "inverted bits": ("y = ~n", "~n"),
    "plus": ("y = +x", "+x"),
    "power of integers": ("y = n**n", "n ** n"),
    "negative power of an integer": ("y = n**-1", "n ** (-1)"),
    "power of a bool": ("y = (x > 0.0)**2", "(x > 0.0) ** 2"),
    "power of an array": ("y = row**2", "row ** 2"),
    "number as a truth": ("y = 1 if n else 2", "n"),
    "float as a truth": ("y = not x", "x"),
    "array as a truth": ("while row:\n        n = 1", "row"),
    "one as a truth": ("while 1:\n        n = 1", "1"),
    "number of and": ("y = n and x", "n"),
    "second number of or": ("y = x > 0.0 or n", "n"),
    "choice of unlike kinds": ("y = x if x > 0.0 else 0", "0"),
    "smallest of unlike kinds": ("y = min(x, 0)", "min(x, 0)"),
    "largest of bools": ("y = max(True, False)", "max(True, False)"),
    "largest of one": ("y = max(x)", "max(x)"),
    "largest in an array": ("y = max(row)", "max(row)"),
    "smallest of nothing": ("y = min()", "min()"),
    "int of a bool": ("y = int(x > 0.0)", "int(x > 0.0)"),
    "int of nothing": ("y = int()", "int()"),
    "int of two": ("y = int(x, 2)", "int(x, 2)"),
    "float of nothing": ("y = float()", "float()"),
    "float of an array": ("y = float(row)", "float(row)"),
    "len of nothing": ("y = len()", "len()"),
    "len of a number": ("y = len(x)", "len(x)"),
    "len of two": ("y = len(row, row)", "len(row, row)"),
    "abs of two": ("y = abs(x, x)", "abs(x, x)"),
    "abs of a bool": ("y = abs(x > 0.0)", "abs(x > 0.0)"),
    "mathematics of two": ("y = math.sin(x, x)", "math.sin(x, x)"),
    "mathematics of nothing": ("y = math.sqrt()", "math.sqrt()"),
    "mathematics of an array": ("y = math.sin(row)", "math.sin(row)"),
    "finite array": ("y = math.isfinite(row)", "math.isfinite(row)"),
    "other mathematics": ("y = math.gamma(x)", "math.gamma(x)"),
    "NumPy's mathematics": ("y = np.sqrt(x)", "np.sqrt(x)"),
    "round": ("y = round(x)", "round(x)"),
    "print": ("print(x)", "print(x)"),
    "range as a value": ("y = range(3)", "range(3)"),
    "unknown function": ("y = unknown(x)", "unknown(x)"),
    "unknown name": ("y = unknown", "unknown"),
    "unknown constant": ("y = math.unknown", "math"),
    "method": ("y = row.sum()", "row.sum()"),
    "method of a method": ("y = row.reshape(3).sum()", "row.reshape(3).sum()"),
    "transposed": ("y = table.T", "table.T"),
    "parameter that is called": ("y = x(n)", "x(n)"),
    "plain function": ("y = plain(x)", "plain(x)"),
    "plain function of a compiled one": ("y = helper.python(x)", "helper.python(x)"),
    "named arguments": ("y = helper(x=x)", "helper(x=x)"),
    "left out argument": ("y = helper()", "helper()"),
    "left out argument with a default": ("y = defaulted(x)", "defaulted(x)"),
    "too many arguments": ("y = helper(x, x)", "helper(x, x)"),
    "arguments of a tuple": ("y = helper(*(x,))", "*(x,)"),
    "an array for a float": ("y = helper(row)", "helper(row)"),
    "a bool for a float": ("y = helper(x > 0.0)", "helper(x > 0.0)"),
    "a tuple for a float": ("y = helper((x, x))", "helper((x, x))"),
    "a float for an integer": ("y = defaulted(x, x)", "defaulted(x, x)"),
    "result of nothing": ("y = nothing(x)", "nothing(x)"),
    "call of what takes more": ("y = several(x)", "several"),
    "call of what is refused": ("y = refused(x)", "x // 2.0"),
    "itself": ("y = f(x, n, row, table)", "f(x, n, row, table)"),
    "itself by another": ("y = round_about(x)", "round_about(x - 1.0)"),
    "itself with ever other tuples": ("y = ever((x, x))", "ever((pair, 1.0))"),
    "run without arrays": ("run(n, n)", "run(n, n)"),
    "run of nothing": ("run()", "run()"),
    "run of a float": ("run(x, n, row)", "run(x, n, row)"),
    "run of a number": ("run(n, n, row, x)", "run(n, n, row, x)"),
    "run as a value": ("y = run(n, n, row)", "run(n, n, row)"),
    "reshape of a number": ("y = x.reshape(1)", "x.reshape(1)"),
    "reshape in another order": ("y = table.reshape(6, order='F')", "table.reshape(6, order='F')"),
    "reshape to a length that is not told": ("y = table.reshape(-1)", "-1"),
    "reshape to lengths that are not told": ("y = table.reshape((-1, 2))", "-1"),
    "reshape to a float": ("y = table.reshape(x)", "x"),
    "reshape to nothing": ("y = table.reshape()", "table.reshape()"),
    "reshape by NumPy": ("y = np.reshape(row, 3)", "np.reshape(row, 3)"),
    "workspace in a loop": ("for k in range(n):\n        y = np.empty(3)", "np.empty(3)"),
    "workspace in a test": ("while np.zeros(3)[0] < x:\n        x -= 1.0", "np.zeros(3)"),
    "workspace of integers": ("y = np.empty(3, int)", "np.empty(3, int)"),
    "workspace of named integers": ("y = np.zeros(3, dtype=int)", "np.zeros(3, dtype=int)"),
    "workspace of a float's length": ("y = np.empty(x)", "x"),
    "workspace of a negative length": ("y = np.empty((2, -1))", "-1"),
    "workspace of nested lengths": ("y = np.empty(((2, 1), 3))", "(2, 1)"),
    "workspace of no length": ("y = np.empty()", "np.empty()"),
    "workspace that is filled": ("y = np.full(3, x)", "np.full(3, x)"),
    "integer becomes a float": ("y = 0\n    y = x", "y"),
    "integer becomes a float by division": ("n /= 2", "n"),
    "integer becomes a float by addition": ("n += 0.5", "n"),
    "float becomes an integer": ("y = x\n    y = 0", "y"),
    "float becomes a loop's variable": ("for x in range(3):\n        n = x", "x"),
    "number becomes an array": ("x = row", "x"),
    "array becomes a number": ("row = row[0]", "row"),
    "array of other axes": ("row = table", "row"),
    "bool becomes an integer": ("y = x > 0.0\n    y = 1", "y"),
    "unknown variable": ("x = y + 1.0\n    y = 2.0", "y"),
    "module's name before it is a variable": ("y = LAST\n    LAST = 2", "LAST"),
    "variable added to at first": ("y += 1.0", "y"),
    "deleted variable": ("del x", "del x"),
    "global variable": ("global LAST\n    LAST = 3", "global LAST"),
    "what is thrown away, read": ("for _ in range(n):\n        x += _", "_"),
    "walrus": ("y = (z := x) + 1.0", "(z := x)"),
    "several targets": ("y = z = x", "y = z = x"),
    "annotated variable": ("y: float = x", "y: float = x"),
    "starred target": ("y, *z = (x, x, x)", "*z"),
    "too few targets": ("y, z = (x, x, x)", "(y, z)"),
    "an array's numbers": ("y, z, a = row", "(y, z, a)"),
    "expression alone": ("x + 1.0", "x + 1.0"),
    "loop over an array": ("for y in row:\n        x += y", "for y in row:"),
    "loop over a tuple": ("for y in (x, x):\n        x += y", "for y in (x, x):"),
    "loop over pairs": ("for k, y in enumerate(row):\n        x += y", "for k, y in enumerate(row):"),
    "loop over another range": ("for k in range(3):\n        x += k\n    range = 3", "for k in range(3):"),
    "loop to a float": ("for k in range(x):\n        n = k", "range(x)"),
    "loop by a variable step": ("for k in range(0, 9, n):\n        x += k", "range(0, 9, n)"),
    "loop by zero": ("for k in range(0, 9, 0):\n        x += k", "range(0, 9, 0)"),
    "loop by a float": ("for k in range(0, 9, 1.0):\n        x += k", "range(0, 9, 1.0)"),
    "loop of four": ("for k in range(0, 9, 1, 1):\n        x += k", "range(0, 9, 1, 1)"),
    "loop of nothing": ("for k in range():\n        x += k", "range()"),
    "loop with else": (
        "for k in range(3):\n        x += k\n    else:\n        x = 0.0",
        "for k in range(3):",
    ),
    "while with else": ("while x > 0.0:\n        x -= 1.0\n    else:\n        x = 1.0", "while x > 0.0:"),
    "loop's variable in an array": ("for row[0] in range(3):\n        x += 1.0", "for row[0] in range(3):"),
    "try": ("try:\n        x = 1.0\n    except ValueError:\n        x = 2.0", "try:"),
    "with": ("with x:\n        x = 1.0", "with x:"),
    "raise": ("raise ValueError", "raise ValueError"),
    "assert": ("assert x > 0.0", "assert x > 0.0"),
    "import": ("import os", "import os"),
    "match": ("match n:\n        case 1:\n            x = 1.0", "match n:"),
    "function within": ("def g():\n        return 1.0", "def g():"),
    "class within": ("class G:\n        pass", "class G:"),
    "lambda": ("y = lambda: x", "lambda: x"),
    "yield": ("yield x", "yield x"),
    "return of an array": ("return row", "return row"),
    "return of a tuple with an array": ("return x, row", "return (x, row)"),
    "return of tuples in a tuple": ("return (x, x), x", "return ((x, x), x)"),
    "return of unlike kinds": ("if x > 0.0:\n        return 1\n    return x", "return x"),
    "return of nothing and of a number": ("if x > 0.0:\n        return 1.0\n    return", "return"),
    "end without a return": ("if x > 0.0:\n        return 1.0\n    x = 2.0", "x = 2.0"),
}
"""Bodies of a function of x, n, row and table, and what a refusal shows of it."""
MODULE = """\
import math
import numpy as np
from statics.kernels.calling import run
HUGE, LAST, LIST, TABLE = 2**63, -1, [1.0], np.ones(3)

def plain(x: float):
    return x

@compiled
def helper(x: float):
    return x

@compiled
def defaulted(x: float, n: int = 1):
    return x

@compiled
def nothing(x: float):
    pass

@compiled
def several(*x):
    return 1.0

@compiled
def refused(x: float):
    return x // 2.0

@compiled
def round_about(x: float):
    return and_back(x)

@compiled
def and_back(x: float):
    return round_about(x - 1.0)

@compiled
def ever(pair):
    return ever((pair, 1.0))

@compiled
def f(x: float, n: int, row, table):
    """


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_of_the_subset_is_refused_by_name(tmp_path: Path, name: str) -> None:
    """With the file and the line."""
    body, shown = REFUSED[name]
    function = defined(f"{MODULE}{body}\n", tmp_path)
    with pytest.raises(LoweringError, match=r"^made_\d+\.py, line \d+: '") as error:
        function(1.0, 2, np.ones(3), np.ones((3, 2)))
    assert shown in str(error.value)


WHOLE_FUNCTIONS = {
    "more arguments": "def f(x, *others):\n    return x",
    "more named arguments": "def f(x, **others):\n    return x",
    "arguments by name only": "def f(x, *, y=1.0):\n    return x",
    "a generator": "def f(x):\n    yield x\n    return x",
    "a coroutine": "async def f(x):\n    return x",
    "no name": "f = lambda x: x",
    "another decorator": "def other(f):\n    def h(x):\n        return f(x)\n    return h\n\n"
    "@other\ndef f(x):\n    return x",
    "variables of another function": "def made(y):\n    def f(x):\n        return x + y\n    return f\n\n"
    "f = made(1.0)",
    "many parts": f"def f(x):\n    return {' + '.join(['x'] * 1500)}",
    "parts within each other": f"def f(x):\n    return {'-(' * 150}x{')' * 150} + {' + '.join(['x'] * 900)}",
}
"""Functions that are refused as a whole."""


@pytest.mark.parametrize("name", WHOLE_FUNCTIONS)
def test_functions_of_other_sorts_are_refused(tmp_path: Path, name: str) -> None:
    function = defined(f"{WHOLE_FUNCTIONS[name]}\n\nf = compiled(f)\n", tmp_path)
    with pytest.raises(LoweringError, match=r"^made_0\.py, line \d+: '"):
        function(1.0)


def test_functions_that_stand_in_no_file_are_refused(tmp_path: Path) -> None:
    """Or no longer."""
    module: dict[str, Any] = {"compiled": compiled}
    exec(compile("@compiled\ndef f(x):\n    return x\n", "<input>", "exec"), module)
    with pytest.raises(LoweringError, match="'f' is not a function found in that file"):
        lower_function(module["f"].python, [FLOAT])
    function = defined("\n@compiled\ndef f(x):\n    return x\n", tmp_path)
    (tmp_path / "made_0.py").write_text("\n@compiled\ndef g(x):\n    return -x\n")
    with pytest.raises(LoweringError, match="'f' is not a function found in that file"):
        function(1.0)


@compiled
def typed(
    x: float, n: int, sure: bool, row: np.ndarray, flat: c.Flat
) -> tuple[float, int, bool, float, float]:
    """A parameter of every sort."""
    return x + n, n * flat.n, sure and flat.sure, row[0], flat.x


FLAT: Any = c.Flat
RIGHT: Any = (0.5, 2, True, np.ones(2), FLAT(3, 0.25, True))
PAST_64_BITS = 2**63


@pytest.mark.parametrize(
    ("at", "value"),
    [
        (0, np.float64(2.5)),
        (0, np.float32(2.5)),
        (0, 3),
        (0, np.int64(3)),
        (1, np.int32(3)),
        (1, True),
        (3, np.array([2.0, 1.0, 0.0])),
        (3, np.asfortranarray(np.array([2.0, 1.0]))),
        (4, FLAT(np.int64(3), np.float64(0.5), False)),
        (4, FLAT(3, 1, False)),
    ],
)
def test_other_right_arguments(at: int, value: Any) -> None:
    arguments = [*RIGHT[:at], value, *RIGHT[at + 1 :]]
    assert typed(*arguments) == typed.python(*arguments)


@pytest.mark.parametrize(
    ("at", "value"),
    [
        (0, "1.0"),
        (0, None),
        (0, 1j),
        (0, np.ones(2)),
        (0, (1.0,)),
        (0, FLAT(3, 0.5, True)),
        (0, 10**400),
        (1, 2.0),
        (1, np.float64(2.0)),
        (1, PAST_64_BITS),
        (1, -PAST_64_BITS - 1),
        (1, None),
        (2, 1),
        (2, np.True_),
        (2, None),
        (3, [1.0, 2.0]),
        (3, None),
        (3, "row"),
        (3, {1.0: 2.0}),
        (3, np.ones(2, np.float32)),
        (3, np.ones(2, int)),
        (3, np.ones(2, bool)),
        (3, np.ones(2, complex)),
        (3, np.ones(2, object)),
        (3, np.ones(2, ">f8")),
        (3, np.ones(4)[::2]),
        (3, np.ones(4)[::-1]),
        (3, np.ones((3, 2)).T),
        (3, np.asfortranarray(np.ones((3, 2)))),
        (3, np.ma.ones(2)),
        (3, memoryview(bytes(16))),
        (4, FLAT(3.0, 0.25, True)),
        (4, FLAT(3, "x", True)),
        (4, FLAT(3, np.ones(2), True)),
        (4, FLAT(PAST_64_BITS, 0.5, True)),
        (4, (3, [0.25], True)),
    ],
)
def test_wrong_arguments_are_refused_with_words(at: int, value: Any) -> None:
    with pytest.raises((TypeError, ValueError), match=r"takes") as error:
        typed(*RIGHT[:at], value, *RIGHT[at + 1 :])
    assert not isinstance(error.value, LoweringError)


@pytest.mark.parametrize("count", range(5))
def test_too_few_arguments_are_refused_with_words(count: int) -> None:
    with pytest.raises(TypeError, match=f"typed takes 5 arguments, not {count}"):
        typed(*RIGHT[:count])
    with pytest.raises(TypeError, match="typed takes 5 arguments, not 6"):
        typed(*RIGHT, *RIGHT[:1])
    with pytest.raises(TypeError, match="unexpected keyword"):
        typed(*RIGHT[:4], flat=RIGHT[4])  # pyright: ignore[reportCallIssue]


@pytest.mark.parametrize(
    "array", [np.empty(0), np.empty((0, 3)), np.empty((3, 0)), np.ones((1, 3)).T, np.ones((3, 1))[:, ::2]]
)
def test_arrays_that_are_empty_or_of_one_column(tmp_path: Path, array: np.ndarray) -> None:
    """Their strides say little."""
    function = defined("@compiled\ndef f(array):\n    return array.size, len(array)\n", tmp_path)
    assert_same(function, array)


def test_arrays_that_are_only_to_be_read_are_read() -> None:
    row = np.arange(1.0, 3.0)
    row.setflags(write=False)
    assert typed(0.5, 2, True, row, RIGHT[4]) == (2.5, 6, True, 1.0, 0.25)


def test_functions_of_the_same_name_in_a_file_are_told_apart(tmp_path: Path) -> None:
    """Both are kept."""
    text = "@compiled\ndef f(x):\n    return x\n\ng = f\n\n@compiled\ndef f(x):\n    return -x\n"
    text += "\nfirst, second = g(1.0), f(1.0)\n\ndef f():\n    return first, second\n"
    assert defined(text, tmp_path)() == (1.0, -1.0)


def test_functions_of_some_arguments_bound() -> None:
    """Arrays among them are seen as they are at the call, and kept."""
    row = np.ones(2)
    bound = typed.bind(*RIGHT[:3], row)
    row[0] = 7.0
    for _ in range(2):
        assert bound(RIGHT[4]) == typed(*RIGHT[:3], row, RIGHT[4])
    with pytest.raises(TypeError, match="typed takes 5 arguments, not 4"):
        bound()
    with pytest.raises(TypeError, match="takes numbers as annotated"):
        bound(FLAT(3, "x", True))
    alive = weakref.ref(row)
    del row
    assert alive() is not None


def test_kinds_are_told_in_words() -> None:
    """What a parameter takes, and what it is given."""
    with pytest.raises(TypeError, match="takes a float as 'x', not an array with 2 axes"):
        typed(np.ones((2, 2)), *RIGHT[1:])
    with pytest.raises(LoweringError, match="a bool"):
        lower_function(c.assigned_in_arms.python, [BOOL])
    with pytest.raises(LoweringError, match="an array with 2 axes"):
        lower_function(c.untold.python, [ArrayKind(2), INT, BOOL])
