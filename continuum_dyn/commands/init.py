"""``continuum-dyn init``: a scenario to start from."""

from importlib.resources import files
from pathlib import Path
from typing import Annotated

import typer

from continuum_dyn.commands.terminal.output import say
from statics.errors import InputError

TEMPLATE = files("continuum_dyn.commands") / "first_scenario.toml"


def init(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="The file to write, such as arm.toml.", show_default=False)
    ],
) -> None:
    """Write a commented scenario to start from.

    It runs as it is. A file that is there is not touched.
    """
    if file.suffix != ".toml":
        raise InputError(f"{file}: scenarios end in .toml. Try {file.with_suffix('.toml').name}.")
    try:
        with file.open("x", encoding="utf-8") as made:
            made.write(TEMPLATE.read_text(encoding="utf-8"))
    except FileExistsError as error:
        raise InputError(f"{file}: is there already, and is left as it is. Name another file.") from error
    except OSError as error:
        raise InputError(f"cannot write {file}: {error.strerror}.") from error
    say(f"written: {file}")
    say(f"run it:  continuum-dyn run {file}")
