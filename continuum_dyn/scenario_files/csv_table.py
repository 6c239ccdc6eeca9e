"""A profile kept in a CSV file beside the scenario."""

import csv
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import islice
from math import inf
from pathlib import Path

from pydantic import ValidationError

from continuum_dyn.scenario.profiles import Table
from continuum_dyn.scenario_files.text import MAX_FILE_SIZE, read_text
from statics.errors import InputError

MAX_ROWS = 1_000_000
"""Largest number of rows of a table, periods included."""
LARGEST = 1e30
"""Largest size of a number in a table."""


@dataclass(frozen=True)
class Tables:
    """The tables of a scenario: ``texts`` of those read so far, by name; ``read`` reads another."""

    read: Callable[[str], str]
    texts: dict[str, str] = field(default_factory=dict)

    def profile(self, name: str, quantity: str, periods: int = 1) -> Table:
        """The table of that name. Raises ``InputError``, also where all tables are too large together."""
        if name not in self.texts:
            self.texts[name] = self.read(name)
        if sum(map(len, self.texts.values())) > MAX_FILE_SIZE:
            raise InputError(
                f"table '{name}': larger than {MAX_FILE_SIZE // 1_000_000} MB with those before it."
            )
        return read_table(name, self.texts[name], quantity, periods)


def table_text(scenario: Path, name: str) -> str:
    """The text of a table beside the scenario's file. Raises ``InputError`` that names the table."""
    folder = scenario.parent.resolve()
    path = (folder / name).resolve()
    if not path.is_relative_to(folder):
        raise InputError(f"the table '{name}' lies outside the scenario's folder.")
    if path.exists() and not path.is_file():
        raise InputError(f"the table '{name}' is not a file.")
    return read_text(path)


def read_table(name: str, text: str, quantity: str, periods: int = 1) -> Table:
    """A table profile from its text: CSV with the header ``time,tension`` (s, N), or ``time,factor``.

    Its rows come ``periods`` times, one after the other; it jumps if they end with another value than they
    begin with. Raises ``InputError`` that names the table and the row that is wrong.
    """
    rows = _rows(name, text)
    if not rows or [cell.strip() for cell in rows[0]] != ["time", quantity]:
        found = ",".join(rows[0])[:60] if rows else "nothing"
        raise InputError(f"table '{name}': the first line must be time,{quantity}; read: {found}")
    values = [_row(name, number, row) for number, row in enumerate(rows[1:], start=1) if row]
    if not values:
        raise InputError(f"table '{name}': no rows below the header.")
    negative = [row for row, (_, value) in enumerate(values, start=1) if value < 0]
    large = [row for row, numbers in enumerate(values, start=1) if LARGEST < max(map(abs, numbers)) < inf]
    if large:
        raise InputError(f"table '{name}', row {large[0]}: too large to compute with. Allowed: {LARGEST:g}.")
    if quantity == "tension" and negative:
        raise InputError(
            f"table '{name}', row {negative[0]}: a cable cannot push; read {values[negative[0] - 1][1]:g}"
        )
    if periods > 1 and len(values) * periods > MAX_ROWS:
        raise InputError(
            f"table '{name}': {periods} periods of {len(values)} rows. Allowed: {MAX_ROWS} rows."
        )
    try:
        return Table(tuple(t for t, _ in values), tuple(value for _, value in values), periods)
    except InputError as error:
        raise InputError(f"table '{name}': {error}") from error
    except ValidationError as error:
        detail = error.errors()[0]
        row = int(detail["loc"][-1]) + 1
        raise InputError(f"table '{name}', row {row}: {detail['msg']}; read {detail['input']!r}") from error


def _rows(name: str, text: str) -> list[list[str]]:
    """The cells of the header and of every row."""
    try:
        rows = list(islice(csv.reader(text.splitlines()), MAX_ROWS + 2))
    except csv.Error as error:
        raise InputError(f"table '{name}': not a CSV file: {error}.") from error
    if len(rows) > MAX_ROWS + 1:
        raise InputError(f"table '{name}': more than {MAX_ROWS} rows. Give fewer.")
    return rows


def _row(name: str, number: int, row: list[str]) -> tuple[float, float]:
    try:
        t, tension = map(float, row)
    except ValueError as error:
        raise InputError(
            f"table '{name}', row {number}: two numbers expected; read: {','.join(row)[:60]}"
        ) from error
    return t, tension
