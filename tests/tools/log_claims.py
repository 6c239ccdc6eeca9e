"""Claims of a log, held against what else it holds, other equations, and another integrator."""

import numpy as np

from continuum_dyn.modes import linearized, still
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.record import Log
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.simulation.energy_balance import PER_TOLERANCE, TOLERATED
from statics.outcome import Outcome
from statics.scene import BASE_POSE

UNBALANCED = 1e-6
"""Largest unbalanced force of an equilibrium, in what bends a segment by a radian."""
OFF_BALANCE = 1e-6
"""Largest distance of an equilibrium from that of the equations of motion, rad or segment lengths."""
ROUNDED = 1e-13
"""Largest gap of the ledger that is rounding, over the stored energy: an arm at rest has no more."""
STEPS_OFF = 1e3
"""Largest distance of two methods' tips, in the tolerance of one step."""


def check(log: Log, scenario: Scenario) -> None:
    """Raise ``AssertionError`` unless the log bears out its outcome."""
    for group in (log.trajectory, log.equilibria):
        for name, values in group.items():
            assert values.dtype.kind not in "fc" or np.isfinite(values).all(), f"{name} is not finite"
    if log.equilibria:
        check_balance(log, scenario)
    if log.outcome.answered and log.trajectory:
        check_ledger(log, scenario)
    if log.outcome is Outcome.SETTLED:
        check_settled(log, scenario)


def check_balance(log: Log, scenario: Scenario) -> None:
    """Hold the unbalanced force of every equilibrium against what bends the softest segment by a radian."""
    columns = scenario.scene.arm.segment_columns()
    scale = float((columns["bending_stiffness"] / columns["rest_length"]).min())
    worst = float(log.equilibria["residual"].max())
    assert worst <= UNBALANCED * scale, f"unbalanced: {worst:.2g} beside {scale:.2g}"


def check_ledger(log: Log, scenario: Scenario) -> None:
    """Hold the energies of a motion against the bound that the program states."""
    found = log.trajectory
    stored = found["kinetic_energy"] + found["elastic_energy"] + found["gravity_energy"]
    gap = np.abs(stored - stored[0] - found["input_work"] + found["dissipated_energy"]).max()
    parts = [np.abs(found[name]).max() for name in ("kinetic_energy", "input_work", "dissipated_energy")]
    whole = max(float(np.ptp(stored)), *parts)
    rounding = ROUNDED * float(np.abs(stored).max())
    x, y = found["disk_x"] - found["disk_x"][0], found["disk_y"] - found["disk_y"][0]
    travel = float(np.hypot(x, y).max())
    bound = TOLERATED + (PER_TOLERANCE * _tolerance(log) / travel if travel else np.inf)
    assert travel == 0.0 or gap <= bound * whole + rounding, f"ledger open: {gap:.2g} of {whole:.2g} J"


def _tolerance(log: Log) -> float:
    """Largest displacement (m) by the error of one step."""
    return (log.attributes.get("rtol", 0.0) + log.attributes.get("atol", 0.0)) * log.arm_length


def check_settled(log: Log, scenario: Scenario) -> None:
    """Hold a settled tip against the last equilibrium, unless friction may leave it beside that."""
    if any(kind.rubs for kind in scenario.scene.cable_kinds):
        return
    apart = [log.trajectory[name][-1, -1] - log.equilibria[name][-1, -1] for name in ("disk_x", "disk_y")]
    gap, within = float(np.hypot(*apart)), scenario.settled_within
    assert gap < within, f"settled {gap:.2g} m from its equilibrium, but {within:.2g} m are allowed"


def check_rest(log: Log, scenario: Scenario) -> None:
    """Hold every equilibrium against the equations of motion: linearized there, they have one just there."""
    scene = scenario.scene
    if not scene.has("inertia") or scene.arm.massless_nodes or any(k.rubs for k in scene.cable_kinds):
        return
    dynamics, columns = Dynamics(scene), log.equilibria
    lengths = scene.arm.rest_lengths[:, None] ** np.arange(dynamics.dofs)
    for point in range(len(columns.get("point", ()))):
        q = np.stack(
            [columns[name][point] for name in ("bend_angle", "elongation")[: dynamics.dofs]], axis=-1
        )
        interval, y = still(_inputs(log, scenario, point)), dynamics.state(q)
        size = dynamics.size
        push = dynamics.rate(0.0, y, interval)[size : 2 * size]
        change = np.linalg.solve(linearized(dynamics, y, interval)[size : 2 * size, :size], push)
        off = float(np.abs(change.reshape(lengths.shape) / lengths).max())
        assert off < OFF_BALANCE, f"equilibrium {point} is {off:.2g} off that of the equations of motion"


def _inputs(log: Log, scenario: Scenario, point: int) -> np.ndarray:
    """Inputs of an equilibrium, without rates."""
    scene, columns = scenario.scene, log.equilibria
    given = [
        columns["cable_displacement" if kind.driven_by_length else "tension"][point, number]
        for number, kind in enumerate(scene.cable_kinds)
    ]
    given += list(columns["load_factor"][point]) if "load_factor" in columns else []
    given += [columns[name][point] for name in BASE_POSE if name in columns]
    return np.pad(np.array(given, dtype=float), (0, len(scene.inputs) - len(given)))


def check_same_motion(log: Log, other: Log) -> None:
    """Hold the tip at all samples against that of another method."""
    apart = [log.trajectory[name][:, -1] - other.trajectory[name][:, -1] for name in ("disk_x", "disk_y")]
    worst, allowed = float(np.hypot(*apart).max()), STEPS_OFF * (_tolerance(log) + _tolerance(other))
    assert worst <= allowed, (
        f"{worst:.2g} m from the motion by another method, but {allowed:.2g} m are allowed"
    )
