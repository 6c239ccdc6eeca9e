"""Bounds on a motion's errors, from its tolerances and its number of steps.

A step may displace no disk by more than a tolerance, (rtol + atol) times the arm's length. Where the motion
does not make an error larger by itself, N steps leave at most N tolerances. A disk that is off by x under a
force F has its energy off by F x, and a motion that the force drives through the travel s, the largest of any
disk, has the energy F s / 2. So a step leaves 2 x / s of the largest energy in the power ledger.

    tip_error       N tolerances, times the amplification that the case states
    ledger          2 N tolerances / travel
    energy_growth   twice the ledger's: what is stored less what is put in may rise by its error alone. In a
                    damped scene with constant inputs a tenth of the ledger's: only about the
                    turning points of the motion damping takes less than a step's error may add
    settled_gap     10 tolerances: errors fade, the last steps' are left; and what the case says still swings
    steps           what the case states
    energy_trend    what the case states

The midpoint rule has no tolerances: of these only what the case states holds for it.
"""

from dataclasses import dataclass

import numpy as np

from continuum_dyn.scenario.expect import Expected
from continuum_dyn.scenario.rates import pieces_from
from continuum_dyn.scenario.scenario import Scenario, dissipated_by
from continuum_dyn.simulation import Run
from continuum_dyn.simulation.trajectory import Trajectory

ROUNDING = 1e-14
"""Largest energy that a step loses to rounding, in parts of the largest energy."""


@dataclass(frozen=True)
class Bound:
    """A quantity of a motion: ``found``, None if not known, and its largest ``allowed`` value."""

    name: str
    found: float | None
    allowed: float

    @property
    def kept(self) -> bool:
        """Whether it holds; what is not known does not."""
        return self.found is not None and self.found <= self.allowed

    @property
    def part(self) -> float:
        """The value found, in parts of the allowed one."""
        return float("inf") if self.found is None else self.found / self.allowed

    def __str__(self) -> str:
        found = "not known" if self.found is None else f"{self.found:.3g}"
        return f"{self.name} {found}, allowed {self.allowed:.3g}"


def bounds_of(run: Run, expected: Expected, tip_error: float | None, whole: bool = True) -> list[Bound]:
    """The bounds of a run that has ended as it should; ``tip_error`` (m) is None if it is not known.

    ``whole``: the run went to the end of the case; only then it must have settled.
    """
    motion, scenario = run.trajectory, run.scenario
    assert motion is not None
    method, steps = scenario.solver.method, motion.counters["steps"]
    found, bounds = energies(motion), []
    if method in expected.steps:
        bounds.append(Bound("steps", steps, expected.steps[method]))
    if whole and expected.energy_trend is not None:
        bounds.append(Bound("energy_trend", found["energy_trend"], expected.energy_trend))
    if method in expected.tip_error:
        bounds.append(Bound("tip_error", tip_error, expected.tip_error[method]))
    if scenario.solver.has_fixed_step:
        return bounds
    step_error = scenario.solver.tolerance(scenario.scene.arm.total_length)
    part = 2.0 * step_error / max(motion.travel, 1e-300)
    ledger = min(1.0, steps * (part + ROUNDING))
    growth = 0.1 * ledger if is_left_alone(scenario) else 2.0 * ledger
    bounds += [
        Bound("ledger", found["ledger"], ledger),
        Bound("energy_growth", found["energy_growth"], growth),
    ]
    if method not in expected.tip_error:
        bounds.append(Bound("tip_error", tip_error, steps * step_error * expected.amplification))
    if whole and expected.outcome == "settled":
        gap = min(10.0 * step_error + expected.still_swings, scenario.settled_within)
        bounds.append(Bound("settled_gap", run.static_gap, gap))
    return bounds


def is_left_alone(scenario: Scenario) -> bool:
    """Whether a damped scene's inputs are constant from the start of the motion on."""
    pieces = [pieces_from(profile, 0.0, 2) for profile in scenario.profiles]
    still = all(len(rows) == 1 and not rows[0, 2:4].any() for rows in pieces)
    return still and bool(dissipated_by(scenario.scene))


def energies(found: Trajectory) -> dict[str, float]:
    """The motion's ``ledger`` and ``energy_growth`` in parts of its largest energy, and its ``energy_trend``.

    The largest gap of the ledger; the largest rise of the energy stored less the work put in; the slope of
    the energy stored times the duration, in parts of the range of the kinetic energy.
    """
    stored = found.stored_energy
    kinetic = found.ledger["kinetic_energy"]
    left = stored - found.ledger["input_work"]
    rise = float(np.max(left - np.minimum.accumulate(left)))
    largest = found.largest_energy
    slope = np.polyfit(found.time - found.time.mean(), stored, 1)[0] if found.time.size > 1 else 0.0
    return {
        "ledger": _part(float(np.abs(found.ledger_gap).max()), largest),
        "energy_growth": _part(rise, largest),
        "energy_trend": _part(abs(float(slope)) * float(np.ptp(found.time)), float(np.ptp(kinetic))),
    }


def _part(value: float, whole: float) -> float:
    return 0.0 if value == 0.0 else value / max(whole, 1e-300)
