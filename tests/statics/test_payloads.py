"""Payloads against the whole arm with bodies of their own, closed forms, and arms without them."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
import whole_arm
from conftest import MOTION, motion, moving, rone2012
from passes_by_hand import Passes
from scipy.optimize import brentq
from whole_arm import difference_matrix, full_scene, gradient, random_state, relative_error, spanned_scene

from continuum_dyn import Scenario, simulate
from continuum_dyn.effects import MassDamping
from continuum_dyn.integrators.midpoint import momentum_passes
from continuum_dyn.passes.dynamics import LEDGER, Dynamics
from continuum_dyn.passes.motion_passes import MOTION as MOVING
from continuum_dyn.passes.observation import observe
from continuum_dyn.scenario.intervals import Interval
from continuum_dyn.scenario.profiles import Step
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.scenario.studies import MotionStudy, StepResponseStudy
from statics import Arm, Bending, Gravity, InputError, Outcome, Payload, Scene, equilibrium
from statics.judges.exact_rod import exact_rod
from statics.kernels.loading import kernel_key, load_interpreted
from statics.kernels.slots import SCALARS
from statics.passes.rest_passes import REST

PIECES = np.array([[0.0, 1.3, 0.0, 0.0, 0.0, 0.0], [0.0, 0.7, 0.0, 0.0, 0.0, 0.0]])
TENSION = PIECES[:, 1].copy()


def laden(scene: Scene, *payloads: Payload) -> Scene:
    return Scene(replace(scene.arm, payloads=payloads), scene.effects)


def laden_scene(disks: int) -> Scene:
    """Every effect, two payloads on the last disk, and one on the first if that is another."""
    heavy, light = Payload(disks, 0.01, 1e-6, (0.005, -0.003)), Payload(1, 0.003, 2e-7, (-0.002, 0.006))
    return laden(full_scene(disks), heavy, *[light][: disks - 1], replace(light, disk=disks))


def laden_span() -> Scene:
    """Two segments from disk to disk, and a payload."""
    return laden(spanned_scene(1), Payload(1, 0.01, 1e-6, (0.005, -0.003)))


class Kernel:
    """A scene's equations of motion under constant tensions."""

    def __init__(self, scene: Scene) -> None:
        self.dynamics, self.interval = Dynamics(scene), Interval(0.0, 1.0, PIECES[: scene.cables])

    def rate(self, y: np.ndarray) -> np.ndarray:
        """dy/dt."""
        return self.dynamics.rate(0.0, y, self.interval)

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """d(rate)/dy."""
        return self.dynamics.jacobian(0.0, y, self.interval)


@cache
def moving_kernel(scene: Scene) -> Kernel:
    return Kernel(scene)


def state(q: np.ndarray, u: np.ndarray) -> np.ndarray:
    return np.concatenate([q.ravel(), u.ravel(), [0.0, 0.0]])


# ---- the whole arm ----


@pytest.mark.parametrize(
    "scene",
    [laden_scene(1), laden_scene(2), pytest.param(laden_span(), marks=pytest.mark.slow)],
    ids=["1", "2", "span"],
)
def test_accelerations_and_energies_are_those_of_kanes_method_with_bodies_of_their_own(scene: Scene) -> None:
    arm, kernel, tension = whole_arm.whole_arm(scene), moving_kernel(scene), TENSION[: scene.cables]
    for seed in range(5):
        q, u = random_state(scene, seed, bend=0.7)
        found = kernel.rate(state(q, u))[q.size : 2 * q.size].reshape(q.shape)
        assert relative_error(found, whole_arm.accelerations(arm, q, u, tension)) < 2e-11
        ledger = np.empty((1, len(LEDGER)))
        poses = np.empty((2, 1, len(q), 3))
        motion, *tables = kernel.dynamics.motion
        observe(motion.passes, q[None], u[None], tension[None], *tables, *poses, ledger)
        mass, _ = whole_arm.mass_and_forcing(arm, q, u, tension)
        assert ledger[0, 0] == pytest.approx(u.T.ravel() @ mass @ u.T.ravel() / 2, rel=1e-13)
        assert ledger[0, 2] == pytest.approx(whole_arm.gravity_energy(arm, q), rel=1e-12)


