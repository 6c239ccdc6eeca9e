"""``continuum-dyn hard``: run hard cases by every method listed in them, and check their bounds."""

import csv
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from continuum_dyn.commands.terminal.output import say
from continuum_dyn.commands.terminal.show import duration, length, with_status
from statics.errors import InputError, LogError

if TYPE_CHECKING:
    from continuum_dyn.experiments.hard_cases import Verdict

PATIENCE = 1.0
"""Longest time of a method that a case does not list, s."""
COLUMNS = ("method", "outcome", "error", "steps", "work", "time", "used")
CSV_COLUMNS = (
    *("case", "method", "claimed", "outcome", "tip_error", "steps", "segment_evaluations"),
    *("solve_time", "used", "missed"),
)
ROW = "  {:<9} {:<20} {:>9} {:>8} {:>8} {:>8} {:>7}"
"""A verdict's line on a terminal, below its case."""
SUFFIXES = (".md", ".csv")


def hard(
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder of scenarios with a table [expect].")
    ] = Path("scenarios/hard"),
    out: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the table to FILE.md or FILE.csv.")
    ] = None,
    every: Annotated[
        bool, typer.Option("--every-method", help="Also run the methods that a case does not list.")
    ] = False,
) -> None:
    """Run hard cases and check their bounds.

    A table [expect] in each scenario of the folder states how it must end, and by which methods; each of
    these methods runs it. Prints a table, and every bound that is exceeded. Exit status: 0 no bound is
    exceeded, 1 at least one is, 2 bad input.
    """
    from continuum_dyn.experiments.hard_cases import judge, load_cases
    from continuum_dyn.integrators import METHODS

    if out is not None and out.suffix not in SUFFIXES:
        raise InputError(f"--out {out}: a table is written to a file that ends in {' or '.join(SUFFIXES)}.")
    paths = sorted(folder.glob("*.toml"))
    if not paths:
        raise InputError(f"{folder}: holds no scenarios (*.toml).")
    cases = [case for path in paths for case in load_cases(path)]
    others: Any = METHODS if every else ()

    def judge_all(progress: Callable[[str], None]) -> "list[Verdict]":
        return [verdict for case in cases for verdict in judge(case, others, PATIENCE, progress)]

    verdicts = with_status(str(folder), judge_all)
    _show(verdicts)
    if out is not None:
        _write(out, verdicts)
        say(f"written: {out}")
    raise typer.Exit(int(any(verdict.claimed and verdict.missed for verdict in verdicts)))


def _write(path: Path, verdicts: "Sequence[Verdict]") -> None:
    try:
        if path.suffix == ".csv":
            _write_csv(path, verdicts)
        else:
            path.write_text(_markdown(verdicts), encoding="utf-8")
    except OSError as error:
        raise LogError(f"cannot write {path}: {error.strerror or error}.") from error


