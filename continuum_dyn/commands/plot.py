"""``continuum-dyn plot``: a figure of a log, for print."""

from pathlib import Path
from typing import Annotated

import typer

from continuum_dyn.commands.terminal.output import say
from continuum_dyn.commands.terminal.pictures import save
from continuum_dyn.commands.terminal.show import make_folder
from statics.errors import InputError, did_you_mean

SUFFIXES = (".png", ".svg", ".pdf")


def plot(
    log: Annotated[Path, typer.Argument(metavar="FILE.h5", help="A log.", show_default=False)],
    parts: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="PART", help="Of shapes, inputs, tip, energies. Default: all.", show_default=False
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="PICTURE",
            help="PNG, SVG or PDF by its suffix. By default NAME_plot.png beside the log.",
            show_default=False,
        ),
    ] = None,
    at: Annotated[
        list[float] | None,
        typer.Option(
            metavar="VALUE", help="A time (s), or value of a ramp, whose shape is drawn. Repeatable."
        ),
    ] = None,
    stretch: Annotated[
        bool, typer.Option("--stretch", help="Let shapes fill the page, not to scale.")
    ] = False,
) -> None:
    """Draw the shapes, the inputs, the tip and the energies of a log.

    Shapes are to scale. The rest is drawn over the time of a motion, or over the tension, length or load
    factor of a ramp. Lines differ in black and white, too.
    """
    from continuum_dyn.record import read_log
    from continuum_dyn.views.figures import log_plots
    from continuum_dyn.warnings.sampling import describe_coarse_samples

    for part in parts or []:
        if part not in log_plots.PARTS:
            raise InputError(f"plot draws no '{part}'.{did_you_mean(part, log_plots.PARTS)}")
    picture = out or log.with_name(f"{log.stem}_plot.png")
    if picture.suffix.lower() not in SUFFIXES:
        raise InputError(f"--out takes a name that ends in {', '.join(SUFFIXES)}; read: {picture.name}.")
    read = read_log(log)
    figure = log_plots.picture(read, parts or [], at or [], stretch)
    make_folder(picture.parent)
    save(figure, picture)
    coarse = describe_coarse_samples(read.trajectory)
    if coarse:
        say(f"samples: {coarse}", err=True)
    say(f"written: {picture}")
