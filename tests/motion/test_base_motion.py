"""Arms on a base that moves: what they do, the work of the base, and which motions are refused.

Accelerations of any scene on such a base are held against Kane's method in ``test_subsets_of_effects.py``.
"""

from collections.abc import Callable
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import MOTION, SCENARIOS
from whole_arm import difference_matrix

from continuum_dyn import Scenario, Trajectory, load_scenario, simulate
from continuum_dyn.effects import Inertia, MaterialDamping
from continuum_dyn.integrators import Monitor
from continuum_dyn.modes import Mode, modes
from continuum_dyn.passes.accelerations import acceleration
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.record import read_log, write_log
from continuum_dyn.scenario.intervals import Interval, Timeline, cut_into_intervals
from continuum_dyn.scenario.profiles import Constant, Piecewise, Profile, Ramp, Sine, SmoothRamp, Step, Table
from continuum_dyn.scenario.rates import Rate, check_smooth
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.scenario.studies import EquilibriumStudy, MotionStudy, StepResponseStudy
from continuum_dyn.simulation.integration import inspector, integrate
from continuum_dyn.views.playback.arm import moving_parts
from continuum_dyn.views.playback.measures import measures_of
from continuum_dyn.views.playback.playback import playback_of
from statics import Arm, Base, Bending, Gravity, InputError, Outcome, Scene
from statics.effects import Effect
from statics.kernels.slots import SCALARS

STILL = Constant(0.0)
SWEPT = (SmoothRamp(0.0, 0.03, 0.01, 0.11), STILL, Sine(-0.2, 0.2, 9.0, phase=pi / 2))
"""x, y and angle of a base that is moved along and turned to and fro."""


@pytest.fixture(scope="module")
def shaken() -> Scenario:
    return load_scenario(SCENARIOS / "shaken_base.toml")


def small_arm(*more: Effect, disks: int = 2) -> Scene:
    """An inextensible arm on a base that moves."""
    arm = Arm.preset("rone2012", disks=disks, base=Base(moves=True))
    return Scene(arm, (Bending(), Inertia(), *more))


def mounted(scenario: Scenario, **changes: Any) -> Scene:
    return Scene(replace(scenario.scene.arm, **changes), scenario.scene.effects)


def driven(x: Profile, y: Profile, angle: Profile, duration: float) -> Timeline:
    rates = [Rate(profile) for profile in (x, y, angle)]
    profiles: list[Piecewise] = [x, y, angle, *rates, *map(Rate, rates)]
    return cut_into_intervals(profiles, duration)


def moved(scene: Scene, stretches: Timeline, solver: Solver, samples: int = 21) -> Trajectory:
    dynamics = Dynamics(scene)
    times = np.linspace(0.0, stretches.end, samples)
    start = dynamics.state(np.zeros((scene.arm.segments, dynamics.dofs)))
    monitor = Monitor(inspect=inspector(dynamics))
    return integrate(dynamics, stretches, times, start, solver, monitor)


# ---- fictitious forces ----


def accelerations(scene: Scene, inputs: np.ndarray) -> np.ndarray:
    q, u = np.random.default_rng(3).uniform(-1.0, 1.0, (2, scene.arm.segments, 1))
    kernel, segments, disks = Dynamics(scene).linearized
    chain, work, w = np.empty((len(q), kernel.widths["chain"])), np.empty((2, *q.shape)), np.empty_like(q)
    scalars = np.empty(SCALARS)
    acceleration(kernel.passes, q, 30.0 * u, inputs, segments, disks, chain, work, w, scalars)
    return w


