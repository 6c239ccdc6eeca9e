"""Any subset of the effects, on any kind of arm, moves as the whole arm does by Kane's method.

Sampled, not listed: a seed chooses the effects and the arm. Kernels run as plain Python, so that a structure
costs its derivation only.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import whole_arm
from whole_arm import gradient, random_state, relative_error

from continuum_dyn.effects import (
    EFFECTS,
    Inertia,
    LinearDrag,
    MassDamping,
    MaterialDamping,
    QuadraticDrag,
    RotaryInertia,
)
from continuum_dyn.motion_kernel import RECIPE
from statics import (
    Arm,
    Bending,
    Cable,
    Cables,
    DiskLoad,
    DiskLoads,
    Extension,
    Gravity,
    Payload,
    Scene,
    codegen,
)
from statics.effects import Effect

OPTIONAL: tuple[Effect, ...] = (
    Bending(),
    Extension(),
    Gravity((1.7, -9.6)),
    Cables(),
    DiskLoads((DiskLoad(1, (-0.3, 0.5), -0.01), DiskLoad(2, (0.4, -0.7), 0.02))),
    RotaryInertia(),
    MaterialDamping(1.2e-3),
    MassDamping(3.0),
    LinearDrag(0.02, 1e-6),
    QuadraticDrag(0.3, 1e-8),
)
TENSION = np.array([1.3, 0.7])


def sampled(seed: int) -> Scene:
    """Each effect and each trait of the arm with even odds."""
    odds = np.random.default_rng(seed).random(20) < 0.5
    effects = [effect for effect, there in zip(OPTIONAL, odds, strict=False) if there]
    subsegments, tapered, laden, heavy = (2 if odds[11] else 1), odds[12], odds[13], odds[14]
    upper = Cable("upper", (0.009, 0.008, 0.006) if tapered else 0.008)
    arm = Arm.preset(
        "rone2012",
        disks=2,
        subsegments=subsegments,
        core_density=7800.0 if heavy or subsegments > 1 else None,
        reference_curvature=3.0,
        cables=(upper, Cable("lower", -0.006, anchor=1)),
        payloads=(Payload(2, 0.01, 1e-6, (0.005, -0.003)),) if laden else (),
    )
    return Scene(arm, [*effects, Inertia()])


def chain_accelerations(scene: Scene, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    kernel: Any = codegen.load_interpreted(scene, RECIPE)
    tables = [
        scene.table(place, getattr(kernel, f"{place.upper()}_COLUMNS")) for place in ("segment", "disk")
    ]
    pieces = np.array([[0.0, tau, 0.0, 0.0, 0.0] for tau in TENSION[: scene.cables]]).reshape(-1, 5)
    y = np.concatenate([q.ravel(), u.ravel(), [0.0, 0.0]])
    return kernel.rate(0.0, y, pieces, *tables, q.shape[1])[q.size : 2 * q.size].reshape(q.shape)


def whole_accelerations(scene: Scene, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """By Kane's method; what the oracle does not know is added as forces on its bodies."""
    arm = whole_arm.whole_arm(scene)
    if not scene.has("rotary_inertia"):
        arm = replace(arm, payload=arm.payload * (1, 0, 1, 1))
    if not (scene.has("bending") or scene.has("material_damping")):
        arm = replace(arm, EJ=np.zeros_like(arm.EJ))
    mass, forcing = whole_arm.mass_and_forcing(arm, q, u, TENSION[: scene.cables])
    if scene.has("material_damping") and not scene.has("bending"):
        forcing = forcing + elastic_moments(arm, q)
    rates, present = u.T.ravel(), {effect.name: effect for effect in scene.effects}
    if isinstance(damping := present.get("mass_damping"), MassDamping):
        forcing = forcing - damping.mass_damping_rate * mass_for_damping(scene, q, u) @ rates
    by_q = gradient(lambda q: np.array(whole_arm.poses(arm, q)), q)
    by_q = np.moveaxis(by_q, 1, 0).reshape(q.size, 3, -1)[:, :, arm.step - 1 :: arm.step]
    v_x, v_y, omega = np.tensordot(rates, by_q, 1)
    force_x, force_y, moment = np.zeros_like(v_x), np.zeros_like(v_x), np.zeros_like(v_x)
    if isinstance(drag := present.get("linear_drag"), LinearDrag):
        force_x, force_y = force_x - drag.drag_per_speed * v_x, force_y - drag.drag_per_speed * v_y
        moment = moment - drag.rotary_drag_per_speed * omega
    if isinstance(drag := present.get("quadratic_drag"), QuadraticDrag):
        speed = drag.drag_per_speed_squared * np.hypot(v_x, v_y)
        force_x, force_y = force_x - speed * v_x, force_y - speed * v_y
        moment = moment - drag.rotary_drag_per_speed_squared * np.abs(omega) * omega
    forcing = forcing + np.sum(by_q * np.array([force_x, force_y, moment]), axis=(1, 2))
    return np.linalg.solve(mass, forcing).reshape(-1, arm.n).T


def elastic_moments(arm: whole_arm.WholeArm, q: np.ndarray) -> np.ndarray:
    """What takes the oracle's elastic moments out again, and leaves their damping."""
    moments = np.zeros(q.shape)
    moments[:, 0] = arm.EJ * (q[:, 0] / arm.L0 - arm.k0)
    return moments.T.ravel()


def mass_for_damping(scene: Scene, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Rayleigh's damping takes rotation, too, whether or not the scene has rotary inertia."""
    rotary = scene if scene.has("rotary_inertia") else Scene(scene.arm, (*scene.effects, RotaryInertia()))
    return whole_arm.mass_and_forcing(whole_arm.whole_arm(rotary), q, u, TENSION[: scene.cables])[0]


def test_every_optional_effect_is_in_the_draw() -> None:
    assert {effect.name for effect in OPTIONAL} == set(EFFECTS) - {"inertia"}


@pytest.mark.parametrize(
    "seed", [*range(4), *(pytest.param(k, marks=pytest.mark.slow) for k in range(4, 16))]
)
def test_subset_of_the_effects_agrees_with_kanes_method(seed: int) -> None:
    scene = sampled(seed)
    for state in range(3):
        q, u = random_state(scene, state, bend=0.7)
        error = relative_error(chain_accelerations(scene, q, u), whole_accelerations(scene, q, u))
        assert error < 2e-11, [effect.name for effect in scene.effects]
