"""``continuum-dyn run``: simulate scenarios and log them."""

import json
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from continuum_dyn.commands.terminal.arguments import Folder, Overrides
from continuum_dyn.commands.terminal.clock import answer_begun
from continuum_dyn.commands.terminal.extras import MissingExtraError, naming_extras
from continuum_dyn.commands.terminal.log_names import hold_log, named_log
from continuum_dyn.commands.terminal.output import console, say
from continuum_dyn.commands.terminal.ramp_table import print_ramp, unsigned_zero
from continuum_dyn.commands.terminal.show import bending, counts, length, make_folder
from continuum_dyn.commands.terminal.verbosity import shows_progress
from statics.errors import InputError
from statics.support.interruption import defer_interruption
from statics.support.plain_text import plain
from statics.support.stages import stage

if TYPE_CHECKING:
    from continuum_dyn.record import Log
    from continuum_dyn.record.comparison import Comparison
    from continuum_dyn.scenario.scenario import Scenario
    from continuum_dyn.simulation import Run
    from continuum_dyn.simulation.resumption import Resumption

BAR_INTERVAL = 0.1
"""Shortest time between two updates of the progress bar, s."""


@dataclass(frozen=True)
class Job:
    """A scenario to answer, the file that it comes from, and its log, which may get a number.

    ``resumption`` is what it continues, ``earlier`` the log that its own is compared with.
    """

    source: Path
    scenario: "Scenario"
    log: Path
    resumption: "Resumption | None" = None
    earlier: "Log | None" = None
    numbered: bool = False


def run(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILE", help="Scenario files (TOML), or logs (.h5) to run again.", show_default=False
        ),
    ],
    overrides: Overrides = None,
    out: Folder = Path("logs"),
    name: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Write the log of one file to DIR/NAME.h5.", show_default=False),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object per line and file.")] = False,
    live: Annotated[bool, typer.Option("--live", help="Show each run in rerun as it goes.")] = False,
) -> None:
    """Simulate scenarios and log them.

    Writes DIR/NAME.h5 and DIR/NAME.rrd for each NAME.toml. With --set the log of another variant is kept, and
    this one becomes NAME_2.h5. For a log, its scenario is run again, into DIR/NAME_again.h5, and both are
    compared. Exit status: 0 answered ("not settled" is an answer), 1 not answered (no stable equilibrium,
    geometric limit, diverged, budget exceeded) or different from the log, 2 bad input, 130 interrupted.
    """
    jobs = _load(files, overrides or (), out)
    if name is not None:
        jobs = [_renamed(jobs, named_log(out, name))]
    make_folder(out)
    statuses = []
    for job in jobs:
        statuses.append(answer(job, as_json, live))
        if statuses[-1] > 1:
            break
    raise typer.Exit(max(statuses))


def _renamed(jobs: Sequence[Job], log: Path) -> Job:
    """The only job, with that log. Raises ``InputError`` if there are several."""
    if len(jobs) > 1:
        raise InputError(f"--name names one log, and there are {len(jobs)} files. Run them one by one.")
    if log.resolve() == jobs[0].source.resolve():
        raise InputError(f"--name {log.stem}: the log would replace {jobs[0].source}. Choose another name.")
    return replace(jobs[0], log=log, numbered=False)


def _load(files: list[Path], overrides: Sequence[str], out: Path) -> list[Job]:
    """All scenarios, checked before the first one runs."""
    for stem, count in Counter(path.stem for path in files).items():
        if count > 1:
            raise InputError(f"{count} files are named '{stem}'; their logs would overwrite each other.")
    with stage("scenarios read"):
        return [_job(path, overrides, out) for path in files]


def _job(path: Path, overrides: Sequence[str], out: Path) -> Job:
    with (
        defer_interruption()
    ):  # what Ctrl-C breaks off within the import of a library might come out as anything
        from continuum_dyn.record import read_log
        from continuum_dyn.record.logged_scenario import logged_scenario
        from continuum_dyn.record.reading import is_hdf5
        from continuum_dyn.scenario_files.reading import load_scenario

    missing_log = path.suffix == ".h5" and not path.exists()
    if not (is_hdf5(path) or missing_log):
        log = out / f"{path.stem}.h5"
        if path.resolve() == log.resolve():
            raise InputError(f"{path}: its log would replace it. Let scenarios end in .toml.")
        return Job(path, load_scenario(path, overrides), log, numbered=bool(overrides))
    log, again = read_log(path), out / f"{path.stem}_again.h5"
    return Job(path, logged_scenario(log, overrides), again, earlier=log, numbered=bool(overrides))


