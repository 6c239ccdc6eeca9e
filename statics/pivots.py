"""Pivots of a matrix that may be indefinite, made positive as they come: plain Python for kernels."""

import math

SINGULAR, TINY = 1e-9, 1e-30
"""Pivots below this part of the torque scale, or below this at all, count as that large."""


def pivot_inverse_1(a: float, size: float, keep_sign: float) -> tuple[float, float, float]:
    """Inverse of a pivot's absolute value; the torque scale so far; 1 if the pivot is negative.

    With ``keep_sign`` the inverse has the pivot's sign.
    """
    size = max(size, abs(a))
    inverse = 1.0 / max(abs(a), SINGULAR * size, TINY)
    negative = 1.0 if a < 0.0 else 0.0
    return inverse * (1.0 - 2.0 * negative * keep_sign), size, negative


def pivot_inverse_2(
    a: float, b: float, c: float, unit: float, size: float, keep_sign: float
) -> tuple[float, float, float, float, float]:
    """Inverse of the pivot [[a, b], [b, c]] with its eigenvalues made positive.

    The second coordinate is measured in ``unit``, so that eigenvalues compare. Returns the three entries
    of the inverse, the torque scale so far, and the number of negative eigenvalues, whose signs stay with
    ``keep_sign``.
    """
    b, c = b * unit, c * unit * unit
    size = max(size, abs(a))
    floor = SINGULAR * size + TINY
    determinant = a * c - b * b
    if a + c > 0.0 and determinant > floor * (a + c):
        return c / determinant, -b * unit / determinant, a * unit * unit / determinant, size, 0.0
    mean, radius = 0.5 * (a + c), math.hypot(0.5 * (a - c), b)
    low, high = mean - radius, mean + radius
    low_is_negative, high_is_negative = 1.0 if low < 0.0 else 0.0, 1.0 if high < 0.0 else 0.0
    of_low = (1.0 - 2.0 * low_is_negative * keep_sign) / max(abs(low), floor)
    of_high = (1.0 - 2.0 * high_is_negative * keep_sign) / max(abs(high), floor)
    turn = 0.5 * math.atan2(2.0 * b, a - c)
    cosine, sine = math.cos(turn), math.sin(turn)
    return (
        cosine * cosine * of_high + sine * sine * of_low,
        cosine * sine * (of_high - of_low) * unit,
        (sine * sine * of_high + cosine * cosine * of_low) * unit * unit,
        size,
        low_is_negative + high_is_negative,
    )
