"""The command line: ``continuum-dyn COMMAND``. Each command is a file in ``commands/``."""

from collections.abc import Callable
from functools import wraps
from typing import Any

import typer

from continuum_dyn.commands import cost, explain, hard, modes, play, reproduce, run
from statics.errors import ContinuumError

BAD_INPUT = 2
INTERRUPTED = 130

app = typer.Typer(
    name="continuum-dyn",
    help="Statics and dynamics of planar cable-driven continuum arms.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
)


def with_exit_status(command: Callable[..., None]) -> Callable[..., None]:
    """The command, with errors that are meant for the user printed without a traceback."""

    @wraps(command)
    def guarded(*arguments: Any, **options: Any) -> None:
        try:
            command(*arguments, **options)
        except ContinuumError as error:
            typer.echo(f"error: {error}", err=True)
            raise typer.Exit(BAD_INPUT) from error
        except KeyboardInterrupt as error:
            typer.echo("interrupted", err=True)
            raise typer.Exit(INTERRUPTED) from error

    return guarded


for _command in (run.run, play.play, explain.explain, modes.modes, cost.cost, hard.hard, reproduce.reproduce):
    app.command()(with_exit_status(_command))


def main() -> None:
    """Entry point of ``continuum-dyn``."""
    app()
