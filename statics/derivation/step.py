"""Step: one segment's part of a pass along the chain."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from statics.derivation.trace import Trace

OUTWARD: Literal["outward"] = "outward"
INWARD: Literal["inward"] = "inward"

Carried = dict[str, tuple[Any, Any]]
"""Value of each name before the first segment of a pass, and after this one."""


def carry_from_zero(symbols: Sequence[Any], values: Sequence[Any]) -> Carried:
    """Carry values under the names of these symbols, zero before the first segment."""
    return {str(name): (0.0, value) for name, value in zip(symbols, values, strict=True)}


@dataclass(frozen=True)
class Step:
    """One segment's part of the pass ``name``, from the base outward or from the tip inward.

    The pass returns its ``results``; ``carried`` stays inside it. Values before the first segment are numbers
    or expressions of inputs and of the first segment's parameters. ``given`` are the numbers that the caller
    of the pass chooses. ``arrays`` are the step's arguments, ``stores`` those that it writes, one column for
    each expression.
    """

    name: str
    doc: str
    direction: Literal["outward", "inward"]
    arrays: tuple[str, ...]
    trace: Trace
    results: Carried = field(default_factory=dict)
    carried: Carried = field(default_factory=dict)
    stores: dict[str, list[Any]] = field(default_factory=dict)
    given: tuple[str, ...] = ()
