"""Logs made by hand, of an arm of two segments, so that what is shown of them is known without a solver."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from conftest import SCENARIOS

from continuum_dyn.record import Log
from statics import Outcome

LENGTH = 0.04
SCENARIO = (SCENARIOS / "step_response.toml").read_text().replace("[arm]", "[arm]\ndisks = 2")


def motion_log(
    samples: int = 11, path: str = "run.h5", loads: str = "", duration: float = 1.0, **columns: np.ndarray
) -> Log:
    """A straight arm at rest for ``duration`` s under 1 N on its upper cable, but for the columns given."""
    rows = samples, 2
    trajectory = {
        "time": np.linspace(0.0, duration, samples),
        "tension": np.ones((samples, 1)),
        "cable_displacement": np.zeros((samples, 1)),
        "bend_angle": np.zeros(rows),
        "bend_angle_rate": np.zeros(rows),
        "curvature": np.zeros(rows),
        "length": np.full(rows, LENGTH / 2),
        "disk_x": np.tile([LENGTH / 2, LENGTH], (samples, 1)),
        "disk_y": np.zeros(rows),
        "disk_theta": np.zeros(rows),
    } | columns
    arm = {
        "hole_offset": np.full((1, 3), 0.008),
        "anchor": np.array([2]),
        "cable_stiffness": np.zeros(1),
    }
    return Log(
        path=Path(path),
        title="By hand",
        outcome=Outcome.COMPLETED,
        message="",
        scenario=SCENARIO + loads,
        tables={},
        attributes={"study": "motion"},
        cables=("upper",),
        arm=arm,
        trajectory=trajectory,
        equilibria={},
        counters={},
        complete=True,
    )


def equilibria(points: np.ndarray, times: np.ndarray, tensions: np.ndarray) -> dict[str, np.ndarray]:
    """Equilibria of a straight arm, told apart by its tip's x: LENGTH plus the row's number, mm."""
    rows = len(points)
    tip = LENGTH + 1e-3 * np.arange(rows)
    return {
        "point": points,
        "time": times,
        "tension": tensions[:, None],
        "cable_displacement": np.zeros((rows, 1)),
        "curvature": np.zeros((rows, 2)),
        "length": np.stack([tip / 2, tip / 2], axis=1),
        "disk_x": np.stack([tip / 2, tip], axis=1),
        "disk_y": np.zeros((rows, 2)),
        "stable": np.ones(rows, dtype=bool),
    }


def ramp_log(tensions: Sequence[float], **columns: np.ndarray) -> Log:
    """Equilibria of the straight arm under these tensions (N), its tip a mm farther each time."""
    rows = len(tensions)
    rests = equilibria(np.arange(1, rows + 1), np.zeros(rows), np.array(tensions))
    rests |= {"disk_theta": np.zeros((rows, 2)), "jumped": np.zeros(rows), "critical": np.zeros(rows)}
    log = motion_log(1)
    return replace(log, trajectory={}, equilibria=rests | columns, attributes={"study": "ramp"})
