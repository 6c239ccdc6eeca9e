"""``continuum-dyn hard``: run hard cases by every method that claims them, and hold them to their bounds."""

import csv
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from continuum_dyn.commands.show import duration, length, with_status
from statics.errors import InputError, LogError

if TYPE_CHECKING:
    from continuum_dyn.hard_cases import HardCase, Verdict

PATIENCE = 2.0
"""Seconds for a method that does not claim a case."""
COLUMNS = ("case", "method", "outcome", "error", "steps", "work", "time", "")
CSV_COLUMNS = (
    *("case", "method", "claimed", "outcome", "tip_error", "steps", "segment_evaluations"),
    *("solve_time", "missed"),
)
ROW = "  {:<9} {:<20} {:>9} {:>8} {:>8} {:>8} {:>7}"
"""A verdict's line on a terminal, below its case."""
SUFFIXES = (".md", ".csv")


def hard(
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder of scenarios that expect something.")
    ] = Path("scenarios/hard"),
    out: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Where the table goes: FILE.md or FILE.csv.")
    ] = None,
    every: Annotated[
        bool, typer.Option("--every-method", help="Run the methods that do not claim a case, too.")
    ] = False,
) -> None:
    """Run hard cases and hold them to their bounds.

    Each scenario of the folder states its bounds in a table [expect]; it is run by every method that claims
    it. Prints a table, and what broke a bound. Exit status: 0 all bounds are kept, 1 one is not, 2 bad input.
    """
    from continuum_dyn.hard_cases import judge, load_case
    from continuum_dyn.integrators import METHODS

    if out is not None and out.suffix not in SUFFIXES:
        raise InputError(f"--out {out}: a table is written to a file that ends in {' or '.join(SUFFIXES)}.")
    paths = sorted(folder.glob("*.toml"))
    if not paths:
        raise InputError(f"{folder}: holds no scenarios (*.toml).")
    cases = [load_case(path) for path in paths]
    others: Any = METHODS if every else ()

    def all_judged(told: Callable[[str], None]) -> "list[Verdict]":
        return [verdict for case in cases for verdict in judge(case, others, PATIENCE, told)]

    verdicts = with_status(str(folder), all_judged)
    _show(verdicts)
    if out is not None:
        _write(out, cases, verdicts)
        typer.echo(f"written: {out}")
    raise typer.Exit(int(any(verdict.claimed and verdict.missed for verdict in verdicts)))


def _write(path: Path, cases: "Sequence[HardCase]", verdicts: "Sequence[Verdict]") -> None:
    try:
        if path.suffix == ".csv":
            _write_csv(path, verdicts)
        else:
            path.write_text(_markdown(cases, verdicts), encoding="utf-8")
    except OSError as error:
        raise LogError(f"cannot write {path}: {error.strerror or error}.") from error


def _write_csv(path: Path, verdicts: "Iterable[Verdict]") -> None:
    """SI units; empty where there is no such number."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(CSV_COLUMNS)
        for verdict in verdicts:
            run, counters = verdict.run, _counters(verdict)
            outcome, seconds = ("refused", None) if run is None else (str(run.outcome), run.solve_time)
            work = (counters.get(name) for name in ("steps", "segment_evaluations"))
            found = (verdict.claimed, outcome, verdict.tip_error, *work, seconds)
            writer.writerow([verdict.case, verdict.method, *found, "; ".join(verdict.missed)])


def _counters(verdict: "Verdict") -> dict[str, int]:
    return {} if verdict.run is None or verdict.run.trajectory is None else verdict.run.trajectory.counters


def _row(verdict: "Verdict") -> tuple[str, ...]:
    """The cells of a verdict, but for its case."""
    if verdict.run is None:
        return verdict.method, "refused", "", "", "", "", "missed" if verdict.claimed else ""
    counters, error = _counters(verdict), verdict.tip_error
    return (
        verdict.method,
        str(verdict.run.outcome),
        "" if error is None else length(error),
        *(_count(counters.get(name)) for name in ("steps", "segment_evaluations")),
        duration(verdict.run.solve_time),
        "missed" if verdict.missed else "met",
    )


def _count(value: int | None) -> str:
    if value is None:
        return ""
    return str(value) if value < 100_000 else f"{value:.1e}".replace("e+0", "e")


def _show(verdicts: "Iterable[Verdict]") -> None:
    typer.echo(ROW.format(*COLUMNS[1:]))
    last = ""
    for verdict in verdicts:
        if verdict.case != last:
            typer.echo(verdict.case)
        typer.echo(ROW.format(*_row(verdict)).rstrip())
        last = verdict.case
    typer.echo("\nError of the tip against a much tighter run; work in segment evaluations.")
    for verdict in verdicts:
        if verdict.claimed and verdict.missed:
            typer.echo(f"{verdict.case}, {verdict.method}: {'; '.join(verdict.missed)}")


def _markdown(cases: "Iterable[HardCase]", verdicts: "Sequence[Verdict]") -> str:
    """Each case with its title, then the methods that claim it, then the others."""
    lines = [
        "# Hard cases",
        "",
        INTRODUCTION,
        "",
        "| case | why it is hard, and what must hold |",
        "|---|---|",
    ]
    lines += [f"| `{case.name}` | {case.scenario.title} |" for case in cases]
    claimed = [verdict for verdict in verdicts if verdict.claimed]
    others = [verdict for verdict in verdicts if not verdict.claimed]
    lines += ["", "## Methods that claim a case", "", *_markdown_table(claimed)]
    if others:
        lines += ["", "## Methods that do not", "", OTHERS, "", *_markdown_table(others)]
        lines += ["", "What they missed:", ""]
        lines += [f"- `{v.case}`, {v.method}: {v.refused or '; '.join(v.missed)}" for v in others if v.missed]
    return "\n".join(lines) + "\n"


INTRODUCTION = """\
Written by `continuum-dyn hard`, which runs the scenarios of a folder and holds each to the bounds of its
table `[expect]`. Error: largest distance of the tip from a much tighter run. Work: segment evaluations. Time:
solving alone, with kernels loaded."""

OTHERS = f"""\
The same cases by every other method, {PATIENCE:g} s for each; refused: the method cannot integrate such a
scene. Missed: it broke a bound."""


def _markdown_table(verdicts: "Iterable[Verdict]") -> list[str]:
    lines = ["| " + " | ".join(COLUMNS) + " |", "|---" * len(COLUMNS) + "|"]
    lines += ["| " + " | ".join((verdict.case, *_row(verdict))) + " |" for verdict in verdicts]
    return lines
