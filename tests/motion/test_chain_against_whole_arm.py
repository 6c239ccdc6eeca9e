"""The chain's equations of motion are those of the whole arm by Kane's method, as sympy derives them."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import whole_arm
from passes_by_hand import Passes
from whole_arm import (
    bare_scene,
    difference_matrix,
    directional,
    full_scene,
    heavy_scene,
    random_state,
    relative_error,
    spanned_scene,
    stiff_scene,
    tapered_scene,
)

from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.passes.motion_passes import MOTION
from continuum_dyn.scenario.intervals import Interval
from statics.arm import Base, Cable, Payload
from statics.effects import DiskLoad, DiskLoads
from statics.equilibria import StaticSolver
from statics.kernels.loading import load, load_interpreted
from statics.passes.rest_passes import REST
from statics.scene import Scene

SEEDS = range(10)
TIME = 0.3
ROUNDING = 2e-12
"""Relative; 4e-13 is reached with extension, where axial forces of 1e5 N cancel, and 5e-14 without."""

SPANNED = pytest.param(spanned_scene, marks=pytest.mark.slow)
any_scene = pytest.mark.parametrize("scene_of", [full_scene, stiff_scene, bare_scene])


def pulling(scene: Scene) -> Interval:
    """Tensions that change with time, for as many cables as the scene has."""
    pieces = np.array([[0.1, 1.3, 2.0, 0.4, 50.0, 0.3], [0.0, 0.7, -1.0, 0.0, 0.0, 0.0]])
    return Interval(0.1, 1.0, pieces[: scene.cables])


def tension_at(scene: Scene) -> np.ndarray:
    """Tensions of ``pulling`` at ``TIME``, written out."""
    upper, lower = 1.3 + 2.0 * (TIME - 0.1) + 0.4 * np.sin(50.0 * (TIME - 0.1) + 0.3), 0.7 - 1.0 * TIME
    return np.array([upper, lower])[: scene.cables]


def chain_accelerations(scene: Scene, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    dynamics = Dynamics(scene)
    rate = dynamics.rate(TIME, dynamics.state(q, u), pulling(scene))
    return rate[dynamics.size : 2 * dynamics.size].reshape(q.shape)


def kane_accelerations(scene: Scene, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    return whole_arm.accelerations(whole_arm.whole_arm(scene), q, u, tension_at(scene))


# ---- the whole arm ----


def with_everything(disks: int, subsegments: int) -> Scene:
    """All that the whole arm knows: its base is free, a payload is on its last disk, a load follows it."""
    scene = tapered_scene(disks, subsegments)
    payloads = (Payload(disks, 0.01, 1e-6, (0.005, -0.003)),)
    loads = DiskLoads((DiskLoad(1, (-0.3, 0.5), -0.01), DiskLoad(disks, (0.4, -0.7), 0.02, follower=True)))
    arm = replace(scene.arm, payloads=payloads, base=Base(0.03, -0.02, 0.7))
    return Scene(arm, (*scene.effects, loads))


@pytest.mark.parametrize(
    "scene",
    [
        full_scene(2),
        *(pytest.param(scene, marks=pytest.mark.slow) for scene in (stiff_scene(3), tapered_scene(3))),
        *(pytest.param(with_everything(*size), marks=pytest.mark.slow) for size in ((1, 2), (2, 1))),
        pytest.param(spanned_scene(2, 2), marks=pytest.mark.slow),
    ],
)
def test_equations_by_numbers_are_those_that_sympys_kanes_method_derives(scene: Scene) -> None:
    arm = whole_arm.whole_arm(scene)
    if arm.base is not None:
        arm = replace(arm, base=np.array([arm.base[0], (0.4, -0.6, 5.0)]))
    tension = tension_at(scene)
    for seed in range(3):
        q, u = random_state(scene, seed)
        mass, forcing = whole_arm.free_mass_and_forcing(arm, q, u, tension)
        derived_mass, derived_forcing = whole_arm.derived_mass_and_forcing(arm, q, u, tension)
        np.testing.assert_allclose(mass, derived_mass, rtol=1e-12, atol=1e-13 * np.abs(mass).max())
        size = np.abs(derived_forcing)[: q.size].reshape(-1, arm.n).max(axis=1).repeat(arm.n)
        np.testing.assert_allclose(forcing[: q.size] / size, derived_forcing[: q.size] / size, 0, 1e-12)
        np.testing.assert_allclose(forcing[q.size :], derived_forcing[q.size :], rtol=1e-11)


# ---- accelerations ----


@any_scene
@pytest.mark.parametrize("disks", [1, 2, 3])
def test_accelerations_equal_kanes_method_on_the_whole_arm(
    scene_of: Callable[[int], Scene], disks: int
) -> None:
    scene = scene_of(disks)
    for seed in SEEDS:
        q, u = random_state(scene, seed)
        assert relative_error(chain_accelerations(scene, q, u), kane_accelerations(scene, q, u)) < ROUNDING


@pytest.mark.slow
def test_accelerations_equal_kanes_method_where_cables_pass_nodes_between_disks() -> None:
    for disks, subsegments in ((1, 3), (2, 2)):
        scene = spanned_scene(disks, subsegments)
        for seed in SEEDS:
            q, u = random_state(scene, seed, bend=0.7)
            error = relative_error(chain_accelerations(scene, q, u), kane_accelerations(scene, q, u))
            assert error < 10 * ROUNDING


@pytest.mark.slow
def test_accelerations_equal_kanes_method_for_a_heavy_core() -> None:
    for disks in (1, 2, 3):
        scene = heavy_scene(disks)
        for seed in SEEDS:
            q, u = random_state(scene, seed)
            assert (
                relative_error(chain_accelerations(scene, q, u), kane_accelerations(scene, q, u)) < ROUNDING
            )


@pytest.mark.slow
@pytest.mark.parametrize(("disks", "subsegments"), [(3, 1), (2, 2)])
def test_accelerations_equal_kanes_method_for_arms_that_taper(disks: int, subsegments: int) -> None:
    scene = tapered_scene(disks, subsegments)
    for seed in SEEDS:
        q, u = random_state(scene, seed, bend=0.7)
        error = relative_error(chain_accelerations(scene, q, u), kane_accelerations(scene, q, u))
        assert error < 10 * ROUNDING


@pytest.mark.slow
def test_accelerations_equal_kanes_method_for_the_four_disks_of_table_1() -> None:
    scene = full_scene(4)
    q, u = random_state(scene, seed=1)
    assert relative_error(chain_accelerations(scene, q, u), kane_accelerations(scene, q, u)) < ROUNDING


def test_accelerations_equal_kanes_method_for_segments_that_almost_close_to_circles() -> None:
    """Half angles beyond 2, where the sigma functions change from their series to the recurrence."""
    scene = full_scene(3, cables=(Cable("upper", 0.001), Cable("lower", -0.002, anchor=2)))
    for seed in SEEDS:
        q, u = random_state(scene, seed, bend=5.5)
        assert relative_error(chain_accelerations(scene, q, u), kane_accelerations(scene, q, u)) < ROUNDING


@pytest.mark.parametrize("bends", [(0.0, 0.0), (0.0, 1.2), (-1e-9, 0.0), (1e-3, -1e-5)])
def test_accelerations_equal_kanes_method_of_many_digits_through_straight(bends: tuple[float, float]) -> None:
    scene = full_scene(2)
    q, u = random_state(scene, seed=3)
    q[:, 0] = bends
    expected = whole_arm.precise_accelerations(whole_arm.whole_arm(scene), q, u, tension_at(scene))
    assert relative_error(chain_accelerations(scene, q, u), expected) < ROUNDING


@pytest.mark.parametrize(
    "number", ["L0", "EJ", "EA", "k0", "m_c", "m", "I_xx", "g", "relaxation", "r_h", "force", "moment"]
)
def test_kanes_method_tells_when_one_number_is_wrong_by_a_ten_thousandth(number: str) -> None:
    scene = heavy_scene(2)
    arm = whole_arm.whole_arm(scene)
    wrong = replace(arm, **{number: 1.0001 * getattr(arm, number)})
    q, u = random_state(scene, seed=4)
    expected = whole_arm.accelerations(wrong, q, u, tension_at(scene))
    assert relative_error(chain_accelerations(scene, q, u), expected) > 10 * ROUNDING


# ---- the power ledger ----


def test_powers_are_those_of_the_whole_arm() -> None:
    """Power in: tension times shortening, dead loads times velocity; power out: Kelvin-Voigt."""
    scene = full_scene(3)
    arm, dynamics, (q, u) = whole_arm.whole_arm(scene), Dynamics(scene), random_state(scene, seed=5)
    power_in, dissipated = dynamics.rate(TIME, dynamics.state(q, u), pulling(scene))[-2:]

    def load_energy(q: np.ndarray) -> complex:
        return whole_arm.cable_energy(arm, q, tension_at(scene)) + whole_arm.load_energy(arm, q)

    viscosity = arm.relaxation * np.column_stack([arm.EJ / arm.L0, arm.EA / arm.L0])
    assert power_in == pytest.approx(-directional(load_energy, q, u), rel=1e-12)
    assert dissipated == pytest.approx(np.sum(viscosity * u**2), rel=1e-14)


@any_scene
def test_kinetic_energy_is_that_of_kanes_mass_matrix(scene_of: Callable[[int], Scene]) -> None:
    scene = scene_of(3)
    dynamics, (q, u) = Dynamics(scene), random_state(scene, seed=6)
    seen = dynamics.observe(dynamics.state(q, u)[None, :], tension_at(scene)[None, :])
    mass, _ = whole_arm.mass_and_forcing(whole_arm.whole_arm(scene), q, u, tension_at(scene))
    expected = u.T.ravel() @ mass @ u.T.ravel() / 2
    assert seen.ledger["kinetic_energy"][0] == pytest.approx(expected, rel=1e-13)


# ---- the Jacobian ----


def kinds_of(dynamics: Dynamics) -> np.ndarray:
    """Kind of each entry of the state: bends, elongations, their rates, input work, dissipated energy."""
    q = np.tile(np.arange(dynamics.dofs), dynamics.scene.arm.segments)
    return np.concatenate([q, q + dynamics.dofs, [2 * dynamics.dofs, 2 * dynamics.dofs + 1]])


def block_error(actual: np.ndarray, expected: np.ndarray, kinds: np.ndarray) -> float:
    """Largest error in the derivatives of one kind by another, over their largest; zeros must be zero."""
    worst = 0.0
    for row in np.unique(kinds):
        for column in np.unique(kinds):
            block = np.ix_(kinds == row, kinds == column)
            error, size = np.abs(actual[block] - expected[block]).max(), np.abs(expected[block]).max()
            worst = max(worst, error / size if size > 0 else error)
    return worst


@pytest.mark.parametrize("scene_of", [full_scene, stiff_scene, heavy_scene, SPANNED])
def test_exact_jacobian_equals_differences_of_the_rate(scene_of: Callable[[int], Scene]) -> None:
    scene = scene_of(4)
    dynamics = Dynamics(scene)
    q, u = random_state(scene, seed=7)
    y, interval = dynamics.state(q, u), pulling(scene)
    of_q, of_u = [0.01, 0.01 * scene.arm.rest_length], [1.0, 0.1]
    steps = np.array([*of_q[: dynamics.dofs], *of_u[: dynamics.dofs], 1.0, 1.0])
    expected = difference_matrix(lambda y: dynamics.rate(TIME, y, interval), y, steps[kinds_of(dynamics)])
    assert block_error(dynamics.jacobian(TIME, y, interval), expected, kinds_of(dynamics)) < 1e-9


# ---- compiled code, interpreted code, and the static kernel ----


def test_compiled_motion_equals_interpreted_motion() -> None:
    scene = full_scene(3)
    dynamics, interpreted = Dynamics(scene), Dynamics(scene, load_interpreted)
    arguments = TIME, dynamics.state(*random_state(scene, seed=8)), pulling(scene)
    np.testing.assert_allclose(dynamics.rate(*arguments), interpreted.rate(*arguments), rtol=1e-11)
    jacobians = dynamics.jacobian(*arguments), interpreted.jacobian(*arguments)
    assert block_error(*jacobians, kinds_of(dynamics)) < ROUNDING


def test_compiled_equilibrium_equals_interpreted_equilibrium() -> None:
    scene = full_scene(4)
    compiled, interpreted = (
        StaticSolver(scene, loader).solve(tension_at(scene)) for loader in (load, load_interpreted)
    )
    assert compiled.outcome == interpreted.outcome
    assert compiled.iterations == interpreted.iterations
    assert relative_error(compiled.coordinates, interpreted.coordinates) < 1e-13


@pytest.mark.parametrize("scene_of", [full_scene, stiff_scene, SPANNED])
def test_virtual_power_at_rest_equals_virtual_work(scene_of: Callable[[int], Scene]) -> None:
    scene = scene_of(5)
    motion, rest, tension = Passes(scene, MOTION), Passes(scene.at_rest, REST), tension_at(scene)
    q, _ = random_state(scene, seed=9)
    motion.motion(q, np.zeros_like(q), np.zeros_like(q), tension)
    rest.pose(q, tension)
    assert relative_error(motion.residual(), rest.residual()) < 1e-14
