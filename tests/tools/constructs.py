"""Functions of every construct that can be compiled; ``test_functions.py`` holds them against Python."""

import math
from math import atan2 as arc
from typing import NamedTuple

import numpy as np

from statics.kernels.compiled import compiled

COUNT, SHARE, YES, LAST = 3, 0.1, True, -1
BIG = 2**62


class Flat(NamedTuple):
    """A named tuple of numbers."""

    n: int
    x: float
    sure: bool


class Mixed(NamedTuple):
    """A named tuple of other things too."""

    row: np.ndarray
    pair: tuple[float, int]
    flat: Flat


@compiled
def loops(n: int, m: int) -> tuple[int, int, int, int, int]:
    """Loops of one, two and three arguments, within each other."""
    one, two, down, up, grid = 0, 0, 0, 0, 0
    for i in range(n):
        one = 3 * one + i
    for i in range(m, n):
        two = 3 * two + i
    for i in range(n, m, -2):
        down = 3 * down + i
    for i in range(m, n, COUNT):
        up = 3 * up + i
    for i in range(n):
        for j in range(i, m):
            if (i + j) % 2 == 0:
                continue
            if j > 5:
                break
            grid += i * j
    return one, two, down, up, grid


@compiled
def after_loop(n: int) -> tuple[int, int, int]:
    """What a loop's variable is afterwards, and that assignments to it change no iteration."""
    i, turns, j = 7, 0, 11
    for i in range(n):
        turns += 1
        i += 10
        i *= 2
    for j in range(n, 0, -1):
        j = j * j
    return i, turns, j


@compiled
def bound_changes(n: int) -> int:
    """The range is made once."""
    turns = 0
    for _ in range(n):
        n += 1
        turns += 1
    return turns + n


@compiled
def collatz(n: int) -> tuple[int, int]:
    """A loop without end that returns."""
    steps = 0
    while True:
        if n <= 1:
            return steps, n
        if n % 2 == 0:
            n //= 2
            steps += 1
            continue
        n = 3 * n + 1
        steps += 1


@compiled
def broken(n: int) -> int:
    """A loop without end that breaks, around one that breaks."""
    total = 0
    while True:
        for k in range(n):
            if k == 3:
                break
            total += k
        total += 1
        if total > 20:
            break
    return total


@compiled
def never(n: int) -> int:
    """Loops and arms that are never entered."""
    while False:
        n += 1
    if False:
        n += 2
    while n < 0:
        n = 0
    pass
    return n


@compiled
def tested(n: int, m: int) -> int:
    """A test of several parts, computed anew at every turn."""
    while n < m and (n % 7 != 0 or n == 0):
        n += 1
    return n


@compiled
def arms(x: float) -> int:
    """Returns in all arms."""
    if x < -1.0:
        return -2
    elif x < 0.0:
        return -1
    elif x == 0.0:
        return 0
    else:
        if x > 1.0:
            return 2
        return 1


@compiled
def assigned_in_arms(x: float) -> float:
    """A variable that is first assigned in an arm."""
    if x > 0.0:
        y = x
    else:
        y = -x
    return y + 1.0


@compiled
def guarded(row: np.ndarray, at: int) -> bool:
    """The second operand is not computed, which would read anywhere, or store."""
    return 0 <= at and at < len(row) and row[at] > 0.0


@compiled
def guarded_or(row: np.ndarray, at: int) -> bool:
    """The same with ``or``."""
    return at < 0 or at >= row.shape[0] or row[at] > 0.0 or not row[at] < 0.0


@compiled
def guarded_choice(row: np.ndarray, at: int) -> float:
    """The same with a conditional expression."""
    return row[at] if 0 <= at and at < row.size else (-1.0 if at < 0 else math.inf)


@compiled
def mark(row: np.ndarray, at: int) -> bool:
    """Count a call."""
    row[at] += 1.0
    return row[at] > 1.0


@compiled
def marked(row: np.ndarray) -> tuple[bool, bool, bool]:
    """What is computed, and how often."""
    return mark(row, 0) and mark(row, 1), mark(row, 2) or mark(row, 3), mark(row, 0) if mark(row, 1) else True


@compiled
def index(row: np.ndarray) -> int:
    """An index that depends on how often it is asked for."""
    row[0] += 1.0
    return int(row[0])


@compiled
def changed_once(row: np.ndarray) -> None:
    """An element's place is computed once."""
    row[0] = 0.0
    row[index(row)] += 2.5
    row[index(row)] *= row[1]
    row[3], row[index(row)] = row[2] - 1.0, 7.0


@compiled
def swaps(a: float, b: float, row: np.ndarray) -> tuple[float, float]:
    """Assignments of several."""
    a, b = b, a
    row[0], row[1] = row[1], row[0]
    (a, n), b = (b, 2), a
    n, row[n] = 1, a
    row[n], n = b, 0
    return a, b + n


@compiled
def changes(x: float, n: int, table: np.ndarray) -> tuple[float, int]:
    """Augmented assignments, to parameters among others."""
    x += n
    x -= 0.1
    x *= 3
    x /= 7.0
    n += 5
    n -= 9
    n *= n
    n //= 4
    n %= 7
    x **= 2
    table[0, 1] += x
    table[1, 0] -= n
    table[1, 1] *= 2
    table[0, 0] /= 3
    table[1, 2] **= 2
    return x, n


