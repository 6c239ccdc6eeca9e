"""Helpers of the commands: quantities in readable units, a plain table, progress, a folder."""

import sys
from collections.abc import Callable, Mapping
from math import isfinite
from pathlib import Path
from shutil import get_terminal_size
from tempfile import TemporaryFile
from textwrap import TextWrapper
from typing import TYPE_CHECKING, Any

from continuum_dyn.commands.terminal.output import console
from continuum_dyn.commands.terminal.verbosity import shows_progress
from statics.errors import LogError
from statics.support.interruption import defer_interruption
from statics.support.plain_text import plain

if TYPE_CHECKING:
    from continuum_dyn.modes import Mode

LEAST_STRAIN = 1e-9
"""Bending strain below which a core is said to be straight: rounding leaves some."""


def length(value: float) -> str:
    """A length (m) in the unit that reads best."""
    for unit, size in (("m", 1.0), ("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9)):
        if value >= 0.999 * size:
            return f"{value / size:.3g} {unit}"
    return f"{value / 1e-12:.3g} pm"


def energy(value: float) -> str:
    """An energy (J) in the unit that reads best."""
    for unit, size in (("J", 1.0), ("mJ", 1e-3), ("uJ", 1e-6), ("nJ", 1e-9)):
        if abs(value) >= 0.999 * size:
            return f"{value / size:.3g} {unit}"
    return f"{value / 1e-12:.3g} pJ"


def duration(value: float) -> str:
    """A time (s) in the unit that reads best."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if abs(value) >= 0.999 * size:
            return f"{value / size:.3g} {unit}"
    return f"{value / 1e-9:.3g} ns"


def counts(counters: Mapping[str, int]) -> str:
    """Counters of a motion with their names: "12 steps, 40 Newton iterations"."""
    words = {name: name.replace("_", " ").replace("newton", "Newton") for name in counters}
    return ", ".join(f"{count} {words[name]}" for name, count in counters.items())


def bending(strain: float) -> str:
    """Largest bending strain, in percent."""
    return f"{100.0 * strain:.2g} % strain of the core at most" if strain >= LEAST_STRAIN else "none"


def mode_row(mode: "Mode") -> tuple[str, str, str]:
    """Frequency, damping ratio and decay time of a mode."""
    kind = "" if mode.kind == "swings" else f", {mode.kind}"
    decay_time = duration(abs(mode.decay_time)) if isfinite(mode.decay_time) else "never"
    grows = "grows e-fold in " if mode.grows else ""
    return f"{mode.frequency:.5g} Hz", f"{mode.damping_ratio:.3g}{kind}", f"{grows}{decay_time}"


def wrap(message: str) -> str:
    """A message of the program with its lines broken at words, where standard error is a terminal."""
    if not sys.stderr.isatty():
        return message
    lines = TextWrapper(get_terminal_size().columns, subsequent_indent="  ")
    lines.break_long_words = lines.break_on_hyphens = False  # of paths, options and commands
    return "\n".join(map(lines.fill, message.splitlines()))


def make_folder(folder: Path) -> None:
    """Make a folder. Raises ``LogError`` if nothing can be written there."""
    try:
        with defer_interruption():
            folder.mkdir(parents=True, exist_ok=True)
            TemporaryFile(dir=folder).close()
    except OSError as error:
        raise LogError(
            f"cannot write to the folder {folder}: {error.strerror}. Name another with --out."
        ) from error


def plain_table(title: str, *columns: str) -> Any:
    """A plain table of rich: the first column to the left, the others to the right."""
    from rich.table import Table

    made = Table(title=title, title_justify="left", box=None, pad_edge=False, header_style="dim")
    for number, column in enumerate(columns):
        made.add_column(column, justify="left" if number == 0 else "right")
    return made


def with_status(title: str, work: Callable[[Callable[[str], None]], Any]) -> Any:
    """Run ``work``, whose argument shows progress on a terminal, and return its result."""
    screen = console(stderr=True)
    if not (screen.is_terminal and shows_progress()):
        return work(lambda _: None)
    from rich.text import Text  # of a plain string rich would take the markup

    title = plain(title)
    with screen.status(Text(title)) as status:
        return work(lambda what: status.update(Text(f"{title}: {plain(what)}")))
