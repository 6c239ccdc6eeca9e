"""Source text, for generated kernels, of the inverse of a pivot that may be indefinite, made positive.

A pivot counts as singular relative to the terms that add up in it, never relative to other pivots: in an arm
whose stiffness varies by many orders of magnitude, the pivot of a soft span is tiny but correct.
"""

SINGULAR, TINY = 1e-9, 1e-30
"""Smallest size that a pivot counts as: over the size of its own terms, and in N m."""

_INVERSE_1 = f'''
def pivot_inverse_1(a, size, keep_sign):
    """Inverse of a pivot's absolute value, whose terms have that size; 1 if the pivot is negative.

    With keep_sign the inverse has the pivot's sign.
    """
    inverse = 1.0 / max(abs(a), {SINGULAR!r} * size, {TINY!r})
    negative = 1.0 if a < 0.0 else 0.0
    return inverse * (1.0 - 2.0 * negative * keep_sign), negative
'''

_INVERSE_2 = f'''
def pivot_inverse_2(a, b, c, unit, size_a, size_c, keep_sign):
    """Inverse of the pivot [[a, b], [b, c]] with its eigenvalues made positive.

    The second coordinate is measured in unit, so that eigenvalues compare; the terms of a and c have the
    given sizes. Returns the three entries of the inverse, and the number of negative eigenvalues, whose signs
    stay with keep_sign.
    """
    b = b * unit
    c = c * unit * unit
    size_c = size_c * unit * unit
    determinant = a * c - b * b
    floor = {SINGULAR!r} * (size_a * abs(c) + size_c * abs(a)) + {TINY!r} * (abs(a) + abs(c))
    regular = 1.0 if abs(determinant) > floor else 0.0
    positive = (1.0 if a > 0.0 else 0.0) * (1.0 if determinant > 0.0 else 0.0)
    if regular * max(positive, keep_sign) > 0.0:
        inverse_00 = c / determinant
        inverse_01 = -b * unit / determinant
        inverse_11 = a * unit * unit / determinant
        negative = 1.0 if determinant < 0.0 else 2.0 - 2.0 * positive
    else:
        smallest = {SINGULAR!r} * size_a + {TINY!r}
        mean = 0.5 * (a + c)
        half = 0.5 * (a - c)
        radius = math.hypot(half, b)
        low = mean - radius
        high = mean + radius
        low_is_negative = 1.0 if low < 0.0 else 0.0
        high_is_negative = 1.0 if high < 0.0 else 0.0
        of_low = (1.0 - 2.0 * low_is_negative * keep_sign) / max(abs(low), smallest)
        of_high = (1.0 - 2.0 * high_is_negative * keep_sign) / max(abs(high), smallest)
        turn = 0.5 * math.atan2(2.0 * b, a - c)
        cosine = math.cos(turn)
        sine = math.sin(turn)
        inverse_00 = cosine * cosine * of_high + sine * sine * of_low
        inverse_01 = cosine * sine * (of_high - of_low) * unit
        inverse_11 = (sine * sine * of_high + cosine * cosine * of_low) * unit * unit
        negative = low_is_negative + high_is_negative
    return inverse_00, inverse_01, inverse_11, negative
'''

PIVOT_SOURCES = {"pivot_inverse_1": _INVERSE_1.strip(), "pivot_inverse_2": _INVERSE_2.strip()}
"""Source of each function that a step may call, by its name."""
