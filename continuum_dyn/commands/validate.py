"""``continuum-dyn validate``: check logs against their format."""

from pathlib import Path
from typing import Annotated

import typer

from continuum_dyn.commands.terminal.output import say

MAX_SHOWN = 20
"""Largest number of faults printed for each file."""


def validate(
    logs: Annotated[
        list[Path], typer.Argument(metavar="LOG", help="Logs written by run.", show_default=False)
    ],
) -> None:
    """Check logs against the documented format: names, shapes, types, units, scales, finite numbers.

    Exit status: 0 all logs are valid, 1 at least one is not, 2 a file cannot be read at all.
    """
    from continuum_dyn.record import FORMAT_VERSION
    from continuum_dyn.record.reading import list_departures

    wrong = False
    for log in logs:
        found = list_departures(log)
        if not found:
            say(f"{log}: a log of format {FORMAT_VERSION}")
            continue
        wrong = True
        say(f"{log}: {len(found)} {'departure' if len(found) == 1 else 'departures'} from the format")
        for line in found[:MAX_SHOWN]:
            say(f"  {line}")
        if len(found) > MAX_SHOWN:
            say(f"  and {len(found) - MAX_SHOWN} more")
    raise typer.Exit(int(wrong))
