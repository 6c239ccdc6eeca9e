"""Arguments and options that several commands take."""

from pathlib import Path
from typing import Annotated

import typer

ScenarioFile = Annotated[
    Path, typer.Argument(metavar="FILE", help="A scenario file (TOML).", show_default=False)
]
Folder = Annotated[Path, typer.Option(metavar="DIR", help="Folder for the written files.")]
BesideLog = Annotated[
    Path | None,
    typer.Option(
        "--out", metavar="DIR", help="Folder for the written files; by default the log's.", show_default=False
    ),
]
Overrides = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        show_default=False,
        help="Change the scenario, e.g. arm.disks=16 or cables.upper.tension.after=2. Repeatable.",
    ),
]
