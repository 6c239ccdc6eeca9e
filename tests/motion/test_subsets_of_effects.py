"""Any subset of the effects, on any kind of arm and base, moves as the whole arm does by Kane's method.

Sampled, not listed: a seed chooses the effects and the arm. Kernels run as plain Python, so that a structure
costs its derivation only.
"""

from dataclasses import replace

import numpy as np
import pytest
import whole_arm
from one_of_each import ONE_OF_EACH
from whole_arm import gradient, random_state, relative_error
from whole_cables import WholeCables

from continuum_dyn.effects import (
    Inertia,
    LinearDrag,
    MassDamping,
    QuadraticDrag,
    RotaryInertia,
)
from continuum_dyn.passes.accelerations import acceleration
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.passes.observation import add_base_power
from statics import (
    Arm,
    Base,
    Cable,
    DiskLoad,
    DiskLoads,
    Payload,
    Scene,
)
from statics.kernels.slots import SCALARS

OPTIONAL = tuple(effect for effect in ONE_OF_EACH if effect.name != "inertia")
FOLLOWING = DiskLoads((DiskLoad(1, (-0.3, 0.5), -0.01), DiskLoad(2, (0.4, -0.7), 0.02, follower=True)))
TENSION = np.array([1.3, 0.7])
BASE = np.array([[0.03, -0.02, 0.7], [0.4, -0.6, 5.0], [3.0, -7.0, 90.0]])
"""Pose, velocity and acceleration of a base: rows of x, y, theta."""


def sampled(seed: int) -> Scene:
    """Each effect and each trait of the arm with even odds; friction asks for cables."""
    random = np.random.default_rng(seed)
    there = dict(zip((effect.name for effect in OPTIONAL), random.random(len(OPTIONAL)) < 0.5, strict=True))
    there["cable_friction"] &= there["cables"]
    meshed, tapered, laden, following, based, moves, by_length, heavy = random.random(8) < 0.5
    effects = [effect for effect in OPTIONAL if there[effect.name]]
    effects = [FOLLOWING if following and effect.name == "loads" else effect for effect in effects]
    offsets = (0.009, 0.008, 0.006) if tapered else 0.008
    stiffness = 300.0 if by_length else None
    upper = Cable("upper", offsets, cable_stiffness=stiffness, friction=0.2, slip_speed=0.02)
    arm = Arm.preset(
        "rone2012",
        disks=2,
        subsegments=2 if meshed else 1,
        core_density=7800.0 if meshed or heavy else None,
        reference_curvature=3.0,
        cables=(upper, Cable("lower", -0.006, anchor=1, friction=0.3, slip_speed=0.03)),
        payloads=(Payload(2, 0.01, 1e-6, (0.005, -0.003)),) if laden else (),
        base=Base(*BASE[0], moves=bool(moves)) if based else None,
    )
    return Scene(arm, [*effects, Inertia()])


def drive_of(scene: Scene) -> np.ndarray:
    """Tension of each cable in play, or the displacement of one that is driven by it."""
    return np.array([0.02 if k.driven_by_length else TENSION[c] for c, k in enumerate(scene.cable_kinds)])


