"""``continuum-dyn play``: look at a log in rerun."""

from pathlib import Path
from typing import Annotated

import typer


def play(
    log: Annotated[Path, typer.Argument(metavar="FILE.h5", help="A log written by run.", show_default=False)],
) -> None:
    """Open a log in the rerun viewer."""
    from continuum_dyn.record import read_log
    from continuum_dyn.views import rerun_view

    rerun_view.show(read_log(log))
