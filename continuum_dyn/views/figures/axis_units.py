"""Axes in the unit that reads best, labelled from the glossary."""

from typing import Any, NamedTuple

import numpy as np

from statics.quantities import QUANTITIES

PREFIXES = (("", 1.0), ("m", 1e-3), ("u", 1e-6), ("n", 1e-9), ("p", 1e-12))
PREFIXED = ("m", "s", "J", "N", "W")
"""Units that take a prefix."""
READS_WELL = 0.3
"""Smallest of the largest values on an axis in a unit that reads well."""


class Axis(NamedTuple):
    """An axis: the number of its units in an SI unit, and its label."""

    per_si: float
    label: str


def axis(name: str, values: Any, words: str | None = None) -> Axis:
    """The axis for these values of a quantity; ``words`` say more than its name does."""
    quantity = QUANTITIES[name]
    words = quantity.name.replace("_", " ") if words is None else words
    if quantity.unit == "1":
        return Axis(1.0, words)
    largest = float(np.max(np.abs(values), initial=0.0))
    if largest == 0.0 and quantity.unit == "m":
        return Axis(1e3, f"{words} (mm)")
    if quantity.unit not in PREFIXED or largest == 0.0:
        return Axis(1.0, f"{words} ({quantity.unit})")
    fitting = (pair for pair in PREFIXES if largest >= READS_WELL * pair[1])
    prefix, size = next(fitting, PREFIXES[-1])
    return Axis(1.0 / size, f"{words} ({prefix}{quantity.unit})")
