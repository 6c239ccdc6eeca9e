"""Soft arms from straight: the search ends in a stable equilibrium or at a named limit, never on a saddle."""

import numpy as np
import pytest
from conftest import rone2012

from statics import Arm, Bending, Equilibrium, Gravity, Outcome, PerDisk, Scene, StaticSolver
from statics.kernels.loading import load, load_interpreted
from statics.passes import search

SEED = 2012
SIZES = (1, 2, 3, 4, 8, 16, 32, 64, 128, 256, 512, 1024)
SOFTNESSES = 10.0 ** -np.arange(7)
DIRECTIONS = {
    "level": (0.0, -9.81),
    "hanging": (9.81, 0.0),
    "upright": (-9.81, 0.0),
    "nearly upright": (-9.81, 1e-12),
    "aslant": (-6.0, -8.0),
}
AT_MOST = {"level": 30, "hanging": 2, "upright": 60, "nearly upright": 60, "aslant": 60}
"""Iterations; measured 28, 2, 41, 20, 35."""


def assert_not_fooled(rest: Equilibrium, most: int = 200) -> None:
    assert rest.outcome in (Outcome.COMPLETED, Outcome.GEOMETRY_LIMIT)
    assert rest.iterations <= most
    assert rest.found == (rest.outcome is Outcome.COMPLETED)
    if rest.found:
        assert rest.unstable_directions == 0
        assert rest.residual < 1e-10  # N, N m


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_from_table_1_to_a_millionth_of_its_stiffness_and_from_1_to_1024_segments(direction: str) -> None:
    for disks in SIZES:
        for stiffness in SOFTNESSES:
            scene = rone2012(disks=disks, stiffness=stiffness, gravity=DIRECTIONS[direction])
            assert_not_fooled(StaticSolver(scene).solve(np.array([0.0])), AT_MOST[direction])


def random_scene(random: np.random.Generator) -> tuple[Scene, float]:
    """Any size, softness, direction of gravity, and in two of three a tension up to 100 N."""
    disks, stiffness = int(1024.0 ** random.random()), 10.0 ** random.uniform(-6.0, 0.0)
    angle, pulls = random.uniform(0.0, 2 * np.pi), random.random() < 2 / 3
    gravity = (9.81 * np.cos(angle), 9.81 * np.sin(angle))
    tension = 10.0 ** random.uniform(-6.0, 2.0) if pulls else 0.0
    return rone2012(disks=disks, stiffness=stiffness, gravity=gravity), tension


@pytest.mark.parametrize("scenes", [300, pytest.param(1500, marks=pytest.mark.slow)])
def test_random_scenes_all_end_well(scenes: int) -> None:
    random, found = np.random.default_rng(SEED), 0
    for _ in range(scenes):
        scene, tension = random_scene(random)
        rest = StaticSolver(scene).solve(np.array([tension]))
        assert_not_fooled(rest, most=120)
        found += rest.found
    assert 0.5 * scenes < found < 0.8 * scenes  # both ends occur: of 1500, 949 are equilibria


def trap() -> StaticSolver:
    """64 segments, a thousandth of Table 1's E J, no extension, half a disk's mass on the last disk."""
    mass = np.full(64, 7.782e-4 * 4 / 64)
    mass[-1] /= 2
    arm = Arm.preset(
        "rone2012",
        disks=64,
        disk_spacing=0.08 / 64,
        youngs_modulus=2.10e8,
        each=PerDisk(disk_mass=tuple(mass)),
    )
    return StaticSolver(Scene(arm, (Bending(), Gravity((0.0, -9.81)))))


def plain_newton(solver: StaticSolver) -> np.ndarray:
    """Coordinates after full steps with the exact matrix, from straight, until nothing moves any further."""
    kernel, segments, disks = solver.kernel, solver.segments, solver.disks
    q, chain = np.zeros((len(segments), 1)), np.empty((len(segments), kernel.widths["chain"]))
    residual, descent, change = np.empty_like(q), np.empty_like(q), np.empty_like(q)
    pivots = np.empty((len(q), kernel.widths["pivots"]))
    for _ in range(50):
        kernel.run("pose", q, np.empty(0), segments, disks, chain)
        kernel.run("residual", disks, chain, residual)
        kernel.run("eliminate", segments, disks, chain, residual, descent, pivots, keep_sign=1.0)
        kernel.run("substitute", chain, descent, change)
        q += change
        if np.abs(change).max() < 1e-13:
            return q
    raise AssertionError("plain Newton does not converge")


def test_plain_newton_is_fooled_where_the_search_is_not() -> None:
    solver = trap()
    fooled = solver.examine(plain_newton(solver), np.empty(0), search.UNSTABLE)
    assert fooled.residual < 1e-16  # N m: an equilibrium to rounding
    assert fooled.unstable_directions == 1
    assert fooled.tip[2] == pytest.approx(3.9, abs=0.05)
    rest = solver.solve(np.empty(0))
    assert_not_fooled(rest, 20)
    assert -np.pi / 2 < rest.tip[2] < -1.0  # it hangs


def test_interpreted_search_takes_the_same_way() -> None:
    scene = rone2012(disks=16, stiffness=1e-4, gravity=DIRECTIONS["upright"])
    compiled, interpreted = (
        StaticSolver(scene, loader).solve(np.zeros(1)) for loader in (load, load_interpreted)
    )
    assert compiled.iterations == interpreted.iterations
    assert len(compiled.left) == len(interpreted.left)
    assert compiled.outcome is interpreted.outcome
