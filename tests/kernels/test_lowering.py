"""Text of steps lowered to machine code: every construct gives the interpreter's own bits, in every lane."""

import ast
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENARIOS
from hypothesis import given
from hypothesis import strategies as st

from continuum_dyn import load_scenario
from statics.arm import Arm
from statics.kernels import calling
from statics.kernels.compiled import compiled
from statics.kernels.loading import Kernel, load, run_interpreted
from statics.kernels.lowering import LoweringError, PassSignature, lower
from statics.kernels.machine_code import MachineCode, compile_text
from statics.kernels.slots import SCALARS, SLOTS
from statics.passes.rest_passes import REST
from statics.scene import Scene

assert Path(lower.__code__.co_filename).parents[2] == Path(__file__).parents[2]

N = 3
NUMBERS = st.lists(st.floats(-1e6, 1e6), min_size=2 * N, max_size=2 * N)

POWERFUL = st.floats(1e-6, 1e6)
"""Python's own numbers, which a root returns, are not divided by zero."""

EXPRESSIONS = (
    "x",
    "-x",
    "2",
    "0.1*x + y",
    "x - y - 0.3",
    "x*y*x",
    "x/y",
    "1/3*x/(y*y + 1.0)",
    "min(x, y)",
    "max(x, y)",
    "min(x, y, 0.5)",
    "max(0, y, x)",
    "abs(x)",
    "math.fabs(y)",
    "math.sqrt(abs(x))",
    "math.sin(x)",
    "math.cos(y)",
    "math.sin(x)*math.cos(x)",
    "math.tanh(x)",
    "math.exp(min(x, 700.0))",
    "math.log(abs(x) + 0.1)",
    "math.atan(x)",
    "math.atan2(x, y)",
    "(x if x > y else y*y)",
    "(1.0 if x < 0.0 else 0.0)",
    "(x if x >= y else 2.0)",
    "(x if x <= 0 else (y if y > x else -y))",
)
MULTIPLIED = {
    "x**0": "1.0",
    "x**1": "x",
    "x**2": "(x*x)",
    "x**3": "x*(x*x)",
    "x**4": "(x*x)*(x*x)",
    "x**5": "x*((x*x)*(x*x))",
    "x**6": "(x*x)*((x*x)*(x*x))",
    "x**(-1)": "1.0/x",
    "x**(-2)": "1.0/(x*x)",
    "x**(-3.0)": "1.0/(x*(x*x))",
    "abs(x)**0.5": "math.sqrt(abs(x))",
    "abs(x)**(1/2)": "math.sqrt(abs(x))",
    "abs(x)**(3/2)": "abs(x)*math.sqrt(abs(x))",
    "abs(x)**(-1/2)": "1.0/math.sqrt(abs(x))",
    "abs(x)**(-2.5)": "1.0/((abs(x)*abs(x))*math.sqrt(abs(x)))",
}
"""Powers, and the products that they are: the interpreter's own power is the library's, rounded once."""
FUNCTIONS = '''
def pivot(a, b):
    """One of two."""
    shift = a - b
    if a > b:
        first = a/(shift + 1.0)
        only = first*2.0
        second = only
    else:
        second = b*b
        first = shift
    return first, second + shift

def both(a):
    one, other = pivot(a, 0.25)
    if other < 1.0:
        one = one*3.0
    else:
        one = a
    return other, one

def single(a, b):
    """A single result, and a call within it."""
    first, second = pivot(a, b)
    return first - twice(second)

def twice(a):
    if a > 0.5:
        a = a + 1.0
    else:
        a = a - 1.0
    return 2.0*a

def again(a):
    return again(a - 1.0)

def there(a):
    return back(a)

def back(a):
    one, other = pivot(a, there(a))
    return one

def none(a):
    return
'''
CALLS = """
    p, r = pivot(x, y)
    s, t = both(p)
    s, t = t, s + r
    chain[i, 0] = p
    chain[i, 1] = r
    chain[i, 2] = s
    x = t
    chain[i, 3] = x
    y = chain[i, 3]
    chain[i, 3] = y + chain[i, 2]
    x = single(y, 2.0*twice(x))
    chain[i, 4] = x + (twice(y) if x > y else min(single(x, y), 1.0))
"""


def numbers_from(values: np.ndarray) -> np.ndarray:
    """Their bits; all that are not a number are alike."""
    return np.where(np.isnan(values), np.nan, values).view(np.int64)


