"""The search without a potential, held against the one by energy: on scenes that have one."""

import numpy as np
import pytest
from conftest import rone2012

from statics import Outcome, Scene, StaticSolver
from statics.derivation import virtual_work
from statics.kernels import loading
from statics.kernels.loading import Kernel, load
from statics.passes import search
from statics.passes.pseudo_transient import find_balance
from statics.passes.rest_passes import REST


@pytest.fixture(scope="module")
def kernel(tmp_path_factory: pytest.TempPathFactory) -> Kernel:
    """The kernel of the paper's arm as it would be if no potential of it were known."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(virtual_work, "have_potentials", lambda _groups, _coordinates: False)
        patch.setattr(loading, "_loaded", {})
        patch.setenv("CONTINUUM_DYN_CACHE", str(tmp_path_factory.mktemp("kernels") / "apart"))
        patch.setattr(loading, "_loaded", {})
        kernel = load(rone2012().structure, REST)
    assert "negative_pivots" not in kernel.text
    assert not kernel.conservative
    return kernel


def balanced(kernel: Kernel, scene: Scene, tension: float) -> tuple[int, int, np.ndarray]:
    """How the search without a potential ends from straight, its iterations, the coordinates."""
    segments, disks = (
        scene.table("segment", kernel.segment_columns),
        scene.table("disk", kernel.disk_columns),
    )
    q = np.zeros((scene.arm.disks, 2))
    numbers = np.array([tension]), segments, disks, scene.arm.rest_length, 200
    return *find_balance(kernel.passes, q, *numbers), q


@pytest.mark.parametrize(
    ("disks", "stiffness", "direction", "tension"),
    [(4, 1.0, 270, 2.0), (12, 1e-2, 200, 0.3), (16, 1e-3, 300, 0.0), (8, 1e-5, 20, 3e-4), (6, 3e-3, 85, 0.0)],
)
def test_search_by_residual_ends_where_the_search_by_energy_does(
    kernel: Kernel, disks: int, stiffness: float, direction: float, tension: float
) -> None:
    """Soft arms under their weight in all directions, where full Newton steps go astray."""
    angle = np.radians(direction)
    scene = rone2012(disks=disks, stiffness=stiffness, gravity=(9.81 * np.cos(angle), 9.81 * np.sin(angle)))
    ended, iterations, q = balanced(kernel, scene, tension)
    rest = StaticSolver(scene).solve(np.array([tension]))
    assert rest.outcome is Outcome.COMPLETED
    assert ended == search.BALANCED
    assert iterations < 30
    np.testing.assert_allclose(q, rest.coordinates, atol=1e-9)


def test_search_by_residual_ends_at_the_named_limit(kernel: Kernel) -> None:
    ended, _, _ = balanced(kernel, rone2012(), 100.0)
    assert ended == search.LIMIT
