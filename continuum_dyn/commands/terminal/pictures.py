"""Figures on their way to a file."""

from pathlib import Path
from typing import TYPE_CHECKING

from statics.errors import LogError
from statics.support.interruption import held

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DOTS_PER_INCH = 200
"""Of pictures that are no vectors."""


def save(figure: "Figure", path: Path) -> None:
    """Write a figure; the suffix says as what. Raises ``LogError`` if it cannot be written."""
    try:
        with held():
            figure.savefig(path, dpi=DOTS_PER_INCH)
    except OSError as error:
        raise LogError(f"cannot write {path}: {error.strerror or error}.") from error
