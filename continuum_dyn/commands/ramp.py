"""``continuum-dyn ramp``: lag behind the static path, and the hysteresis loop."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from continuum_dyn.commands.terminal.arguments import BesideLog
from continuum_dyn.commands.terminal.assertions import (
    HELP,
    Verdict,
    exit_unless_held,
    judge,
    parse,
    verdict_table,
)
from continuum_dyn.commands.terminal.output import console, say
from continuum_dyn.commands.terminal.pictures import save
from continuum_dyn.commands.terminal.show import (
    duration,
    energy,
    length,
    make_folder,
    plain_table,
    with_status,
)
from statics.errors import InputError

if TYPE_CHECKING:
    from continuum_dyn.answers.ramp import RampAnswers


def ramp(
    log: Annotated[Path, typer.Argument(metavar="FILE.h5", help="A log of a ramp.", show_default=False)],
    out: BesideLog = None,
    error: Annotated[
        float, typer.Option(metavar="LENGTH", help="Lag (m) up to which a ramp counts as quasistatic.")
    ] = 1e-4,
    measure: Annotated[
        bool, typer.Option("--measure", help="Measure the quasistatic rate, by runs at several rates.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
    assertions: Annotated[
        list[str] | None, typer.Option("--assert", metavar="TEXT", help=HELP.format("tip_lag < 1e-5"))
    ] = None,
) -> None:
    """Show how closely a ramp follows its static path.

    For a motion with static_path = true: how far its tip lags behind the equilibria of the same tensions, and
    up to which rate it would stay within an error. For an up-and-down ramp, in motion or at rest: the
    hysteresis loop between its two branches. Writes DIR/NAME_ramp.png. Exit status: 1 if an assertion does
    not hold.
    """
    from continuum_dyn.answers.ramp import FIGURES, ramp_answers
    from continuum_dyn.answers.ramp_rates import measure_at_other_rates
    from continuum_dyn.record import read_log
    from continuum_dyn.record.logged_scenario import logged_scenario
    from continuum_dyn.views.figures import ramp_plot

    asked = parse(assertions or [], FIGURES)
    if not 0.0 < error < float("inf"):
        raise InputError(f"--error takes a length above 0, in m; read: {error:g}.")
    read = read_log(log)
    found = ramp_answers(read, error)
    folder = out or log.parent
    make_folder(folder)
    if measure:
        scenario, before = logged_scenario(read), found
        found = with_status(read.title, lambda progress: measure_at_other_rates(before, scenario, progress))
    picture = folder / f"{log.stem}_ramp.png"
    save(ramp_plot.ramp(read.title, found), picture)
    verdicts = judge(asked, found.figures)
    if as_json:
        asserted = [verdict.record for verdict in verdicts]
        named = {"log": str(log), "title": read.title} | _record(found)
        say(json.dumps(named | {"assertions": asserted, "picture": str(picture)}))
    else:
        _show(read.title, found, verdicts)
        say(f"written: {picture}")
    exit_unless_held(verdicts)


def _record(found: "RampAnswers") -> dict[str, Any]:
    """The answer as JSON: every figure, the lag of each branch, and the lags at other rates."""
    drive = {"quantity": found.drive.quantity, "of": found.drive.of, "rate_unit": found.drive.rate_unit}
    ways, runs = [vars(way) for way in found.lags], [run._asdict() for run in found.measured]
    return {"drive": drive, **found.figures, "missing": found.missing, "ways": ways, "measured": runs}


def _show(title: str, found: "RampAnswers", verdicts: list[Verdict]) -> None:
    screen = console()
    screen.print(title)
    screen.print(_figure_table(found))
    if found.lags:
        screen.print(_lag_table(found))
    if verdicts:
        screen.print(verdict_table(verdicts, found.missing))
    screen.print()


def _figure_table(found: "RampAnswers") -> Any:
    table = plain_table("", "", "", "")
    table.show_header, table.columns[2].justify, table.columns[2].overflow = False, "left", "fold"
    figures, unit = found.figures, found.drive.rate_unit
    drive = f"{found.drive.quantity.replace('_', ' ')} of '{found.drive.of}'"

    def row(words: str, name: str, write: Any, explained: str) -> None:
        value = figures[name]
        if value is not None:
            table.add_row(words, write(value), explained)
        elif words and found.missing[name]:
            table.add_row(words, "none", found.missing[name])

    def rate(value: float) -> str:
        return f"{value:.3g} {unit}"

    if found.motion is not None:
        row("rate", "ramp_rate", rate, f"largest rate of the {drive}")
        row("lag", "tip_lag", length, "largest distance of the tip from its static path")
        row("", "delay", duration, "as a delay on that path")
        within = f"for a lag of {length(figures['quasistatic_error'] or 0.0)}"
        row("quasistatic", "quasistatic_rate", rate, f"{within}, if proportional to the rate")
        row("", "measured_quasistatic_rate", rate, f"{within}, from runs at several rates")
        row("hysteresis", "hysteresis_area", energy, "work once around the loop, in motion")
        row("", "tip_hysteresis", length, "largest tip distance of its branches, in motion")
    row(
        "hysteresis" if found.motion is None else "",
        "static_hysteresis_area",
        energy,
        "work once around the loop, at rest",
    )
    row("", "static_tip_hysteresis", length, "largest tip distance of its branches, at rest")
    return table


def _lag_table(found: "RampAnswers") -> Any:
    """Lag on each branch of the drive, and at each rate that was run."""
    table = plain_table("\nLag against rate", "", f"rate ({found.drive.rate_unit})", "largest lag", "delay")
    for way in found.lags:
        late = "" if way.delay is None else duration(way.delay)
        table.add_row(f"{way.start:g} to {way.end:g} s", f"{way.ramp_rate:.3g}", length(way.tip_lag), late)
    for run in found.measured:
        table.add_row("run at", f"{run.ramp_rate:.3g}", length(run.tip_lag), "")
    return table
