"""Reads and checks scenario files: TOML in, a scenario out.

A scenario is data; no text of it is ever evaluated. All errors of a file are reported together, each
with its place, what was read, and the nearest allowed word.
"""

import json
import tomllib
from collections.abc import Callable, Sequence
from math import inf
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from continuum_dyn.scenario.expect import Expect
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.solver import FIXED_STEP
from continuum_dyn.scenario_files.building import build
from continuum_dyn.scenario_files.csv_table import Tables, table_text
from continuum_dyn.scenario_files.messages import explain
from continuum_dyn.scenario_files.overrides import apply_overrides
from continuum_dyn.scenario_files.tables import ScenarioFile
from continuum_dyn.scenario_files.text import read_text
from continuum_dyn.scenario_files.toml_text import read_toml
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
        text = apply_overrides(text, plain_line(path.name), overrides)
        content = read_toml(text)
        _check_sizes(content, "")
        file = ScenarioFile.model_validate_json(json.dumps(content, default=str))
        _check_tolerances(content)
        return build(file, plain_line(path.stem), text, Tables(text_of_table)), file.expect
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: not a TOML file: {error}.") from error
    except ValidationError as error:
        raise InputError(explain(path, error)) from error
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    except RecursionError as error:
        raise InputError(f"{path}: nested too deeply to be a scenario.") from error


def _check_sizes(content: Any, place: str) -> None:
    """Refuse numbers of no physical arm, whose products would be beyond floating point."""
    if isinstance(content, dict):
        for key, value in content.items():
            _check_sizes(value, f"{place} {key}".lstrip())
    elif isinstance(content, list):
        for number, value in enumerate(content, start=1):
            _check_sizes(value, f"{place} number {number}" if isinstance(value, dict) else place)
    elif type(content) in (int, float) and not _is_physical(abs(content)):
        raise InputError(
            f"{place[:60]!r}: too {'large' if abs(content) > 1 else 'small'} a number to compute with. "
            f"Allowed: 0, and sizes from {SMALLEST:g} to {LARGEST:g}, in SI units."
        )


def _is_physical(size: float) -> bool:
    """Whether a number can be computed with; pydantic reports those that are not finite."""
    return size == 0 or SMALLEST <= size <= LARGEST or not size < inf


def _check_tolerances(content: dict[str, Any]) -> None:
    settings = content.get("solver", {})
    given = [name for name in ("rtol", "atol") if name in settings]
    if given and settings.get("method") in FIXED_STEP:
        raise InputError(
            f'[solver] {" and ".join(given)} beside method = "midpoint": its steps are equal. Give step (s).'
        )
    if given and "accuracy" in content:
        raise InputError(
            f"[solver] {' and '.join(given)} beside [accuracy]: the accuracy decides the tolerances. "
            "Give one or the other."
        )
