"""Streams to rerun's compiled core: its Python layer takes longer to load than a run takes."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyarrow as pa
import rerun_bindings as core

from continuum_dyn.views.rerun_core.components import COMPONENTS, arrow, moments, parts


@dataclass(frozen=True)
class Moments:
    """Places on a time line: ns where time passes (``moves``), numbers otherwise."""

    timeline: str
    times: np.ndarray
    moves: bool


class Stream:
    """A recording, or a layout, of rerun's core."""

    def __init__(self, native: core.PyRecordingStream) -> None:
        self.native = native

    def log(self, entity: str, kind: str, /, *, static: bool = True, **columns: Any) -> None:
        """Send columns of what rerun calls ``kind``; those that are None are left out."""
        core.log_arrow_msg(entity, _described(kind, columns), static, self.native)

    def send(
        self, entity: str, at: Moments, kind: str, counts: np.ndarray | None = None, **columns: Any
    ) -> None:
        """Send columns that change with time: a number of rows at each moment, or one."""
        counts = np.ones(len(at.times), dtype=int) if counts is None else counts
        rows = {name: parts(values, counts) for name, values in _described(kind, columns).items()}
        core.send_arrow_chunk(entity, {at.timeline: moments(at.times, at.moves)}, rows, self.native)


def content(stream: Stream) -> core.PyMemorySinkStorage:
    """All that is sent to a stream, kept in memory."""
    memory = core.memory_recording(stream.native)
    assert memory is not None
    return memory


def _described(kind: str, columns: Mapping[str, Any]) -> dict[core.ComponentDescriptor, pa.Array]:
    described = {}
    for name, values in columns.items():
        if values is not None:
            component, arrow_type = COMPONENTS[kind][name]
            field = f"{kind.rpartition('.')[2]}:{name}"
            descriptor = core.ComponentDescriptor(field, f"rerun.{kind}", f"rerun.{component}")
            described[descriptor] = arrow(arrow_type, values)
    return described
