"""The core's own mass, spread along each segment: its quadrature, its weight, its absence."""

from dataclasses import replace

import numpy as np
import pytest
import whole_arm
from conftest import moving, rone2012
from whole_arm import WholeArm, directional, heavy_scene, random_state

from continuum_dyn.effects import Inertia
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.passes.motion_passes import LINEARIZED, MIDPOINT, MOTION
from continuum_dyn.scenario.intervals import Interval
from statics import Arm, Bending, Gravity, Payload, Scene, equilibrium
from statics.core_mass import AT_END, AT_POINT, FRACTIONS
from statics.effects import Effect
from statics.judges.exact_rod import exact_rod
from statics.kernels.loading import Family, kernel_key, load_interpreted
from statics.passes.rest_passes import REST

FAMILIES = (LINEARIZED, MOTION, MIDPOINT, REST)


def with_core(scene: Scene, density: float = 7850.0) -> Scene:
    return Scene(replace(scene.arm, core_density=density), scene.effects)


def bare(segments: int, weight: float, *effects: Effect) -> Scene:
    """An upright-clamped cantilever, E J = 1 N m^2, 1 m and ``weight`` (N) in all, its disks of 1e-14 kg."""
    arm = Arm(segments, 1 / segments, youngs_modulus=1.0, area=1.0, second_moment=1.0, disk_mass=1e-14)
    return Scene(replace(arm, core_density=weight), (Bending(), Gravity((0.0, -1.0)), *effects))


# ---- only where it is asked for ----


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)
def test_core_without_density_is_in_no_line_of_the_generated_source(family: Family) -> None:
    scene = moving(rone2012(), damping=family is not MIDPOINT)
    scene = scene.at_rest if family is REST else scene
    assert "core_" not in load_interpreted(scene.structure, family).text
    assert "core_point_mass" in family.write(with_core(scene).structure)


def test_core_with_density_is_in_no_line_where_nothing_acts_on_masses() -> None:
    weightless = with_core(rone2012()).without("gravity")
    assert "core_" not in load_interpreted(weightless.structure, REST).text
    assert kernel_key(weightless.structure, REST) == kernel_key(rone2012().without("gravity").structure, REST)


# ---- the quadrature ----


@pytest.mark.parametrize("power", range(7))
def test_quadrature_is_exact_to_the_fifth_power_of_the_way_along(power: int) -> None:
    ends = AT_END * (0.0**power + 1.0)
    found = ends + AT_POINT * sum(fraction**power for fraction in FRACTIONS)
    assert (abs(found - 1 / (power + 1)) < 1e-15) == (power <= 5)


def integrals(arm: WholeArm, q: np.ndarray, u: np.ndarray) -> tuple[float, float]:
    """Kinetic energy and gravity energy of the core alone, by Gauss-Legendre's 30 points on each arc, J."""
    nodes, weights = np.polynomial.legendre.leggauss(30)
    kinetic = potential = 0.0
    for node, weight in zip((1 + nodes) / 2, weights / 2, strict=True):
        v_x, v_y = directional(lambda q, s=node: np.array(whole_arm.poses_along(arm, q, s)), q, u)
        x, y = whole_arm.poses_along(arm, q, node)
        kinetic += weight * arm.m_c @ (v_x**2 + v_y**2) / 2
        potential -= weight * arm.m_c @ (arm.g[0] * x + arm.g[1] * y)
    return kinetic, potential


def energies(scene: Scene, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Kinetic energy and gravity energy of the scene, J, by its generated text."""
    dynamics = Dynamics(scene)
    seen = dynamics.observe(dynamics.state(q, u)[None], np.zeros((1, len(scene.inputs))))
    return np.array([seen.ledger["kinetic_energy"][0], seen.ledger["gravity_energy"][0]])


@pytest.mark.parametrize(("bend", "errors"), [(0.1, (4e-7, 4e-12)), (1.0, (4e-5, 4e-7)), (3.0, (1e-3, 1e-5))])
def test_energies_of_the_core_are_the_integrals_along_its_arcs(
    bend: float, errors: tuple[float, float]
) -> None:
    """Two segments, the second carried by the first; the quadrature's relative errors, motion and weight."""
    scene = heavy_scene(2)
    arm = whole_arm.whole_arm(scene)
    without = Scene(replace(scene.arm, core_density=None), scene.effects)
    for seed in range(5):
        q, u = random_state(scene, seed)
        q[:, 0] = bend * np.sign(q[:, 0])
        found = energies(scene, q, u) - energies(without, q, u)
        expected = np.array(integrals(arm, q, u))
        scale = np.array([expected[0], np.hypot(*arm.g) * arm.m_c.sum() * arm.L0.sum()])
        assert (np.abs(found - expected) / scale < errors).all()


def test_mass_of_the_arm_is_that_of_disks_core_and_payloads() -> None:
    arm = Arm.preset("rone2012", core_density=7850.0, subsegments=8, payloads=(Payload(4, 0.01),))
    core = 7850.0 * 5.027e-7 * 0.08
    assert arm.total_mass == pytest.approx(4 * 7.782e-4 + core + 0.01)
    on_nodes = arm.node_columns()["node_mass"].sum()
    between = 2 * arm.segment_columns()["core_point_mass"].sum()
    at_base = AT_END * core / 32
    assert on_nodes + between + at_base == pytest.approx(4 * 7.782e-4 + core)


# ---- its weight ----


@pytest.mark.slow
def test_cantilever_sags_under_its_own_weight_by_the_beams_formula() -> None:
    """Q L^4 / (8 E J) and an end slope of q L^3 / (6 E J) (Timoshenko 1955, art. 21), for a small load.

    Arcs reach the slope exactly and leave 1/24 of q L^4 / E J over the number of segments squared.
    """
    weight = 1e-4
    for segments in (1, 4, 16):
        _, y, theta = equilibrium(bare(segments, weight)).tip
        assert theta == pytest.approx(-weight / 6, rel=1e-7)
        assert y == pytest.approx(-weight / 8 + weight / 24 / segments**2, rel=1e-7)


@pytest.mark.parametrize("weight", [1.0, 10.0, 40.0])
def test_cantilever_under_its_own_weight_tends_to_the_exact_rod_with_second_order(weight: float) -> None:
    rod = np.array(exact_rod(bare(1, weight)).tip)
    apart = [np.hypot(*(np.array(equilibrium(bare(n, weight)).tip) - rod)[:2]) for n in (16, 32, 64)]
    np.testing.assert_allclose(np.log2(np.divide(apart[:-1], apart[1:])), 2.0, atol=0.05)


def test_fall_of_a_loose_core_begins_like_that_of_a_rod_on_a_hinge() -> None:
    """One segment without stiffness, straight and level: a point moves by s^2 L dphi / 2.

    Virtual power: rho (L^2 / 4) phi'' integral s^4 = rho g (L / 2) integral s^2, so phi'' L = (10 / 3) g.
    """
    scene = Scene(bare(1, 2.0).arm, (Gravity((0.0, -9.81)), Inertia()))
    dynamics = Dynamics(scene)
    start = dynamics.state(np.zeros((1, 1)))
    found = dynamics.rate(0.0, start, Interval(0.0, 1.0, np.zeros((0, 6))))[1]
    assert found == pytest.approx(-10 / 3 * 9.81, rel=1e-12)
