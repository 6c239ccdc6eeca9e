"""Drag and damping by mass against closed forms, the whole arm's own formulas, and the power ledger."""

from typing import Any

import numpy as np
import pytest
import whole_arm
from scipy.integrate import solve_ivp
from scipy.signal import argrelmax
from whole_arm import difference_matrix, gradient, random_state, relative_error

from continuum_dyn.effects import Inertia, LinearDrag, MassDamping, QuadraticDrag, RotaryInertia
from continuum_dyn.integrators.choice import check
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Interval
from statics import Arm, Bending, Gravity, InputError, Scene
from statics.effects import Effect

FREE = Interval(0.0, 10.0, np.empty((0, 6)))
ENERGIES = ("kinetic_energy", "elastic_energy", "gravity_energy")
THICK, THIN, BY_MASS = LinearDrag(0.03, 2e-6), QuadraticDrag(0.4, 3e-8), MassDamping(12.0)
NONE = LinearDrag(0.0), QuadraticDrag(0.0), MassDamping(0.0)


def damped(disks: int, *dampings: Effect, gravity: tuple[float, float] = (0.0, 0.0)) -> Dynamics:
    """The paper's arm without cables and extension; dampings that are not named are zero."""
    given = {effect.name for effect in dampings}
    zero = [effect for effect in NONE if effect.name not in given]
    effects = (Bending(), Gravity(gravity), Inertia(), RotaryInertia(), *dampings, *zero)
    return Dynamics(Scene(Arm.preset("rone2012", disks=disks), effects))


def released(dynamics: Dynamics, bend: float, duration: float, samples: int = 2001) -> Any:
    """States, shape (samples, size), from rest with the same bend of all segments."""
    start = dynamics.state(np.full((dynamics.scene.arm.disks, 1), bend))
    tight = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13 * abs(bend)}
    time = np.linspace(0.0, duration, samples)
    found = solve_ivp(lambda t, y: dynamics.rate(t, y, FREE), (0.0, duration), start, t_eval=time, **tight)
    return found.t, found.y.T


class OneDisk:
    """Small motion of an arm of one disk: x = L0, y = L0 phi / 2, so M phi'' + k phi = 0 and drag."""

    arm = Arm.preset("rone2012", disks=1)
    lever = 0.02 / 2
    inertia = 7.782e-4 * lever**2 + 2.029e-8
    frequency = np.sqrt(2.10e11 * 2.011e-14 / 0.02 / inertia)


# ---- closed forms ----


@pytest.mark.parametrize("drag", [THICK, LinearDrag(0.5), LinearDrag(0.0, 5e-5)], ids=repr)
def test_linear_drag_has_its_logarithmic_decrement(drag: LinearDrag) -> None:
    rate = (drag.drag_per_speed * OneDisk.lever**2 + drag.rotary_drag_per_speed) / (2 * OneDisk.inertia)
    ringing = np.sqrt(OneDisk.frequency**2 - rate**2)
    t, y = released(damped(1, drag), bend=1e-4, duration=10 * 2 * np.pi / ringing)
    expected = np.exp(-rate * t) * (np.cos(ringing * t) + rate / ringing * np.sin(ringing * t))
    np.testing.assert_allclose(y[:, 0] / 1e-4, expected, atol=1e-7)


@pytest.mark.parametrize("drag", [QuadraticDrag(20.0), QuadraticDrag(0.0, 2e-5)], ids=repr)
def test_inverse_amplitude_under_quadratic_drag_grows_evenly(drag: QuadraticDrag) -> None:
    """1 / A = 1 / A_0 + 4 kappa omega t / (3 pi) for phi'' + omega^2 phi + kappa |phi'| phi' = 0.

    By averaging: Nayfeh and Mook 1979, sec. 3.3.2.
    """
    kappa = drag.drag_per_speed_squared * OneDisk.lever**3 + drag.rotary_drag_per_speed_squared
    kappa /= OneDisk.inertia
    periods = 40
    t, y = released(
        damped(1, drag), bend=0.02, duration=periods * 2 * np.pi / OneDisk.frequency, samples=80001
    )
    peaks = argrelmax(y[:, 0])[0]
    growth = np.diff(1 / y[peaks, 0]) / np.diff(t[peaks])
    expected = 4 * kappa * OneDisk.frequency / (3 * np.pi)
    assert len(peaks) >= periods - 1
    np.testing.assert_allclose(growth, expected, rtol=2e-3)
    assert y[peaks[-1], 0] < 0.5 * 0.02


def test_damping_by_mass_gives_every_mode_the_ratio_alpha_over_twice_its_frequency() -> None:
    free, dynamics = damped(4), damped(4, BY_MASS)
    straight = dynamics.state(np.zeros((4, 1)))
    modes = [np.linalg.eigvals(d.jacobian(0.0, straight, FREE)[:8, :8]) for d in (free, dynamics)]
    omega, found = np.sort(modes[0].imag[modes[0].imag > 0]), modes[1][modes[1].imag > 0]
    found = found[np.argsort(found.imag)]
    ratio = BY_MASS.mass_damping_rate / (2 * omega)
    np.testing.assert_allclose(-found.real / np.abs(found), ratio, rtol=1e-7)
    np.testing.assert_allclose(np.abs(found), omega, rtol=1e-9)


