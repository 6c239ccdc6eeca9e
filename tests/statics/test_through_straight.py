"""Through straight and round several turns: values, first and second derivatives against many digits.

The program's are those of its kernels: the potential of an arm without stiffness is, up to its sign, what
the one unit load that it is under works along, so the residual and the Newton matrix hold the derivatives.
"""

from typing import Any

import mpmath
import numpy as np
import pytest

from statics import Arm, Bending, Cable, Cables, DiskLoad, DiskLoads, Extension, Scene, StaticSolver

CURVATURES = [0.0, *(sign * 10.0**power for power in (-300, -160, -8, -2, 0, 1, 2, 3) for sign in (1, -1))]
"""1/m; the last ones bend a segment of 20 mm by 20 rad, three turns."""
LENGTH, OFFSET, STRETCH = 0.02, 0.008, 3e-4
TINY = 1e-200
"""Its square is zero: no stiffness at all."""
STIFFNESS = 0.1
"""N m, as large as what a unit load adds to the matrix of an arm, which may be singular without any."""


def scene(disks: int, load: str, stiffness: float = 0.0) -> Scene:
    """An arm under one unit load; ``stiffness`` is EJ / L0 in N m and, times L0^2, EA / L0."""
    force = {"x": (1.0, 0.0), "y": (0.0, 1.0)}.get(load, (0.0, 0.0))
    cables = (Cable("one", OFFSET),) if load == "cable" else ()
    modulus, area, second = (1.0, stiffness / LENGTH, stiffness * LENGTH) if stiffness else (TINY, TINY, TINY)
    arm = Arm(disks, LENGTH, modulus, area, second, cables=cables)
    works = Cables() if load == "cable" else DiskLoads((DiskLoad(disks, force, float(load == "theta")),))
    return Scene(arm, (Bending(), Extension(), works))


def segment(load: str, bend: Any, stretch: Any) -> Any:
    """What a load works along on one segment, in mpmath's digits. Rone 2012, Eq. 11 and 23."""
    length = LENGTH + stretch
    k = bend / length
    if load == "theta":
        return bend
    if load == "cable":
        return 2 * (1 / k - mpmath.mpf(OFFSET)) * mpmath.sin(bend / 2)
    return mpmath.sin(bend) / k if load == "x" else (1 - mpmath.cos(bend)) / k


def tip(load: str, bends: Any, stretches: Any) -> Any:
    """The same of a whole arm's tip, and of its cable's length."""
    if load in ("theta", "cable"):
        return mpmath.fsum(segment(load, *each) for each in zip(bends, stretches, strict=True))
    place, turn = mpmath.mpc(0), mpmath.mpc(1)
    for each in zip(bends, stretches, strict=True):
        place += turn * mpmath.mpc(segment("x", *each), segment("y", *each))
        turn *= mpmath.expj(each[0])
    return place.real if load == "x" else place.imag


def derivatives(load: str, bend: float, stretch: float) -> dict[str, float]:
    """Value and derivatives by bend angle p and elongation e, in as many digits as it takes."""
    with mpmath.workdps(1000):
        at = mpmath.mpf(bend) or mpmath.mpf("1e-400"), mpmath.mpf(stretch)
        orders = {"": (0, 0), "p": (1, 0), "e": (0, 1), "pp": (2, 0), "pe": (1, 1), "ee": (0, 2)}
        return {
            name: float(
                mpmath.diff(lambda p, e: segment(load, p, e), at, order) if name else segment(load, *at)
            )
            for name, order in orders.items()
        }


class Swept:
    """What the kernel's passes leave at coordinates q, shape (segments, 2)."""

    def __init__(self, load: str, q: np.ndarray, stiffness: float = 0.0) -> None:
        self.solver = StaticSolver(scene(len(q), load, stiffness))
        self.sign = 1.0 if load == "cable" else -1.0
        kernel, (segments, disks) = self.solver.kernel, (self.solver.segments, self.solver.disks)
        self.inputs = np.ones(1) if load == "cable" else np.empty(0)
        chain, self.pivots = (
            np.empty((len(q), kernel.widths["chain"])),
            np.empty((len(q), kernel.widths["pivots"])),
        )
        self.residual, descent, self.change = np.empty_like(q), np.empty_like(q), np.empty_like(q)
        posed = kernel.run("pose", q, self.inputs, segments, disks, chain)
        self.potential = self.sign * posed["potential"]
        kernel.run("residual", disks, chain, self.residual)
        inward = segments, disks, chain, self.residual, descent, self.pivots
        kernel.run("eliminate", *inward, keep_sign=1.0)
        kernel.run("substitute", chain, descent, self.change)

    @property
    def of_one_segment(self) -> dict[str, float]:
        """Likewise named: the first pivot is the whole matrix."""
        numbers = [*self.residual[0], *self.pivots[0]]
        signed = [self.potential, *(self.sign * number for number in numbers)]
        return dict(zip(("", "p", "e", "pp", "pe", "ee"), signed, strict=True))


