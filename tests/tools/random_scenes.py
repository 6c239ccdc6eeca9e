"""Random scenes for claims that hold in all of them: few structures, any numbers.

A structure costs a second or more of derivation, so these are few, and their kernels run as plain Python;
together they have every effect and every trait of an arm. Numbers are drawn around those of the paper's arm,
loads up to about what bends it by a radian, which leaves one equilibrium to be found.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from continuum_dyn.effects import (
    Inertia,
    LinearDrag,
    MassDamping,
    MaterialDamping,
    QuadraticDrag,
    RotaryInertia,
)
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Interval
from statics import (
    Arm,
    Base,
    Bending,
    Cable,
    CableFriction,
    Cables,
    DiskLoad,
    DiskLoads,
    Equilibrium,
    Extension,
    Gravity,
    Payload,
    PerDisk,
    Scene,
    StaticSolver,
)
from statics.ramp import ramp

FEW, MANY = 20, 100
"""Examples of a claim on each kind of scene: by default, and among the slow tests."""
NOTHING = 1e-30
"""Numbers below this part of their range are drawn as zero: their products leave the range of floats."""

Draw = Callable[[st.SearchStrategy[Any]], Any]


@dataclass(frozen=True)
class Case:
    """A scene, what drives it, by name, and its state: coordinates and rates, shape (segments, dofs)."""

    scene: Scene
    inputs: Mapping[str, float]
    q: np.ndarray
    u: np.ndarray

    @property
    def drives(self) -> np.ndarray:
        """The inputs in the scene's order."""
        return np.array([self.inputs[name] for name in self.scene.inputs])


# ---- numbers ----


@cache
def within(limit: float) -> st.SearchStrategy[float]:
    """A number of either sign, or zero."""
    return st.floats(-limit, limit).map(lambda value: value if abs(value) > NOTHING * limit else 0.0)


@cache
def upto(limit: float) -> st.SearchStrategy[float]:
    return within(limit).map(abs)


@cache
def near(value: float) -> st.SearchStrategy[float]:
    return st.floats(0.7, 1.4).map(lambda factor: factor * value)


@cache
def vector(limit: float) -> st.SearchStrategy[tuple[float, float]]:
    return st.tuples(within(limit), within(limit))


# ---- structures ----


def arm(draw: Draw, **traits: Any) -> Arm:
    """One to three disks, all alike or all different, and the traits of the structure."""
    disks = draw(st.integers(1, 3))

    def each(strategy: st.SearchStrategy[float]) -> tuple[float, ...]:
        return tuple(draw(strategy) for _ in range(disks))

    differs = PerDisk(
        disk_spacing=each(near(0.02)),
        youngs_modulus=each(near(2.1e11)),
        disk_mass=each(near(7.8e-4)),
        reference_curvature=each(within(5.0)),
    )
    traits = {name: value(disks) if callable(value) else value for name, value in traits.items()}
    return Arm.preset("rone2012", disks=disks, each=differs if draw(st.booleans()) else PerDisk(), **traits)


def base(draw: Draw, *, moves: bool) -> Base:
    return Base(draw(within(0.3)), draw(within(0.3)), draw(within(4.0)), moves=moves)


def gravity(draw: Draw) -> Gravity:
    return Gravity(draw(vector(30.0)))


def load(draw: Draw, disks: int, **kind: bool) -> DiskLoad:
    return DiskLoad(draw(st.integers(1, disks)), draw(vector(0.2)), draw(within(0.01)), **kind)