@pytest.mark.parametrize("column", range(4), ids=["mass", "inertia", "offset along", "offset across"])
def test_kanes_method_tells_when_a_payloads_number_is_wrong_by_a_ten_thousandth(column: int) -> None:
    scene = laden_scene(2)
    arm, (q, u) = whole_arm.whole_arm(scene), random_state(scene, seed=4)
    wrong = replace(arm, payload=arm.payload * (1 + 1e-4 * (np.arange(4) == column)))
    found = moving_kernel(scene).rate(state(q, u))[q.size : 2 * q.size].reshape(q.shape)
    assert relative_error(found, whole_arm.accelerations(wrong, q, u, TENSION)) > 2e-10


def test_damping_by_mass_takes_power_from_payloads_as_from_disks() -> None:
    """Rayleigh's alpha times twice the kinetic energy."""
    plain = laden_scene(2)
    scene = Scene(plain.arm, (*(e for e in plain.effects if e.name != "material_damping"), MassDamping(7.0)))
    q, u = random_state(scene, seed=1)
    mass, _ = whole_arm.mass_and_forcing(whole_arm.whole_arm(scene), q, u, TENSION)
    expected = 7.0 * u.T.ravel() @ mass @ u.T.ravel()
    assert moving_kernel(scene).rate(state(q, u))[-1] == pytest.approx(expected, rel=1e-12)


def test_exact_jacobian_equals_differences_of_the_rate() -> None:
    scene = laden_scene(2)
    kernel, (q, u) = moving_kernel(scene), random_state(scene, seed=7)
    steps = [*[0.01, 2e-4] * 2, *[1.0, 0.1] * 2, 1.0, 1.0]
    expected = difference_matrix(kernel.rate, state(q, u), steps)
    size = np.abs(expected).max(axis=1, keepdims=True)
    np.testing.assert_allclose(kernel.jacobian(state(q, u)) / size, expected / size, atol=1e-8)


def test_residual_at_rest_is_the_gradient_of_the_energy_and_the_stiffness_its_hessian() -> None:
    scene = laden_scene(2)
    arm, passes = whole_arm.whole_arm(scene), Passes(scene.at_rest, REST)
    unit = np.array([1.0, arm.L0[0]])

    def residual(values: np.ndarray) -> np.ndarray:
        passes.pose(values.reshape(2, 2), TENSION)
        return passes.residual()

    for seed in range(5):
        q, _ = random_state(scene, seed)
        found = residual(q)
        expected = gradient(lambda q: whole_arm.potential_energy(arm, q, TENSION), q)
        assert relative_error(found, expected) < 1e-12
        step, _ = passes.solve(found)
        hessian = difference_matrix(lambda values: residual(values).ravel(), q.ravel(), [1e-2, 1e-5] * 2)
        expected = np.linalg.solve(hessian, -found.ravel()).reshape(q.shape)
        assert relative_error(step / unit, expected / unit) < 1e-7


def test_momenta_and_slopes_are_those_of_the_whole_arm() -> None:
    plain = laden_scene(2)
    scene = Scene(plain.arm, (effect for effect in plain.effects if effect.name != "material_damping"))
    arm, (kernel, *tables) = whole_arm.whole_arm(scene), Dynamics(scene).midpoint
    for seed in range(3):
        q, u = random_state(scene, seed)
        mass = whole_arm.mass_and_forcing(arm, q, u, TENSION)[0]
        by_q, p, slope = np.empty_like(q), np.empty_like(q), np.empty_like(q)
        chain, arm_tables = np.empty((len(q), kernel.widths["chain"])), (np.empty((0, 6)), *tables)
        scalars = np.empty(SCALARS)
        momentum_passes(kernel.passes, q, u, TENSION, arm_tables, chain, by_q, p, slope, scalars)
        potential = gradient(lambda q: whole_arm.potential_energy(arm, q, TENSION), q)
        assert relative_error(p, (mass @ u.T.ravel()).reshape(-1, arm.n).T) < 1e-13
        assert relative_error(slope, whole_arm.kinetic_slope(arm, q, u)) < 1e-12
        assert relative_error(by_q, potential) < 1e-12


