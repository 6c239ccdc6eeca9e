"""MuJoCo: rigid links, hinges with the core's stiffness and damping, spatial tendons through the holes.

A hinge stands in the middle of each segment, which gives the chord of a bent segment the direction of the
arc's chord; at a segment's end it would be off at first order. A cable from hole to hole past such a hinge
gains leverage with the bend phi as r + L phi / 4, past an arc as r + L phi / 12. So a second model pulls a
third on that tendon and the rest on one of constant leverage r: right to that order. More hinges to a
segment do not help (0.24 mm with two, three or four): they bend otherwise than the arc of constant curvature.
"""

# pyright: reportMissingImports=false

from collections.abc import Callable, Iterator

import mujoco
import numpy as np
from mujoco import rollout
from scipy.optimize import fsolve

from .case import PAPER_DISKS, Answer, Case, timed

PACKAGES = ("mujoco",)
LACKS = (
    "extension, arcs (a segment is two rigid halves), and control of its steps, of first order but for RK4"
)
INTEGRATORS = {
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
    "RK4": mujoco.mjtIntegrator.mjINT_RK4,
}
SETTINGS = [("RK4", 20)] + [("implicitfast", count) for count in (1, 2, 5, 10, 20, 50, 100)]
"""Integrators, and steps between samples. Euler is as good as implicitfast, the others are worse."""
MOST = 1600
"""Most disks times steps between samples: finer ones take seconds and change nothing."""
MODELS = {"hinges": (1.0, 0.0), "hinges, leverage mended": (1 / 3, 2 / 3)}
"""Shares of the tension on the tendon from hole to hole, and on the one of constant leverage."""
REPEATS = 7

WORLD = """
<mujoco>
  <compiler angle="radian" inertiafromgeom="false"/>
  <option gravity="{gravity[0]} {gravity[1]} 0"><flag contact="disable" constraint="disable"/></option>
  <worldbody><site name="hole0" pos="0 {hole} 0"/>{arm}</worldbody>
  <tendon><spatial name="straight">{holes}</spatial><fixed name="level">{hinges}</fixed></tendon>
  <actuator>{motors}</actuator>
</mujoco>
"""
LINK = """
<body pos="{ahead} 0 0">
  <joint name="hinge{number}" type="hinge" axis="0 0 1" stiffness="{bending}" damping="{damping}"/>
  <inertial pos="{half} 0 0" mass="{mass}" diaginertia="{polar} {inertia} {inertia}"/>
  <site name="hole{number}" pos="{half} {hole} 0"/>{rest}
</body>
"""


def answers(case: Case) -> Iterator[Answer]:
    """Both models over a range of steps; RK4 for the paper's arm only: a finer one diverges."""
    for name, shares in MODELS.items():
        for integrator, count in SETTINGS:
            if case.disks * count > MOST or (integrator == "RK4" and case.disks != PAPER_DISKS):
                continue
            solve = _solver(case, shares, integrator, count)
            settings = f"{integrator}, step {1e6 * case.samples[1] / count:g} us"
            yield Answer(name, settings, *timed(solve, REPEATS), LACKS)


def _model(case: Case, shares: tuple[float, float]) -> mujoco.MjModel:
    """The arm, base along +x, its plane x-y."""
    numbers = {
        "half": case.L0 / 2,
        "hole": case.hole,
        "mass": case.mass,
        "inertia": case.inertia,
        "polar": 2 * case.inertia,
        "bending": case.EJ / case.L0,
        "damping": case.retardation * case.EJ / case.L0,
    }
    arm, segments = "", range(1, case.disks + 1)
    for number in reversed(segments):
        ahead = case.L0 if number > 1 else case.L0 / 2
        arm = LINK.format(number=number, ahead=ahead, rest=arm, **numbers)
    holes = "".join(f'<site site="hole{number}"/>' for number in (0, *segments))
    hinges = "".join(f'<joint joint="hinge{number}" coef="{-case.hole}"/>' for number in segments)
    pulls = {tendon: share for tendon, share in zip(("straight", "level"), shares, strict=True) if share}
    motors = "".join(f'<motor tendon="{tendon}" gear="{-share}"/>' for tendon, share in pulls.items())
    world = {"gravity": case.gravity, "hole": case.hole, "arm": arm}
    return mujoco.MjModel.from_xml_string(WORLD.format(**world, holes=holes, hinges=hinges, motors=motors))


def _solver(case: Case, shares: tuple[float, float], integrator: str, count: int) -> Callable[[], np.ndarray]:
    """Solve by MuJoCo's own compiled loop over the steps, and return the tip at the samples."""
    model = _model(case, shares)
    model.opt.integrator = INTEGRATORS[integrator]
    model.opt.timestep = case.samples[1] / count
    data = mujoco.MjData(model)
    data.qpos[:] = _at_rest(model, data)
    start = np.empty(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
    mujoco.mj_getState(model, data, start, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    control = np.full(((case.samples.size - 1) * count, model.nu), case.tension)

    def solve() -> np.ndarray:
        states, _sensors = rollout.rollout(model, data, start, control)
        sampled = np.vstack([start, states[0, count - 1 :: count]])
        return _tip(case, sampled[:, 1 : 1 + model.nq])

    return solve


def _at_rest(model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
    """Bends at rest without tension."""

    def moments(bends: np.ndarray) -> np.ndarray:
        data.qpos[:] = bends
        mujoco.mj_forward(model, data)
        return data.qfrc_passive - data.qfrc_bias

    return fsolve(moments, np.zeros(model.nq), xtol=1e-10)


def _tip(case: Case, bends: np.ndarray) -> np.ndarray:
    """Tip from the bends, shape (samples, 2): each segment half before its hinge, half after."""
    after = np.cumsum(bends, axis=1)
    angles = np.concatenate([after - bends, after], axis=1)
    return case.L0 / 2 * np.column_stack([np.cos(angles).sum(axis=1), np.sin(angles).sum(axis=1)])
