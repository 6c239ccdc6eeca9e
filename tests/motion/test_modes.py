"""Modes of the arm at rest, by other routes: by hand, the whole arm, the motion in time, a beam's table."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg
import whole_arm
from conftest import SCENARIOS, moving, rone2012
from scipy.optimize import brentq
from typer.testing import CliRunner
from whole_arm import bare_scene, difference_matrix, full_scene

from continuum_dyn import Scenario, load_scenario
from continuum_dyn.cli import app
from continuum_dyn.effects import Inertia, MaterialDamping, RotaryInertia
from continuum_dyn.integrators import Monitor
from continuum_dyn.modes import MOST_COORDINATES, Mode, RestModes, modes_at_rest, rates_without
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import cut_into_intervals
from continuum_dyn.scenario.profiles import Constant
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.scenario.studies import EquilibriumStudy
from continuum_dyn.simulation.integration import inspector, integrate
from continuum_dyn.views.figures import plots
from statics import Arm, Bending, Cable, CableFriction, Cables, Extension, InputError, Scene
from statics.quantities import QUANTITIES

RETARDATION = 1.2e-3
"""Of the paper's arm in the tests' scenes, s."""
CANTILEVER = (1.87510407, 4.69409113, 7.85475744)
"""beta L of the lowest modes of a cantilever; Blevins 1979, Table 8-1."""


def at_rest(scene: Scene, *tensions: float) -> Scenario:
    return Scenario(scene, tuple(map(Constant, tensions)), EquilibriumStudy())


def damped_by(scene: Scene, retardation_time: float) -> Scene:
    others = (Inertia(), RotaryInertia())
    return Scene(scene.arm, (*scene.effects, *others, MaterialDamping(retardation_time)))


def weightless() -> Scene:
    """The paper's arm without gravity: at no tension its damping is proportional to its stiffness."""
    return rone2012(gravity=(0.0, 0.0))


# ---- closed forms ----


def test_arm_of_one_disk_is_a_pendulum_on_two_springs() -> None:
    """Straight along gravity, so its bending and its extension do not know of each other.

    To second order in phi the disk is at x = (L0 + e) (1 - phi^2 / 6), y = (L0 + e) phi / 2, and a cable
    through its centre is (L0 + e) (1 - phi^2 / 24) long.
    """
    scene = moving(rone2012(disks=1, gravity=(9.81, 0.0)))
    scene = Scene(replace(scene.arm, cables=(Cable("centre", 0.0),)), scene.effects)
    mass, inertia, tension = 4 * 7.782e-4, 2.029e-8, 0.3
    EJ, EA, L0 = 2.10e11 * 2.011e-14, 2.10e11 * 5.027e-7, 0.08
    length = L0 + (mass * 9.81 - tension) * L0 / EA
    stiffness = np.array([EJ / L0 + mass * 9.81 * length / 3 - tension * length / 12, EA / L0])
    masses = np.array([mass * length**2 / 4 + inertia, mass])
    damping = RETARDATION * np.array([EJ, EA]) / L0
    bending, extension = modes_at_rest(at_rest(scene, tension)).modes
    expected = np.sqrt(stiffness / masses)
    np.testing.assert_allclose([2 * np.pi * m.frequency for m in (bending, extension)], expected, rtol=1e-9)
    ratios = damping / (2 * np.sqrt(stiffness * masses))
    np.testing.assert_allclose([m.damping_ratio for m in (bending, extension)], ratios, rtol=1e-9)
    np.testing.assert_allclose(bending.shape, [[0.0, 1.0, 2.0 / length]], atol=1e-9)
    np.testing.assert_allclose(extension.shape, [[1.0, 0.0, 0.0]], atol=1e-9)


def test_kelvin_voigt_damps_each_mode_by_its_own_frequency() -> None:
    found = modes_at_rest(at_rest(moving(weightless()), 0.0)).modes
    free = modes_at_rest(at_rest(damped_by(weightless(), 0.0), 0.0)).modes
    assert [mode.swings for mode in found] == [True, True, *6 * [False]]
    for mode, undamped in zip(found, free, strict=True):
        speed = 2 * np.pi * undamped.frequency
        assert mode.frequency == pytest.approx(undamped.frequency, rel=1e-8)
        assert mode.damping_ratio == pytest.approx(RETARDATION * speed / 2, rel=1e-8)
        np.testing.assert_allclose(mode.shape, undamped.shape, atol=1e-5, rtol=1e-5)
        if not mode.swings:
            slow, fast = mode.decay_rates
            assert slow < fast
            assert slow + fast == pytest.approx(RETARDATION * speed**2, rel=1e-8)
            assert slow * fast == pytest.approx(speed**2, rel=1e-8)
        assert undamped.damping_ratio == 0.0
        assert undamped.decay_time == np.inf