# ---- closed forms ----


@pytest.mark.parametrize("gravity", [(0.0, -9.81), (9.81, 0.0), (-3.0, 2.0)])
def test_one_disk_bends_until_the_core_carries_its_payload(gravity: tuple[float, float]) -> None:
    """EJ phi / L = g x d/dphi of the mass moments, with x = L sin(phi) / phi, y = L (1 - cos(phi)) / phi."""
    payload = Payload(1, 1.0, 1e-6, (0.015, -0.012))
    arm = Arm.preset("rone2012", disks=1, payloads=(payload,))
    L, (d_x, d_y), (g_x, g_y) = 0.02, payload.offset, gravity

    def unbalanced(phi: float) -> float:
        x_by_phi = L * (phi * np.cos(phi) - np.sin(phi)) / phi**2
        y_by_phi = L * (phi * np.sin(phi) + np.cos(phi) - 1) / phi**2
        arm_x = x_by_phi - np.sin(phi) * d_x - np.cos(phi) * d_y
        arm_y = y_by_phi + np.cos(phi) * d_x - np.sin(phi) * d_y
        disk = 7.782e-4 * (g_x * x_by_phi + g_y * y_by_phi)
        return disk + payload.mass * (g_x * arm_x + g_y * arm_y) - 2.10e11 * 2.011e-14 / L * phi

    found = equilibrium(Scene(arm, (Bending(), Gravity(gravity))))
    side = np.sign(found.coordinates[0, 0])
    expected = brentq(unbalanced, side * 1e-3, side * 2.0, xtol=1e-15)
    assert abs(expected) > 0.05
    assert found.stable
    assert found.coordinates[0, 0] == pytest.approx(expected, rel=1e-10)


def test_payload_at_the_centre_is_a_heavier_disk() -> None:
    scene, mass, inertia = full_scene(2), 7.782e-4, 2.029e-8
    heavier = Scene(replace(scene.arm, disk_mass=3 * mass, disk_inertia=2 * inertia), scene.effects)
    carrying = laden(scene, *(Payload(disk, mass, inertia / 2) for disk in (1, 1, 2, 2)))
    y = state(*random_state(scene, seed=2))
    np.testing.assert_allclose(moving_kernel(carrying).rate(y), moving_kernel(heavier).rate(y), rtol=1e-10)


def test_payload_of_nothing_is_no_payload() -> None:
    scene = full_scene(2)
    y = state(*random_state(scene, seed=2))
    nothing = Payload(1, 0.0, offset=(0.1, 0.2))
    found = moving_kernel(laden(scene, nothing, nothing)).rate(y)
    np.testing.assert_allclose(found, moving_kernel(scene).rate(y), rtol=1e-11)


@pytest.mark.parametrize("weight", [1.0, 1e3, 1e6])
def test_arm_finds_its_rest_under_a_payload_of_many_disks(weight: float) -> None:
    payload = Payload(4, weight * 7.782e-4, offset=(0.01, 0.004))
    found = equilibrium(Scene(Arm.preset("rone2012", payloads=(payload,)), (Bending(), Gravity())))
    assert found.stable
    assert found.residual < 1e-10 * max(1.0, weight * 7.782e-4 * 9.81)


# ---- only what is asked ----


def test_arm_without_payloads_has_nothing_of_them_in_its_generated_sources() -> None:
    for scene, there in ((full_scene(2), False), (laden_scene(2), True)):
        assert ("payload" in load_interpreted(scene.structure, MOVING).text) == there
        assert ("payload" in load_interpreted(scene.at_rest.structure, REST).text) == there


