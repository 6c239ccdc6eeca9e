"""Text files read from disk, refused if they are missing, too large or not text."""

import io
from difflib import get_close_matches
from pathlib import Path

from statics.errors import InputError, did_you_mean

LOG_START = b"\x89HDF"
"""First bytes of a log."""
MOST_NEIGHBOURS = 8
"""Largest number of files that are named beside one that is missing."""
MAX_FILE_SIZE = 50_000_000
"""Largest size of a text file, bytes."""


def read_text(path: Path, largest: int = MAX_FILE_SIZE) -> str:
    """Read a text file in UTF-8, with a byte order mark or without, of at most ``largest`` bytes.

    Raises ``InputError`` that names the file and, if it is missing, its neighbours.
    """
    try:
        with path.open("rb") as file:
            content = file.read(largest + 1)
        if content.startswith(LOG_START):
            raise InputError(
                f"{path}: a log, not a scenario. To get its scenario: "
                f"continuum-dyn info {path} --scenario > NAME.toml"
            )
        if len(content) > largest:
            raise InputError(f"{path}: larger than {largest // 1_000_000} MB.")
        return io.TextIOWrapper(io.BytesIO(content), encoding="utf-8-sig").read()
    except FileNotFoundError as error:
        known = [p.name for p in sorted(path.parent.glob("*.toml"))] if path.parent.is_dir() else []
        if len(known) > MOST_NEIGHBOURS:
            known = get_close_matches(path.name, known, MOST_NEIGHBOURS, 0.5)
        hint = did_you_mean(path.name, known) if known else ""
        raise InputError(f"{path}: no such file.{hint}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not a text file in UTF-8.") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}.") from error
