"""Source text, for generated kernels, of the inverse of a pivot that may be indefinite, made positive."""

SINGULAR, TINY = 1e-9, 1e-30
"""Smallest size that a pivot counts as: over the torque scale, and in N m."""

_INVERSE_1 = f'''
def pivot_inverse_1(a, size, keep_sign):
    """Inverse of a pivot's absolute value; the torque scale so far; 1 if the pivot is negative.

    With keep_sign the inverse has the pivot's sign.
    """
    size = max(size, abs(a))
    inverse = 1.0 / max(abs(a), {SINGULAR!r} * size, {TINY!r})
    negative = 1.0 if a < 0.0 else 0.0
    return inverse * (1.0 - 2.0 * negative * keep_sign), size, negative
'''

_INVERSE_2 = f'''
def pivot_inverse_2(a, b, c, unit, size, keep_sign):
    """Inverse of the pivot [[a, b], [b, c]] with its eigenvalues made positive.

    The second coordinate is measured in unit, so that eigenvalues compare. Returns the three entries of the
    inverse, the torque scale so far, and the number of negative eigenvalues, whose signs stay with keep_sign.
    """
    b = b * unit
    c = c * unit * unit
    size = max(size, abs(a))
    floor = {SINGULAR!r} * size + {TINY!r}
    determinant = a * c - b * b
    margin = determinant - floor * (a + c) if a + c > 0.0 else -1.0
    if margin > 0.0:
        inverse_00 = c / determinant
        inverse_01 = -b * unit / determinant
        inverse_11 = a * unit * unit / determinant
        negative = 0.0
    else:
        mean = 0.5 * (a + c)
        half = 0.5 * (a - c)
        radius = math.hypot(half, b)
        low = mean - radius
        high = mean + radius
        low_is_negative = 1.0 if low < 0.0 else 0.0
        high_is_negative = 1.0 if high < 0.0 else 0.0
        of_low = (1.0 - 2.0 * low_is_negative * keep_sign) / max(abs(low), floor)
        of_high = (1.0 - 2.0 * high_is_negative * keep_sign) / max(abs(high), floor)
        turn = 0.5 * math.atan2(2.0 * b, a - c)
        cosine = math.cos(turn)
        sine = math.sin(turn)
        inverse_00 = cosine * cosine * of_high + sine * sine * of_low
        inverse_01 = cosine * sine * (of_high - of_low) * unit
        inverse_11 = (sine * sine * of_high + cosine * cosine * of_low) * unit * unit
        negative = low_is_negative + high_is_negative
    return inverse_00, inverse_01, inverse_11, size, negative
'''

PIVOT_SOURCES = {"pivot_inverse_1": _INVERSE_1.strip(), "pivot_inverse_2": _INVERSE_2.strip()}
"""Source of each function that a step may call, by its name."""
