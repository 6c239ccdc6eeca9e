"""Figures of a ramp's log: the lag of the motion behind the static path, and the hysteresis loop."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from continuum_dyn.answers.lag import delay, gap
from continuum_dyn.answers.loops import Loop, widest_gap, widest_loop, work_around
from continuum_dyn.answers.turnings import monotonic_branches
from continuum_dyn.record import Log
from statics.errors import InputError

FIGURES = (
    *("ramp_rate", "tip_lag", "delay", "quasistatic_error", "quasistatic_rate", "measured_quasistatic_rate"),
    *("hysteresis_area", "tip_hysteresis", "static_hysteresis_area", "static_tip_hysteresis"),
)
"""Glossary names of the figures."""
SMALLEST_BRANCH = 1e-2
"""Smallest range of a branch, in parts of the drive's range."""
JUMP = 0.5
"""Largest change from sample to sample that is not a jump, in parts of a branch."""


@dataclass(frozen=True)
class Drive:
    """The ramped tension, cable displacement or load factor at each row; ``of`` names the cable or load."""

    quantity: str
    of: str
    values: np.ndarray

    @property
    def rate_unit(self) -> str:
        """Unit of its rate."""
        return {"tension": "N/s", "cable_displacement": "m/s", "load_factor": "1/s"}[self.quantity]


@dataclass(frozen=True)
class TipPath:
    """The path of the tip, shape (rows, 2), m, and of the cables, shape (rows, cables), N and m."""

    tip: np.ndarray
    tension: np.ndarray
    cable_displacement: np.ndarray


@dataclass(frozen=True)
class BranchLag:
    """The lag on one branch of the drive: its times and largest rate, the largest lag (m), the delay (s)."""

    start: float
    end: float
    ramp_rate: float
    tip_lag: float
    delay: float | None


class RateLag(NamedTuple):
    """A largest rate of the drive, in its unit per s, and the largest lag (m) of a motion at that rate."""

    ramp_rate: float
    tip_lag: float


@dataclass(frozen=True)
class RampAnswers:
    """Figures of a ramp's log.

    ``static`` is the path of equilibria; ``motion`` the path of the motion at the same rows, with its
    ``time`` (s), its tip's ``gaps`` (m) from the static one and its ``lags`` on each branch, None and
    empty if nothing moves. ``loop`` is the widest one. ``figures`` are in SI units, by glossary name; for
    those that are None ``missing`` has the reason. ``measured`` has the lags at other rates.
    """

    drive: Drive
    static: TipPath
    motion: TipPath | None
    time: np.ndarray | None
    gaps: np.ndarray | None
    lags: tuple[BranchLag, ...]
    loop: Loop | None
    figures: dict[str, float | None]
    missing: dict[str, str]
    measured: tuple[RateLag, ...] = ()


def ramp_answers(log: Log, error: float) -> RampAnswers:
    """Compute the figures of a ramp of equilibria, or of a motion with its static path.

    ``quasistatic_rate`` is the rate at which the lag reaches ``error`` (m), if it is proportional to the
    rate. Raises ``InputError`` if the log has no static path, or if nothing is ramped.
    """
    rows = _rows(log)
    drive, static = _drive(log, rows), _path(log.equilibria, rows)
    branches = monotonic_branches(drive.values, SMALLEST_BRANCH * float(np.ptp(drive.values)))
    motion = time = gaps = None
    lags: tuple[BranchLag, ...] = ()
    if log.trajectory:
        samples = log.equilibria["point"][rows] - 1
        motion, time = _path(log.trajectory, samples), log.trajectory["time"][samples]
        gaps = gap(motion.tip, static.tip)
        lags = tuple(_lag(drive, static, motion, time, branch) for branch in branches)
    loop = None if _unstable(log, rows) else widest_loop(drive.values, branches)
    figures = dict.fromkeys(FIGURES) | {"quasistatic_error": error}
    figures |= _lag_figures(lags, gaps, time, static, motion, error) | _loop_figures(
        drive, loop, static, motion
    )
    missing = {name: _reason(name, log, loop, rows) for name, value in figures.items() if value is None}
    return RampAnswers(drive, static, motion, time, gaps, lags, loop, figures, missing)


