"""Spans much stiffer or softer than their neighbours: equilibria are those of the whole arm, or refused."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import rone2012

from statics import Equilibrium, Outcome, PerDisk, Scene, StaticSolver
from statics.passes import search

ONE_NEWTON = np.array([1.0])


def with_span(number: int, factor: float) -> Scene:
    """The paper's arm with one span of so many times the stiffness."""
    scene = rone2012()
    of_spans = np.full(scene.arm.disks, scene.arm.youngs_modulus)
    of_spans[number] *= factor
    return replace(scene, arm=replace(scene.arm, each=PerDisk(youngs_modulus=tuple(of_spans.tolist()))))


def energy(scene: Scene, q: np.ndarray, tension: float) -> complex:
    """Potential energy (J) of chained circular arcs with a cable, for complex q, shape (disks, 2)."""
    arm, (phi, stretch) = scene.arm, q.T
    length, modulus = arm.disk_spacing + stretch, arm.per_disk("youngs_modulus")
    near = np.concatenate([[0.0], np.cumsum(phi)])[:-1]
    half = np.where(abs(phi) < 1e-8, 1e-8, phi / 2)
    chord = length * np.where(abs(phi) < 1e-8, 1 - phi**2 / 24, np.sin(half) / half)
    height = np.cumsum(chord * np.sin(near + phi / 2))
    cable = np.sum(chord - 2 * arm.cables[0].holes(arm.disks)[1:] * np.sin(phi / 2))
    elastic = np.sum(modulus * (arm.second_moment * phi**2 + arm.area * stretch**2)) / (2 * arm.disk_spacing)
    return elastic + 9.81 * np.sum(arm.per_disk("disk_mass") * height) + tension * cable


def gradient(scene: Scene, q: np.ndarray, tension: float) -> np.ndarray:
    """By complex steps, shape (disks * 2,)."""
    steps = 1e-30j * np.eye(q.size).reshape(q.size, *q.shape)
    return np.array([energy(scene, q + step, tension).imag for step in steps]) / 1e-30


def unstable_directions(scene: Scene, q: np.ndarray, tension: float) -> int:
    """Negative eigenvalues of the Hessian by differences, rows and columns scaled to a diagonal of ones."""
    size = np.tile([1e-6, 1e-6 * scene.arm.disk_spacing], len(q))
    rows = []
    for k, step in enumerate(size):
        change = np.zeros(q.size)
        change[k] = step
        ahead, behind = (gradient(scene, q + sign * change.reshape(q.shape), tension) for sign in (1, -1))
        rows.append((ahead - behind) / (2 * step))
    dense = 0.5 * (np.array(rows) + np.array(rows).T)
    scale = np.sqrt(np.abs(np.diag(dense)))
    return int(np.sum(np.linalg.eigvalsh(dense / np.outer(scale, scale)) < 0.0))


def holds(scene: Scene, found: Equilibrium, tension: float) -> bool:
    """Whether the whole arm's own forces balance, within 1e-9 of the cable's and the weight's torque."""
    unbalanced = gradient(scene, found.coordinates, tension) * np.tile([1.0, 0.02], len(found.bend_angle))
    return bool(np.abs(unbalanced).max() < 1e-9 * (0.008 * tension + 1e-3))


@pytest.mark.parametrize("factor", [1e11, 1e16, 1e30])
def test_rigid_last_span_turns_as_the_softer_ones_bend(factor: float) -> None:
    """Tip at 1 N of an independent model by Newton's method with dense matrices; mm."""
    found = StaticSolver(with_span(3, factor)).solve(ONE_NEWTON)
    assert found.stable
    np.testing.assert_allclose(np.array(found.tip[:2]) * 1e3, [79.7876, 5.1067], atol=1e-4)


@pytest.mark.parametrize("factor", [1e-30, 1e-12, 1e-6, 1e-3, 1e3, 1e9, 1e14, 1e20, 1e30])
@pytest.mark.parametrize("span", range(4))
@pytest.mark.parametrize("tension", [0.0, 1.0])
def test_span_of_any_stiffness_is_in_balance_or_refused(span: int, factor: float, tension: float) -> None:
    scene = with_span(span, factor)
    found = StaticSolver(scene).solve(np.array([tension]))
    assert found.found or factor < 1e-2
    if found.found:
        assert holds(scene, found, tension)
        assert found.unstable_directions == unstable_directions(scene, found.coordinates, tension)
        assert found.stable == (found.unstable_directions == 0)


def test_what_is_not_in_balance_is_no_equilibrium_whatever_a_search_says() -> None:
    solver = StaticSolver(with_span(3, 1e16))
    rest = solver.solve(ONE_NEWTON)
    for span in range(4):
        off = rest.coordinates
        off[span, 0] += 1e-6 if span < 3 else 1e-22
        assert solver.examine(off, ONE_NEWTON, search.STABLE).outcome is Outcome.NO_EQUILIBRIUM
    assert solver.examine(rest.coordinates, ONE_NEWTON, search.STABLE).stable
