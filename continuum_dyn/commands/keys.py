"""``continuum-dyn keys``: the keys of scenario files."""

from collections.abc import Sequence
from shutil import get_terminal_size
from textwrap import fill
from typing import TYPE_CHECKING, Annotated

import typer

from continuum_dyn.commands.terminal.output import say
from statics.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from continuum_dyn.scenario_files.keys import KeyTable

INDENT = "    "


def keys(
    table: Annotated[
        str | None,
        typer.Argument(
            metavar="TABLE",
            help="A table, an effect, a kind of study or a profile: arm, gravity, ramp. All by default.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Print every key of scenario files: example, meaning, unit, allowed values and default.

    Units are SI. `continuum-dyn init` writes a file with most of them to start from.
    """
    from continuum_dyn.scenario_files.keys import key_tables

    found, width = key_tables(), get_terminal_size().columns
    for each in found if table is None else _named(table, found):
        _print(each, width)


def _named(name: str, tables: "Sequence[KeyTable]") -> "list[KeyTable]":
    """The tables in whose headings a name stands. Raises ``InputError`` if it stands in none."""
    words = {table.heading: _words(table.heading) for table in tables}
    found = [table for table in tables if name in words[table.heading]]
    if not found:
        known = sorted({word for each in words.values() for word in each} - {"kind", "profile", "the"})
        holders = [table.heading for table in tables if any(key.name == name for key in table.keys)]
        where = f" It is a key of {', '.join(holders)}." if holders else did_you_mean(name, known)
        raise InputError(f"no table is named '{name[:60]}'.{where}")
    return found


def _words(heading: str) -> set[str]:
    return set(heading.translate(str.maketrans('[]="', "    ")).split())


def _print(table: "KeyTable", width: int) -> None:
    say(table.heading)
    say("\n\n".join(fill(part, width) for part in table.text.replace("`", "").split("\n\n")))
    if table.example:
        say(f"\n{table.example}")
    for key in table.keys:
        default = key.default if key.default in ("", "required") else f"default: {key.default}"
        say(f"\n{key.example}")
        for line in (key.meaning, "; ".join(filter(None, (key.value, default)))):
            say(fill(line.replace("`", ""), width, initial_indent=INDENT, subsequent_indent=INDENT))
    say("\n")
