"""``continuum-dyn info``: the contents of a log."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from continuum_dyn.commands.terminal.output import console, give_back
from continuum_dyn.commands.terminal.show import bending, counts, duration, length, plain_table

if TYPE_CHECKING:
    import numpy as np

    from continuum_dyn.record import Log


def info(
    log: Annotated[Path, typer.Argument(metavar="LOG", help="A log written by run.", show_default=False)],
    scenario: Annotated[
        bool, typer.Option("--scenario", help="Print only the text of its scenario.")
    ] = False,
) -> None:
    """Show the contents of a log: outcome, method, arm, and each dataset with its range.

    With --scenario it prints the scenario file of the run: info LOG --scenario > NAME.toml
    """
    from continuum_dyn.record import read_log

    found = read_log(log)
    if scenario:
        give_back(found.scenario)
        return
    screen = console()
    screen.print(_overview(found))
    groups = {"trajectory": found.trajectory, "equilibria": found.equilibria}
    for name, columns in groups.items():
        if columns:
            screen.print(_datasets(name, columns))


def _overview(log: "Log"):
    from rich.table import Table

    table = Table(title=log.title, title_justify="left", show_header=False, box=None, pad_edge=False)
    table.add_column(style="dim", no_wrap=True)
    table.add_column(overflow="fold")
    for name, value in _facts(log):
        table.add_row(name, value)
    return table


def _facts(log: "Log") -> Iterator[tuple[str, str]]:
    given, arm = log.attributes, log.arm
    yield "outcome", str(log.outcome) + (f": {log.message}" if log.message else "")
    if not log.complete:
        yield "", f"not complete; to resume: continuum-dyn resume {log.path}"
    settings = [f"{name} {given[name]:g}" for name in ("rtol", "atol", "step") if name in given]
    yield "study", " by ".join([given["study"], *([given["method"]] if "method" in given else [])])
    if settings:
        yield "settings", ", ".join(settings)
    if log.counters:
        yield "work", counts(log.counters)
    for name in ("static_gap", "tip_error", "mesh_error"):
        if name in given:
            yield name.replace("_", " "), length(given[name])
    if "bending_strain" in given:
        yield "bending", bending(given["bending_strain"])
    for warning in given.get("warnings", "").splitlines():
        yield "warning", warning
    yield "solving", f"{duration(given['solve_time'])}"
    cables = f"cables {', '.join(log.cables)}" if log.cables else "no cables"
    yield "arm", f"{arm['disks']} disks, {arm['disks'] * arm['subsegments']} segments, {cables}"
    tables = f" and {', '.join(log.tables)}" if log.tables else ""
    lines = len(log.scenario.splitlines())
    yield (
        "scenario",
        f"{lines} lines{tables}; print it with --scenario" if lines else "none: the run was made from Python",
    )
    yield "file", f"format {given['format_version']}, {log.path.stat().st_size / 1000:.0f} kB"
    yield "made by", given["versions"]


def _datasets(group: str, columns: "Mapping[str, np.ndarray]"):
    """Each dataset with its shape, unit, least and largest value."""
    from statics.quantities import QUANTITIES

    table = plain_table("\n" + group, "", "shape", "unit", "least", "largest")
    for name, values in columns.items():
        ends = [f"{float(end):.5g}" for end in (values.min(), values.max())] if values.size else ["", ""]
        table.add_row(name, " x ".join(map(str, values.shape)), QUANTITIES[name].unit, *ends)
    return table
