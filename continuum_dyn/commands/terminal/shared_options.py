"""Options of every command, taken before its name and after it."""

import inspect
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import wraps
from typing import Annotated, Any

import typer

from continuum_dyn.commands.terminal.verbosity import quiet, verbose
from statics.errors import InputError
from statics.kernels.kept_files import no_cache

PANEL = "Options of every command"

Quiet = Annotated[
    bool,
    typer.Option("--quiet", "-q", help="Print only errors, and JSON if requested.", rich_help_panel=PANEL),
]
Verbose = Annotated[
    bool,
    typer.Option(
        "--verbose", "-v", help="Print what is compiled, and the time of each stage.", rich_help_panel=PANEL
    ),
]
WithoutCache = Annotated[
    bool,
    typer.Option("--no-cache", help="Compile everything again, and cache nothing.", rich_help_panel=PANEL),
]


SHARED = {"be_quiet": Quiet, "be_verbose": Verbose, "without_cache": WithoutCache}


def with_shared_options(command: Callable[..., None]) -> Callable[..., None]:
    """The command, with these options after its own. One that prints JSON does so even if it is quiet."""

    @wraps(command)
    def shared(context: typer.Context, **options: Any) -> None:
        given = {name: options.pop(name) or context.find_root().params[name] for name in SHARED}
        with _apply(**given, json=options.get("as_json", False)):
            command(**options)

    own = inspect.signature(command)
    kind = inspect.Parameter.KEYWORD_ONLY
    context = inspect.Parameter("context", inspect.Parameter.POSITIONAL_ONLY, annotation=typer.Context)
    added = [
        inspect.Parameter(name, kind, default=False, annotation=option) for name, option in SHARED.items()
    ]
    parameters = [context, *own.parameters.values(), *added]
    shared.__signature__ = own.replace(parameters=parameters)  # pyright: ignore[reportAttributeAccessIssue]
    shared.__annotations__ = {**command.__annotations__, **SHARED, "context": typer.Context}
    return shared


@contextmanager
def _apply(be_quiet: bool, be_verbose: bool, without_cache: bool, json: bool) -> Iterator[None]:
    if be_quiet and be_verbose:
        raise InputError("--quiet beside --verbose. Give one or the other.")
    with ExitStack() as settings:
        if without_cache:
            settings.enter_context(no_cache())
        if be_quiet:
            settings.enter_context(quiet(json))
        if be_verbose:
            settings.enter_context(verbose())
        yield