def _write_csv(path: Path, verdicts: "Iterable[Verdict]") -> None:
    """Write the verdicts in SI units; a cell without a number stays empty."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(CSV_COLUMNS)
        for verdict in verdicts:
            run, counters = verdict.run, _counters(verdict)
            outcome, seconds = ("refused", None) if run is None else (str(run.outcome), run.solve_time)
            work = (counters.get(name) for name in ("steps", "segment_evaluations"))
            used = verdict.used if verdict.bounds else None
            found = (verdict.claimed, outcome, verdict.tip_error, *work, seconds, used)
            writer.writerow([verdict.case.name, verdict.method, *found, "; ".join(verdict.missed)])


def _counters(verdict: "Verdict") -> dict[str, int]:
    return {} if verdict.run is None or verdict.run.trajectory is None else verdict.run.trajectory.counters


def _row(verdict: "Verdict") -> tuple[str, ...]:
    """The cells of a verdict."""
    if verdict.run is None:
        return verdict.method, "refused", "", "", "", "", "missed" if verdict.claimed else ""
    counters, error = _counters(verdict), verdict.tip_error
    return (
        verdict.method,
        str(verdict.run.outcome),
        "" if error is None else length(error),
        *(_count(counters.get(name)) for name in ("steps", "segment_evaluations")),
        duration(verdict.run.solve_time),
        "missed" if verdict.missed else _percent(verdict.used),
    )


def _count(value: int | None) -> str:
    if value is None:
        return ""
    return str(value) if value < 100_000 else f"{value:.1e}".replace("e+0", "e")


def _percent(part: float) -> str:
    return f"{100.0 * part:.0f} %" if part >= 0.01 else "< 1 %"


def _show(verdicts: "Iterable[Verdict]") -> None:
    say(ROW.format(*COLUMNS))
    for name, of_case in groupby(verdicts, key=lambda verdict: verdict.case.name):
        say(name)
        for verdict in of_case:
            say(ROW.format(*_row(verdict)).rstrip())
    say("\nError of the tip against a much tighter run; work in segment evaluations;")
    say("used: the largest part of what a bound allows.")
    for verdict in verdicts:
        if verdict.claimed and verdict.missed:
            say(f"{verdict.case.name}, {verdict.method}: {'; '.join(verdict.missed)}")


def _markdown(verdicts: "Sequence[Verdict]") -> str:
    """Totals of each method; then each case with its title and a table, the listed methods first."""
    lines = ["# Hard cases", "", INTRODUCTION, ""]
    if not all(verdict.claimed for verdict in verdicts):
        lines += [OTHERS, "", *_totals(verdicts), ""]
    for title, of_title in groupby(verdicts, key=lambda verdict: verdict.case.scenario.title):
        lines += [f"## {title}", ""]
        for name, of_case in groupby(of_title, key=lambda verdict: verdict.case.name):
            lines += [f"`{name}`", "", *_table(list(of_case)), ""]
    return "\n".join(lines).rstrip() + "\n"


INTRODUCTION = """\
Written by `continuum-dyn hard`, which runs the scenarios of a folder and checks
their stated or implied bounds. Error: largest distance of the tip from a much
tighter run by the last method listed in the case. Work: segment evaluations.
Time: solving alone, with kernels loaded. Used: the largest part of a bound that
is used up."""

OTHERS = f"""\
Methods in brackets are not listed in the case; each has {PATIENCE:g} s. The table counts
the cases in which each method kept every bound, and the other results:"""


def _totals(verdicts: "Iterable[Verdict]") -> list[str]:
    """Number of cases in which each method kept the bounds, and of each kind of failure."""
    kinds: dict[str, Counter[str]] = {}
    for verdict in verdicts:
        kinds.setdefault(verdict.method, Counter())[_kind(verdict)] += 1
    names = ("kept", "bound missed", "out of time", "diverged", "refused")
    lines = ["| method | " + " | ".join(names) + " |", "|---" + "|--:" * len(names) + "|"]
    return lines + [
        f"| {method} | " + " | ".join(str(found[name] or "") for name in names) + " |"
        for method, found in kinds.items()
    ]


def _kind(verdict: "Verdict") -> str:
    if verdict.run is None:
        return "refused"
    outcome = str(verdict.run.outcome)
    named = {"budget_exceeded": "out of time", "diverged": "diverged"}
    return named.get(outcome, "bound missed") if verdict.missed else "kept"


def _table(verdicts: "Sequence[Verdict]") -> list[str]:
    lines = ["| " + " | ".join(COLUMNS) + " |", "|---|---" + "|--:" * 4 + "|---|"]
    for verdict in verdicts:
        method, *cells, used = _row(verdict)
        if verdict.missed:
            used = _failing(verdict)
        lines.append("| " + " | ".join((method if verdict.claimed else f"({method})", *cells, used)) + " |")
    return lines


def _failing(verdict: "Verdict") -> str:
    """The failure of a method, in short."""
    if verdict.bounds:
        return "missed: " + ", ".join(bound.name for bound in verdict.bounds if not bound.kept)
    if verdict.run is None or verdict.run.trajectory is None:
        return "missed"
    return f"at {duration(float(verdict.run.trajectory.time[-1]))}"
