"""Hard cases: a scenario run by every method that claims it, and held to the bounds that it states."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from continuum_dyn.accuracy import tip_distance
from continuum_dyn.expect import Expect
from continuum_dyn.integrators import Budget
from continuum_dyn.scenario import load_expecting
from continuum_dyn.simulation import Run, simulate
from continuum_dyn.study import Method, MotionStudy, Scenario
from continuum_dyn.trajectory import Trajectory
from statics.errors import InputError

TIGHTER = 1e-3
"""Times a case's tolerances: those of the run that errors are measured against."""
TIGHTEST = 1e-13


@dataclass(frozen=True)
class HardCase:
    """A scenario with its bounds; ``name`` is its file's."""

    name: str
    scenario: Scenario
    expect: Expect


@dataclass(frozen=True)
class Verdict:
    """How one method did: ``refused`` says why it cannot integrate the scene at all, else there is a run.

    ``tip_error`` in m, None where it is not asked for or the run ended early; ``missed`` has a sentence for
    every bound that it broke. ``claimed`` tells whether the case says that the method can do it.
    """

    case: str
    method: Method
    claimed: bool
    run: Run | None = None
    refused: str = ""
    tip_error: float | None = None
    missed: tuple[str, ...] = ()


def load_case(path: Path) -> HardCase:
    """The case of a scenario file. Raises ``InputError`` if it is not one of a motion, or expects nothing."""
    scenario, expect = load_expecting(path)
    if expect is None:
        raise InputError(f"{path}: expects nothing. Give [expect] outcome, and steps of each method.")
    if not isinstance(scenario.study, MotionStudy):
        raise InputError(
            f'{path}: [expect] is about a motion; this is a study of kind "{scenario.study.kind}".'
        )
    return HardCase(path.stem, scenario, expect)


def judge(
    case: HardCase,
    others: Iterable[Method] = (),
    patience: float = 3600.0,
    told: Callable[[str], None] = lambda _: None,
) -> list[Verdict]:
    """A verdict for each method that claims the case, then for those ``others`` that do not.

    An other has ``patience`` (s) for its run; ``told`` is called with what is going on.
    """
    claiming: tuple[Method, ...] = tuple(case.expect.steps)
    told(f"{case.name}: reference")
    reference = _reference(case, claiming[0])
    verdicts = []
    order: list[Method] = [*claiming, *(other for other in others if other not in claiming)]
    for method in order:
        told(f"{case.name}: {method}")
        seconds = case.scenario.solver.max_seconds
        if method not in claiming:
            seconds = min(seconds, patience)
        verdicts.append(_verdict(case, method, reference, Budget(case.scenario.solver.max_steps, seconds)))
    return verdicts


def _reference(case: HardCase, method: Method) -> Trajectory | None:
    if case.expect.tip_error is None:
        return None
    solver = case.scenario.solver
    rtol = max(TIGHTEST, TIGHTER * solver.rtol)
    tight = replace(
        solver, method="chain" if method == "chain" else "explicit", step=None, rtol=rtol, atol=1e-3 * rtol
    )
    run = simulate(replace(case.scenario, solver=tight))
    return run.trajectory if run.outcome is case.expect.outcome else None


def _verdict(case: HardCase, method: Method, reference: Trajectory | None, budget: Budget) -> Verdict:
    claimed, solver = method in case.expect.steps, case.scenario.solver
    step = solver.step if method == "midpoint" else None
    try:
        run = simulate(
            replace(case.scenario, solver=replace(solver, method=method, step=step)), budget=budget
        )
    except InputError as reason:
        missed = (str(reason),) if claimed else ()
        return Verdict(case.name, method, claimed, refused=str(reason), missed=missed)
    error = None
    if reference is not None and run.trajectory is not None and run.outcome is case.expect.outcome:
        error = _tip_error(run.trajectory, reference, case.expect.horizon)
    return Verdict(
        case.name, method, claimed, run, "", error, tuple(missed_by(run, method, error, case.expect))
    )


def _tip_error(found: Trajectory, reference: Trajectory, horizon: float | None) -> float:
    """Largest distance of the tips over the samples that both have, up to the horizon.

    The last state of a run that stopped early is no sample.
    """
    both = int(
        np.argmin(np.append(found.time[: reference.time.size] == reference.time[: found.time.size], False))
    )
    count = both if horizon is None else min(both, int(np.searchsorted(reference.time, horizon, "right")))
    return tip_distance(found.first(count), reference.first(count))


def missed_by(run: Run, method: Method, tip_error: float | None, expect: Expect) -> list[str]:
    """A sentence for each bound that the run breaks."""
    if run.outcome is not expect.outcome:
        why = f": {run.message}" if run.message else ""
        return [f"ended as {run.outcome}, not {expect.outcome}{why}"]
    if run.trajectory is None:
        return []
    found = {"tip_error": tip_error, "settled_gap": run.static_gap, **energies(run.trajectory)}
    found["steps"] = run.trajectory.counters["steps"]
    bounds: dict[str, Any] = {name: getattr(expect, name) for name in found}
    bounds["steps"] = expect.steps.get(method)
    checked = ((name, value, bounds[name]) for name, value in found.items() if bounds[name] is not None)
    return [
        f"{name} {'not known' if value is None else f'{value:.3g}'}, allowed {bound:.3g}"
        for name, value, bound in checked
        if value is None or not value <= bound
    ]


def energies(found: Trajectory) -> dict[str, float]:
    """The motion's ``ledger``, ``energy_growth`` and ``energy_trend``, as ``Expect`` defines them."""
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