def _rows(log: Log) -> np.ndarray:
    """Rows of the equilibria that were found, one for each point, without those that a search has left."""
    points = log.equilibria.get("point", np.empty(0, dtype=int))
    rows = np.flatnonzero(np.append(np.diff(points) != 0, True)) if points.size else points
    if log.trajectory and len(rows) <= 2:
        raise InputError(
            f"{log.path}: no static path in this log. Add static_path = true to [study], and run."
        )
    if len(rows) < 2:
        raise InputError(f"{log.path}: a ramp needs at least 2 equilibria; found: {len(rows)}.")
    return rows


def _drive(log: Log, rows: np.ndarray) -> Drive:
    """The first cable that is driven by its length and drawn in, whose tension changes, or the first load."""
    for number, name in enumerate(log.cables):
        by_length = log.arm["cable_stiffness"][number] > 0.0
        quantity = "cable_displacement" if by_length else "tension"
        values = log.equilibria[quantity][rows, number]
        if np.ptp(values) > 0.0:
            return Drive(quantity, name, values)
    factors = log.equilibria.get("load_factor", np.empty((rows[-1] + 1, 0)))[rows]
    for number, values in enumerate(factors.T, start=1):
        if np.ptp(values) > 0.0:
            return Drive("load_factor", f"load {number}", values)
    raise InputError(f"{log.path}: not a log of a ramp: no tension or load factor changes.")


def _path(columns: Any, rows: np.ndarray) -> TipPath:
    tip = np.column_stack([columns["disk_x"][rows, -1], columns["disk_y"][rows, -1]])
    return TipPath(tip, columns["tension"][rows], columns["cable_displacement"][rows])


def _lag(drive: Drive, static: TipPath, motion: TipPath, time: np.ndarray, branch: slice) -> BranchLag:
    values, at = drive.values[branch], time[branch]
    steps = np.abs(np.diff(values))
    if steps.max() > JUMP * np.ptp(values):
        raise InputError(
            f"the {drive.quantity.replace('_', ' ')} of {drive.of} jumps at {at[np.argmax(steps)]:g} s; a "
            "ramp changes it gradually. For steps, use continuum-dyn settle."
        )
    rate = float(np.max(steps / np.diff(at)))
    late = delay(at, motion.tip[branch], static.tip[branch])
    lag = float(gap(motion.tip[branch], static.tip[branch]).max())
    return BranchLag(float(at[0]), float(at[-1]), rate, lag, late)


def _lag_figures(
    lags: tuple[BranchLag, ...],
    gaps: np.ndarray | None,
    time: np.ndarray | None,
    static: TipPath,
    motion: TipPath | None,
    error: float,
) -> dict[str, float | None]:
    """Figures of the motion against its static path."""
    if motion is None or gaps is None or time is None:
        return {}
    rate, lag = max(branch.ramp_rate for branch in lags), float(gaps.max())
    late = delay(time, motion.tip, static.tip)
    within = error * rate / lag if lag > 0.0 else None
    return {"ramp_rate": rate, "tip_lag": lag, "delay": late, "quasistatic_rate": within}


def _loop_figures(
    drive: Drive, loop: Loop | None, static: TipPath, motion: TipPath | None
) -> dict[str, float | None]:
    """Figures of the loops of the motion and of the static path."""
    figures: dict[str, float | None] = {}
    for path, kind in ((motion, ""), (static, "static_")):
        if loop is not None and path is not None:
            cables = zip(path.tension.T, path.cable_displacement.T, strict=True)
            area = sum(work_around(loop, drive.values, *columns) for columns in cables)
            figures[f"{kind}hysteresis_area"] = None if drive.quantity == "load_factor" else area
            figures[f"{kind}tip_hysteresis"] = widest_gap(loop, drive.values, path.tip)
    return figures


def _unstable(log: Log, rows: np.ndarray) -> bool:
    return not log.equilibria.get("stable", np.ones(rows[-1] + 1))[rows].all()


def _reason(name: str, log: Log, loop: Loop | None, rows: np.ndarray) -> str:
    if name == "measured_quasistatic_rate":
        return "not measured; --measure runs the scenario at other rates"
    if not log.trajectory and not name.startswith("static"):
        return "a ramp of equilibria has no motion"
    if name == "quasistatic_rate":
        return "the motion does not lag behind its static path"
    if _unstable(log, rows):
        return "the path passes through unstable equilibria; it has no rising and falling branch"
    if loop is None:
        return "the input does not return"
    return "the work of loads is not in the log"