def tensions(scene: Scene, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """On all stretches from disk to disk, shape (cables, disks)."""
    if not scene.cables:
        return np.empty((0, scene.arm.disks))
    return WholeCables(scene, drive_of(scene), on_base(scene)).in_motion(q, u)


def base_of(scene: Scene) -> np.ndarray:
    """Pose, velocity and acceleration of the scene's base, shape (3, 3), or (3, 0) if it has none."""
    if scene.arm.base is None:
        return np.empty((3, 0))
    return BASE if scene.arm.base_moves else BASE * [[1.0], [0.0], [0.0]]


def inputs_of(scene: Scene) -> np.ndarray:
    """In the order of the scene's names; cables are not being drawn in."""
    pose, *motion = base_of(scene)
    still = np.zeros(len(scene.driven_by_length))
    return np.concatenate([drive_of(scene), pose, still, *motion])[: len(scene.inputs)]


class Chain:
    """A scene's equations of motion, at one state."""

    def __init__(self, scene: Scene, q: np.ndarray, u: np.ndarray) -> None:
        self.kernel, *self.tables = Dynamics(scene).motion
        self.inputs = inputs_of(scene)
        self.q, self.u = q, u

    def accelerations(self) -> np.ndarray:
        """Of the coordinates, shape of q."""
        q, chain, w = self.q, np.empty((len(self.q), self.kernel.widths["chain"])), np.empty_like(self.q)
        work, scalars = np.empty((2, *q.shape)), np.empty(SCALARS)
        passes, tables = self.kernel.passes, self.tables
        acceleration(passes, q, self.u, self.inputs, *tables, chain, work, w, scalars)
        return w

    def base_power(self) -> float:
        """What the base does on the arm, W."""
        power = np.zeros(1)
        add_base_power(self.kernel.passes, self.q[None], self.u[None], self.inputs[None], *self.tables, power)
        return power[0]


def whole_motion(scene: Scene, q: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, float]:
    """Accelerations, and the base's power (W), by Kane's method for an arm whose base is free, but driven.

    What the oracle does not know is added as forces on its bodies.
    """
    mass, forcing = whole_equations(scene, q, u)
    _, v_b, a_b = base_of(scene)
    w = np.linalg.solve(mass[: q.size, : q.size], forcing[: q.size] - mass[: q.size, q.size :] @ a_b)
    wrench = mass[q.size :] @ np.append(w, a_b) - forcing[q.size :]
    return w.reshape(q.shape[::-1]).T, wrench @ v_b


def whole_equations(scene: Scene, q: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    arm = on_base(scene)
    if not scene.has("rotary_inertia"):
        arm = replace(arm, payload=arm.payload * (1, 0, 1, 1))
    if not (scene.has("bending") or scene.has("material_damping")):
        arm = replace(arm, EJ=np.zeros_like(arm.EJ))
    mass, forcing = whole_arm.free_mass_and_forcing(arm, q, u, tensions(scene, q, u))
    if scene.has("material_damping") and not scene.has("bending"):
        forcing[: q.size] += elastic_moments(arm, q)
    pose, v_b, _ = base_of(scene)
    rates, present = np.append(u.T, v_b), {effect.name: effect for effect in scene.effects}
    if isinstance(damping := present.get("mass_damping"), MassDamping):
        forcing = forcing - damping.mass_damping_rate * mass_for_damping(scene, q, u) @ rates
    by_q = gradient(lambda q: np.array(whole_arm.poses(arm, q)), q)
    by_q = np.moveaxis(by_q, 1, 0).reshape(q.size, 3, -1)
    if pose.size:
        x, y, theta = whole_arm.poses(arm, q)
        none, one = 0.0 * theta, 1.0 + 0.0 * theta
        rigid = [[one, none, none], [none, one, none], [pose[1] - y, x - pose[0], one]]
        by_q = np.concatenate([by_q, rigid])
    by_q = by_q[:, :, arm.step - 1 :: arm.step]
    v_x, v_y, omega = np.tensordot(rates, by_q, 1)
    force_x, force_y, moment = np.zeros_like(v_x), np.zeros_like(v_x), np.zeros_like(v_x)
    if isinstance(drag := present.get("linear_drag"), LinearDrag):
        force_x, force_y = force_x - drag.drag_per_speed * v_x, force_y - drag.drag_per_speed * v_y
        moment = moment - drag.rotary_drag_per_speed * omega
    if isinstance(drag := present.get("quadratic_drag"), QuadraticDrag):
        speed = drag.drag_per_speed_squared * np.hypot(v_x, v_y)
        force_x, force_y = force_x - speed * v_x, force_y - speed * v_y
        moment = moment - drag.rotary_drag_per_speed_squared * np.abs(omega) * omega
    return mass, forcing + np.sum(by_q * np.array([force_x, force_y, moment]), axis=(1, 2))


def on_base(scene: Scene) -> whole_arm.WholeArm:
    arm = whole_arm.whole_arm(scene)
    return arm if arm.base is None else replace(arm, base=base_of(scene)[:2])


def elastic_moments(arm: whole_arm.WholeArm, q: np.ndarray) -> np.ndarray:
    """What takes the oracle's elastic moments out again, and leaves their damping."""
    moments = np.zeros(q.shape)
    moments[:, 0] = arm.EJ * (q[:, 0] / arm.L0 - arm.k0)
    return moments.T.ravel()


def mass_for_damping(scene: Scene, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Rayleigh's damping takes rotation, too, whether or not the scene has rotary inertia."""
    rotary = scene if scene.has("rotary_inertia") else Scene(scene.arm, (*scene.effects, RotaryInertia()))
    return whole_arm.free_mass_and_forcing(on_base(rotary), q, u, tensions(scene, q, u))[0]


@pytest.mark.parametrize(
    "seed",
    [1, 3, 12, *(pytest.param(k, marks=pytest.mark.slow) for k in (*range(16), 27) if k not in (1, 3, 12))],
)
def test_subset_of_the_effects_agrees_with_kanes_method(seed: int) -> None:
    scene = sampled(seed)
    for state in range(3):
        q, u = random_state(scene, state, bend=0.7)
        chain, (w, power) = Chain(scene, q, u), whole_motion(scene, q, u)
        error = relative_error(chain.accelerations(), w)
        assert error < 5e-11, [effect.name for effect in scene.effects]
        if scene.arm.base_moves:
            assert chain.base_power() == pytest.approx(power, rel=1e-9)