def test_arm_on_a_base_that_accelerates_feels_another_gravity() -> None:
    """Einstein's lift: g - a; where the base is and how fast it goes does not matter."""
    hurried = np.array([0.3, -0.2, 0.4, 2.0, -5.0, 0.0, 3.0, -7.0, 0.0])
    still = np.array([0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    found = accelerations(small_arm(Gravity((1.0, -9.81)), disks=3), hurried)
    expected = accelerations(small_arm(Gravity((1.0 - 3.0, -9.81 + 7.0)), disks=3), still)
    np.testing.assert_allclose(found, expected, rtol=1e-11)


def test_one_segment_on_a_rotating_base_feels_the_centrifugal_force() -> None:
    """M |r_phi|^2 w = -m r_phi . r_phiphi u^2 + m omega^2 r . r_phi - EJ phi / L, in polar coordinates.

    The tip stands at rho = 2 L sin(phi / 2) / phi, at the angle phi / 2 to the base, so |r_phi|^2 is
    rho'^2 + rho^2 / 4, and what rotates it is the rate of its angular momentum, m rho^2 (omega + u / 2).
    """
    scene, phi, u, omega = small_arm(disks=1), 0.8, 25.0, 40.0
    L, m, EJ = 0.02, 7.782e-4, 2.10e11 * 2.011e-14
    s, c = np.sin(phi / 2), np.cos(phi / 2)
    rho, rho_1 = 2 * L * s / phi, L * (c / phi - 2 * s / phi**2)
    rho_2 = L * (-s / (2 * phi) - 2 * c / phi**2 + 4 * s / phi**3)
    inertia, slope = rho_1**2 + rho**2 / 4, rho_1 * rho_2 + rho * rho_1 / 4
    w = (-m * slope * u**2 + m * omega**2 * rho * rho_1 - EJ * phi / L) / (m * inertia)
    moment = m * (2 * rho * rho_1 * u * (omega + u / 2) + rho**2 * w / 2)
    dynamics = Dynamics(scene)
    y = dynamics.state(np.array([[phi]]), np.array([[u]]))
    rotating = np.array([[0.0, value, 0.0, 0.0, 0.0, 0.0] for value in (0, 0, 1.1, 0, 0, omega, 0, 0, 0)])
    interval = Interval(0.0, 1.0, rotating)
    assert dynamics.rate(0.0, y, interval)[1] == pytest.approx(w, rel=1e-11)
    seen = dynamics.observe(y[None], interval.inputs(np.zeros(1)))
    assert seen.ledger["input_power"][0] == pytest.approx(moment * omega, rel=1e-11)


# ---- the equations ----


def test_jacobian_is_exact_where_the_base_moves() -> None:
    """The integrand of the work, too, against differences of sixth order."""
    dynamics = Dynamics(small_arm(Gravity(), MaterialDamping(1.2e-3)))
    _, interval, *_ = driven(*SWEPT, 0.2)
    random = np.random.default_rng(4)
    y = dynamics.state(random.uniform(-0.5, 0.5, (2, 1)), random.uniform(-20.0, 20.0, (2, 1)))
    size = 2 * dynamics.size
    expected = difference_matrix(
        lambda y: dynamics.rate(0.03, y, interval), y, np.repeat([1e-3, 1e-1], [2, 4])
    )
    found = dynamics.jacobian(0.03, y, interval)
    scale = np.abs(expected[:, :size]).max(axis=1, keepdims=True)
    assert np.abs((found - expected)[:, :size] / np.maximum(scale, 1e-6)).max() < 1e-8


SETTINGS = {name: Solver(name, rtol=1e-9, atol=1e-11) for name in ("chain", "explicit", "DOP853", "Radau")}
SETTINGS["midpoint"] = Solver("midpoint", step=2.5e-5)


@pytest.mark.parametrize("method", SETTINGS)
def test_work_of_the_base_closes_the_ledger_by_any_method(method: str) -> None:
    """And it is the integral of the base's power, its wrench times its velocity, by the trapezoidal rule."""
    damped = () if method == "midpoint" else (MaterialDamping(1.2e-3),)
    run = moved(small_arm(Gravity(), *damped), driven(*SWEPT, 0.02), SETTINGS[method], samples=401)
    work, power = run.ledger["input_work"], run.ledger["input_power"]
    largest = np.abs(work).max()
    assert largest > 1e-5
    assert np.abs(run.ledger_gap).max() < 2e-5 * largest
    by_power = np.cumsum((power[1:] + power[:-1]) / 2 * np.diff(run.time))
    assert np.abs(by_power - work[1:]).max() < 2e-5 * largest


def test_midpoint_rule_keeps_its_order_where_the_base_moves() -> None:
    """In steps that resolve the arm's fastest mode, of 5.3e3 rad/s."""
    scene, stretches = small_arm(Gravity()), driven(*SWEPT, 0.02)
    exact = moved(scene, stretches, Solver("DOP853", rtol=1e-11, atol=1e-13))
    errors = []
    for step in (5e-5, 2.5e-5):
        run = moved(scene, stretches, Solver("midpoint", step=step))
        errors.append(np.hypot(run.disk_x - exact.disk_x, run.disk_y - exact.disk_y).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.2)


# ---- scenarios ----


@pytest.mark.slow
def test_arm_moved_along_settles_where_the_statics_find_it(shaken: Scenario) -> None:
    """20 cm along and a quarter turn: the same scene, another motion of the base."""
    there = replace(
        shaken,
        scene=mounted(shaken, base=Base(moves=True)),
        base_motion=(SmoothRamp(0.0, 0.2, 0.05, 0.25), STILL, SmoothRamp(0.0, pi / 2, 0.1, 0.3)),
        study=StepResponseStudy(1.2, samples=601),
    )
    run = simulate(there)
    assert run.outcome is Outcome.SETTLED
    assert run.static_gap is not None
    assert run.static_gap < 1e-7
    assert run.tip == pytest.approx((0.2, 0.08, pi / 2), abs=2e-6)
    assert (run.equilibria[-1].base_x, run.equilibria[-1].base_theta) == pytest.approx((0.2, pi / 2))


@pytest.mark.slow
def test_shaken_base_swings_the_arm_as_its_linear_motion_says(shaken: Scenario) -> None:
    """Small and late: (i omega - A)^-1 of the exact Jacobian, pushed by the base's acceleration alone."""
    omega, size = 2 * pi * 23.0, 1e-6
    motion = (STILL, Sine(0.0, size, 23.0, phase=pi / 2), STILL)
    small = replace(
        shaken,
        scene=mounted(shaken, base=Base(y=size, moves=True)),
        base_motion=motion,
        study=MotionStudy(1.0, samples=4001),
        solver=Solver("chain", 1e-11, 1e-13),
    )
    run = simulate(small)
    assert run.trajectory is not None
    dynamics, y = Dynamics(small.scene), np.append(run.equilibria[0].coordinates.ravel(), np.zeros(10))
    still, lifted = np.zeros((2, 9, 6))
    lifted[7, 1] = 1.0
    at_rest, pushed = (dynamics.rate(0.0, y, Interval(0.0, 1.0, pieces)) for pieces in (still, lifted))
    states = 2 * dynamics.size
    matrix = (
        1j * omega * np.eye(states) - dynamics.jacobian(0.0, y, Interval(0.0, 1.0, still))[:states, :states]
    )
    response = np.linalg.solve(matrix, (pushed - at_rest)[:states] * -size * omega**2)
    late = run.trajectory.time > 0.6
    expected = np.real(response[0] * np.exp(1j * omega * run.trajectory.time[late]))
    found = run.trajectory.bend_angle[late, 0] - run.equilibria[0].bend_angle[0]
    np.testing.assert_allclose(found, expected, atol=2e-3 * np.abs(response[0]))


def test_modes_are_those_of_the_arm_on_its_base_at_rest(shaken: Scenario) -> None:
    """A tip that moves across the arm moves along x where the arm stands upright."""
    level = Scene(replace(shaken.scene.arm, base=None), (Bending(), *MOTION))
    upright = Scene(replace(level.arm, base=Base(angle=pi / 2)), level.effects)
    first, second = map(lowest_mode, (level, upright))
    assert second.frequency == pytest.approx(first.frequency, rel=1e-9)
    assert np.abs(second.shape[-1, 0]) == pytest.approx(first.shape[-1, 1], rel=1e-9)
    assert second.shape[-1, 1] == pytest.approx(0.0, abs=1e-9)


def lowest_mode(scene: Scene) -> Mode:
    """About the straight arm."""
    dynamics, inputs = Dynamics(scene), scene.check_tension([])
    interval = cut_into_intervals([Constant(float(value)) for value in inputs], 1.0).first
    return modes(dynamics, dynamics.state(np.zeros((scene.arm.segments, dynamics.dofs))), interval)[0]


@pytest.mark.slow
def test_log_and_recording_have_the_base_where_it_was(shaken: Scenario, tmp_path: Path) -> None:
    run = simulate(replace(shaken, study=MotionStudy(0.1, samples=101, static_path=True)))
    write_log(run, tmp_path / "shaken.h5")
    log = read_log(tmp_path / "shaken.h5")
    y = 0.5e-3 * (np.cos(46 * pi * log.trajectory["time"]) - 1.0)
    np.testing.assert_allclose(log.trajectory["base_y"], y, atol=1e-12)
    np.testing.assert_allclose(log.equilibria["base_y"], y, atol=1e-12)
    np.testing.assert_allclose(
        log.equilibria["disk_y"][:, -1] - y, log.equilibria["disk_y"][0, -1], atol=1e-9
    )
    playback = playback_of(log)
    assert playback is not None
    drawn: Any = moving_parts(playback, np.arange(101), measures_of([playback]))
    np.testing.assert_allclose(drawn["arm/base"].strips.mean(axis=1)[:, 1], y, atol=1e-12)
    np.testing.assert_allclose(drawn["arm/rim"].strips[:, 0, 1], y, atol=1e-12)
    tip = drawn["arm/rim"].strips[:, -1]
    np.testing.assert_allclose(tip[:, 1], log.trajectory["disk_y"][:, -1], atol=1e-12)


# ---- refusals ----


@pytest.mark.parametrize(
    "smooth",
    [
        Constant(0.3),
        Step(0.2, 0.2, at=0.1),
        Ramp(1.0, 1.0, 0.0, 1.0),
        Table((-1.0, 0.0, 1.0), (0.5, 0.2, 0.2)),
        SmoothRamp(0.1, 0.35, 0.0, 0.3),
        SmoothRamp(-2.0, 1e-9, 0.7, 0.8),
        Sine(0.1, -0.2, 3.0, phase=1.5708),
        Sine(0.1, 0.2, 3.0, phase=-4.71239),
    ],
)
def test_profile_that_starts_from_rest_and_has_no_corner_is_smooth(smooth: Profile) -> None:
    check_smooth(smooth, "[base] x", "m")


@pytest.mark.parametrize(
    ("hit", "told"),
    [
        (Step(0.0, 0.01), r"jumps by 0.01 m at 0 s.*\"step\".*smooth_ramp"),
        (Step(0.0, 0.01, at=0.2), r"jumps by 0.01 m at 0.2 s"),
        (Ramp(0.0, 0.1, 0.5, 0.7), r"rate jumps by 0.5 m/s at 0.5 s.*\"ramp\".*smooth_ramp"),
        (Sine(0.0, 0.1, 2.0), r"rate jumps by 1.25664 m/s at 0 s.*phase = 1.5708"),
        (Sine(0.0, 0.1, 2.0, phase=1.5), r"rate jumps by"),
        (Table((0.0, 1.0), (0.0, 0.5)), r"rate jumps by 0.5 m/s at 0 s.*\"table\".*smooth_ramp"),
        (Table((-1.0, 1.0, 2.0), (0.3, 0.3, 0.5)), r"rate jumps by 0.2 m/s at 1 s"),
    ],
)
def test_impulse_is_refused_with_what_to_try(hit: Profile, told: str) -> None:
    with pytest.raises(InputError, match=r"\[base\] x: .*" + told):
        check_smooth(hit, "[base] x", "m")


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda _: {"base_motion": ()}, "0 profiles given for the motion of a moving base"),
        (lambda _: {"study": EquilibriumStudy()}, "a moving base belongs to a study of motion"),
        (lambda _: {"base_motion": (STILL, Constant(0.1), STILL)}, r"\[base\] y: the arm's base is at 0"),
        (lambda shaken: {"scene": mounted(shaken, subsegments=2)}, "Give the arm's core_density"),
        (lambda shaken: {"scene": mounted(shaken, base=None)}, "a fixed base"),
    ],
)
def test_base_that_does_not_fit_is_refused(
    shaken: Scenario, change: Callable[[Scenario], dict[str, Any]], told: str
) -> None:
    with pytest.raises(InputError, match=told):
        replace(shaken, **change(shaken))


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (", phase = 1.5707963267948966", "", "[base] y: its rate jumps by 0.0722566 m/s at 0 s"),
        ("\ny = {", "\nz = {", "[base]: unknown key 'z'"),
        ('"sine"', '"sin"', "[base] y: unknown profile 'sin'. Write 'sine'."),
        ("phase =", "fase =", "Did you mean 'phase'?"),
        ("\ny = {", "\nx = [1.0, 2.0]\ny = {", "[base] x: a number is expected; read [1.0, 2.0]"),
        ("\ny = {", '\nx = { profile = "table", file = "no.csv" }\ny = {', "no such file"),
    ],
)
def test_bad_base_of_a_file_is_named_with_what_is_allowed(
    tmp_path: Path, old: str, new: str, told: str
) -> None:
    text = (SCENARIOS / "shaken_base.toml").read_text()
    assert old in text
    (tmp_path / "scenario.toml").write_text(text.replace(old, new))
    with pytest.raises(InputError) as caught:
        load_scenario(tmp_path / "scenario.toml")
    assert told in str(caught.value)


def test_file_may_give_numbers_profiles_and_none(tmp_path: Path) -> None:
    text = (SCENARIOS / "mounted_upright.toml").read_text()
    assert load_scenario(SCENARIOS / "mounted_upright.toml").scene.arm.base == Base(0.0, 0.0, pi / 2)
    (tmp_path / "scenario.toml").write_text(text.replace("x = 0.0\n", "").replace("y = 0.0\n", "y = 0.3\n"))
    assert load_scenario(tmp_path / "scenario.toml").scene.arm.base == Base(0.0, 0.3, pi / 2)