# ---- the whole arm ----


def drags(dynamics: Dynamics, v: np.ndarray, omega: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Forces (disks, 2) and moments (disks,) on all disks, as the effects' formulas have them."""
    arm, speed = dynamics.scene.arm, np.hypot(*v.T)[:, None]
    assert arm.disk_mass is not None
    assert arm.disk_inertia is not None
    alpha = BY_MASS.mass_damping_rate
    force = -(THICK.drag_per_speed + THIN.drag_per_speed_squared * speed + alpha * arm.disk_mass) * v
    spinning = THICK.rotary_drag_per_speed + THIN.rotary_drag_per_speed_squared * np.abs(omega)
    return force, -(spinning + alpha * arm.disk_inertia) * omega


@pytest.mark.slow
def test_accelerations_are_those_of_kanes_method_with_drag_on_the_disks() -> None:
    dynamics = damped(3, THICK, THIN, BY_MASS, gravity=(1.7, -9.6))
    arm = whole_arm.whole_arm(dynamics.scene)
    for seed in range(5):
        q, u = random_state(dynamics.scene, seed)
        by_q = gradient(lambda q: np.array(whole_arm.poses(arm, q)), q)[:, 0]
        v_x, v_y, omega = np.tensordot(u[:, 0], by_q, 1)
        force, moment = drags(dynamics, np.column_stack([v_x, v_y]), omega)
        mass, forcing = whole_arm.mass_and_forcing(arm, q, u, np.empty(0))
        forcing = forcing + np.sum(by_q * np.array([*force.T, moment]), axis=(1, 2))
        rate = dynamics.rate(0.0, dynamics.state(q, u), FREE)
        assert relative_error(rate[3:6, None], np.linalg.solve(mass, forcing)[:, None]) < 2e-12
        dissipated = -(force[:, 0] @ v_x + force[:, 1] @ v_y + moment @ omega)
        assert rate[-1] == pytest.approx(dissipated, rel=1e-12)


# ---- the Jacobian, at rest too ----


def test_exact_jacobian_with_drag_equals_differences_of_the_rate() -> None:
    dynamics = damped(3, THICK, THIN, BY_MASS)
    y = dynamics.state(*random_state(dynamics.scene, seed=7))
    steps = [*[0.01] * 3, *[1.0] * 3, 1.0, 1.0]
    expected = difference_matrix(lambda y: dynamics.rate(0.0, y, FREE), y, steps)
    found = dynamics.jacobian(0.0, y, FREE)
    np.testing.assert_allclose(found, expected, atol=1e-8 * np.abs(expected).max())


def test_quadratic_drag_is_nothing_at_rest_and_so_is_its_jacobian() -> None:
    thin, none = damped(3, QuadraticDrag(1e3, 1e-3)), damped(3)
    q, _ = random_state(thin.scene, seed=3)
    for u in (np.zeros_like(q), np.full_like(q, 1e-100)):
        y = thin.state(q, u)
        jacobian = thin.jacobian(0.0, y, FREE)
        assert np.isfinite(jacobian).all()
        np.testing.assert_allclose(jacobian, none.jacobian(0.0, y, FREE), rtol=1e-12, atol=1e-50)
        np.testing.assert_allclose(thin.rate(0.0, y, FREE), none.rate(0.0, y, FREE), rtol=1e-12, atol=1e-50)


# ---- the power ledger ----


def test_energy_lost_is_the_energy_dissipated() -> None:
    dynamics = damped(3, THICK, THIN, BY_MASS, gravity=(0.0, -9.81))
    _, y = released(dynamics, bend=0.8, duration=0.2, samples=101)
    ledger = dynamics.observe(y, np.empty((len(y), 0))).ledger
    energy = np.sum([ledger[name] for name in ENERGIES], axis=0)
    lost, dissipated = energy[0] - energy, y[:, -1]
    assert np.all(np.diff(dissipated) > 0)
    assert dissipated[-1] > 0.2 * np.ptp(ledger["kinetic_energy"])
    np.testing.assert_allclose(lost, dissipated, atol=1e-9 * dissipated[-1])


# ---- bad input ----


@pytest.mark.parametrize("effect", [LinearDrag, QuadraticDrag, MassDamping])
@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf, "1.0"])
def test_coefficients_that_cannot_be_are_refused(effect: Any, value: Any) -> None:
    with pytest.raises(ValueError, match="Input should be"):
        effect(value)


def test_damping_by_mass_names_the_inertia_that_it_needs() -> None:
    with pytest.raises(InputError, match="'mass_damping' needs the arm's disk_inertia"):
        Scene(Arm(4, 0.02, disk_mass=1e-3), (BY_MASS,))


def test_damping_of_the_disks_alone_does_not_move_nodes_without_mass() -> None:
    arm = Arm.preset("rone2012", subsegments=2)
    scene = Scene(arm, (Bending(), Inertia(), RotaryInertia(), THICK, BY_MASS))
    with pytest.raises(InputError, match="they need damping of the core"):
        check(scene, "chain")
