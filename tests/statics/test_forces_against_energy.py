"""The chain's generalized forces and stiffness are derivatives of the whole arm's energy."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
import pytest
import sympy as sp
import whole_arm
from passes_by_hand import Passes
from whole_arm import (
    WholeArm,
    difference_matrix,
    full_scene,
    gradient,
    heavy_scene,
    random_state,
    relative_error,
    stiff_scene,
)

from statics.arm import Cable
from statics.derivation.segment import SegmentSymbols
from statics.derivation.sigma import Sigma
from statics.derivation.trace import symbol
from statics.effects.cables import disk_loads
from statics.equilibria import equilibrium
from statics.passes.rest_passes import REST
from statics.scene import Scene

SEEDS = range(10)
SOFT = 2.1e10, 2.1e9
"""Young's moduli of cores so soft that random states have directions of negative stiffness, Pa."""

three_disks_or_five = pytest.mark.parametrize("disks", [3, pytest.param(5, marks=pytest.mark.slow)])
with_mass_or_stiff = pytest.mark.parametrize(
    "scene_of", [pytest.param(full_scene, marks=pytest.mark.slow), stiff_scene, heavy_scene]
)
any_core = pytest.mark.parametrize("scene_of", [full_scene, stiff_scene, heavy_scene])


def tension_of(scene: Scene) -> np.ndarray:
    return np.array([1.3, 0.7])[: scene.cables]


@dataclass(frozen=True)
class Statics:
    """What the static kernel says of one state.

    ``newton_step`` comes from pivots made positive, ``flipped_pivots`` of which were not;
    ``negative_pivots`` counts them where they keep their signs.
    """

    potential: float
    potential_scale: float
    residual: np.ndarray
    newton_step: np.ndarray
    flipped_pivots: int
    negative_pivots: int


def chain_statics(scene: Scene, q: np.ndarray, tension: np.ndarray) -> Statics:
    passes = Passes(scene.at_rest, REST)
    seen = passes.pose(q, tension)
    residual = passes.residual()
    step, flipped = passes.solve(residual)
    _, kept = passes.solve(residual, keep_sign=1.0)
    counts = (int(counted["negative_pivots"]) for counted in (flipped, kept))
    return Statics(seen["potential"], seen["potential_scale"], residual, step, *counts)


def energy_gradient(arm: WholeArm, q: np.ndarray, tension: np.ndarray) -> np.ndarray:
    return gradient(lambda q: whole_arm.potential_energy(arm, q, tension), q)


def energy_hessian(arm: WholeArm, q: np.ndarray, tension: np.ndarray) -> np.ndarray:
    """Shape (q.size, q.size), elongations measured in L0 so that rows compare, J."""
    unit = np.broadcast_to([1.0, arm.L0[0]][: q.shape[1]], q.shape).ravel()

    def scaled_gradient(z: np.ndarray) -> np.ndarray:
        return unit * energy_gradient(arm, (z * unit).reshape(q.shape), tension).ravel()

    return difference_matrix(scaled_gradient, q.ravel() / unit, np.full(q.size, 0.01))


# ---- energy and forces ----


@any_core
@pytest.mark.parametrize("disks", [1, 2, 3, 20])
def test_residual_equals_the_gradient_of_the_energy(scene_of: Callable[[int], Scene], disks: int) -> None:
    scene = scene_of(disks)
    arm, tension = whole_arm.whole_arm(scene), tension_of(scene)
    for seed in SEEDS:
        q, _ = random_state(scene, seed)
        found, energy = chain_statics(scene, q, tension), whole_arm.potential_energy(arm, q, tension)
        assert relative_error(found.residual, energy_gradient(arm, q, tension)) < 1e-12
        assert abs(found.potential - energy) < 1e-14 * found.potential_scale


def test_residual_equals_the_gradient_of_the_energy_for_segments_that_almost_close_to_circles() -> None:
    """Half angles beyond 2, where the sigma functions change from their series to the recurrence."""
    scene = full_scene(3, cables=(Cable("upper", 0.001), Cable("lower", -0.002, anchor=2)))
    arm, tension = whole_arm.whole_arm(scene), tension_of(scene)
    for seed in SEEDS:
        q, _ = random_state(scene, seed, bend=5.5)
        residual = chain_statics(scene, q, tension).residual
        assert relative_error(residual, energy_gradient(arm, q, tension)) < 1e-12


@pytest.mark.parametrize("number", ["L0", "EJ", "EA", "k0", "m_c", "m", "g", "r_h", "force", "moment"])
def test_the_energy_tells_when_one_number_is_wrong_by_a_millionth(number: str) -> None:
    scene = heavy_scene(3)
    arm, tension = whole_arm.whole_arm(scene), tension_of(scene)
    wrong = replace(arm, **{number: 1.000001 * getattr(arm, number)})
    q, _ = random_state(scene, seed=1)
    residual = chain_statics(scene, q, tension).residual
    assert relative_error(residual, energy_gradient(wrong, q, tension)) > 1e-11