# ---- the whole arm ----


def test_frequencies_are_those_of_the_whole_arms_mass_and_potential_energy() -> None:
    found = modes_at_rest(at_rest(damped_by(rone2012(disks=3), 0.0), 2.0))
    arm, tension = whole_arm.whole_arm(found.scenario.scene), np.array([2.0])
    q = found.rest.coordinates
    mass, _ = whole_arm.mass_and_forcing(arm, q, 0.0 * q, tension)

    def forces(flat: np.ndarray) -> np.ndarray:
        return whole_arm.gradient(
            lambda at: whole_arm.potential_energy(arm, at, tension), flat.reshape(2, 3).T
        ).T.ravel()

    stiffness = difference_matrix(forces, q.T.ravel(), [1e-3] * 3 + [1e-5] * 3)
    squares = scipy.linalg.eigh(0.5 * (stiffness + stiffness.T), mass, eigvals_only=True)
    np.testing.assert_allclose([2 * np.pi * m.frequency for m in found.modes], np.sqrt(squares), rtol=1e-6)


def test_rates_are_those_of_kanes_method_on_the_whole_arm() -> None:
    found = modes_at_rest(at_rest(full_scene(2), 1.3, 0.4))
    arm, tension = whole_arm.whole_arm(found.scenario.scene), np.array([1.3, 0.4])
    q = found.rest.coordinates

    def accelerations(flat: np.ndarray) -> np.ndarray:
        at, rates = flat.reshape(2, *q.shape)
        return whole_arm.accelerations(arm, at, rates, tension).ravel()

    state = np.concatenate([q.ravel(), np.zeros(q.size)])
    steps = np.tile([1e-3, 1e-5], q.size)
    lower = difference_matrix(accelerations, state, steps)
    whole = np.linalg.eigvals(np.vstack([np.eye(q.size, state.size, q.size), lower]))
    rates = [rate for mode in found.modes for rate in (2 if mode.swings else 1) * mode.rates]
    np.testing.assert_allclose(np.sort(np.abs(whole)), np.sort(rates), rtol=1e-5)
    assert sum(mode.swings for mode in found.modes) == 1
    assert found.modes[0].decay_rates[0] == pytest.approx(np.max(-whole[whole.imag > 0].real), rel=1e-5)


# ---- the motion in time ----


@pytest.fixture(scope="module")
def light() -> RestModes:
    return modes_at_rest(load_scenario(SCENARIOS / "step_response_light_damping.toml"))


def swing(found: RestModes, mode: Mode, periods: int) -> tuple[np.ndarray, np.ndarray]:
    """Time, and the tip's displacement across (m) after release from the mode's shape at 10 um."""
    scene = found.scenario.scene
    dynamics = Dynamics(scene)
    samples = np.linspace(0.0, periods / mode.frequency, 400 * periods + 1)
    still = cut_into_intervals(tuple(map(Constant, found.rest.tension.tolist())), float(samples[-1]))
    start = dynamics.state(found.rest.coordinates + 1e-5 * mode.coordinates)
    monitor = Monitor(inspect=inspector(dynamics))
    solver = Solver("chain", rtol=1e-12, atol=1e-15)
    motion = integrate(dynamics, still, samples, start, solver, monitor)
    return motion.time, motion.disk_y[:, -1] - found.rest.tip[1]


