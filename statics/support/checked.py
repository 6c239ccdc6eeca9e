"""Types that are checked when an object is made: no coercion, no NaN, no infinity, no control characters."""

from typing import Annotated

from pydantic import AfterValidator, ConfigDict, Field, Strict

STRICT = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
Vector = Annotated[tuple[float, float], Strict(False)]


def _printable(text: str) -> str:
    """Refuse what would steer a terminal, and the zero that ends a text in files and paths."""
    if not text.isprintable():
        raise ValueError("a text of one line without control characters is expected")
    return text


LONGEST_LINE = 200
Line = Annotated[str, Field(max_length=LONGEST_LINE), AfterValidator(_printable)]