def loaded(draw: Draw) -> Scene:
    """All that brakes, payloads and loads that change, on a base that moves."""

    def payloads(disks: int) -> tuple[Payload, ...]:
        inertia, offset = near(1e-6), vector(0.01)
        on = [disks, disks, *([draw(st.integers(1, disks - 1))] if disks > 1 else [])]  # two on one disk
        return tuple(Payload(disk, draw(near(2e-3)), draw(inertia), draw(offset)) for disk in on)

    cables = Cable("upper", draw(near(0.007))), Cable("lower", -draw(near(0.005)), anchor=1)
    here = arm(draw, cables=cables, payloads=payloads, base=base(draw, moves=True), core_density=7.8e3)
    loads = [load(draw, here.disks), load(draw, here.disks)]
    loads += [load(draw, here.disks, driven=True), load(draw, here.disks, driven=True)]
    damping = MaterialDamping(draw(upto(1e-3))), MassDamping(draw(upto(5.0)))
    drag = LinearDrag(draw(upto(0.02)), draw(upto(1e-5))), QuadraticDrag(draw(upto(0.3)), draw(upto(1e-6)))
    at_rest = Bending(), Extension(), gravity(draw), Cables(), DiskLoads(tuple(loads))
    return Scene(here, (*at_rest, Inertia(), RotaryInertia(), *damping, *drag))


def following(draw: Draw) -> Scene:
    """Loads that turn with their disk beside dead ones: no potential, no symmetric matrix."""
    here = arm(draw, cables=(Cable("upper", draw(near(0.007))),), base=base(draw, moves=False))
    loads = [load(draw, here.disks, follower=follows) for follows in (False, True, True)]
    loads.append(load(draw, here.disks, follower=True, driven=True))
    at_rest = Bending(), Extension(), gravity(draw), Cables(), DiskLoads(tuple(loads))
    return Scene(here, (*at_rest, Inertia(), RotaryInertia(), MaterialDamping(draw(upto(1e-3)))))


def rubbing(draw: Draw) -> Scene:
    """Cables that rub at their holes, on a base that moves."""

    def cable(name: str, offset: float, anchor: int | None) -> Cable:
        friction, slip_speed = draw(st.floats(0.05, 0.4)), draw(near(1e-2))
        return Cable(name, offset, anchor, friction=friction, slip_speed=slip_speed)

    cables = cable("upper", draw(near(0.007)), None), cable("lower", -draw(near(0.005)), 1)
    here = arm(draw, cables=cables, base=base(draw, moves=True))
    at_rest = Bending(), Extension(), gravity(draw), Cables(), CableFriction()
    return Scene(here, (*at_rest, Inertia(), MaterialDamping(draw(upto(1e-3)))))


def meshed(draw: Draw) -> Scene:
    """Two segments from disk to disk, holes that differ, cables driven by their length."""

    def cables(disks: int) -> tuple[Cable, ...]:
        holes = tuple(draw(near(0.007)) * (1 - 0.01 * disk) for disk in range(disks + 1))  # never alike
        stiffness = near(500.0)
        upper = Cable("upper", holes, cable_stiffness=draw(stiffness))
        return upper, Cable("lower", -draw(near(0.005)), cable_stiffness=draw(stiffness))

    here = arm(draw, cables=cables, subsegments=2, core_density=7.8e3, base=base(draw, moves=False))
    at_rest = Bending(), Extension(), gravity(draw), Cables()
    return Scene(here, (*at_rest, Inertia(), MaterialDamping(draw(upto(1e-3)))))


def inextensible(draw: Draw) -> Scene:
    """Only bends, and stands where every arm without a base does."""
    here = arm(draw, cables=(Cable("upper", draw(near(0.007))),))
    loads = DiskLoads((load(draw, here.disks),))
    return Scene(here, (Bending(), gravity(draw), Cables(), loads, Inertia()))


KINDS = (loaded, following, rubbing, meshed, inextensible)
LIMITS = {
    "tension": 2.0,
    "cable_displacement": 1e-3,
    "load_factor": 1.5,
    "cable_displacement_rate": 0.05,
    "base_velocity_x": 0.5,
    "base_velocity_y": 0.5,
    "base_angular_velocity": 5.0,
    "base_acceleration_x": 20.0,
    "base_acceleration_y": 20.0,
    "base_angular_acceleration": 100.0,
}
"""Of the inputs, of either sign but for tensions."""