class Steps:
    """A module of one pass, ``go``, over q (n, 2), chain (n, width) and inputs; lowered and interpreted.

    It carries two numbers from segment to segment, and is given one.
    """

    def __init__(self, body: str, width: int, direction: str = "outward", functions: str = "") -> None:
        self.width, self.direction = width, direction
        self.signature = PassSignature(
            direction, ("slowing",), ("largest", "clearance"), ("q", "inputs", "chain")
        )
        self.text = (
            f"import math\n\nINPUTS = ('tension',)\nCONSERVATIVE = True\nSEGMENT_COLUMNS = ()\n"
            f"DISK_COLUMNS = ()\nCHAIN_COLUMNS = ()\nWIDTHS = {{'q': 2, 'chain': {width}}}\n"
            f"PASSES = {{'go': {(direction, *list(vars(self.signature).values())[1:])!r}}}\n{functions}\n"
            "def go_start(inputs, segments, chain):\n    tension = inputs[0]\n    return 0.5*tension, 1.5\n\n"
            "def go_step(i, carried, given, q, inputs, chain):\n    largest, clearance = carried\n"
            f"    slowing, = given\n    x = q[i, 0]\n    y = q[i, 1]\n{body}\n"
            "    return largest + inputs[0]*x, max(clearance, y) - slowing\n"
        )

    @property
    def tree(self) -> ast.Module:
        """The module, parsed."""
        return ast.parse(self.text)

    @cache  # noqa: B019, lives as long as the tests
    def code(self, lanes: int = 1) -> MachineCode:
        """The pass, compiled."""
        text = lower(self.tree, {"go": self.signature}, {"q": 2, "chain": self.width}, SLOTS, lanes=lanes)
        return MachineCode(compile_text(text))

    def lowered(self, q: np.ndarray, given: float, lanes: int = 1) -> tuple[np.ndarray, np.ndarray]:
        """Results and chain; with lanes, they and ``q`` have them as the last axis."""
        last = () if lanes == 1 else (lanes,)
        scalars, chain = np.full((SCALARS, *last), np.nan), np.full((len(q), self.width, *last), np.nan)
        scalars[SLOTS["slowing"]] = given
        inputs = np.full((1, *last), 0.7)
        calling.run(self.code(lanes).address("go"), len(q), scalars, q, inputs, chain)
        return scalars[[SLOTS["largest"], SLOTS["clearance"]]], chain

    @cache  # noqa: B019
    def kernel(self) -> Kernel:
        """The pass, to be interpreted."""
        return Kernel(self.text, REST, lambda _: {"go": 0})

    def interpreted(self, q: np.ndarray, given: float) -> tuple[np.ndarray, np.ndarray]:
        """The same by the interpreter, for a single arm."""
        scalars, chain = np.full(SCALARS, np.nan), np.full((len(q), self.width), np.nan)
        scalars[SLOTS["slowing"]] = given
        arrays = {"q": q, "inputs": np.array([0.7]), "chain": chain}
        run_interpreted(self.kernel(), "go", len(q), scalars, arrays)
        return scalars[[SLOTS["largest"], SLOTS["clearance"]]], chain


@cache
def stored(*expressions: str, direction: str = "outward") -> Steps:
    """A pass that stores the values of expressions of x and y."""
    lines = [f"    chain[i, {k}] = {expression}" for k, expression in enumerate(expressions)]
    return Steps("\n".join(lines), len(expressions), direction)


CALLING = {direction: Steps(CALLS, 5, direction, FUNCTIONS) for direction in ("outward", "inward")}


def assert_same_bits(found: tuple[np.ndarray, ...], expected: tuple[np.ndarray, ...]) -> None:
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_array_equal(numbers_from(one), numbers_from(other))


@pytest.mark.parametrize("direction", ["outward", "inward"])
@given(numbers=NUMBERS, slowing=st.floats(-1e6, 1e6))
def test_every_expression_has_the_interpreters_bits(
    direction: str, numbers: list[float], slowing: float
) -> None:
    """And so have what is carried, what is given and what is returned, in passes of either direction."""
    q, steps = np.reshape(numbers, (N, 2)), stored(*EXPRESSIONS, direction=direction)
    assert_same_bits(steps.lowered(q, slowing), steps.interpreted(q, slowing))


