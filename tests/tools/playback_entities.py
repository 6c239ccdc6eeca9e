"""Recordings for rerun read back."""

from pathlib import Path
from typing import Any

from rerun.chunk import RrdReader


def entities_of(path: Path) -> dict[str, dict[str, list[Any]]]:
    """Entities of a recording, by path: their columns by name, those that never change too."""
    entities: dict[str, dict[str, list[Any]]] = {}
    for chunk in RrdReader(path).stream():
        if chunk.entity_path.endswith("/picture"):
            continue  # a list of all its bytes would take seconds
        columns = entities.setdefault(str(chunk.entity_path), {})
        for name, values in chunk.to_record_batch().to_pydict().items():
            columns.setdefault(name, []).extend(values)
    return entities
