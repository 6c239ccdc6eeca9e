"""Arguments and options that several commands take."""

from pathlib import Path
from typing import Annotated

import typer

ScenarioFile = Annotated[
    Path, typer.Argument(metavar="FILE", help="A scenario file (TOML).", show_default=False)
]
Folder = Annotated[Path, typer.Option(metavar="DIR", help="Folder of what is written.")]
BesideLog = Annotated[
    Path | None,
    typer.Option(
        "--out", metavar="DIR", help="Folder of what is written; by default the log's.", show_default=False
    ),
]
Overrides = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        show_default=False,
        help="Change the scenario: arm.disks=16, cables.upper.tension.after=2. May be repeated.",
    ),
]
