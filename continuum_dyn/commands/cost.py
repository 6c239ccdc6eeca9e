"""``continuum-dyn cost``: what accuracy costs in time."""

import csv
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from continuum_dyn.commands.show import length, make_folder

if TYPE_CHECKING:
    from continuum_dyn.cost import Cost


def cost(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A scenario of a motion.", show_default=False)],
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder of what is written.")] = Path("logs"),
) -> None:
    """Show what accuracy costs in time.

    Runs the motion by every method over a range of tolerances and without each of its effects; prints
    error, time and work, and the cheapest way to each error. Writes DIR/NAME_cost.csv, .h5 and .png.
    """
    from continuum_dyn.cost import measure
    from continuum_dyn.record import write_cost
    from continuum_dyn.scenario import load_scenario
    from continuum_dyn.views import plots

    scenario = load_scenario(file)
    make_folder(out)
    measured = _with_status(scenario.title, lambda progress: measure(scenario, progress))
    stem = out / f"{file.stem}_cost"
    _write_csv(measured, stem.with_suffix(".csv"))
    write_cost(measured, stem.with_suffix(".h5"))
    plots.cost(measured).savefig(stem.with_suffix(".png"), dpi=130)
    _show(measured)
    typer.echo(f"written: {stem}.csv, .h5, .png")


def _with_status(title: str, work: Any) -> Any:
    from rich.console import Console

    console = Console(stderr=True)
    if not console.is_terminal:
        return work(lambda _: None)
    with console.status(title) as status:
        return work(lambda what: status.update(f"{title}: {what}"))


def _write_csv(measured: "Cost", path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["method", "rtol", "tip_error", "solve_time", "steps", "segment_evaluations"])
        for p in measured.prices:
            writer.writerow([p.method, p.rtol, p.error, p.seconds, p.steps, p.segment_evaluations])


def _show(measured: "Cost") -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console(highlight=False)

    def table(title: str, *columns: str) -> Any:
        made = Table(title=title, title_justify="left", box=None, pad_edge=False, header_style="dim")
        for number, column in enumerate(columns):
            made.add_column(column, justify="left" if number == 0 else "right")
        return made

    prices = table(measured.scenario.title, "method", "rtol", "tip error", "time", "steps", "work")
    for p in measured.prices:
        row = (length(p.error), f"{p.seconds * 1e3:.3g} ms", str(p.steps), str(p.segment_evaluations))
        prices.add_row(p.method, f"{p.rtol:.0e}", *row)
    for method, rtol in measured.over_budget.items():
        prices.add_row(method, f"{rtol:.0e}", "", "given up")
    console.print(prices)
    console.print(f"Errors against two references {length(measured.reference_gap)} apart; work in segment")
    console.print("evaluations.\n")
    effects = table("Without an effect", "left out", "tip moves by", "time", "fastest rate")
    effects.add_row("(nothing)", "", "1", f"{measured.fastest_rate:.3g} 1/s")
    for e in measured.effects:
        if e.tip_shift is None:
            effects.add_row(e.name, "no such motion without it")
        else:
            effects.add_row(e.name, length(e.tip_shift), f"{e.time_ratio:.2g}", f"{e.fastest_rate:.3g} 1/s")
    console.print(effects)
    frontier = table("\nCheapest way to a tip error", "below", "method", "rtol", "time", "work")
    for target, p in measured.frontier().items():
        if p is None:
            frontier.add_row(length(target), "not reached")
        else:
            time = f"{p.seconds * 1e3:.3g} ms"
            frontier.add_row(length(target), p.method, f"{p.rtol:.0e}", time, str(p.segment_evaluations))
    console.print(frontier)
