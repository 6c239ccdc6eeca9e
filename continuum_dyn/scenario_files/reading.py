"""Reads and checks scenario files: TOML in, a scenario out.

A scenario is data; no text of it is ever evaluated. All errors of a file are reported together, each
with its place, what was read, and the nearest allowed word.
"""

import json
import tomllib
from collections.abc import Callable, Iterator, Sequence
from math import inf
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from continuum_dyn.scenario.expect import Expect
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.solver import FIXED_STEP
from continuum_dyn.scenario_files.building import build
from continuum_dyn.scenario_files.csv_table import Tables, table_text
from continuum_dyn.scenario_files.mistakes.messages import Mistake, explain, mistakes_of, where
from continuum_dyn.scenario_files.mistakes.parts import mistakes_of_parts
from continuum_dyn.scenario_files.overrides import apply_overrides
from continuum_dyn.scenario_files.tables import ScenarioFile
from continuum_dyn.scenario_files.text import read_text
from continuum_dyn.scenario_files.toml_text import read_toml, toml_mistake
from statics.errors import InputError
from statics.support.plain_text import plain_line

MAX_FILE_SIZE = 5_000_000
"""Largest size of a scenario file, bytes; long tables have files of their own."""
SMALLEST, LARGEST = 1e-60, 1e30
"""Smallest and largest size of a number other than 0; the inertia of a disk of 1 nm is of 1e-44 kg m^2."""


def load_scenario(path: str | Path, overrides: Sequence[str] = ()) -> Scenario:
    """Read and check a scenario file, with changes such as "arm.disks=16" made to it.

    Raises ``InputError`` whose text names the file, every place in it that is wrong, what is allowed
    there and the nearest match.
    """
    return load_expecting(path, overrides)[0]


def load_expecting(path: str | Path, overrides: Sequence[str] = ()) -> tuple[Scenario, Expect | None]:
    """Load a scenario with its expectations. Raises ``InputError`` like ``load_scenario``."""
    path = Path(path)
    text = read_text(path, MAX_FILE_SIZE)
    return parse(text, path, lambda name: table_text(path, name), overrides)


def parse(
    text: str, path: Path, text_of_table: Callable[[str], str], overrides: Sequence[str] = ()
) -> tuple[Scenario, Expect | None]:
    """Parse the text of a scenario file; ``path`` is for titles and messages.

    ``text_of_table`` reads a table by its name in the scenario. Raises ``InputError``
    like ``load_scenario``.
    """
    try:
        text = _changed(text, path, overrides)
        content = read_toml(text)
        mistakes = [*_unphysical_numbers(content, []), *_crossed_tolerances(content)]
        file = _checked(content, mistakes)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: {toml_mistake(text, error)}") from error
    except RecursionError as error:
        raise InputError(f"{path}: nested too deeply to be a scenario.") from error
    tables = Tables(text_of_table)
    if file is not None and not mistakes:
        try:
            return build(file, plain_line(path.stem), text, tables), file.expect
        except InputError as error:
            mistakes = mistakes_of_parts(content, [], text, tables) or [Mistake((), str(error), ":")]
    else:
        mistakes += mistakes_of_parts(content, mistakes, text, tables)
    raise InputError(explain(path, mistakes, content))


def _changed(text: str, path: Path, overrides: Sequence[str]) -> str:
    try:
        return apply_overrides(text, plain_line(path.name), overrides)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def _checked(content: dict[str, Any], mistakes: list[Mistake]) -> ScenarioFile | None:
    """The tables of a file, or None after adding what is wrong with them to the mistakes.

    Raises ``RecursionError`` for a file that is nested too deeply.
    """
    try:
        return ScenarioFile.model_validate_json(json.dumps(_physical(content), default=str))
    except ValidationError as error:
        if error.errors()[0]["type"] == "json_invalid":
            raise RecursionError from error
        known = {mistake.place for mistake in mistakes}
        mistakes += (mistake for mistake in mistakes_of(error) if mistake.place not in known)
    return None


def _unphysical_numbers(content: Any, place: list[str]) -> Iterator[Mistake]:
    """Mistakes of numbers of no physical arm, whose products would be beyond floating point."""
    if isinstance(content, dict):
        for key, value in content.items():
            yield from _unphysical_numbers(value, [*place, key])
    elif isinstance(content, list):
        for number, value in enumerate(content):
            yield from _unphysical_numbers(value, [*place, str(number)])
    elif not _is_physical(content):
        yield Mistake(
            tuple(place),
            f"{where(place)[:60]}: too {'large' if abs(content) > 1 else 'small'} a number to compute with. "
            f"Allowed: 0, and sizes from {SMALLEST:g} to {LARGEST:g}, in SI units.",
        )


def _physical(content: Any) -> Any:
    """The content with 1 for each such number, so that what else is wrong is found as well."""
    if isinstance(content, dict):
        return {key: _physical(value) for key, value in content.items()}
    if isinstance(content, list):
        return [_physical(value) for value in content]
    return content if _is_physical(content) else 1


def _is_physical(value: Any) -> bool:
    """Whether it is no number that is too large or small; pydantic reports those that are not finite."""
    if type(value) not in (int, float):
        return True
    size = abs(value)
    return size == 0 or SMALLEST <= size <= LARGEST or not size < inf


def _crossed_tolerances(content: dict[str, Any]) -> Iterator[Mistake]:
    """Mistakes of tolerances beside what decides them."""
    settings = content.get("solver")
    if not isinstance(settings, dict):
        return
    given = [name for name in ("rtol", "atol") if name in settings]
    if given and settings.get("method") in FIXED_STEP:
        yield Mistake(
            ("solver",),
            f'[solver] {" and ".join(given)} beside method = "midpoint": its steps are equal. Give step (s).',
        )
    if given and "accuracy" in content:
        yield Mistake(
            ("solver",),
            f"[solver] {' and '.join(given)} beside [accuracy]: the accuracy decides the tolerances. "
            "Give one or the other.",
        )
