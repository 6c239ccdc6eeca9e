"""``continuum-dyn init``: a scenario to start from."""

from pathlib import Path
from typing import Annotated

import typer

from continuum_dyn.commands.terminal.output import say
from continuum_dyn.scenario_files.shipped import FIRST, shipped, shipped_scenario, title_of
from continuum_dyn.scenario_files.text import read_text
from statics.errors import InputError


def init(
    file: Annotated[
        Path | None,
        typer.Argument(metavar="FILE", help="The file to write, such as arm.toml.", show_default=False),
    ] = None,
    source: Annotated[
        str,
        typer.Option(
            "--from",
            metavar="NAME",
            help="The scenario to copy: ramp, friction, water, base and others of --list.",
        ),
    ] = FIRST,
    names: Annotated[bool, typer.Option("--list", help="List the scenarios, and write none.")] = False,
) -> None:
    """Write a commented scenario to start from.

    It runs as it is, and its comments show everything that a scenario may hold. `--from` copies another
    scenario that comes with the program. Existing files are not changed.
    """
    if names:
        _list()
        return
    if file is None:
        raise InputError("missing FILE, the file to write. Try continuum-dyn init arm.toml.")
    if file.suffix != ".toml":
        raise InputError(f"{file}: scenarios end in .toml. Try {file.with_suffix('.toml').name}.")
    for path, text in _files(shipped_scenario(source), file).items():
        _write(path, text)
        say(f"written: {path}")
    say(f"run it:  continuum-dyn run {file}")


def _list() -> None:
    width = max(map(len, shipped()))
    for name, file in shipped().items():
        say(f"{name:{width}}  {title_of(file)}")


def _files(source: Path, target: Path) -> dict[Path, str]:
    """The texts to write by their paths: tables beside the scenario, then the scenario.

    Raises ``InputError`` if one of them exists.
    """
    from continuum_dyn.scenario_files.reading import load_scenario  # slow to load

    tables = load_scenario(source).tables
    found = {target.parent / name: text for name, text in tables.items()} | {target: read_text(source)}
    for path in found:
        if path.exists():
            raise InputError(f"{path} already exists and was not changed. Choose another name or folder.")
    return found


def _write(path: Path, text: str) -> None:
    try:
        with path.open("x", encoding="utf-8") as made:
            made.write(text)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}.") from error
