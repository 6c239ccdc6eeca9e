"""Up to 5000 N: the tension at which a cable's holes meet is found and named."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import UPPER, rone2012

from continuum_dyn import Scenario, simulate
from continuum_dyn.scenario.profiles import Constant
from continuum_dyn.scenario.studies import EquilibriumStudy, RampStudy
from statics import Arm, Bending, Cables, Extension, Outcome, Scene, StaticSolver
from statics.effects import Effect
from statics.ramp import limit_on_the_way, ramp

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


def closed_form(disks: int, extends: bool) -> float:
    """Tension (N) at which holes meet without other loads: EJ phi / L0 = tau sigma_0(h) r where phi r = L.

    The core's length is L = L0 (1 - tau sigma_0(h) / EA) then; two segments from disk to disk bend alike.
    """
    stiffness, area, r = 2.10e11, Arm.preset("rone2012").per_disk("area")[0], 0.008
    shortened, tension = 1.0, 0.0
    for _ in range(20):
        h = shortened * 0.08 / disks / (2 * r)
        chord = np.sin(h) / h
        tension = shortened * stiffness * 2.011e-14 / (r**2 * chord)
        if extends:
            shortened = 1.0 - tension * chord / (stiffness * area)
    return tension


@pytest.mark.slow
@pytest.mark.parametrize("extends", [True, False])
@pytest.mark.parametrize("subsegments", [1, 2])
def test_limit_is_that_of_the_closed_form(subsegments: int, extends: bool) -> None:
    loads: tuple[Effect, ...] = (Bending(), Cables(), *([Extension()] if extends else []))
    for disks in (2, 4, 5, 8, 16):
        arm = Arm.preset(
            "rone2012", disks=disks, disk_spacing=0.08 / disks, subsegments=subsegments, cables=(UPPER,)
        )
        solver = StaticSolver(Scene(arm, loads))
        limit = limit_on_the_way(solver, np.array([5000.0]), None)
        assert limit is not None
        assert limit.tension[0] == pytest.approx(closed_form(disks, extends), rel=1e-4)
        for part in (0.5, 0.9, 0.99, 0.999):
            assert ramp(solver, [part * limit.tension])[0].stable  # from straight
        assert solver.solve(1.001 * limit.tension).outcome is Outcome.GEOMETRY_LIMIT


@pytest.mark.parametrize("path", ["stable", "arc_length"])
def test_ramp_to_5000_n_keeps_what_is_below_the_limit(path: str) -> None:
    scenario = Scenario(rone2012(), ((0.0, 40.0, 80.0, 1000.0, 5000.0),), RampStudy())
    run = simulate(replace(scenario, study=RampStudy(path=path)))  # pyright: ignore[reportArgumentType]
    assert run.outcome is Outcome.GEOMETRY_LIMIT
    assert "geometric limit at tension 86.8" in run.message
    assert [point.tension[0] for point in run.equilibria if point.found] == [0.0, 40.0, 80.0]
