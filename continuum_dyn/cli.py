"""The command line: ``continuum-dyn COMMAND``. Each command is a file in ``commands/``."""

import os
import signal
import sys
from collections.abc import Callable
from functools import wraps
from importlib.metadata import version
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from continuum_dyn.commands import (
    cost,
    explain,
    hard,
    info,
    init,
    keys,
    modes,
    play,
    plot,
    ramp,
    reproduce,
    resume,
    run,
    schema,
    settle,
    validate,
)
from continuum_dyn.commands.terminal.extras import naming_extras
from continuum_dyn.commands.terminal.output import drop_output, prepare_streams, say
from continuum_dyn.commands.terminal.shared_options import (
    Quiet,
    Verbose,
    WithoutCache,
    with_shared_options,
)
from continuum_dyn.commands.terminal.show import wrap
from statics.errors import ContinuumError, LogError

BAD_INPUT = 2
INTERRUPTED = 130

COMMANDS = (
    ("Simulate and view", run.run),
    ("Simulate and view", resume.resume),
    ("Simulate and view", play.play),
    ("Simulate and view", plot.plot),
    ("Evaluate a log", info.info),
    ("Evaluate a log", settle.settle),
    ("Evaluate a log", ramp.ramp),
    ("Evaluate a log", validate.validate),
    ("Understand", explain.explain),
    ("Understand", modes.modes),
    ("Understand", cost.cost),
    ("Scenario files", init.init),
    ("Scenario files", keys.keys),
    ("Scenario files", schema.schema),
    ("Check the program", hard.hard),
    ("Check the program", reproduce.reproduce),
)
"""Heading and function of each command, in the order of the help."""

EXIT_STATUSES = """\
**Exit status**

- 0: answered ("not settled" is an answer)
- 1: not answered, or a check failed
- 2: bad input, or a file that cannot be read or written
- 130: interrupted; everything computed so far is saved
"""


def _without_types(parameters: list[Any]) -> list[Any]:
    """The help names no type of a flag, which takes no value, nor of an argument, whose name says it."""
    for parameter in parameters:
        if getattr(parameter, "is_flag", False):
            parameter.metavar = ""
        elif parameter.param_type_name == "argument":
            parameter.display_type_rich = lambda **_: ""
    return parameters


class _Command(TyperCommand):
    def get_params(self, ctx: Any) -> list[Any]:
        return _without_types(super().get_params(ctx))


class _Group(TyperGroup):
    def get_params(self, ctx: Any) -> list[Any]:
        return _without_types(super().get_params(ctx))


app = typer.Typer(
    name="continuum-dyn",
    cls=_Group,
    no_args_is_help=True,
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
    epilog=EXIT_STATUSES,
    context_settings={"help_option_names": ["--help", "-h"]},
)


def _show_version(asked: bool) -> None:
    if asked:
        say(f"continuum-dyn {version('continuum-dyn')}")
        raise typer.Exit


def with_exit_status(command: Callable[..., None]) -> Callable[..., None]:
    """The command, with errors that are meant for the user printed without a traceback."""

    @wraps(command)
    def guarded(*arguments: Any, **options: Any) -> None:
        try:
            with naming_extras():
                command(*arguments, **options)
        except ContinuumError as error:
            say(wrap(f"error: {error}"), err=True)
            raise typer.Exit(BAD_INPUT) from error
        except MemoryError as error:
            say("error: out of memory. Try fewer samples or segments, or give the program more.", err=True)
            raise typer.Exit(BAD_INPUT) from error
        except KeyboardInterrupt as error:
            say("interrupted", err=True)
            raise typer.Exit(INTERRUPTED) from error

    return guarded


@app.callback()
def options(
    be_quiet: Quiet = False,
    be_verbose: Verbose = False,
    without_cache: WithoutCache = False,
    show_version: Annotated[
        bool, typer.Option("--version", help="Print the version.", callback=_show_version, is_eager=True)
    ] = False,
) -> None:
    """Statics and dynamics of planar cable-driven continuum arms."""


for _panel, _command in COMMANDS:
    app.command(cls=_Command, rich_help_panel=_panel)(with_exit_status(with_shared_options(_command)))


def _io_message(error: OSError) -> str:
    """Message about a file, or standard output, that could not be read or written."""
    if error.filename is not None:
        return f"cannot use {error.filename}: {error.strerror}."
    return f"cannot write to standard output: {error.strerror or error}. What was logged by then is on disk."


def main() -> None:
    """Run the command line. After Ctrl-C, by any exception, the exit status is ``INTERRUPTED``."""
    presses = []

    def interrupt(_signal: int, _frame: object) -> None:
        presses.append(_signal)
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    os.environ["MPLBACKEND"] = "agg"  # figures go to files, and matplotlib ends at a name it does not know
    try:
        prepare_streams()
        app()
    except (OSError, LogError) as error:
        drop_output()
        say(f"error: {error if isinstance(error, LogError) else _io_message(error)}", err=True)
        sys.exit(BAD_INPUT)
    except BaseException:
        if presses:
            sys.exit(INTERRUPTED)
        raise
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # all is said and on disk