def answer(job: Job, as_json: bool, live: bool = False) -> int:
    """Answer a scenario, log it and print its results; return the exit status."""
    with defer_interruption():  # so that what was computed is logged
        report = _answer(job, as_json, live)
        if as_json:
            say(json.dumps(report["record"]))
        else:
            _show(report)
    comparison = report["comparison"]
    differs = comparison is not None and not comparison.same
    return max(report["run"].outcome.exit_status, int(differs))


def _answer(job: Job, quiet: bool, live: bool) -> dict[str, Any]:
    from continuum_dyn.record import read_log
    from continuum_dyn.record.comparison import compare
    from continuum_dyn.simulation import simulate

    started = answer_begun()
    with hold_log(job.log, job.scenario.text, job.numbered) as (streamed, replaces):
        if live:
            from continuum_dyn.views.playback.live import start

            start(streamed.path)
        with _progress(job.scenario.title, quiet) as progress:
            result = simulate(job.scenario, progress, sink=streamed, resumption=job.resumption)
        with stage("log written"):
            streamed.finish(result)
    log = read_log(streamed.path)
    with stage("recording written"):
        recording, without = _recording(log)
    wall_time = time.perf_counter() - started
    comparison = None if job.earlier is None else compare(job.earlier, log)
    record = _record(job.source, result, log.path, recording, wall_time)
    record["replaced"] = replaces
    if comparison is not None:
        record["compared"] = asdict(comparison) | {"same": comparison.same}
    extra = {"comparison": comparison, "source": job.source, "without_recording": without}
    return {"run": result, "log": log.path, "replaces": replaces, "record": record} | extra


def _recording(log: "Log") -> tuple[Path | None, str]:
    """The recording written beside a log, or None and the reason."""
    try:
        with naming_extras():
            from continuum_dyn.views.playback.recording import save
    except MissingExtraError as missing:
        return None, str(missing)
    recording = log.path.with_suffix(".rrd")
    save([log], recording)
    return recording, ""


def _record(path: Path, result: "Run", log: Path, recording: Path | None, wall_time: float) -> dict[str, Any]:
    """The answer as JSON; ``tip`` is x, y (m), theta (rad), times are in s, ``static_gap`` in m."""
    arm = result.scenario.scene.arm
    record: dict[str, Any] = {
        "scenario": str(path),
        "title": result.scenario.title,
        "outcome": str(result.outcome),
        "message": result.message,
        "tip": result.tip,
        "segments": arm.segments,
        "tip_error": result.tip_error,
        "mesh_error": None if result.mesh is None else result.mesh.estimate,
        "bending_strain": result.bending_strain,
        "warnings": list(result.warnings),
        "solve_time": result.solve_time,
        "wall_time": wall_time,
        "log": str(log),
        "recording": None if recording is None else str(recording),
    }
    if result.trajectory is not None:
        record["method"] = result.solver.method if result.solver else None
        record["static_gap"] = result.static_gap
        record["ledger_gap"] = (
            float(abs(result.trajectory.ledger_gap).max()) if result.trajectory.time.size else None
        )
        record |= result.trajectory.counters
    else:
        record["equilibria"] = [
            {
                "tension": point.tension.tolist(),
                "outcome": str(point.outcome),
                "tip": point.tip if point.found else None,
                "stable": point.stable,
                "critical": point.critical.name.lower(),
                "jumped": point.jumped,
            }
            for point in result.equilibria
        ]
    return record


@contextmanager
def _progress(title: str, quiet: bool) -> Iterator[Any]:
    """A progress bar on a terminal; during compilation it only pulses, with a message."""
    screen = console(stderr=True)
    if quiet or not (screen.is_terminal and shows_progress()):
        yield None
        return
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

    title, latest = plain(title), time.monotonic()
    columns = TextColumn("{task.description}", markup=False), BarColumn()
    with Progress(
        *columns, TaskProgressColumn(), TimeRemainingColumn(), console=screen, transient=True
    ) as bar:
        task = bar.add_task(f"{title}: loading its kernels, or compiling new ones", total=None)

        def update(fraction: float) -> None:
            nonlocal latest
            if time.monotonic() - latest > BAR_INTERVAL:
                latest = time.monotonic()
                bar.update(task, description=title, total=1.0, completed=fraction)

        yield update


