"""Settling of a log's motion: its step figures, its ring-down, and the modes it should swing in."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from continuum_dyn.answers.last_change import LastChange, last_change
from continuum_dyn.answers.ring_down import FEWEST_SAMPLES, RingDown, fit_ring_down
from continuum_dyn.answers.step_figures import overshoot, rise_time, settling_time
from continuum_dyn.modes import Mode, check, modes, still
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.record import Log
from continuum_dyn.record.logged_scenario import logged_scenario
from continuum_dyn.scenario.intervals import cut_into_intervals
from continuum_dyn.scenario.scenario import Scenario
from statics.errors import InputError

BANDS = {"settling_time_5": 0.05, "settling_time_2": 0.02, "settling_time_1": 0.01}
"""Half-width of the band in which the tip has settled, in parts of its travel, by glossary name."""
STEP_FIGURES = ("rise_time", "overshoot", *BANDS)
FIGURES = (
    *("travel", *STEP_FIGURES, "frequency", "damping_ratio", "ring_down_misfit"),
    *("mode_frequency", "mode_damping_ratio", "static_gap"),
)
"""Glossary names of the figures."""
NO_TRAVEL = 1e-9
"""Largest travel that counts as none, in arm lengths."""


@dataclass(frozen=True)
class Settling:
    """Settling of the tip after the last change of the inputs.

    ``along`` is the tip's position (m) at each ``time`` (s), along the straight line from its position when
    this change began (0) to where it rests (``travel``); motion across that line is left out.
    ``cables_stick`` says that cables rub: in the motion linearized about rest, so in ``mode``, they stick.
    ``figures`` are in SI units, by glossary name; for those that are None ``missing`` has the reason.
    """

    time: np.ndarray
    along: np.ndarray
    travel: float
    change: LastChange
    ring_down: RingDown | None
    mode: Mode | None
    cables_stick: bool
    figures: dict[str, float | None]
    missing: dict[str, str]


def settling(log: Log) -> Settling:
    """Compute how the motion of a log settles.

    Times count from the beginning of the last change of the inputs; overshoot and bands are parts of the
    travel. Frequency and damping ratio are fitted to the free motion after its end, and compare with the
    mode of the last equilibrium whose frequency is nearest. Raises ``InputError`` if the log has no motion
    to an equilibrium, or if its tip does not travel.
    """
    scenario, time = logged_scenario(log), _motion_times(log)
    change = last_change(scenario, float(time[-1]))
    along, travel = _along(log, change.begin)
    missing: dict[str, str] = {}
    found = _try(missing, "mode", lambda: _modes_at_the_end(log, scenario)) or ()
    ring_down = _try(missing, "ring_down", lambda: _ring_down(time, along, change, found))
    mode = _nearest(found, ring_down)
    steps = _try(missing, "step", lambda: _step_figures(time, along / travel, change, found, ring_down))
    figures = {
        "travel": travel,
        **(steps or dict.fromkeys(STEP_FIGURES)),
        "frequency": getattr(ring_down, "frequency", None),
        "damping_ratio": getattr(ring_down, "damping_ratio", None),
        "ring_down_misfit": getattr(ring_down, "misfit", None),
        "mode_frequency": getattr(mode, "frequency", None),
        "mode_damping_ratio": getattr(mode, "damping_ratio", None),
        "static_gap": _number(log.attributes.get("static_gap")),
    }
    reasons = {name: _reason(name, missing) for name, value in figures.items() if value is None}
    stick = any(kind.rubs for kind in scenario.scene.cable_kinds)
    return Settling(time, along, travel, change, ring_down, mode, stick, figures, reasons)


def _motion_times(log: Log) -> np.ndarray:
    if not log.trajectory or len(log.trajectory["time"]) < 2:
        raise InputError(f"{log.path}: not a log of a motion; equilibria do not settle.")
    if "time" not in log.equilibria or len(log.equilibria["time"]) < 2:
        raise InputError(f"{log.path}: the final equilibrium was not found, so settling is not defined.")
    return log.trajectory["time"]


def _along(log: Log, begin: float) -> tuple[np.ndarray, float]:
    """Position of the tip along its travel at all samples, and the travel, m."""
    motion = log.trajectory
    tip = np.column_stack([motion["disk_x"][:, -1], motion["disk_y"][:, -1]])
    start = CubicSpline(motion["time"], tip)(begin)
    line = _place_of_rest(log) - start
    travel = float(np.hypot(*line))
    if travel < NO_TRAVEL * log.arm_length:
        raise InputError(f"{log.path}: the tip starts at its final equilibrium and has no travel.")
    return (tip - start) @ line / travel, travel


def _place_of_rest(log: Log) -> np.ndarray:
    """Rest position of the tip from the log, x and y, m; with friction not the last equilibrium."""
    if "rest_x" in log.attributes:
        return np.array([log.attributes["rest_x"], log.attributes["rest_y"]])
    return np.array([log.equilibria[name][-1, -1] for name in ("disk_x", "disk_y")])


def _try(missing: dict[str, str], name: str, compute: Callable[[], Any]) -> Any:
    """The result of ``compute``; if it raises ``InputError``, None, and the reason is kept under ``name``."""
    try:
        return compute()
    except InputError as error:
        missing[name] = str(error)
        return None


def _reason(name: str, missing: dict[str, str]) -> str:
    if name in STEP_FIGURES and "step" in missing:
        return missing["step"].rstrip(".")
    if name in BANDS:
        return "the tip does not stay within the band for half a period before the log ends"
    if name == "rise_time":
        return "the tip does not reach 90 % of its travel"
    if name == "static_gap":
        return "the motion stopped early"
    return missing.get("mode" if name.startswith("mode") else "ring_down", "").rstrip(".")


def _number(value: Any) -> float | None:
    return None if value is None else float(value)


def _modes_at_the_end(log: Log, scenario: Scenario) -> tuple[Mode, ...]:
    """All modes about the last equilibrium of the log. Raises ``InputError`` as ``modes.check``."""
    if scenario.chooses_mesh:
        assert scenario.accuracy is not None
        scenario = scenario.with_mesh(int(log.arm["subsegments"]), scenario.accuracy.tip)
    check(scenario.scene)
    dynamics = Dynamics(scenario.scene)
    end = scenario.require_motion("only a motion settles").duration
    inputs = cut_into_intervals(scenario.profiles, end).last.inputs(np.array([end]))[0]
    rest = [log.equilibria[name][-1] for name in ("bend_angle", "elongation") if name in log.equilibria]
    with np.errstate(all="ignore"):
        return modes(dynamics, dynamics.state(np.column_stack(rest)), still(inputs))


def _step_figures(
    time: np.ndarray,
    part: np.ndarray,
    change: LastChange,
    found: tuple[Mode, ...],
    ring_down: RingDown | None,
) -> dict[str, float | None]:
    """Rise time, overshoot and settling times. Raises ``InputError`` if samples miss a step's swings."""
    if change.end - change.begin < _longest_swing(found):
        _check_samples(time, found)
    curve, begin = CubicSpline(time, part), change.begin
    stays = 0.0 if ring_down is None else 0.5 * ring_down.period
    times = {name: settling_time(curve, band, begin, stays) for name, band in BANDS.items()}
    return {"rise_time": rise_time(curve, begin), "overshoot": overshoot(curve, begin)} | times