@pytest.mark.parametrize(("number", "periods"), [(0, 12), (1, 4)])
def test_release_from_a_shape_swings_at_its_frequency_and_dies_away_by_its_ratio(
    light: RestModes, number: int, periods: int
) -> None:
    mode = light.modes[number]
    time, y = swing(light, mode, periods)
    before = np.flatnonzero(np.diff(np.sign(y)) != 0)
    crossings = time[before] - y[before] * np.diff(time)[before] / (y[before + 1] - y[before])
    damped = mode.frequency * np.sqrt(1.0 - mode.damping_ratio**2)
    assert len(crossings) == pytest.approx(2 * periods, abs=1)
    half_periods = (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    assert 0.5 / half_periods == pytest.approx(damped, rel=1e-3)
    peaks = [np.abs(part).max() for part in np.split(y, before + 1)[1:-1]]
    decrement = 2.0 * np.log(peaks[0] / peaks[-1]) / (len(peaks) - 1)  # over a whole period
    ratio = decrement / np.hypot(2 * np.pi, decrement)
    assert mode.damping_ratio == pytest.approx(ratio, rel=0.01)


# ---- the cantilever beam ----


def beam(disks: int, *, core: float) -> RestModes:
    """E J = 1, length 1, mass 1: the part ``core`` in the core, the rest in equal disks."""
    arm = Arm(disks, 1.0 / disks, youngs_modulus=1.0, area=1.0, second_moment=1.0)
    arm = replace(arm, disk_mass=(1.0 - core) / disks, core_density=core or None)
    return modes_at_rest(at_rest(Scene(arm, (Bending(), Inertia()))))


def roots(found: RestModes) -> np.ndarray:
    """Beta L of the lowest three modes."""
    return np.sqrt([2 * np.pi * mode.frequency for mode in found.modes[:3]])


def test_many_equal_disks_swing_like_a_cantilever_beam() -> None:
    coarse, fine = roots(beam(40, core=0.0)), roots(beam(80, core=0.0))
    np.testing.assert_allclose((coarse - CANTILEVER) / (fine - CANTILEVER), 2.0, rtol=0.1)  # first order
    np.testing.assert_allclose(2 * fine - coarse, CANTILEVER, rtol=1e-3)


@pytest.mark.slow
def test_core_with_mass_swings_like_a_cantilever_beam() -> None:
    coarse, fine = roots(beam(20, core=1.0 - 1e-12)), roots(beam(40, core=1.0 - 1e-12))
    assert (fine > CANTILEVER).all()  # arcs are some of the beam's shapes: from above (Rayleigh)
    np.testing.assert_allclose((coarse - CANTILEVER) / (fine - CANTILEVER), 4.0, rtol=0.01)  # second order
    np.testing.assert_allclose((4 * fine - coarse) / 3, CANTILEVER, rtol=1e-5)


@pytest.mark.slow
def test_mass_along_the_core_is_better_than_at_the_ends_of_its_segments() -> None:
    """Twenty segments: the first frequency, which goes by the square, to 0.05 % instead of 5 %."""
    along, at_ends = (roots(beam(20, core=core)) / CANTILEVER - 1 for core in (1.0 - 1e-12, 0.0))
    assert (np.abs(at_ends) > (90, 12, 4) * np.abs(along)).all()
    assert along[0] < 2.5e-4
    assert at_ends[0] < -0.02


def test_shapes_are_those_of_a_cantilever_beam() -> None:
    found = beam(40, core=1.0 - 1e-12)
    along = np.linspace(0.0, 1.0, 41)[1:]
    for mode, beta in zip(found.modes, CANTILEVER, strict=False):
        sigma = (np.sinh(beta) - np.sin(beta)) / (np.cosh(beta) + np.cos(beta))  # Blevins 1979, Table 8-1

        def shape(x: np.ndarray, beta: float = beta, sigma: float = sigma) -> np.ndarray:
            return np.cosh(beta * x) - np.cos(beta * x) - sigma * (np.sinh(beta * x) - np.sin(beta * x))

        np.testing.assert_allclose(mode.shape[:, 1], shape(along) / shape(np.array(1.0)), atol=5e-3)
        np.testing.assert_allclose(mode.shape[:, 0], 0.0, atol=1e-12)
    second = found.modes[1].shape[:, 1]
    node = brentq(lambda x: float(np.interp(x, along, second)), 0.5, 0.99)
    assert node == pytest.approx(0.783, abs=2e-3)


# ---- what it refuses ----


def test_scene_without_inertia_is_told_what_to_add() -> None:
    with pytest.raises(InputError, match=r"Add inertia = \{\}"):
        modes_at_rest(load_scenario(SCENARIOS / "tension_ramp.toml"))


def test_nodes_without_mass_and_too_many_coordinates_are_refused() -> None:
    bare = bare_scene(2)
    with pytest.raises(InputError, match="core_density"):
        modes_at_rest(at_rest(Scene(replace(bare.arm, subsegments=2), bare.effects)))
    with pytest.raises(InputError, match=f"Allowed: {MOST_COORDINATES}"):
        modes_at_rest(at_rest(bare_scene(MOST_COORDINATES + 1)))


def test_arm_that_does_not_rest_has_no_modes() -> None:
    with pytest.raises(InputError, match="stable equilibrium; found: geometry_limit"):
        modes_at_rest(at_rest(moving(rone2012()), 100.0))


# ---- effects left out ----


def test_rates_without_an_effect_are_those_of_the_scene_without_it() -> None:
    scenario = at_rest(moving(weightless()), 0.0)
    without = rates_without(scenario, "material_damping")
    free = modes_at_rest(at_rest(damped_by(weightless(), 0.0), 0.0))
    assert without == pytest.approx(free.rates, rel=1e-9)
    assert rates_without(scenario, "inertia") is None
    assert rates_without(load_scenario(SCENARIOS / "step_response.toml"), "bending") is None


# ---- the command ----


def test_command_prints_a_table_and_writes_shapes_and_a_picture(tmp_path: Path, light: RestModes) -> None:
    scenario = str(SCENARIOS / "step_response_light_damping.toml")
    result = CliRunner(env={"COLUMNS": "80"}).invoke(app, ["modes", scenario, "--out", str(tmp_path)])
    assert result.exit_code == 0, result.output
    assert "23.071 Hz" in result.stdout
    assert "creeps" in result.stdout
    assert max(map(len, result.stdout.splitlines()[:-1])) <= 80
    with (tmp_path / "step_response_light_damping_modes.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 8 * 4
    assert set(rows[0]) <= set(QUANTITIES)
    assert float(rows[0]["frequency"]) == pytest.approx(light.modes[0].frequency, rel=1e-12)
    assert float(rows[3]["shape_y"]) == pytest.approx(light.modes[0].shape[-1, 1], rel=1e-9)
    assert (tmp_path / "step_response_light_damping_modes.png").stat().st_size > 10_000


def test_picture_shows_the_lowest_six_about_the_arm_at_rest(light: RestModes) -> None:
    shown = plots.modes(light).axes
    assert len(shown) == 6
    at_rest_line = np.asarray(shown[0].lines[0].get_xydata())
    np.testing.assert_allclose(at_rest_line[-1], 1e3 * np.array(light.rest.tip[:2]), atol=1e-9)


def of_disks_with_hardly_any_mass(mass: float, damping: bool, friction: float = 0.0) -> Scenario:
    cable = Cable("upper", 0.008, friction=friction)
    core = Arm(4, 0.02, youngs_modulus=2.1e11, area=4e-7, second_moment=2e-14, cables=(cable,))
    arm = replace(core, disk_mass=mass, disk_inertia=2.4e-8)
    effects = [Bending(), Extension(), Cables(), Inertia(), RotaryInertia()]
    effects += [MaterialDamping(1e-3)] if damping else []
    return at_rest(Scene(arm, [*effects, *([CableFriction()] if friction else [])]), 0.0)


@pytest.mark.parametrize("damping", [True, False])
@pytest.mark.parametrize("mass", [1e-7, 1e-9])
def test_light_disks_swing_as_their_rotary_inertia_alone_lets_them(mass: float, damping: bool) -> None:
    """Angles theta of disks on rotary springs EJ / L0 in a row: I theta'' + K theta = 0."""
    chain = 2.0 * np.eye(4) - np.eye(4, k=1) - np.eye(4, k=-1)
    chain[3, 3] = 1.0
    squares = 2.1e11 * 2e-14 / 0.02 / 2.4e-8 * np.linalg.eigvalsh(chain)
    found = modes_at_rest(of_disks_with_hardly_any_mass(mass, damping))
    frequencies = [mode.frequency for mode in found.modes[:4]]
    np.testing.assert_allclose(frequencies, np.sqrt(squares) / (2.0 * np.pi), rtol=0.3e6 * mass)


@pytest.mark.parametrize("friction", [0.0, 0.2])
@pytest.mark.parametrize("damping", [True, False])
@pytest.mark.parametrize("mass", [1e-20, *(pytest.param(m, marks=pytest.mark.slow) for m in (1e-60, 1e-100))])
def test_modes_that_rounding_drowns_are_refused(mass: float, damping: bool, friction: float) -> None:
    with pytest.raises(InputError, match="modes are lost in rounding: rates of the linearized motion go"):
        modes_at_rest(of_disks_with_hardly_any_mass(mass, damping, friction))