@given(numbers=st.lists(POWERFUL | POWERFUL.map(float.__neg__), min_size=2 * N, max_size=2 * N))
def test_powers_have_the_bits_of_products_and_roots(numbers: list[float]) -> None:
    q = np.reshape(numbers, (N, 2))
    powers, products = stored(*MULTIPLIED), stored(*MULTIPLIED.values())
    assert_same_bits(powers.lowered(q, 0.0), products.interpreted(q, 0.0))


@given(numbers=st.lists(POWERFUL, min_size=2 * N, max_size=2 * N))
def test_powers_are_those_of_the_library_up_to_one_rounding_a_product(numbers: list[float]) -> None:
    """At most four of them, each of half a unit of the last place, and twice that where a part is squared."""
    q = np.reshape(numbers, (N, 2))
    steps = stored(*MULTIPLIED)
    np.testing.assert_array_max_ulp(steps.lowered(q, 0.0)[1], steps.interpreted(q, 0.0)[1], maxulp=5)


@given(numbers=NUMBERS)
def test_hypot_is_pythons_to_a_unit_in_the_last_place(numbers: list[float]) -> None:
    """Python's is its own, of any number of arguments, and rounds otherwise than the C library's."""
    q, steps = np.reshape(numbers, (N, 2)), stored("math.hypot(x, y)")
    np.testing.assert_array_max_ulp(steps.lowered(q, 0.0)[1], steps.interpreted(q, 0.0)[1], maxulp=1)


@pytest.mark.parametrize("direction", ["outward", "inward"])
@given(numbers=NUMBERS)
def test_calls_with_an_if_of_two_arms_and_several_results(direction: str, numbers: list[float]) -> None:
    q, steps = np.reshape(numbers, (N, 2)), CALLING[direction]
    assert_same_bits(steps.lowered(q, 0.1), steps.interpreted(q, 0.1))
    assert_same_bits(steps.lowered(q % 2.0, 0.1), steps.interpreted(q % 2.0, 0.1))


def test_a_pass_over_no_segment_returns_what_it_starts_with() -> None:
    found, _ = stored("x").lowered(np.empty((0, 2)), 0.0)
    assert found.tolist() == [0.35, 1.5]


@pytest.mark.parametrize("lanes", [4, 8])
@given(data=st.data())
def test_every_lane_of_every_construct_has_the_bits_of_a_single_arm(lanes: int, data: st.DataObject) -> None:
    many = st.lists(st.floats(-1e6, 1e6), min_size=2 * N * lanes, max_size=2 * N * lanes)
    q = np.reshape(data.draw(many), (N, 2, lanes))
    for steps in (stored(*EXPRESSIONS), stored(*MULTIPLIED), stored("math.hypot(x, y)"), *CALLING.values()):
        found = steps.lowered(q, 0.1, lanes)
        for lane in range(lanes):
            alone = steps.lowered(np.ascontiguousarray(q[..., lane]), 0.1)
            assert_same_bits(tuple(part[..., lane] for part in found), alone)


@pytest.mark.parametrize(
    ("body", "refused"),
    [
        ("    while x > 0:\n        x = x - 1", "while x > 0:"),
        ("    for k in range(3):\n        x = x + k", "for k in range"),
        ("    x = [x, y]", "'[x, y]'"),
        ("    x = unknown(y)", "'unknown(y)'"),
        ("    x, y = unknown(y)", "'unknown(y)'"),
        ("    x = math.gamma(y)", "'math.gamma(y)'"),
        ("    x = math.sin(x, y)", "'math.sin(x, y)'"),
        ("    x = math.sqrt(x, y)", "'math.sqrt(x, y)'"),
        ("    x = abs()", "'abs()'"),
        ("    x = max(x, y, key=abs)", "'max(x, y, key=abs)'"),
        ("    x, y = pivot(x)", "'pivot(x)'"),
        ("    x, y = pivot(x, b=y)", "'pivot(x, b=y)'"),
        ("    x, y, z = pivot(x, y)", "'(x, y, z)'"),
        ("    x = pivot(x, y)", "'pivot(x, y)'"),
        ("    x, y = twice(x)", "'twice(x)'"),
        ("    x = twice(x, y)", "'twice(x, y)'"),
        ("    x = twice()", "'twice()'"),
        ("    x = twice(a=x)", "'twice(a=x)'"),
        ("    x = none(x)", "returns nothing"),
        ("    x = again(x)", "'again(a - 1.0)' is a recursive call"),
        ("    x, y = pivot(x, back(y))", "'back(a)' is a recursive call"),
        ("    x = missing", "'missing'"),
        ("    x = i*y", "'i'"),
        ("    x = q*y", "'q'"),
        ("    x += y", "'x += y'"),
        ("    x = y = 1.0", "'x = y = 1.0'"),
        ("    x = x // y", "'x // y'"),
        ("    x = x if x == y else y", "'x == y'"),
        ("    x = x if x > y > 0 else y", "'x > y > 0'"),
        ("    x = x**y", "'y' as an exponent"),
        ("    x = x**0.3", "'0.3' as an exponent"),
        ("    x = x**65", "'65' as an exponent"),
        ("    x = q[i + 1, 0]", "'q[i + 1, 0]'"),
        ("    x = q[x, 0]", "'q[x, 0]'"),
        ("    x = q[i, 2]", "'q[i, 2]'"),
        ("    x = q[i, -1]", "'q[i, -1]'"),
        ("    x = q[0]", "'q[0]'"),
        ("    if x > y:\n        q[i, 0] = x\n    else:\n        y = x", "a branch of an if"),
    ],
)
def test_what_the_language_does_not_have_is_refused_by_name(body: str, refused: str) -> None:
    with pytest.raises(LoweringError) as error:
        Steps(body, 1, functions=FUNCTIONS).code()
    assert refused in str(error.value)


