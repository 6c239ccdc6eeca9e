"""A log in memory."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from statics.outcome import Outcome


@dataclass(frozen=True)
class Log:
    """A log read back: arrays by glossary name; ``trajectory`` is empty without a motion.

    ``scenario`` is the text of the scenario's file, ``tables`` those of the CSV files that it names.
    ``attributes`` are the file's, ``counters`` what the solver counted. A log that is not ``complete`` is
    still written, or its run was killed.
    """

    path: Path
    title: str
    outcome: Outcome
    message: str
    scenario: str
    tables: Mapping[str, str]
    attributes: Mapping[str, Any]
    cables: tuple[str, ...]
    arm: Mapping[str, Any]
    trajectory: Mapping[str, np.ndarray]
    equilibria: Mapping[str, np.ndarray]
    counters: Mapping[str, int]
    complete: bool

    @property
    def arm_length(self) -> float:
        """Undeformed length of the arm, m; its ``disk_spacing`` is one number, or one for each disk."""
        return float(np.mean(self.arm["disk_spacing"])) * self.arm["disks"]

    @property
    def bare_disks(self) -> list[slice]:
        """Disks of each cable whose holes it passes without a sheath; 0 is the base."""
        anchors = self.arm["anchor"]
        starts = self.arm.get("start", np.zeros_like(anchors))  # none in logs of earlier versions
        return [slice(int(start), int(last) + 1) for start, last in zip(starts, anchors, strict=True)]
