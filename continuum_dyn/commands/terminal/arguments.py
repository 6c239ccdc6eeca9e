"""Arguments and options that several commands take."""

from pathlib import Path
from typing import Annotated

import typer

ScenarioFile = Annotated[
    Path, typer.Argument(metavar="FILE", help="A scenario file (TOML).", show_default=False)
]
Folder = Annotated[Path, typer.Option(metavar="DIR", help="Folder of what is written.")]
Overrides = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        show_default=False,
        help="Change the scenario: arm.disks=16, cables.upper.tension.after=2. May be repeated.",
    ),
]