@compiled
def views(cube: np.ndarray, a: int, b: int) -> tuple[float, int, int, int, int, int]:
    """Views of an array of three axes, written to."""
    plane = cube[a]
    row, some, head, tail = plane[b], cube[a:b], cube[a, :b], plane[a:]
    flat = cube.reshape(cube.size)
    flat[0] = 100.0
    wide = cube.reshape((cube.shape[0], cube.shape[1] * cube.shape[2]))
    wide[1, 2] = 200.0
    row[1] = plane[b, 0] + 1.0
    cube[a, b][2] = 300.0
    cube[a][b, 3] = cube[a, b, 1]
    part = flat[2:7][1:][:3]
    part[0], part[len(part) - 1] = -1.0, -2.0
    for i in range(len(some)):
        some[i, 0, 0] += 0.5
    for i in range(len(head)):
        head[i, 0] += 0.25
    tail[0, 1] -= 4.0
    _, rows, columns = cube.shape
    again = cube[:]
    return again[a, b, 0], rows, columns, len(tail) + head.size, plane.shape[1], len(some)


@compiled
def no_axes(single: np.ndarray) -> int:
    """An array without axes."""
    single[()] = single[()] * 2.0
    single[()] += 1.0
    return single.size


@compiled
def workspaces(n: int, x: float) -> tuple[float, float, int]:
    """Arrays that end with the function, whichever return it takes."""
    if n == 0:
        return 0.0, x, n
    line, plane, cube = np.empty(n), np.zeros((n, 2)), np.empty((n, 2, COUNT))
    total = 0.0
    for i in range(n):
        line[i] = x + i
        for k in range(2):
            total += plane[i, k]
            plane[i, k] = line[i] * k
            for m in range(COUNT):
                cube[i, k, m] = plane[i, k] + m
    if x > 0.0:
        late = np.zeros(n)
        late[0] = 1.0
        return total + late[0], cube[n - 1, 1, 2], cube.size
    return total, filled(np.empty(n), x), len(line)


@compiled
def filled(row: np.ndarray, x: float) -> float:
    """The sum of a row that is set to x."""
    total = 0.0
    for i in range(len(row)):
        row[i] = x
        total += row[i]
    return total


@compiled
def constants(x: float, n: int) -> tuple[float, int, bool, float, int, float]:
    """Numbers of the module and of ``math``."""
    return x * SHARE + math.pi, n + COUNT, YES and n > 0, -math.inf, BIG - n, x + arc(x, math.e)


@compiled
def nothing(row: np.ndarray, n: int) -> None:
    """Return early, or at the end."""
    if n < 0:
        return
    if n == 0:
        return None
    row[0] = n


@compiled
def numbers(x: float, n: int) -> tuple[float, int, bool, bool]:
    """Several results."""
    return x + n, n - 1, x > n, n == 0


@compiled
def fixed() -> float:
    """Without parameters."""
    return SHARE


@compiled
def empty(nothing: tuple[()]) -> tuple[()]:
    """A tuple of nothing, given and returned."""
    return nothing


@compiled
def single(x: float) -> tuple[float]:
    """A tuple of one."""
    return (x,)


@compiled
def calls(x: float, n: int, row: np.ndarray) -> tuple[float, int, bool, float, float]:
    """Calls of all sorts of functions; an integer becomes a float."""
    nothing(row, n)
    nothing(row[1:], -1)
    y, m, above, zero = numbers(n, n)
    found = numbers(x, m)
    numbers(x, 1)
    (z,) = single(numbers(y, m)[0])
    empty(())
    z += fixed()
    return (
        y + found[0],
        m + found[1],
        (above or zero) and not found[3],
        z,
        assigned_in_arms(assigned_in_arms(n)),
    )


@compiled
def tuples(
    flat: Flat, mixed: Mixed, plain: tuple[tuple[int, float], np.ndarray, bool], n: int
) -> tuple[float, int, bool, float, int]:
    """Tuples that hold others."""
    (k, y), row, sure = plain
    own = (row, (flat, n))
    flat = mixed.flat
    own[0][1] = mixed.pair[0] + own[1][0].x + y
    mixed.row[mixed.pair[1]] = own[1][1]
    return total_of(own[1]), flat.n + k, sure and mixed[2].sure, mixed.flat.x, mixed.flat[0]


@compiled
def total_of(pair: tuple[Flat, int]) -> float:
    """Of the parts of a tuple within a tuple."""
    flat, n = pair
    return flat.x * n + flat.n


@compiled
def entry(results: float, i1: int, entry: np.ndarray, define: float, v1: float, größe: int) -> float:
    """Names that LLVM has too, or could not read."""
    ret, double, b1, p0, s1 = results, i1, 0, define, v1
    for undef in range(2):
        b1 += undef
    entry[0] = double + größe
    return ret + double + b1 + p0 * s1 + pow(results)


@compiled
def pow(x: float) -> float:
    """Named as a function of the library."""
    return x * x


@compiled
def hides(max: float, COUNT: int, np: float, math: int) -> float:
    """Parameters that hide names of the module."""
    len = COUNT + math
    return max + len + np


@compiled
def deep(x: float, y: float) -> float:
    """An expression of many parts."""
    return ((x + y) * (x - y) + ((x * x - y * y) * (x + 1.0) - (y - 2.0) * (x - (y - (x - (y - 1.0)))))) * (
        ((((((((x + 1.0) * x + 2.0) * x + 3.0) * x + 4.0) * x + 5.0) * x + 6.0) * x + 7.0) * x) + 8.0
    ) - (x if (x if x > y else y) > (y if x > 0.0 else 1.0) else (y if not (x < 0.0 or y < 0.0) else x - y))


@compiled
def untold(x, n, sure):
    """Parameters without annotations are seen by their values."""
    return x * n, n, not sure


@compiled
def endless(n: int) -> None:
    """Without any return."""
    while True:
        n += 1