def _ring_down(time: np.ndarray, along: np.ndarray, change: LastChange, found: tuple[Mode, ...]) -> RingDown:
    """Fit the free motion after the last change, if its samples show the lowest mode's swings."""
    _check_samples(time, found)
    free = time >= change.end
    return fit_ring_down(time[free], along[free])


def _longest_swing(found: tuple[Mode, ...]) -> float:
    """Half a period (s) of the lowest mode that swings; 0 if none does."""
    return max((0.5 / mode.frequency for mode in found if mode.swings), default=0.0)


def _check_samples(time: np.ndarray, found: tuple[Mode, ...]) -> None:
    """Raise ``InputError`` if samples are too far apart to show the lowest mode: they would show another."""
    spacing, swing = float(np.median(np.diff(time))), _longest_swing(found)
    if 0.0 < swing < FEWEST_SAMPLES * spacing:
        raise InputError(
            f"too few samples: one every {spacing:.3g} s, and the lowest mode has {0.5 / swing:.4g} Hz. "
            "Increase [study] samples."
        )


def _nearest(found: tuple[Mode, ...], ring_down: RingDown | None) -> Mode | None:
    """The mode whose frequency is nearest to the ring-down's; the lowest one if nothing rings."""
    if ring_down is None or not found:
        return found[0] if found else None
    frequency = ring_down.frequency
    return min(found, key=lambda mode: abs(mode.frequency - frequency))