def test_without_gravity_a_payload_has_no_weight_in_the_generated_source() -> None:
    scene = laden_scene(2)
    floating = Scene(scene.arm, (effect for effect in scene.effects if effect.name != "gravity"))
    assert "payload" not in REST.write(floating.at_rest.structure)
    assert "gravity_x" not in MOVING.write(floating.structure)


def test_numbers_of_payloads_compile_nothing_and_one_more_on_a_disk_does() -> None:
    one, other = (
        laden(rone2012(), Payload(disk, mass, 0.0, (mass, 0.0))) for disk, mass in ((1, 1.0), (4, 2.0))
    )
    two = laden(rone2012(), *one.arm.payloads, *one.arm.payloads)
    spread = laden(rone2012(), *one.arm.payloads, *other.arm.payloads)
    key = kernel_key(one.structure, REST)
    assert [kernel_key(scene.structure, REST) == key for scene in (other, spread, two)] == [
        True,
        True,
        False,
    ]


# ---- bad input ----


def test_payload_beyond_the_arm_is_refused() -> None:
    with pytest.raises(InputError, match=r"payload on disk 5: beyond the arm\. Allowed: disks 1 to 4"):
        Arm.preset("rone2012", payloads=(Payload(5, 0.1),))


@pytest.mark.parametrize(
    "wrong", [{"mass": -1.0}, {"inertia": -1.0}, {"mass": np.nan}, {"offset": (0.0, np.inf)}]
)
def test_payload_that_cannot_be_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="Input should be"):
        Payload(**({"disk": 1, "mass": 1.0} | wrong))


def test_exact_rod_refuses_payloads_by_name() -> None:
    with pytest.raises(InputError, match="has no payloads"):
        exact_rod(laden(rone2012(), Payload(4, 0.01)), 1.0)


# ---- motion ----


@pytest.mark.slow
def test_arm_with_a_payload_settles_where_the_statics_say_and_its_ledger_closes() -> None:
    scene = laden(moving(rone2012()), Payload(4, 2e-3, 1e-7, (0.006, 0.003)))
    gaps = []
    for rtol in (1e-6, 1e-8):
        asked = Solver("chain", rtol=rtol, atol=1e-3 * rtol)
        run = simulate(Scenario(scene, (Step(before=0.0, after=1.0),), StepResponseStudy(3.0), asked))
        assert run.outcome is Outcome.SETTLED
        assert run.static_gap is not None
        assert run.static_gap < 1e-6
        assert run.trajectory is not None
        gaps.append(np.abs(run.trajectory.ledger_gap).max() / run.trajectory.ledger["input_work"].max())
    assert np.all(np.array(gaps) < [1e-3, 1e-4])


@pytest.mark.slow
def test_midpoint_rule_keeps_the_energy_of_an_arm_with_a_payload() -> None:
    plain = rone2012()
    arm = replace(plain.arm, payloads=(Payload(4, 2e-3, 1e-7, (0.006, 0.003)),))
    effects = [effect for effect in plain.effects if effect.name != "extension"]
    scene = Scene(arm, (*effects, *MOTION[:2]))
    ranges = []
    for step in (4e-4, 1e-4):
        asked = Solver("midpoint", step=step)
        ledger = motion(
            Scenario(scene, (Step(before=1.0, after=0.0),), MotionStudy(4.0, samples=4001), asked)
        ).ledger
        energy = ledger["kinetic_energy"] + ledger["elastic_energy"] + ledger["gravity_energy"]
        parts = np.array_split(energy / np.ptp(ledger["kinetic_energy"]), 4)
        ranges.append([float(np.ptp(part)) for part in parts])
        assert ranges[-1][3] < 1.1 * ranges[-1][0]
    assert max(ranges[0]) < 2e-4
    assert ranges[0][0] / ranges[1][0] == pytest.approx(4.0**2, rel=0.3)