@pytest.mark.parametrize("curvature", CURVATURES)
def test_segment_and_its_derivatives_are_right_to_1e_14_of_the_largest_of_their_group(
    curvature: float,
) -> None:
    bend = curvature * (LENGTH + STRETCH)
    for group in (("x", "y"), ("theta",), ("cable",)):
        found = [Swept(load, np.array([[bend, STRETCH]])).of_one_segment for load in group]
        exact = [derivatives(load, bend, STRETCH) for load in group]
        for name in exact[0]:
            largest = max(abs(of_load[name]) for of_load in exact)
            for of_kernel, of_load in zip(found, exact, strict=True):
                assert abs(of_kernel[name] - of_load[name]) <= 1e-14 * largest


WOUND = [
    [0.0, 1e-300, -1e-300, 1e-8, -1e-8, 0.0],
    [100.0, -100.0, 300.0, -300.0, 1e3, -1e3],
    [250.0, 250.0, 250.0, 250.0, 250.0, 250.0],
    [1e3, 0.0, -1e-300, 50.0, -1e3, 1e-8],
]
"""Curvatures (1/m): straight; alternating; one way, nearly five turns; all at once."""


@pytest.mark.parametrize("curvatures", WOUND)
@pytest.mark.parametrize(
    "load", ["cable", *(pytest.param(load, marks=pytest.mark.slow) for load in ("x", "y"))]
)
def test_whole_arm_and_its_derivatives_are_right_to_1e_14_of_the_largest(
    load: str, curvatures: list[float]
) -> None:
    """The matrix by what the elimination makes of it: H dq = -r holds to that of the largest of |H| |dq|."""
    q = np.column_stack([(LENGTH + STRETCH) * np.array(curvatures), np.full(len(curvatures), STRETCH)])
    swept = Swept(load, q)
    value, slopes, matrix = exactly(load, q)
    reach = len(q) * LENGTH
    assert abs(swept.potential - value) <= 1e-14 * reach
    off = swept.sign * swept.residual.ravel() - slopes
    for part in (slice(0, None, 2), slice(1, None, 2)):  # by bend angles, by elongations
        assert np.abs(off[part]).max() <= 1e-14 * max(np.abs(slopes[part]).max(), reach)
    unit = np.tile([1.0, LENGTH], len(q))
    stiff = Swept(load, q, STIFFNESS)
    matrix = unit[:, None] * (stiff.sign * matrix) * unit + STIFFNESS * np.eye(q.size)
    change, residual = stiff.change.ravel() / unit, unit * stiff.residual.ravel()
    sizes = np.abs(matrix) @ np.abs(change)
    assert np.abs(matrix @ change + residual).max() <= 1e-14 * sizes.max()


def exactly(load: str, q: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Value, slopes and matrix of a whole arm in 200 digits."""
    with mpmath.workdps(200):
        step = mpmath.mpf("1e-40")
        flat = [mpmath.mpf(value) for value in q.ravel()]
        flat[::2] = [bend or mpmath.mpf("1e-30") for bend in flat[::2]]

        def at(*moved: tuple[int, int]) -> Any:
            there = list(flat)
            for number, _ in moved:
                there[number] = flat[number] + step * sum(steps for other, steps in moved if other == number)
            return tip(load, there[::2], there[1::2])

        numbers = range(len(flat))
        slopes = np.array([float((at((i, 1)) - at((i, -1))) / (2 * step)) for i in numbers])
        matrix = np.zeros((len(flat), len(flat)))
        for i in numbers:
            for j in range(i + 1):
                corners = (
                    at((i, 1), (j, 1)) - at((i, 1), (j, -1)) - at((i, -1), (j, 1)) + at((i, -1), (j, -1))
                )
                matrix[i, j] = matrix[j, i] = float(corners / (4 * step**2))
        return float(at()), slopes, matrix
