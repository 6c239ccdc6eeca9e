"""What the commands share: a length in its best unit, a table, a folder to write to."""

from pathlib import Path
from typing import Any

from statics.errors import LogError


def length(value: float) -> str:
    """A length (m) in the unit that reads best."""
    for unit, size in (("m", 1.0), ("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9)):
        if value >= 0.999 * size:
            return f"{value / size:.3g} {unit}"
    return f"{value / 1e-12:.3g} pm"


def table(title: str, *columns: str) -> Any:
    """An empty table of rich's; numbers stand to the right, names in the first column to the left."""
    from rich.table import Table

    made = Table(title=title, title_justify="left", box=None, pad_edge=False, header_style="dim")
    for number, column in enumerate(columns):
        made.add_column(column, justify="left" if number == 0 else "right")
    return made


def make_folder(folder: Path) -> None:
    """Make the folder, or raise ``LogError`` if nothing can be written there."""
    probe = folder / ".writable"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise LogError(
            f"cannot write to the folder {folder}: {error.strerror}. Name another with --out."
        ) from error
