"""The even entire functions sigma_n(x) = j_n(x) / x^n, j_n the spherical Bessel functions.

sigma_0 is sin(x)/x, sigma_{-1} is cos(x), and each is the derivative of the one before:

    sigma_n'(x) = -x sigma_{n+1}(x)                                            DLMF 10.51.3
    x^2 sigma_{n+1}(x) = (2n + 1) sigma_n(x) - sigma_{n-1}(x)                  DLMF 10.51.1

No formula divides by the curvature, so the straight arm needs no special case.
"""

from collections.abc import Sequence
from fractions import Fraction
from math import factorial, prod
from typing import Any

import sympy as sp
from sympy.core.function import ArgumentIndexError

SERIES_TERMS = 11
"""Number of terms of the power series used for |x| < 2; there they reach 5e-16."""


class Sigma(sp.Function):
    """Sigma function sigma_n(x) in sympy, ``Sigma(n, x)`` with n >= -1, never expanded."""

    nargs = 2

    def fdiff(self, argindex: int = 2) -> Any:
        """Derivative with respect to x. DLMF 10.51.3."""
        n, x = self.args
        if argindex != 2:
            raise ArgumentIndexError(self, argindex)
        return -x * Sigma(n + 1, x)


def series_coefficients(order: int) -> Sequence[float]:
    """Coefficients of sigma_order in powers of x^2, lowest first, shape (SERIES_TERMS,). DLMF 10.53.1."""
    return [
        float(Fraction((-1) ** k, 2**k * factorial(k) * prod(range(1, 2 * (order + k) + 2, 2))))
        for k in range(SERIES_TERMS)
    ]


def ladder_source(order: int) -> str:
    """Python source of ``sigma_ladder_<order>(x)``, which returns sigma_{-1}, ..., sigma_order at once.

    For |x| < 2 it takes the two highest from their series and the rest by the recurrence downwards, which is
    stable there; beyond, all upwards from sine and cosine. DLMF 10.51.1.
    """
    names = ["sigma_minus_1", *(f"sigma_{n}" for n in range(order + 1))]
    series = [f"        {names[n + 1]} = {_horner(series_coefficients(n))}" for n in (order, order - 1)]
    down = [
        f"        {names[n]} = {_times(2 * n + 1, names[n + 1])} - x2 * {names[n + 2]}"
        for n in range(order - 1, -1, -1)
    ]
    up = [
        f"        {names[n + 2]} = ({_times(2 * n + 1, names[n + 1])} - {names[n]}) / x2"
        for n in range(order)
    ]
    lines = [
        f"def sigma_ladder_{order}(x):",
        f'    """{", ".join(names)} at x."""',
        "    x2 = x * x",
        "    if x2 < 4.0:",
        *series,
        *down,
        "    else:",
        "        sigma_minus_1 = math.cos(x)",
        "        sigma_0 = math.sin(x) / x",
        *up,
        f"    return {', '.join(names)}",
    ]
    return "\n".join(lines)


def _horner(coefficients: Sequence[float]) -> str:
    text = repr(coefficients[-1])
    for coefficient in reversed(coefficients[:-1]):
        text = f"{coefficient!r} + x2 * ({text})"
    return text


def _times(factor: int, name: str) -> str:
    return name if factor == 1 else f"{factor}.0 * {name}"