def test_paper_loads_on_disks_give_the_cables_generalized_force() -> None:
    """Eq. 22-25 through the whole arm's Jacobian; a core of almost nothing leaves the cables alone to act."""
    scene = full_scene(5, youngs_modulus=1.0)
    arm, tension = whole_arm.whole_arm(scene), tension_of(scene)
    for seed in SEEDS:
        q, _ = random_state(scene, seed)
        force, moment = disk_loads(scene.arm, tension, *whole_arm.poses(arm, q))
        by_q = gradient(lambda q: np.array(whole_arm.poses(arm, q)), q)
        expected = by_q[:, :, 0] @ force[:, 0] + by_q[:, :, 1] @ force[:, 1] + by_q[:, :, 2] @ moment
        slack = chain_statics(scene, q, np.zeros(2)).residual
        assert relative_error(slack - chain_statics(scene, q, tension).residual, expected) < 1e-12


# ---- stiffness ----


@with_mass_or_stiff
@three_disks_or_five
def test_newton_step_equals_the_dense_solution(scene_of: Callable[[int], Scene], disks: int) -> None:
    scene = scene_of(disks)
    arm, tension = whole_arm.whole_arm(scene), tension_of(scene)
    unit = np.array([1.0, arm.L0[0]])[: len(scene.coordinates)]
    for seed in SEEDS:
        q, _ = random_state(scene, seed)
        found = chain_statics(scene, q, tension)
        dense = np.linalg.solve(energy_hessian(arm, q, tension), -(found.residual * unit).ravel())
        assert relative_error(found.newton_step, dense.reshape(q.shape) * unit) < 1e-11


def soft_states(scene_of: Callable[..., Scene], disks: int) -> Iterator[tuple[Statics, int]]:
    """What the chain says of random states, and the number of negative eigenvalues of the dense Hessian."""
    for youngs_modulus, seed in product(SOFT, SEEDS):
        scene = scene_of(disks, youngs_modulus=youngs_modulus)
        q, _ = random_state(scene, seed)
        hessian = energy_hessian(whole_arm.whole_arm(scene), q, tension_of(scene))
        eigenvalues = np.linalg.eigvalsh((hessian + hessian.T) / 2)
        yield chain_statics(scene, q, tension_of(scene)), int(np.sum(eigenvalues < 0))


@with_mass_or_stiff
@three_disks_or_five
def test_negative_pivots_count_the_negative_eigenvalues_of_the_stiffness(
    scene_of: Callable[..., Scene], disks: int
) -> None:
    found = list(soft_states(scene_of, disks))
    assert len({negative for _, negative in found}) > min(3, disks - 1)
    for statics, negative in found:
        assert statics.negative_pivots == negative
        assert (statics.flipped_pivots == 0) == (negative == 0)


@any_core
def test_equilibrium_is_a_minimum_of_the_energy(scene_of: Callable[[int], Scene]) -> None:
    scene = scene_of(5)
    arm, tension = whole_arm.whole_arm(scene), tension_of(scene)
    found = equilibrium(scene, tension)
    q = found.coordinates
    assert found.stable
    assert np.abs(energy_gradient(arm, q, tension)).max() < 1e-12
    assert np.linalg.eigvalsh(energy_hessian(arm, q, tension)).min() > 0
    assert found.elastic_energy == pytest.approx(whole_arm.elastic_energy(arm, q), rel=1e-13)
    assert found.gravity_energy == pytest.approx(whole_arm.gravity_energy(arm, q), rel=1e-13)
    disks = found.disk_x, found.disk_y, found.disk_theta
    np.testing.assert_allclose(disks, whole_arm.poses(arm, q), rtol=1e-13)


# ---- one segment ----


def in_closed_form(n: Any, x: Any) -> Any:
    """sigma_n from sine and cosine by the recurrence, for x != 0. DLMF 10.49."""
    if n <= 0:
        return sp.cos(x) if n == -1 else sp.sin(x) / x
    return ((2 * n - 1) * in_closed_form(n - 1, x) - in_closed_form(n - 2, x)) / x**2


def segment_jacobian(k: float, L: float, L0: float) -> np.ndarray:
    """d(x, y, theta)/d(k, L) of the program's segment, by the chain rule from phi = k L and e = L - L0."""
    segment = SegmentSymbols(("bend_angle", "elongation"), ())
    pose = sp.Matrix([*segment.displacement, segment.bend_angle])
    by_q = pose.jacobian(segment.coordinates).replace(Sigma, in_closed_form)
    values = {segment.bend_angle: k * L, segment.elongation: L - L0, symbol("rest_length"): L0}
    by_phi, by_e = np.array(by_q.subs(values).evalf(20), dtype=float).T
    return np.column_stack([L * by_phi, k * by_phi + by_e])


@pytest.mark.parametrize("seed", SEEDS)
def test_jacobian_of_a_segment_is_that_of_rone_2012_eq_14_and_18(seed: int) -> None:
    random = np.random.default_rng(seed)
    k, L = random.choice([-1, 1]) * random.uniform(5, 75), random.uniform(0.018, 0.022)
    phi = k * L
    printed = [
        [(phi * np.cos(phi) - np.sin(phi)) / k**2, np.cos(phi)],
        [(phi * np.sin(phi) + np.cos(phi) - 1) / k**2, np.sin(phi)],
        [L, k],
    ]
    np.testing.assert_allclose(segment_jacobian(k, L, L0=0.02), printed, rtol=1e-12)
