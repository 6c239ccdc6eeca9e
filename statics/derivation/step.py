"""One segment's part of a pass along the chain."""

from dataclasses import dataclass, field
from typing import Any, Literal

from statics.derivation.trace import Trace

OUTWARD: Literal["outward"] = "outward"
INWARD: Literal["inward"] = "inward"


@dataclass(frozen=True)
class Step:
    """One segment's part of the pass ``name``, from the base outward or from the tip inward.

    ``results`` and ``carried`` map a name to its value before the first segment and after this one, the
    former a number or an expression of what the first segment knows; results are what the pass returns.
    ``given`` are the numbers that the caller of the pass chooses. ``arrays`` are the step's arguments,
    ``stores`` those that it writes, one column for each expression.
    """

    name: str
    doc: str
    direction: Literal["outward", "inward"]
    arrays: tuple[str, ...]
    trace: Trace
    results: dict[str, tuple[Any, Any]] = field(default_factory=dict)
    carried: dict[str, tuple[Any, Any]] = field(default_factory=dict)
    stores: dict[str, list[Any]] = field(default_factory=dict)
    given: tuple[str, ...] = ()