def _show(report: dict[str, Any]) -> None:
    from rich.table import Table
    from rich.text import Text

    result: Run = report["run"]
    record = report["record"]
    table = Table(
        title=result.scenario.title, title_justify="left", show_header=False, box=None, pad_edge=False
    )
    table.add_column(style="dim", no_wrap=True)
    table.add_column(overflow="fold")
    table.add_row("outcome", Text(str(result.outcome), style="bold"))
    if result.message:
        table.add_row("", result.message)
    if result.tip is not None:
        of_last = result.trajectory is not None or result.equilibria[-1].found
        table.add_row("tip", _pose(result.tip) + ("" if of_last else ", the last one found"))
    if result.static_gap is not None:
        rest = "the nearest rest that friction allows" if len(result.rests) > 1 else "the final equilibrium"
        table.add_row("gap to static", f"{length(result.static_gap)} from {rest}")
    if result.trajectory is not None:
        _add_motion(table, result)
    if result.tip_error is not None:
        table.add_row("accuracy", _accuracy(result, result.tip_error))
    if result.bending_strain is not None:
        table.add_row("bending", bending(result.bending_strain))
    for warning in result.warnings:
        table.add_row("warning", warning)
    table.add_row("time", f"{result.solve_time:.3g} s solving, {record['wall_time']:.3g} s in all")
    if report["comparison"] is not None:
        table.add_row("compared", _comparison_text(report["comparison"], report["source"]))
    replaced = ", replaces the log of another scenario" if report["replaces"] else ""
    table.add_row("log", f"{report['log']}{replaced}")
    if report["without_recording"]:
        table.add_row("recording", f"none; {report['without_recording']}")
    else:
        table.add_row("play it", f"continuum-dyn play {report['log']}")
    screen = console()
    screen.print(table)
    points = result.equilibria
    if result.trajectory is None and len(points) > 1:
        print_ramp(result.scenario, points)
    screen.print()


def _comparison_text(found: "Comparison", earlier: Path) -> str:
    """Whether the run is the same as the earlier one."""
    verdict = "same as" if found.same else "DIFFERENT from"
    parts = [f"{verdict} {earlier}"]
    if found.outcomes[0] != found.outcomes[1]:
        parts.append(f"outcome {found.outcomes[1]}, was {found.outcomes[0]}")
    if found.tip_distance is None:
        parts.append("no tip to compare")
    elif found.tip_distance == 0.0:
        parts.append("tips equal to the last bit")
    else:
        apart = f"{length(found.tip_distance)} apart {found.place}"
        parts.append(f"tips at most {apart}, allowed {length(found.allowed)}")
    return "; ".join(parts)


def _add_motion(table: Any, result: "Run") -> None:
    """Method, accuracy and energy balance of the motion."""
    trajectory, solver = result.trajectory, result.solver
    assert trajectory is not None
    assert solver is not None
    table.add_row("solver", f"{solver.method}: {counts(trajectory.counters)}")
    energy = max(
        float(abs(column).max(initial=0.0))
        for name, column in trajectory.ledger.items()
        if "power" not in name
    )
    if energy > 0.0:
        gap = float(abs(trajectory.ledger_gap).max())
        table.add_row("power ledger", f"closes to {gap / energy:.1g} of the largest energy in it")


def _accuracy(result: "Run", error: float) -> str:
    """The checks of the equilibria, and the work they took."""
    took = [] if result.solver is None else [f"rtol {result.solver.rtol:.1e}"]
    if result.mesh is not None:
        found = result.mesh
        meshes = (
            f"from {found.subsegments} and {2 * found.subsegments}"
            if found.extrapolated
            else f"= {found.subsegments}"
        )
        took.append(f"subsegments {meshes}, which contribute {length(found.estimate)}")
    verdict = "estimated, more than requested" if "not reached" in result.message else "checked"
    return f"tip within {length(error)}, {verdict}; {', '.join(took)}"


def _pose(tip: tuple[float, float, float]) -> str:
    x, y, theta = map(unsigned_zero, (f"{1e3 * tip[0]:.4f}", f"{1e3 * tip[1]:.4f}", f"{tip[2]:.5f}"))
    return f"x {x} mm, y {y} mm, theta {theta} rad"
