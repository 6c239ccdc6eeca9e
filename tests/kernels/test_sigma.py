"""sigma_n: compiled and symbolic forms against multi-precision, through zero and beyond the series."""

import math
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from statics.derivation.sigma import Sigma, ladder_source

ORDERS = (1, 2, 3)


def ladder(order: int) -> Any:
    """The generated function, interpreted."""
    namespace: dict[str, Any] = {"math": math}
    exec(ladder_source(order), namespace)
    return namespace[f"sigma_ladder_{order}"]


def exact(n: int, x: float) -> float:
    """j_n(x) / x^n in 60 digits; DLMF 10.47.3."""
    with mpmath.workdps(60):
        z = mpmath.mpf(x)
        if n == -1:
            return float(mpmath.cos(z))
        if z == 0:
            return float(1 / mpmath.fac2(2 * n + 1))
        return float(mpmath.sqrt(mpmath.pi / (2 * z)) * mpmath.besselj(n + mpmath.mpf(1) / 2, z) / z**n)


@pytest.mark.parametrize("order", ORDERS)
@given(x=st.floats(-12.0, 12.0))
def test_ladder_equals_spherical_bessel_functions(order: int, x: float) -> None:
    found = ladder(order)(x)
    expected = [exact(n, abs(x)) for n in range(-1, order + 1)]
    np.testing.assert_allclose(found, expected, atol=1e-15, rtol=2e-15)


@pytest.mark.parametrize(
    "x", [0.0, 1e-300, -1e-300, 1e-160, 1e-8, -1e-8, 2.0, -2.0, math.nextafter(2.0, 3.0)]
)
def test_ladder_is_smooth_through_straight_and_over_its_seam(x: float) -> None:
    np.testing.assert_allclose(ladder(3)(x), [exact(n, abs(x)) for n in range(-1, 4)], rtol=2e-15)


def test_derivative_of_each_rung_is_the_next() -> None:
    x = sp.Symbol("x", real=True)
    closed = {-1: sp.cos(x), 0: sp.sin(x) / x}
    closed[1] = sp.simplify((closed[0] - closed[-1]) / x**2)
    for n in (-1, 0):
        symbolic = Sigma(n, x).diff(x).replace(Sigma, lambda order, _: closed[int(order)])
        assert sp.simplify(symbolic - closed[n].diff(x)) == 0
