"""Number types that are checked when an object is made: no coercion, no NaN, no infinity."""

from typing import Annotated

from pydantic import ConfigDict, Field, Strict

STRICT = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
Vector = Annotated[tuple[float, float], Strict(False)]