@pytest.fixture(scope="module")
def sixteen() -> Scene:
    """The scene of the step response at rest, of 16 segments."""
    scene = load_scenario(SCENARIOS / "step_response.toml").scene.at_rest
    disks = 16
    arm = Arm.preset("rone2012", disks=disks, disk_spacing=0.08 / disks, cables=scene.arm.cables)
    return Scene(arm, scene.effects)


def test_arrays_that_are_not_contiguous_are_refused() -> None:
    """Passes know no strides."""
    with pytest.raises(ValueError, match="contiguous"):
        stored("x").lowered(np.ones((2, N)).T, 0.0)

    @compiled
    def call(address: int, scalars: np.ndarray) -> None:
        calling.run(address, 1, scalars)

    with pytest.raises(ValueError, match="contiguous"):
        call(0, np.empty(2 * SCALARS)[::2])


@pytest.mark.parametrize("lanes", [4, 8])
def test_every_lane_of_a_scenes_passes_has_the_bits_of_a_single_arm(sixteen: Scene, lanes: int) -> None:
    kernel = load(sixteen.structure, REST)
    text = lower(kernel.tree, kernel.signatures, kernel.widths, SLOTS, lanes=lanes)
    code = MachineCode(compile_text(text))
    n, rng = sixteen.arm.segments, np.random.default_rng(0)
    tables = {
        "segments": sixteen.table("segment", kernel.segment_columns),
        "disks": sixteen.table("disk", kernel.disk_columns),
    }
    assert n == 16
    alone = [
        {
            "q": rng.uniform(-1.0, 1.0, (n, kernel.widths["q"])) * [0.1, 1e-6][: kernel.widths["q"]],
            "inputs": rng.uniform(0.5, 2.0, len(kernel.inputs)),
            **tables,
        }
        for _ in range(lanes)
    ]
    for arrays in alone:
        arrays |= {name: np.zeros((n, width)) for name, width in kernel.widths.items() if name not in arrays}
    together = {name: np.stack([arrays[name] for arrays in alone], axis=-1) for name in alone[0]}
    scalars = [np.zeros(SCALARS) for _ in range(lanes)]
    for each in scalars:
        each[[SLOTS["damping_weight"], SLOTS["stiffness_weight"], SLOTS["slowing"]]] = 0.0, 1.0, 0.5
        each[SLOTS["keep_sign"]] = rng.choice([0.0, 1.0])
    scalars_together = np.stack(scalars, axis=-1)
    for name in ("pose", "residual", "eliminate", "substitute"):
        signature = kernel.signatures[name]
        calling.run(code.address(name), n, scalars_together, *(together[array] for array in signature.arrays))
        for lane, arrays in enumerate(alone):
            own = [arrays[array] for array in signature.arrays]
            calling.run(kernel.addresses[name], n, scalars[lane], *own)
            for array in signature.arrays:
                assert_same_bits((together[array][..., lane],), (arrays[array],))
            assert_same_bits((scalars_together[:, lane],), (scalars[lane],))
    assert np.isfinite(together["change"]).all()
    assert (together["change"] != 0.0).any()
