"""The door to the terminal: all text goes through it, and is shown as it is.

No markup, no codes of emoji and no control characters of a text take effect; what the output cannot show is
replaced.
"""

import os
import sys
from contextlib import nullcontext, suppress
from functools import cache
from io import TextIOWrapper
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

import typer

from statics.errors import LogError
from statics.support.plain_text import plain

if TYPE_CHECKING:
    from rich.console import Console


def say(text: str = "", err: bool = False) -> None:
    """Print a text and a new line. An error that cannot be printed is left to the exit status."""
    with suppress(OSError) if err else nullcontext():
        typer.echo(plain(text), err=err)


def give_back(text: str) -> None:
    """Print the text of a file, byte by byte as it was read, or made fit for a terminal."""
    raw = getattr(sys.stdout, "buffer", None)
    if sys.stdout.isatty() or raw is None:
        sys.stdout.write(plain(text))
    else:
        sys.stdout.flush()
        raw.write(text.encode(errors="replace"))
    sys.stdout.flush()


def console(stderr: bool = False) -> "Console":
    """A console of rich that shows text as it is."""
    return _plain_console()(stderr=stderr, markup=False, emoji=False, highlight=False)


@cache
def _plain_console() -> type["Console"]:
    from rich.console import Console  # slow to load
    from rich.text import Text

    class PlainConsole(Console):
        def render_str(self, text: str, **options: Any) -> Text:
            return super().render_str(plain(text), **options)

    return PlainConsole


def prepare_streams() -> None:
    """Make standard output and error take any text. Raises ``LogError`` if standard output is closed."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")  # what an encoding such as ASCII does not have
    if sys.stderr is None:
        sys.stderr = _nowhere()
    if sys.stdout is None:
        sys.stdout = _nowhere()
        raise LogError("standard output is closed, so nothing can be printed. Try > /dev/null, or a file.")


def drop_output() -> None:
    """Discard what is left for standard output, which the interpreter would try to write at its exit."""
    sys.stdout = _nowhere()


def _nowhere() -> TextIO:
    return Path(os.devnull).open("w", encoding="utf-8")
