"""Headings and notes of figures, in which text from elsewhere is shown as it is."""

from textwrap import fill

from matplotlib.figure import Figure

from statics.support.plain_text import plain_line

NOTE_WIDTH = 100
"""Largest number of characters in a line of a note."""
HEADING_WIDTH = 8.0
"""Largest number of characters in a line of a heading, for each inch of the figure's width."""
HEADING_LINES = 3


def set_heading(figure: Figure, title: str) -> None:
    """Head a figure with a text, in which dollar signs begin no formula; a long one takes several lines."""
    width = round(HEADING_WIDTH * figure.get_figwidth())
    words = fill(plain_line(title), width, max_lines=HEADING_LINES, placeholder=" ...")
    figure.suptitle(words, parse_math=False, usetex=False)


def add_note(figure: Figure, text: str) -> None:
    """Put a note below a figure."""
    words = fill(plain_line(text), NOTE_WIDTH)
    figure.supxlabel(words, fontsize=8, color="C3", parse_math=False, usetex=False)
