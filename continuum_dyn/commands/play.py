"""``continuum-dyn play``: show logs in rerun."""

from pathlib import Path
from typing import Annotated

import typer

from continuum_dyn.commands.terminal.output import say
from statics.errors import InputError

RECORDING = ".rrd"
"""Ending of the names of rerun's recordings."""
SIGNATURE = b"RRF"
"""First bytes of rerun's recordings."""


def play(
    logs: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILE.h5...",
            help="Logs written by run; several logs share one view.",
            show_default=False,
        ),
    ],
    web: Annotated[
        bool, typer.Option("--web", help="Show the logs in a browser on this computer, until Ctrl-C.")
    ] = False,
    save: Annotated[
        Path | None,
        typer.Option(
            "--save", metavar="FILE.rrd", help="Write a recording instead of showing it.", show_default=False
        ),
    ] = None,
) -> None:
    """Play logs back in rerun: in its window, in a browser, or into a file.

    Several logs are shown side by side in the same time, each in its own colour.
    """
    if web and save is not None:
        raise InputError("--web shows the recording and --save keeps it in a file. Give one of them.")
    if save is not None:
        _check_target(save)
    from continuum_dyn.record import read_log
    from continuum_dyn.views.playback import recording, viewer

    found = [read_log(path) for path in logs]
    if save is not None:
        recording.save(found, save)
        say(f"written: {save}")
    elif web:
        viewer.serve(found, lambda address: say(f"{address}\nUntil Ctrl-C."))
    else:
        viewer.show(found)


def _check_target(save: Path) -> None:
    """Raise ``InputError`` if a recording of that name is none, or would replace another kind of file."""
    if save.suffix.lower() != RECORDING:
        raise InputError(f"--save takes a name that ends in {RECORDING}; read: {save.name}.")
    if save.is_file():
        with save.open("rb") as file:
            start = file.read(len(SIGNATURE))
        if start and start != SIGNATURE:
            raise InputError(
                f"--save {save}: the file there is no recording and is kept. Choose another name."
            )
