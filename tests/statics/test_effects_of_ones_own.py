"""Effects that no file of the program knows: their class is all that they need."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import pytest
from conftest import UPPER
from whole_arm import difference_matrix, random_state, relative_error

from statics import Arm, Bending, Cables, Extension, InputError, Scene, StaticSolver
from statics.effects import Effect, Pair
from statics.effects.effect import Account, Site
from statics.quantities import QUANTITIES, Quantity


@dataclass(frozen=True)
class Spring:
    """What the springs below share: one stiffness, the same everywhere."""

    account: ClassVar[Account] = "elastic_energy"
    acts_at_rest: ClassVar[bool] = True
    coordinates: ClassVar[tuple[str, ...]] = ()
    arm_quantities: ClassVar[tuple[str, ...]] = ()
    quantities: ClassVar[tuple[str, ...]] = ("spring_stiffness",)
    source: ClassVar[str] = "Hooke 1678"

    def columns(self, arm: Arm) -> dict[str, float]:
        """The stiffness."""
        return {"spring_stiffness": 300.0}


class HardeningSpring(Spring):
    """Its force grows with the cube of a disk's deflection."""

    name: ClassVar[str] = "hardening_spring"
    site: ClassVar[Site] = "disk"

    def pairs(self, at: Any) -> list[Pair]:
        """One pair: the spring's force, deflection."""
        y = at.position[1]
        return [Pair(-1e3 * at.spring_stiffness * y**3, y)]


class Sleeve(Spring):
    """A spring along each cable, from hole to hole."""

    name: ClassVar[str] = "sleeve"
    site: ClassVar[Site] = "span"

    def pairs(self, at: Any) -> list[Pair]:
        """A pair for each cable: the spring's force, hole-to-hole length."""
        return [Pair(-at.spring_stiffness * (c.length - at.disk_spacing), c.length) for c in at.cables]


class Unvalued(HardeningSpring):
    """It forgets the values of its quantities."""

    name: ClassVar[str] = "unvalued"

    def columns(self, arm: Arm) -> dict[str, float]:
        """None, which is wrong."""
        return {}


@dataclass(frozen=True)
class ReadsItsNumber(Spring):
    """It writes its own stiffness into its pair, where a kernel would keep it for every other."""

    name: ClassVar[str] = "reads_its_number"
    site: ClassVar[Site] = "disk"
    k: float = 300.0

    def pairs(self, at: Any) -> list[Pair]:
        """One pair, wrong: the spring's force, deflection."""
        return [Pair(-self.k * at.position[1], at.position[1])]


@pytest.fixture(autouse=True)
def glossary(monkeypatch: pytest.MonkeyPatch) -> None:
    entry = Quantity("spring_stiffness", "c", "N/m", "force of a spring over its elongation")
    monkeypatch.setitem(QUANTITIES, entry.name, entry)


def scene_with(effect: Effect, subsegments: int = 1) -> Scene:
    arm = Arm.preset("rone2012", disks=3, subsegments=subsegments, cables=(UPPER,))
    return Scene(arm, (Bending(), Extension(), Cables(), effect))


@pytest.mark.parametrize("subsegments", [1, 2])
@pytest.mark.parametrize("effect", [HardeningSpring(), Sleeve()], ids=lambda effect: effect.name)
def test_force_of_an_effect_is_the_gradient_of_its_energy(effect: Effect, subsegments: int) -> None:
    scene = scene_with(effect, subsegments)
    solver, tension = StaticSolver(scene), np.array([0.7])
    kernel, q = solver.kernel, random_state(scene, seed=1, bend=0.7)[0]
    chain, residual = np.empty((len(q), kernel.widths["chain"])), np.empty_like(q)

    def potential(flat: np.ndarray) -> np.ndarray:
        found = kernel.run("pose", flat.reshape(q.shape), tension, solver.segments, solver.disks, chain)
        return np.array([found["potential"]])

    steps = np.tile([1e-2, 1e-2 * scene.arm.rest_length], len(q))
    slope = difference_matrix(potential, q.ravel(), steps).reshape(q.shape)
    potential(q.ravel())
    kernel.run("residual", solver.disks, chain, residual)
    assert relative_error(residual, slope) < 1e-9


def test_quantity_without_a_value_is_named() -> None:
    with pytest.raises(InputError, match="'spring_stiffness' has no value on each disk"):
        StaticSolver(scene_with(Unvalued()))


def test_field_that_pairs_read_is_named() -> None:
    with pytest.raises(InputError, match=r"'reads_its_number' reads its field 'k' in pairs\(\).*at\.k"):
        StaticSolver(scene_with(ReadsItsNumber()))
