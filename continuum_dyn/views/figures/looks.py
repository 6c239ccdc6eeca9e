"""Colours, lines and markers that can be told apart in black and white, and by colour-blind readers."""

from collections.abc import Sequence
from textwrap import shorten
from typing import Any

from statics.support.plain_text import plain_line

BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY = (
    *("#0072B2", "#D55E00", "#009E73"),
    *("#E69F00", "#CC79A7", "#56B4E9"),
)
"""Colours of Okabe and Ito 2008, without black and yellow."""
COLORS = ("k", BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY)
"""Colours of lines that share an axis, in order of use."""
LINES = ("-", "--", "-.", ":", (0, (6, 1, 1, 1, 1, 1)), (0, (8, 3)))
MARKERS = ("o", "s", "^", "D", "v", "x")
LETTERS: dict[Any, Any] = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "figure.titlesize": 12.0,
    "legend.fontsize": 8.0,
    "axes.titlelocation": "left",
}
"""Sizes of letters, in points, on a figure as wide as a page, and the place of titles."""


def style(number: int) -> dict[str, Any]:
    """The colour and line of the line of that number, from 0."""
    return {"color": COLORS[number % len(COLORS)], "ls": LINES[number % len(LINES)]}


MOST_NAMED = 6
"""Largest number of lines of a kind that a legend names; the last one counts those beyond."""
LONGEST_NAME = 18
"""Largest number of letters of a name in a legend."""


def without_math(text: str) -> str:
    """A text on one line in which dollar signs begin no formula."""
    return plain_line(text).replace("$", r"\$")


def legend_labels(names: Sequence[str]) -> list[str]:
    """Labels for a legend, short and not too many; a label that begins with "_" is not in the legend."""
    short = [shorten(plain_line(name), LONGEST_NAME, placeholder="...") for name in names]
    labels = [without_math(name.lstrip("_") or "...") for name in short]
    beyond = len(labels) - MOST_NAMED
    if beyond > 0:
        labels[MOST_NAMED - 1 :] = [f"{beyond + 1} more"] + ["_"] * beyond
    return labels
