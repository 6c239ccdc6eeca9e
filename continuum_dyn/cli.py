"""The command line: ``continuum-dyn COMMAND``. Each command is a file in ``commands/``."""

import signal
import sys
from collections.abc import Callable
from functools import wraps
from typing import Annotated, Any

import typer

from continuum_dyn.commands import cost, explain, hard, modes, play, ramp, reproduce, run, settle
from statics.errors import ContinuumError
from statics.kernel_files import no_cache

BAD_INPUT = 2
INTERRUPTED = 130

app = typer.Typer(
    name="continuum-dyn",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
)


@app.callback()
def options(
    context: typer.Context,
    without_cache: Annotated[
        bool, typer.Option("--no-cache", help="Compile anew, and keep nothing of it.")
    ] = False,
) -> None:
    """Statics and dynamics of planar cable-driven continuum arms."""
    if without_cache:
        context.with_resource(no_cache())


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


for _command in (
    run.run,
    play.play,
    settle.settle,
    ramp.ramp,
    explain.explain,
    modes.modes,
    cost.cost,
    hard.hard,
    reproduce.reproduce,
):
    app.command()(with_exit_status(_command))


def main() -> None:
    """Entry point of ``continuum-dyn``."""
    try:
        app()
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # all is said and on disk
