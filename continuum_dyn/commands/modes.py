"""``continuum-dyn modes``: frequencies, damping and shapes of small motions about rest."""

import csv
from pathlib import Path
from typing import TYPE_CHECKING, Any

from continuum_dyn.commands.terminal.arguments import Folder, Overrides, ScenarioFile
from continuum_dyn.commands.terminal.output import console, say
from continuum_dyn.commands.terminal.show import make_folder, mode_row, plain_table, with_status
from statics.support.interruption import defer_interruption

if TYPE_CHECKING:
    from continuum_dyn.modes import RestModes

MAX_ROWS = 20
"""Largest number of modes that are printed; the CSV holds all."""
COLUMNS = (
    "mode",
    "frequency",
    "damping_ratio",
    "decay_rate",
    "fast_decay_rate",
    "disk",
    "shape_x",
    "shape_y",
    "shape_theta",
)
"""Columns of the CSV, by glossary name."""


def modes(
    file: ScenarioFile,
    overrides: Overrides = None,
    out: Folder = Path("logs"),
) -> None:
    """Show the modes of the arm at rest.

    These are small motions about the initial equilibrium: frequency, damping ratio, decay time, shape. The
    scene needs the effect inertia. Writes DIR/NAME_modes.csv, with the shapes of all modes, and
    NAME_modes.png, with the first six.
    """
    from continuum_dyn.modes import modes_at_rest
    from continuum_dyn.scenario_files.reading import load_scenario
    from continuum_dyn.views.figures import plots

    scenario = load_scenario(file, overrides or ())
    make_folder(out)
    found = with_status(scenario.title, lambda _: modes_at_rest(scenario))
    stem = out / f"{file.stem}_modes"
    with defer_interruption():
        _write_csv(found, stem.with_suffix(".csv"))
        plots.modes(found).savefig(stem.with_suffix(".png"), dpi=130)
    _show(found)
    say(f"written: {stem}.csv, .png")


def _write_csv(found: "RestModes", path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        for number, mode in enumerate(found.modes, start=1):
            slow, fast = (*mode.decay_rates, "")[:2]
            for disk, shape in enumerate(mode.shape.tolist(), start=1):
                writer.writerow([number, mode.frequency, mode.damping_ratio, slow, fast, disk, *shape])


def _show(found: "RestModes") -> None:
    screen = console()
    screen.print(_mode_table(found))
    if len(found.modes) > MAX_ROWS:
        screen.print(f"and {len(found.modes) - MAX_ROWS} more, up to {found.modes[-1].frequency:.5g} Hz.")
    screen.print(f"\nAbout the equilibrium that the scenario starts from{_tensions(found)}. Frequencies are")
    screen.print("undamped; tip along x, y: its displacement, relative to the largest of any disk.")


def _tensions(found: "RestModes") -> str:
    return (
        f" ({', '.join(f'{tension:g} N' for tension in found.rest.tension)})"
        if found.rest.tension.size
        else ""
    )


def _mode_table(found: "RestModes") -> Any:
    title = f"{found.scenario.title}: modes at rest"
    shown = plain_table(title, "mode", "frequency", "damping ratio", "falls to 1/e in", "tip along x", "y")
    for number, mode in enumerate(found.modes[:MAX_ROWS], start=1):
        x, y, _ = mode.shape[-1].round(2) + 0.0  # no -0.00
        shown.add_row(str(number), *mode_row(mode), f"{x:.2f}", f"{y:.2f}")
    return shown
