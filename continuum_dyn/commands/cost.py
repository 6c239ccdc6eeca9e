"""``continuum-dyn cost``: computing time against accuracy."""

import csv
from dataclasses import asdict
from math import log2
from pathlib import Path
from typing import TYPE_CHECKING, Any

from continuum_dyn.commands.terminal.arguments import Folder, Overrides, ScenarioFile
from continuum_dyn.commands.terminal.output import console, say
from continuum_dyn.commands.terminal.show import length, make_folder, plain_table, with_status
from statics.support.interruption import defer_interruption

if TYPE_CHECKING:
    from collections.abc import Sequence

    from continuum_dyn.experiments.cost import Cost, MeshPrice


def cost(
    file: ScenarioFile,
    overrides: Overrides = None,
    out: Folder = Path("logs"),
) -> None:
    """Show the computing time that accuracy costs.

    Runs the motion by every method over a range of tolerances, on finer and finer meshes, and without each
    of its effects. Prints error, least time and work, and the cheapest method for each error: that of least
    work, weighted with its method's time for an evaluation. Writes DIR/NAME_cost.csv, NAME_cost_mesh.csv,
    NAME_cost.h5 and NAME_cost.png.
    """
    from continuum_dyn.experiments.cost import measure
    from continuum_dyn.experiments.cost_file import write_cost
    from continuum_dyn.scenario_files.reading import load_scenario
    from continuum_dyn.views.figures import plots

    scenario = load_scenario(file, overrides or ())
    make_folder(out)
    measured = with_status(scenario.title, lambda progress: measure(scenario, progress))
    stem = out / f"{file.stem}_cost"
    with defer_interruption():
        _write_csv(measured, stem.with_suffix(".csv"))
        _write_mesh_csv(measured, out / f"{file.stem}_cost_mesh.csv")
        write_cost(measured, stem.with_suffix(".h5"))
        plots.cost(measured).savefig(stem.with_suffix(".png"), dpi=130)
    _show(measured)
    say(f"written: {stem}.csv, _mesh.csv, .h5, .png")


def _write_csv(measured: "Cost", path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["method", "rtol", "tip_error", "solve_time", "steps", "segment_evaluations"])
        for p in measured.prices:
            writer.writerow([p.method, p.rtol, p.error, p.seconds, p.steps, p.segment_evaluations])


def _write_mesh_csv(measured: "Cost", path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        if measured.meshes:
            writer.writerow(asdict(measured.meshes[0]))
        writer.writerows(asdict(mesh).values() for mesh in measured.meshes)


def _show(measured: "Cost") -> None:
    screen = console()
    screen.print(_price_table(measured))
    screen.print(
        f"Errors against a reference, checked by a second one {length(measured.reference_gap)} away;"
    )
    screen.print("work in segment evaluations.\n")
    if measured.meshes:
        screen.print(_mesh_table(measured.meshes))
        screen.print("At rest under the last tensions, against the exact rod. From two: extrapolated")
        screen.print("from this mesh and the one before.\n")
    else:
        screen.print(f"No mesh errors: {measured.no_meshes}\n")
    screen.print(_effect_table(measured))
    screen.print(_frontier_table(measured))


def _price_table(measured: "Cost") -> Any:
    prices = plain_table(measured.scenario.title, "method", "rtol", "tip error", "time", "steps", "work")
    for p in measured.prices:
        row = (length(p.error), f"{p.seconds * 1e3:.3g} ms", str(p.steps), str(p.segment_evaluations))
        prices.add_row(p.method, f"{p.rtol:.0e}", *row)
    for method, rtol in measured.over_budget.items():
        prices.add_row(method, f"{rtol:.0e}", "", "given up")
    return prices


def _mesh_table(meshes: "Sequence[MeshPrice]") -> Any:
    columns = ("subsegments", "tip", "order", "angle", "order", "from two", "order", "statics", "motion")
    made = plain_table("Meshes", *columns)
    for before, mesh in zip((None, *meshes), meshes, strict=False):
        names = ("tip_error", "angle_error", "limit_error")
        errors = [getattr(mesh, name) for name in names]
        orders = [
            _order(getattr(before, name, None), error) for name, error in zip(names, errors, strict=True)
        ]
        moved = "" if mesh.motion_seconds is None else f"{mesh.motion_seconds * 1e3:.3g} ms"
        made.add_row(
            str(mesh.subsegments),
            *(length(errors[0]), orders[0]),
            *(f"{errors[1]:.1e}", orders[1]),
            *("" if errors[2] is None else length(errors[2]), orders[2]),
            *(f"{mesh.seconds * 1e6:.3g} us", moved),
        )
    return made


def _order(before: float | None, error: float | None) -> str:
    """Order of convergence: the power of the number of segments by which the error fell."""
    return f"{log2(before / error):.1f}" if before and error else ""


def _effect_table(measured: "Cost") -> Any:
    effects = plain_table(
        "Effects left out one at a time", "left out", "tip moves by", "time", "fastest rate"
    )
    effects.add_row("(nothing)", "", "1", f"{measured.fastest_rate:.3g} 1/s")
    for e in measured.effects:
        if e.tip_shift is None:
            effects.add_row(e.name, "no motion without it")
        else:
            effects.add_row(e.name, length(e.tip_shift), f"{e.time_ratio:.2g}", f"{e.fastest_rate:.3g} 1/s")
    return effects


def _frontier_table(measured: "Cost") -> Any:
    title = "\nCheapest way to a tip error, by work at each method's time for an evaluation"
    frontier = plain_table(title, "below", "method", "rtol", "time", "work")
    for target, p in measured.frontier().items():
        if p is None:
            frontier.add_row(length(target), "not reached")
        else:
            time = f"{p.seconds * 1e3:.3g} ms"
            frontier.add_row(length(target), p.method, f"{p.rtol:.0e}", time, str(p.segment_evaluations))
    return frontier
