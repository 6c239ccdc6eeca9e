"""Loads that change in time: what they do to a motion, and to nothing else."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENARIOS, motion

from continuum_dyn import Scenario, Trajectory, load_scenario, simulate
from continuum_dyn.modes import modes_at_rest
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.passes.motion_passes import MOTION
from continuum_dyn.scenario.intervals import cut_into_intervals
from continuum_dyn.scenario.profiles import Constant, Profile, Sine, Step, Table
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.scenario.studies import MotionStudy, RampStudy
from statics import DiskLoad, DiskLoads, InputError, Outcome, Scene, equilibrium


@pytest.fixture(scope="module")
def shaken() -> Scenario:
    return load_scenario(SCENARIOS / "shaken_tip.toml")


def with_loads(scenario: Scenario, *loads: DiskLoad, factors: tuple[Profile, ...] = ()) -> Scenario:
    others = (effect for effect in scenario.scene.effects if not isinstance(effect, DiskLoads))
    scene = Scene(scenario.scene.arm, (*others, DiskLoads(loads)))
    return replace(scenario, scene=scene, load_factors=factors, study=MotionStudy(0.05, samples=51))


def test_constant_factor_is_a_constant_load(shaken: Scenario) -> None:
    driven = DiskLoad(3, (0.01, -0.02), 1e-4, driven=True)
    tripled = DiskLoad(3, (0.03, -0.06), 3e-4)
    by_factor = with_loads(shaken, driven, factors=(Constant(3.0),))
    by_load = with_loads(shaken, tripled)
    assert by_factor.scene.inputs == ("tension_1", "load_factor_1")
    np.testing.assert_allclose(rate_of(by_factor), rate_of(by_load), rtol=1e-12)


def rate_of(scenario: Scenario) -> np.ndarray:
    """dy/dt of one state that moves."""
    y = np.append(np.random.default_rng(1).uniform(-1, 1, 8), [0.0, 0.0])
    (interval,) = cut_into_intervals(scenario.profiles, 1.0)
    return Dynamics(scenario.scene).rate(0.3, y, interval)


@pytest.mark.slow
def test_work_of_a_driven_load_is_booked(shaken: Scenario) -> None:
    """Factor times force times displacement, by the trapezoidal rule over fine samples."""
    load = DiskLoad(4, (0.0, 5e-3), driven=True)
    fine = replace(
        with_loads(shaken, load, factors=(Sine(0.0, 1.0, 20.0),)), solver=Solver("chain", 1e-11, 1e-13)
    )
    found = motion(replace(fine, study=MotionStudy(0.05, samples=5001)))
    assert found.load_factor is not None
    np.testing.assert_allclose(found.load_factor[:, 0], np.sin(40 * np.pi * found.time), atol=1e-12)
    force, y = 5e-3 * found.load_factor[:, 0], found.disk_y[:, -1]
    by_load = np.sum((force[1:] + force[:-1]) / 2 * np.diff(y))
    assert np.abs(found.ledger_gap).max() < 1e-4 * found.ledger["input_work"].max()
    cable = -0.1 * (cable_length(found, -1) - cable_length(found, 0))
    assert found.ledger["input_work"][-1] == pytest.approx(by_load + cable, rel=1e-4)


def cable_length(found: Trajectory, sample: int) -> float:
    """Length of the cable at 8 mm from hole to hole, all segments, m."""
    phi = found.bend_angle[sample]
    return float(np.sum(np.sinc(phi / 2 / np.pi) * (0.02 - phi * 0.008)))


@pytest.mark.slow
def test_small_oscillation_has_the_amplitude_and_phase_of_the_linear_arm(shaken: Scenario) -> None:
    """Against (i omega - A)^-1 b of the exact Jacobian, after the start has died out."""
    load, omega = DiskLoad(4, (0.0, 1e-5), driven=True), 2 * np.pi * 20.0
    small = with_loads(shaken, load, factors=(Sine(0.0, 1.0, 20.0),))
    small = replace(small, study=MotionStudy(2.0, samples=8001), solver=Solver("chain", 1e-10, 1e-12))
    dynamics, rest = Dynamics(small.scene), simulate(small).equilibria[0]
    still = with_loads(shaken, load, factors=(Constant(0.0),)).profiles
    pushed = with_loads(shaken, load, factors=(Constant(1.0),)).profiles
    y = dynamics.state(rest.coordinates)
    (interval,), (with_push,) = cut_into_intervals(still, 1.0), cut_into_intervals(pushed, 1.0)
    size = 2 * dynamics.size
    response = np.linalg.solve(
        1j * omega * np.eye(size) - dynamics.jacobian(0.0, y, interval)[:size, :size],
        (dynamics.rate(0.0, y, with_push) - dynamics.rate(0.0, y, interval))[:size],
    )
    found = motion(small)
    late = found.time > 1.5
    angle = found.bend_angle[late, 0] - rest.bend_angle[0]
    expected = np.imag(response[0] * np.exp(1j * omega * found.time[late]))
    np.testing.assert_allclose(angle, expected, atol=2e-3 * np.abs(response[0]))


@pytest.mark.slow
def test_study_at_rest_takes_the_factor_as_it_is(shaken: Scenario) -> None:
    load = DiskLoad(4, (0.0, 0.02), driven=True)
    stepped = with_loads(shaken, load, factors=(Step(0.5, 1.0),))
    run = simulate(stepped)
    halved = with_loads(shaken, DiskLoad(4, (0.0, 0.01), driven=True), factors=(Constant(1.0),))
    assert run.equilibria[0].tip == pytest.approx(equilibrium(halved.scene, 0.1).tip)
    assert run.outcome is Outcome.COMPLETED


def test_modes_know_what_drives_the_scene(shaken: Scenario) -> None:
    """A constant factor is part of the rest that the modes are about."""
    pushed = with_loads(shaken, DiskLoad(4, (0.0, 0.5), driven=True), factors=(Constant(2.0),))
    pulled = with_loads(shaken, DiskLoad(4, (0.0, 1.0), driven=True), factors=(Constant(1.0),))
    first, second = (modes_at_rest(scenario).modes[0].frequency for scenario in (pushed, pulled))
    assert first == pytest.approx(second, rel=1e-9)
    assert first != pytest.approx(modes_at_rest(shaken).modes[0].frequency, rel=1e-3)


def test_ramp_takes_no_profile_of_a_factor(shaken: Scenario) -> None:
    with pytest.raises(InputError, match="lists of tensions and load factors, or numbers"):
        replace(shaken, study=RampStudy(), drives=((0.0, 1.0),))


def test_ramp_takes_lists_of_factors_as_long_as_those_of_tensions(shaken: Scenario) -> None:
    ramp = replace(shaken, study=RampStudy(), drives=((1.0, 1.0),), load_factors=((0.5, 1.0),))
    factors = [point.load_factor for point in simulate(ramp).equilibria]
    np.testing.assert_array_equal(factors, [[0.5], [1.0]])
    with pytest.raises(InputError, match="equal length; they have 2, 3 entries"):
        replace(ramp, load_factors=((0.0, 0.5, 1.0),))


def test_scene_without_driven_loads_has_none_in_its_kernel(shaken: Scenario) -> None:
    assert "load_factor" not in MOTION.write(with_loads(shaken, DiskLoad(4)).scene.structure)
    assert "load_factor_1" in MOTION.write(shaken.scene.structure)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("disk = 4", "disk = 5", "load on disk 5: beyond the arm"),
        ('"sine", mean', '"sinus", mean', "'sine'"),
        (
            '{ profile = "sine", mean = 0.0, amplitude = 1.0, frequency = 20.0 }',
            "[1.0, 2.0]",
            "list for factor belongs",
        ),
        ('"sine", mean = 0.0, amplitude = 1.0, frequency = 20.0', '"table", file = "no.csv"', "no such file"),
        ("factor =", "factr =", "'factor'"),
    ],
)
def test_bad_load_is_named_with_what_is_allowed(tmp_path: Path, old: str, new: str, told: str) -> None:
    text = (SCENARIOS / "shaken_tip.toml").read_text()
    assert old in text
    path = tmp_path / "scenario.toml"
    path.write_text(text.replace(old, new))
    with pytest.raises(InputError) as caught:
        load_scenario(path)
    assert told in str(caught.value)


def test_factor_from_a_file(tmp_path: Path) -> None:
    text = (SCENARIOS / "shaken_tip.toml").read_text()
    before = '"sine", mean = 0.0, amplitude = 1.0, frequency = 20.0'
    (tmp_path / "factor.csv").write_text("time,factor\n0.0,-1.0\n1.0,2.0\n")
    (tmp_path / "scenario.toml").write_text(text.replace(before, '"table", file = "factor.csv"'))
    scenario = load_scenario(tmp_path / "scenario.toml")
    assert scenario.load_factors == (Table((0.0, 1.0), (-1.0, 2.0)),)
