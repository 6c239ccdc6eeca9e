"""``continuum-dyn resume``: resume an interrupted run."""

from pathlib import Path
from typing import Annotated

import typer

from continuum_dyn.commands.run import Job, answer


def resume(
    log: Annotated[
        Path,
        typer.Argument(
            metavar="LOG",
            help="A log (.h5) that ended early, or the part (.h5.part) left by a killed run.",
            show_default=False,
        ),
    ],
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as a JSON object.")] = False,
) -> None:
    """Resume a run that was interrupted, killed, or stopped by its budget.

    Only the log is needed. The motion continues from its last sample, with a new budget of the same size,
    and the log of the whole run replaces the old one. A search for equilibria, or for an accuracy, restarts.
    Exit status: as for run.
    """
    from continuum_dyn.record import read_log
    from continuum_dyn.record.log_format import UNFINISHED
    from continuum_dyn.record.logged_scenario import logged_scenario
    from continuum_dyn.record.resuming import resumption_of

    unfinished = log.with_name(log.name + UNFINISHED)
    found = read_log(unfinished if not log.exists() and unfinished.exists() else log)
    scenario = logged_scenario(found)
    whole = found.path.with_name(found.path.name.removesuffix(UNFINISHED))
    job = Job(found.path, scenario, whole, resumption=resumption_of(found, scenario))
    raise typer.Exit(answer(job, as_json))
