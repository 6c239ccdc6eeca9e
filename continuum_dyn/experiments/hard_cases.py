"""Hard cases: scenarios run by every method listed in them, and checked against bounds of their errors."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from continuum_dyn.experiments.bounds import Bound, bounds_of
from continuum_dyn.integrators import Budget
from continuum_dyn.scenario.expect import Expected
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario.solver import FIXED_STEP, Method, Solver
from continuum_dyn.scenario.studies import MotionStudy
from continuum_dyn.scenario_files.reading import load_expecting
from continuum_dyn.simulation import Run, simulate
from continuum_dyn.simulation.accuracy import tip_distance
from continuum_dyn.simulation.trajectory import Trajectory
from statics.effects import Extension
from statics.errors import InputError
from statics.outcome import Outcome
from statics.scene import Scene

TIGHTER = 1e-3
"""Tolerances of the reference run, in parts of the case's."""
TIGHTEST = 1e-13
"""Smallest tolerance of a reference run."""


@dataclass(frozen=True)
class HardCase:
    """A scenario with its expectations; ``name`` is its file's, with a note on extension if changed."""

    name: str
    scenario: Scenario
    expected: Expected

    @property
    def reference(self) -> Method:
        """Reference method for errors."""
        return list(self.expected.steps)[-1]


@dataclass(frozen=True)
class Verdict:
    """The result of one method: a run, or in ``refused`` the reason why it cannot integrate the scene.

    ``tip_error`` in m and ``bounds`` are not known if the run did not end as it should. ``missed`` has a
    sentence for every expectation that failed. ``claimed``: the case names the method as one of its own.
    """

    case: HardCase
    method: Method
    claimed: bool
    run: Run | None = None
    refused: str = ""
    tip_error: float | None = None
    bounds: tuple[Bound, ...] = ()
    missed: tuple[str, ...] = ()

    @property
    def used(self) -> float:
        """Largest part of any bound that the run used up."""
        return max((bound.part for bound in self.bounds), default=0.0)


def load_cases(path: Path) -> list[HardCase]:
    """Load the case of a scenario file, and the case with or without extension if the file has one.

    Raises ``InputError`` if it is not one of a motion, or expects nothing.
    """
    scenario, expect = load_expecting(path)
    if expect is None:
        raise InputError(f"{path}: no table [expect]. Give its outcome, and steps of each method.")
    scenario.require_motion(f"{path}: [expect] is about a motion")
    extends, name = scenario.scene.has("extension"), path.stem
    other = expect.without_extension if extends else expect.with_extension
    if (expect.with_extension if extends else expect.without_extension) is not None:
        raise InputError(
            f"{path}: [expect.{'with' if extends else 'without'}_extension]: the scenario itself is "
            f"{'with' if extends else 'without'} extension. Give these expectations in [expect]."
        )
    cases = [HardCase(name, scenario, expect)]
    if other is not None and extends:
        cases.append(HardCase(f"{name}, without extension", scenario.without("extension"), other))
    elif other is not None:
        effects = (*scenario.scene.effects, Extension())
        extending = replace(scenario, scene=Scene(scenario.scene.arm, effects))
        cases.append(HardCase(f"{name}, with extension", extending, other))
    return cases


def judge(
    case: HardCase,
    others: Iterable[Method] = (),
    patience: float = 3600.0,
    progress: Callable[[str], None] = lambda _: None,
) -> list[Verdict]:
    """Judge each method that the case lists, then ``others``.

    Each of the others has ``patience`` (s) for its run; ``progress`` receives what is being computed.
    """
    claiming: tuple[Method, ...] = tuple(case.expected.steps)
    progress(f"{case.name}: reference")
    reference = _reference(case)
    verdicts = []
    order: list[Method] = [*claiming, *(other for other in others if other not in claiming)]
    for method in order:
        progress(f"{case.name}: {method}")
        seconds = case.scenario.solver.max_seconds
        if method not in claiming:
            seconds = min(seconds, patience)
        verdicts.append(_verdict(case, method, reference, Budget(case.scenario.solver.max_steps, seconds)))
    return verdicts


def _reference(case: HardCase) -> Trajectory | None:
    """The motion by the case's last method at tighter tolerances; None if it did not end as required."""
    rtol = max(TIGHTEST, TIGHTER * case.scenario.solver.rtol)
    tight = replace(case.scenario.solver, method=case.reference, step=None).with_rtol(rtol)
    run = simulate(_cut_to_claim(case, tight))
    return run.trajectory if run.outcome is _outcome(case, case.reference) else None


def _cut_to_claim(case: HardCase, solver: Solver) -> Scenario:
    """The scenario by that method, cut after the last sample that the method must reach."""
    scenario, until = replace(case.scenario, solver=solver), case.expected.until.get(solver.method)
    study = scenario.require_motion("[expect] is about a motion")
    if until is None:
        return scenario
    between = study.duration / (study.samples - 1)
    count = max(1, int(until / between * (1.0 + 1e-9)))
    return replace(scenario, study=MotionStudy(count * between, samples=count + 1))


def _outcome(case: HardCase, method: Method) -> Outcome:
    """The outcome that the case must have by that method."""
    cut, settled = method in case.expected.until, case.expected.outcome is Outcome.SETTLED
    return Outcome.COMPLETED if cut and settled else case.expected.outcome


def _verdict(case: HardCase, method: Method, reference: Trajectory | None, budget: Budget) -> Verdict:
    claimed, solver = method in case.expected.steps, case.scenario.solver
    step = solver.step if method in FIXED_STEP else None
    try:
        scenario = _cut_to_claim(case, replace(solver, method=method, step=step))
        run = simulate(scenario, budget=budget)
    except InputError as reason:
        missed = (str(reason),) if claimed else ()
        return Verdict(case, method, claimed, refused=str(reason), missed=missed)
    if run.outcome is not _outcome(case, method) or run.trajectory is None:
        why = f": {run.message}" if run.message else ""
        ended = f"ended as {run.outcome}, not {_outcome(case, method)}{why}"
        return Verdict(case, method, claimed, run, missed=(ended,))
    error = None if reference is None else _tip_error(run.trajectory, reference, case.expected.horizon)
    bounds = bounds_of(run, case.expected, error, whole=method not in case.expected.until)
    missed = tuple(str(bound) for bound in bounds if not bound.kept)
    return Verdict(case, method, claimed, run, "", error, tuple(bounds), missed)


def _tip_error(found: Trajectory, reference: Trajectory, horizon: float | None) -> float:
    """Largest distance of the tips over the samples that both have, up to the horizon.

    The last state of a run that stopped early is no sample.
    """
    count = min(found.time.size, reference.time.size)
    same = np.isclose(found.time[:count], reference.time[:count], rtol=1e-9, atol=0.0)
    count = count if same.all() else int(np.argmin(same))
    if horizon is not None:
        count = min(count, int(np.searchsorted(reference.time, horizon * (1.0 + 1e-9), "right")))
    return tip_distance(found.first(count), reference.first(count))
