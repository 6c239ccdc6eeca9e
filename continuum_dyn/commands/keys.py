"""``continuum-dyn keys``: what a scenario file may say."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from continuum_dyn.commands.terminal.output import console
from statics.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from continuum_dyn.scenario_files.keys import KeyTable


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
    """Print every key of scenario files: what it may be, what it is by default, what it means.

    Units are SI. `continuum-dyn init` writes a file with most of them to start from.
    """
    from continuum_dyn.scenario_files.keys import key_tables

    found = key_tables()
    for each in found if table is None else _named(table, found):
        _print(each)


def _named(name: str, tables: "Sequence[KeyTable]") -> "list[KeyTable]":
    """The tables in whose headings a name stands. Raises ``InputError`` if it stands in none."""
    words = {table.heading: _words(table.heading) for table in tables}
    found = [table for table in tables if name in words[table.heading]]
    if not found:
        known = sorted({word for each in words.values() for word in each} - {"kind", "profile", "the"})
        holders = [table.heading for table in tables if any(key.name == name for key in table.keys)]
        where = f" It is a key of {', '.join(holders)}." if holders else did_you_mean(name, known)
        raise InputError(f"no table is named '{name}'.{where}")
    return found


def _words(heading: str) -> set[str]:
    return set(heading.translate(str.maketrans('[]="', "    ")).split())


def _print(table: "KeyTable") -> None:
    from rich.table import Table

    screen = console()
    screen.print(table.heading)
    screen.print(table.text.replace("`", ""))
    if table.keys:
        shown = Table(box=None, pad_edge=False, header_style="dim")
        for column in ("key", "may be", "by default", "meaning"):
            shown.add_column(column, overflow="fold", ratio={"may be": 2, "meaning": 4}.get(column))
        for key in table.keys:
            shown.add_row(*(cell.replace("`", "") for cell in key))
        screen.print(shown)
    screen.print()
