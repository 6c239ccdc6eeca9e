"""Writing figures to files."""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from statics.errors import LogError
from statics.support.interruption import defer_interruption

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DOTS_PER_INCH = 200
"""Resolution of raster pictures, dots per inch."""


def save(figure: "Figure", path: Path) -> None:
    """Write a figure in the format of its suffix. Raises ``LogError`` if it cannot be written."""
    try:
        with defer_interruption(), warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="Glyph .* missing from")  # it is drawn as a box
            figure.savefig(path, dpi=DOTS_PER_INCH)
    except OSError as error:
        raise LogError(f"cannot write {path}: {error.strerror or error}.") from error