def quantity_of(name: str) -> str:
    """A name as the glossary has it, without the number of its cable or load."""
    stem, _, number = name.rpartition("_")
    return stem if number.isdigit() else name


def draw_input(draw: Draw, name: str) -> float:
    limit = LIMITS[quantity_of(name)]
    return draw(upto(limit) if name.startswith("tension") else within(limit))


@st.composite
def cases(draw: Draw, kind: Callable[[Draw], Scene]) -> Case:
    """Scenes of a kind, in any state: bends up to 0.7 rad from disk to disk, 2 % of elongation, 20 rad/s."""
    scene = kind(draw)
    pose = dict(zip(("base_x", "base_y", "base_theta"), scene.arm.base_pose, strict=True))
    inputs = {name: pose[name] if name in pose else draw_input(draw, name) for name in scene.inputs}
    size = np.array([[0.7 / scene.arm.subsegments, 0.02 * scene.arm.rest_length], [20.0, 0.2]])
    parts = len(scene.coordinates)
    state = [[draw(within(1.0)) for _ in range(parts)] for _ in range(2 * scene.arm.segments)]
    q, u = np.array(state).reshape(2, -1, parts) * size[:, None, :parts]
    return Case(scene, inputs, q, u)


# ---- answers ----


def at_rest(case: Case) -> Equilibrium:
    """The equilibrium under the case's inputs, from straight."""
    return StaticSolver(case.scene).solve(case.drives)


def let_out(case: Case) -> Equilibrium:
    """The same, come to from a fiftieth more tension: where cables rub the arm remembers it."""
    solver = StaticSolver(case.scene)
    if not any(kind.rubs for kind in case.scene.cable_kinds):
        return at_rest(case)
    more = [1.02 if name.startswith("tension") else 1.0 for name in case.scene.inputs]
    return ramp(solver, [np.array(more) * case.drives, case.drives])[-1]


def dynamics_of(case: Case) -> tuple[Dynamics, np.ndarray, Interval]:
    """The equations of motion, the state and inputs that stay as they are."""
    dynamics = Dynamics(case.scene)
    pieces = np.zeros((len(case.scene.inputs), 6))
    pieces[:, 1] = case.drives
    return dynamics, dynamics.state(case.q, case.u), Interval(0.0, 1.0, pieces)


def accelerations(case: Case) -> np.ndarray:
    """Of the coordinates, shape (segments, dofs)."""
    dynamics, y, interval = dynamics_of(case)
    return dynamics.rate(0.0, y, interval)[dynamics.size : 2 * dynamics.size].reshape(case.q.shape)


def powers(case: Case) -> np.ndarray:
    """Put in and dissipated, W."""
    dynamics, y, interval = dynamics_of(case)
    return dynamics.rate(0.0, y, interval)[2 * dynamics.size :]


# ---- claims ----


def holds_in(*kinds: Callable[[Draw], Scene], **drawn: st.SearchStrategy[Any]) -> Callable[..., Any]:
    """Make a test of a claim on a case and what is drawn with it: on each kind, with few examples or many."""
    return _at_both_depths({kind.__name__: {"case": cases(kind)} | drawn for kind in kinds})


def holds_for(**drawn: st.SearchStrategy[Any]) -> Callable[..., Any]:
    """Make a test of a claim on what is drawn, with few examples or many."""
    return _at_both_depths({"any": drawn})


def _at_both_depths(by_name: dict[str, dict[str, st.SearchStrategy[Any]]]) -> Callable[..., Any]:
    def to_test(claim: Callable[..., None]) -> Callable[..., None]:
        @pytest.mark.parametrize("name", by_name)
        @pytest.mark.parametrize("examples", [FEW, pytest.param(MANY, marks=pytest.mark.slow)])
        def test(name: str, examples: int) -> None:
            settings(max_examples=examples)(given(**by_name[name])(claim))()

        test.__name__, test.__doc__ = claim.__name__, claim.__doc__
        return test

    return to_test
