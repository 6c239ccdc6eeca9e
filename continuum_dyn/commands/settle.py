"""``continuum-dyn settle``: settling times and ring-down of a motion."""

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
from continuum_dyn.commands.terminal.show import duration, length, make_folder, plain_table, with_status

if TYPE_CHECKING:
    from continuum_dyn.answers.settling import Settling

CLEAR_MISFIT = 0.05
"""Smallest misfit at which a ring-down is reported to be more than one damped sinusoid."""


def settle(
    log: Annotated[Path, typer.Argument(metavar="FILE.h5", help="A log of a motion.", show_default=False)],
    out: BesideLog = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
    assertions: Annotated[
        list[str] | None,
        typer.Option("--assert", metavar="TEXT", help=HELP.format("settling_time_2 < 0.8")),
    ] = None,
) -> None:
    """Show how the motion of a log settles.

    Evaluates the motion after the last change of the inputs, along the straight line from the tip to its rest
    position: rise time, overshoot, settling times; frequency and damping ratio of the ring-down, compared
    with those of the linear mode at that equilibrium; and the remaining gap. Writes DIR/NAME_settle.png.
    Exit status: 1 if an assertion does not hold.
    """
    from continuum_dyn.answers.settling import FIGURES, settling
    from continuum_dyn.record import read_log
    from continuum_dyn.views.figures import settling_plot

    asked = parse(assertions or [], FIGURES)
    read = read_log(log)
    found = with_status(read.title, lambda _: settling(read))
    folder = out or log.parent
    make_folder(folder)
    picture = folder / f"{log.stem}_settle.png"
    save(settling_plot.settling(read.title, found), picture)
    verdicts = judge(asked, found.figures)
    if as_json:
        record: dict[str, Any] = {"log": str(log), "title": read.title, **found.figures}
        record |= {"mode_of_cables_that_stick": found.cables_stick and found.mode is not None}
        record |= {"missing": found.missing}
        asserted = [verdict.record for verdict in verdicts]
        say(json.dumps(record | {"assertions": asserted, "picture": str(picture)}))
    else:
        _show(read.title, found, verdicts)
        say(f"written: {picture}")
    exit_unless_held(verdicts)


def _show(title: str, found: "Settling", verdicts: list[Verdict]) -> None:
    screen = console()
    screen.print(title)
    screen.print(_step_table(found))
    screen.print(_ring_down_table(found))
    if found.cables_stick and found.mode is not None:
        screen.print("The linear mode is for sticking cables: in small motions they do not slip.")
    for why in dict.fromkeys(found.missing[name] for name in found.missing):
        names = [name.replace("_", " ") for name, reason in found.missing.items() if reason == why]
        screen.print(f"no {', '.join(names)}: {why}.")
    if (found.figures["ring_down_misfit"] or 0.0) > CLEAR_MISFIT:
        screen.print("It does not decay like a single mode: damping depends on the amplitude, or several")
        screen.print("modes oscillate.")
    if verdicts:
        screen.print(verdict_table(verdicts, found.missing))
    screen.print()


def _step_table(found: "Settling") -> Any:
    table = plain_table("", "", "", "")
    table.show_header, table.columns[2].justify = False, "left"
    figures, begin, end = found.figures, found.change.begin, found.change.end
    changes = f"{begin:g} s" if begin == end else f"{begin:g} to {end:g} s"
    table.add_row("travel of the tip", length(found.travel), f"inputs last change at {changes}")
    table.add_row("rise time", _time(figures["rise_time"]), "from 10 to 90 % of the travel")
    table.add_row("overshoot", _percent(figures["overshoot"]), "of the travel")
    for percent in (5, 2, 1):
        stays = _time(figures[f"settling_time_{percent}"])
        table.add_row("settling time" if percent == 5 else "", stays, f"to within {percent} % of the travel")
    gap = figures["static_gap"]
    table.add_row("gap to static", "none" if gap is None else length(gap), "from the final equilibrium")
    return table


def _percent(part: float | None) -> str:
    return "none" if part is None else f"{round(100 * part, 4):.3g} %"


def _time(value: float | None) -> str:
    return "none" if value is None else duration(value)


def _ring_down_table(found: "Settling") -> Any:
    table = plain_table("\nRing-down", "", "fitted", "linear mode", "fitted over mode")
    for name, unit in (("frequency", " Hz"), ("damping_ratio", "")):
        fitted, mode = found.figures[name], found.figures[f"mode_{name}"]
        cells = ["none" if value is None else f"{value:.5g}{unit}" for value in (fitted, mode)]
        apart = "" if fitted is None or not mode else f"{100 * (fitted / mode - 1):+.3g} %"
        table.add_row(name.replace("_", " "), *cells, apart)
    misfit = found.figures["ring_down_misfit"]
    if misfit is not None:
        table.add_row("misfit", f"{100 * misfit:.2g} %", "", "")
    return table
