"""Up to 5000 N: the tension at which a cable's holes meet is found and named."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import rone2012

from continuum_dyn import Scenario, simulate
from continuum_dyn.profiles import Constant
from continuum_dyn.study import EquilibriumStudy, RampStudy
from statics import Outcome, StaticSolver
from statics.ramp import limit_on_the_way

LIMITS = [(4, 86.8), (8, 70.4), (16, 67.0)]
"""Tension (N) at which all holes meet, computed apart from this program; it tends to EJ / r^2 = 65.99 N."""


@pytest.mark.parametrize(("disks", "limit"), LIMITS)
@pytest.mark.parametrize("tension", [100.0, 5000.0])
def test_limit_is_named_with_the_tension_that_reaches_it(disks: int, limit: float, tension: float) -> None:
    run = simulate(Scenario(rone2012(disks=disks), (Constant(tension),), EquilibriumStudy()))
    assert run.outcome is Outcome.GEOMETRY_LIMIT
    named = float(run.message.removeprefix("geometric limit at tension ").split(" N")[0])
    assert named == pytest.approx(limit, rel=1e-3)
    assert run.tip is None


@pytest.mark.parametrize("disks", [4, 16])
def test_every_tension_below_the_limit_has_an_equilibrium_and_none_above(disks: int) -> None:
    solver = StaticSolver(rone2012(disks=disks))
    limit = limit_on_the_way(solver, np.array([5000.0]), None)
    assert limit is not None
    tensions = np.append(np.linspace(0.0, 5000.0, 501), limit.tension[0] * np.array([1 - 1e-5, 1 + 1e-5]))
    for tension in tensions:
        rest = solver.solve(np.array([tension]))
        assert rest.outcome is (Outcome.COMPLETED if tension < limit.tension[0] else Outcome.GEOMETRY_LIMIT)
        assert rest.found == (tension < limit.tension[0])


@pytest.mark.parametrize("path", ["stable", "arc_length"])
def test_ramp_to_5000_n_keeps_what_is_below_the_limit(path: str) -> None:
    scenario = Scenario(rone2012(), ((0.0, 40.0, 80.0, 1000.0, 5000.0),), RampStudy())
    run = simulate(replace(scenario, study=RampStudy(path=path)))  # pyright: ignore[reportArgumentType]
    assert run.outcome is Outcome.GEOMETRY_LIMIT
    assert "geometric limit at tension 86.8" in run.message
    assert [point.tension[0] for point in run.equilibria if point.found] == [0.0, 40.0, 80.0]
