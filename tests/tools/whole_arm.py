"""The whole arm from the paper's formulas alone: an oracle for the program's chain.

Equations of motion and potential energy by numpy, in complex numbers; the former once more by sympy's
KanesMethod, with cables as forces on the disks' holes, which vouches for those by numpy. Nothing is taken
from the program but the numbers of a scene. The paper's formulas divide by the curvature, so states must
stay away from straight segments.

Coordinates q and rates u have shape (n, 1) or (n, 2), one row for each segment: phi = k L, and e = L - L0.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import mpmath
import numpy as np
import sympy as sp
from sympy.physics.mechanics import (
    KanesMethod,
    Particle,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)

from continuum_dyn.effects import Inertia, MaterialDamping, RotaryInertia
from statics.arm import Arm, Cable, PerDisk
from statics.effects import Bending, Cables, DiskLoad, DiskLoads, Extension, Gravity
from statics.scene import Scene

# ---- the numbers of an arm ----

LOBATTO_INSIDE = ((1 - 5**-0.5) / 2, (1 + 5**-0.5) / 2)
"""Parts of a segment's way along it where 5/12 of its core's mass stand; 1/12 stand on either end."""


@dataclass(frozen=True, eq=False)
class WholeArm:
    """An arm in the paper's letters, SI units; what a scene leaves out is zero here.

    ``n`` segments, with ``L0``, ``EJ``, ``EA``, ``k0`` and the core's own mass ``m_c`` of each, shape (n,);
    every ``step``-th of their ends is a disk. ``m`` and ``I_xx`` hold what stands on each end, shape (n,), so
    do the dead loads ``force`` (n, 2) and ``moment`` (n,), and the forces ``follower`` (n, 2) in axes that
    turn with the end. ``r_h`` has shape (cables, disks + 1), the base's first; ``last`` (the anchor's disk)
    has one number for each cable; ``relaxation`` is eta / E. ``payload`` holds mass, inertia and offset of
    each, shape (payloads, 4), and ``carriers`` the ends that carry them. ``base`` holds the pose and the
    velocity of a base that is not at the origin, shape (2, 3), or is None.
    """

    n: int
    step: int
    extends: bool
    L0: np.ndarray
    EJ: np.ndarray
    EA: np.ndarray
    k0: np.ndarray
    m_c: np.ndarray
    m: np.ndarray
    I_xx: np.ndarray
    g: np.ndarray
    relaxation: float
    r_h: np.ndarray
    first: np.ndarray
    last: np.ndarray
    force: np.ndarray
    moment: np.ndarray
    follower: np.ndarray
    payload: np.ndarray
    carriers: tuple[int, ...]
    base: np.ndarray | None

    @property
    def numbers(self) -> list[float]:
        """In the order of ``_Symbols.numbers``."""
        return [*self.g, self.relaxation]

    @property
    def core(self) -> list[np.ndarray]:
        """In the order of ``_Symbols.core``."""
        return [self.L0, self.EJ, self.EA, self.k0, self.m_c]

    @property
    def core_points(self) -> int:
        """Number of points between the ends of a segment that carry the core's mass."""
        return len(LOBATTO_INSIDE) if self.m_c.any() else 0

    def tension_along(self, tension: np.ndarray) -> np.ndarray:
        """Tension of every cable from disk to disk, shape (cables, disks): zero before start, beyond anchor.

        Takes one tension for each cable, or all of that shape.
        """
        along = np.array(tension)
        along = along[:, None] if along.ndim == 1 else along
        disk = np.arange(1, self.n // self.step + 1)
        return along * ((disk > self.first[:, None]) & (disk <= self.last[:, None]))


def whole_arm(scene: Scene) -> WholeArm:
    """Numbers of a scene in the paper's letters."""
    arm, has = scene.arm, {type(effect): effect for effect in scene.effects}
    E = arm.per_disk("youngs_modulus")
    cables = arm.cables if Cables in has else ()
    gravity, damping = has.get(Gravity), has.get(MaterialDamping)
    n, step = arm.disks * arm.subsegments, arm.subsegments
    (force, follower), (moment, m, I_xx) = np.zeros((2, n, 2)), np.zeros((3, n))
    for load in getattr(has.get(DiskLoads), "loads", ()):
        (follower if load.follower else force)[step * load.disk - 1] += load.force
        moment[step * load.disk - 1] += load.moment
    m[step - 1 :: step] = arm.per_disk("disk_mass")
    I_xx[step - 1 :: step] = arm.per_disk("disk_inertia") if RotaryInertia in has else 0.0
    L0 = np.repeat(arm.per_disk("disk_spacing") / step, step)
    A = np.repeat(arm.per_disk("area"), step)
    m_c = (arm.core_density or 0.0) * A * L0
    for i in range(n):
        m[i] += m_c[i] / 12
        m[i - 1] += m_c[i] / 12 if i > 0 else 0.0
    return WholeArm(
        n=n,
        step=step,
        extends=Extension in has,
        L0=L0,
        EJ=np.repeat(E * arm.per_disk("second_moment"), step),
        EA=np.repeat(E, step) * A,
        k0=np.repeat(arm.per_disk("reference_curvature"), step),
        m_c=m_c,
        m=m,
        I_xx=I_xx,
        g=np.array(gravity.acceleration if isinstance(gravity, Gravity) else (0.0, 0.0)),
        relaxation=damping.retardation_time if isinstance(damping, MaterialDamping) else 0.0,
        r_h=np.array([cable.holes(arm.disks) for cable in cables]).reshape(-1, arm.disks + 1),
        first=np.array([cable.start or 0 for cable in cables]),
        last=np.array([cable.anchor or arm.disks for cable in cables]),
        force=force,
        moment=moment,
        follower=follower,
        payload=np.array([(p.mass, p.inertia, *p.offset) for p in arm.payloads]).reshape(-1, 4),
        carriers=tuple(step * payload.disk for payload in arm.payloads),
        base=None if arm.base is None else np.array([arm.base_pose, (0.0, 0.0, 0.0)]),
    )


# ---- scenes and states that the tests share ----

ONE_CABLE = (Cable("upper", 0.008),)


def full_scene(disks: int, **changes: Any) -> Scene:
    """Every effect: a bent core that extends, a cable on either side, loads half-way and at the tip."""
    cables = (Cable("upper", 0.008), Cable("lower", -0.006, anchor=max(1, disks - 1)))
    arm = Arm.preset("rone2012", **{"disks": disks, "cables": cables, "reference_curvature": 3.0} | changes)
    loads = (DiskLoad(disks, (0.4, -0.7), 0.02), DiskLoad((disks + 1) // 2, (-0.3, 0.5), -0.01))
    at_rest = (Bending(), Extension(), Gravity((1.7, -9.6)), Cables(), DiskLoads(loads))
    return Scene(arm, (*at_rest, Inertia(), RotaryInertia(), MaterialDamping(1.2e-3)))


def stiff_scene(disks: int, **changes: Any) -> Scene:
    """No extension, one cable, no loads."""
    arm = Arm.preset("rone2012", **{"disks": disks, "cables": ONE_CABLE} | changes)
    return Scene(arm, (Bending(), Gravity(), Cables(), Inertia(), RotaryInertia(), MaterialDamping(1.2e-3)))


def spanned_scene(disks: int, subsegments: int = 2) -> Scene:
    """Several segments from disk to disk, past which the cable runs straight; the core has its own mass."""
    meshed = {"subsegments": subsegments, "core_density": 7800.0, "cables": ONE_CABLE}
    arm = Arm.preset("rone2012", disks=disks, reference_curvature=3.0, **meshed)
    at_rest = (Bending(), Extension(), Gravity(), Cables())
    return Scene(arm, (*at_rest, Inertia(), RotaryInertia(), MaterialDamping(1.2e-3)))


def heavy_scene(disks: int, **changes: Any) -> Scene:
    """Every effect, and a core as heavy as its disks."""
    return full_scene(disks, core_density=7.8e4, **changes)


def tapered_scene(disks: int, subsegments: int = 1) -> Scene:
    """Disks, cores and holes that all differ from base to tip."""
    steps = np.linspace(1.0, 0.6, disks)
    offsets = np.linspace(0.009, 0.005, disks + 1)
    table_1 = {"disk_spacing": 0.02, "area": 5.027e-7, "second_moment": 2.011e-14, "disk_mass": 7.782e-4}
    each = {name: tuple(value * steps**power) for power, (name, value) in enumerate(table_1.items(), start=1)}
    curvature = tuple(np.linspace(3.0, -2.0, disks))
    arm = Arm.preset(
        "rone2012",
        disks=disks,
        subsegments=subsegments,
        core_density=7800.0,
        each=PerDisk(**each, reference_curvature=curvature),
        cables=(Cable("upper", tuple(offsets)), Cable("lower", -0.006, anchor=max(1, disks - 1))),
    )
    at_rest = (Bending(), Extension(), Gravity(), Cables())
    return Scene(arm, (*at_rest, Inertia(), RotaryInertia(), MaterialDamping(1.2e-3)))


def bare_scene(disks: int) -> Scene:
    """Point masses on an elastic core: no extension, no cables, no gravity, no rotary inertia, no damping."""
    return Scene(Arm.preset("rone2012", disks=disks), (Bending(), Inertia()))


def random_state(scene: Scene, seed: int, bend: float = 1.5) -> tuple[np.ndarray, np.ndarray]:
    """Bends from 0.1 rad to ``bend`` of either sign, 3 % of elongation, 30 rad/s and 0.3 m/s at most."""
    random = np.random.default_rng(seed)
    shape = scene.arm.segments, len(scene.coordinates)
    sign = random.choice([-1.0, 1.0], shape[0])
    q, u = random.uniform(-1, 1, shape), random.uniform(-1, 1, shape)
    q[:, 0], u[:, 0] = sign * random.uniform(0.1, bend, shape[0]), 30 * u[:, 0]
    q[:, 1:], u[:, 1:] = 0.03 * scene.arm.rest_length * q[:, 1:], 0.3 * u[:, 1:]
    return q, u


def relative_error(actual: np.ndarray, expected: np.ndarray) -> float:
    """Largest error in each column over the largest entry of that column: bends and elongations apart."""
    error, size = np.abs(actual - expected).max(axis=0), np.abs(expected).max(axis=0)
    return float(np.max(error / size))


# ---- equations of motion: Kane's method on all bodies at once ----


class _Symbols:
    """What the equations of motion are written in."""

    def __init__(
        self, n: int, extends: bool, cables: int, step: int, payloads: int, core_points: int, free: bool
    ) -> None:
        self.step = step
        self.inside = LOBATTO_INSIDE[:core_points]
        self.phi, self.phi_rate = dynamicsymbols(f"phi1:{n + 1}"), dynamicsymbols(f"omega1:{n + 1}")
        self.e = dynamicsymbols(f"e1:{n + 1}") if extends else ()
        self.e_rate = dynamicsymbols(f"v1:{n + 1}") if extends else ()
        self.numbers = sp.symbols("g_x g_y relaxation")
        self.core = [sp.symbols(f"{name}_1:{n + 1}") for name in ("L0", "EJ", "EA", "k0", "m_c")]
        self.m, self.I_xx = sp.symbols(f"m1:{n + 1}"), sp.symbols(f"I1:{n + 1}")
        self.r_h = sp.Matrix(cables, n // step + 1, lambda c, i: sp.Symbol(f"r{c}_{i}"))
        self.tension = sp.Matrix(cables, n // step, lambda c, i: sp.Symbol(f"tau{c}_{i}"))
        self.load = sp.Matrix(n, 5, lambda i, a: sp.Symbol(f"load{i}_{a}"))
        self.payload = sp.Matrix(payloads, 4, lambda i, a: sp.Symbol(f"payload{i}_{a}"))
        self.world = ReferenceFrame("N")
        self.base = dynamicsymbols("x_b y_b theta_b") if free else ()
        self.base_rate = dynamicsymbols("v_x v_y omega_b") if free else ()
        self.q = [*self.phi, *self.e, *self.base]
        self.u = [*self.phi_rate, *self.e_rate, *self.base_rate]

    @property
    def arguments(self) -> list[Any]:
        numbers = [self.numbers, *self.core, self.m, self.I_xx, self.r_h.flat()]
        return [self.q, self.u, *numbers, self.tension.flat(), self.load.flat(), self.payload.flat()]

    def rate(self, expression: Any) -> Any:
        return sum(sp.diff(expression, q) * u for q, u in zip(self.q, self.u, strict=True))


def _place_disks(s: _Symbols) -> tuple[list[ReferenceFrame], list[Point]]:
    """Frames and centres of the base and of all disks, with their velocities. Rone 2012, Eq. 10-12."""
    world, frames, centers = s.world, [ReferenceFrame("B")], [Point("O")]
    (_, _, angle), (v_x, v_y, omega) = s.base or (0, 0, 0), s.base_rate or (0, 0, 0)
    frames[0].orient_axis(world, angle, world.z)
    frames[0].set_ang_vel(world, omega * world.z)
    centers[0].set_vel(world, v_x * world.x + v_y * world.y)
    for i, phi in enumerate(s.phi):
        L = s.core[0][i] + s.e[i] if s.e else s.core[0][i]
        k = phi / L
        x, y = sp.sin(phi) / k, (1 - sp.cos(phi)) / k
        near, frame = frames[-1], ReferenceFrame(f"A{i + 1}")
        frame.orient_axis(world, sum(s.phi[: i + 1], angle), world.z)
        frame.set_ang_vel(world, sum(s.phi_rate[: i + 1], omega) * world.z)
        center = centers[-1].locatenew(f"P{i + 1}", x * near.x + y * near.y)
        center.set_vel(near, s.rate(x) * near.x + s.rate(y) * near.y)
        center.v1pt_theory(centers[-1], world, near)
        frames.append(frame)
        centers.append(center)
    return frames, centers


def _disk_loads(s: _Symbols, frames: list[ReferenceFrame], centers: list[Point]) -> list[Any]:
    """Weights (Eq. 19), dead loads, and forces that turn with their disk."""
    *_, g_x, g_y, _relaxation = s.numbers
    world, loads = s.world, []
    for i, (frame, center) in enumerate(zip(frames[1:], centers[1:], strict=True)):
        weight = s.m[i] * g_x * world.x + s.m[i] * g_y * world.y
        dead = s.load[i, 0] * world.x + s.load[i, 1] * world.y
        loads.append((center, weight + dead + s.load[i, 3] * frame.x + s.load[i, 4] * frame.y))
        loads.append((frame, s.load[i, 2] * world.z))
    return loads


def _core_moments(s: _Symbols, frames: list[ReferenceFrame]) -> list[Any]:
    """Bending moments of a Kelvin-Voigt core on the two disks of every segment (Eq. 20)."""
    (L0, EJ, _EA, k0, _m_c), (*_, relaxation) = s.core, s.numbers
    loads: list[Any] = []
    for i, phi in enumerate(s.phi):
        moment = EJ[i] * ((phi + relaxation * s.phi_rate[i]) / L0[i] - k0[i]) * frames[0].z
        loads += [(frames[i + 1], -moment), (frames[i], moment)]
    return loads


def _axial_forces(s: _Symbols) -> sp.Matrix:
    """Generalized forces of a Kelvin-Voigt core along its length: they work along e alone."""
    (L0, _EJ, EA, _k0, _m_c), (*_, relaxation) = s.core, s.numbers
    along = [-EA[i] / L0[i] * (e + relaxation * s.e_rate[i]) for i, e in enumerate(s.e)]
    return sp.Matrix([*[0] * len(s.phi), *along, *[0] * len(s.base)])


def _cable_forces(s: _Symbols, c: int, frames: list[ReferenceFrame], centers: list[Point]) -> list[Any]:
    """One cable's pulls from hole to hole, on both of any two neighbouring disks (Eq. 22-24)."""
    loads, holes = [], []
    disks = frames[:: s.step]
    for i, (frame, center) in enumerate(zip(disks, centers[:: s.step], strict=True)):
        hole = center.locatenew(f"{center.name}_hole{c}", s.r_h[c, i] * frame.y)
        hole.v2pt_theory(center, s.world, frame)
        holes.append(hole)
    for i, near in enumerate(disks[:-1]):
        way = holes[i + 1].pos_from(holes[i]).express(near)
        pull = s.tension[c, i] * way.normalize()
        loads += [(holes[i + 1], -pull), (holes[i], pull)]
    return loads


def _payload_bodies(
    s: _Symbols, carriers: tuple[int, ...], frames: list[ReferenceFrame], centers: list[Point]
) -> tuple[list[RigidBody], list[Any]]:
    """A body of its own for each payload, fixed to its disk, and its weight."""
    *_, g_x, g_y, _relaxation = s.numbers
    world, bodies, loads = s.world, [], []
    for number, carrier in enumerate(carriers):
        m, I, along, across = s.payload.row(number)  # noqa: E741
        frame, center = frames[carrier], centers[carrier]
        own = center.locatenew(f"payload{number}", along * frame.x + across * frame.y)
        own.v2pt_theory(center, world, frame)
        bodies.append(RigidBody(f"payload{number}", own, frame, m, (inertia(frame, 0, 0, I), own)))
        loads.append((own, m * g_x * world.x + m * g_y * world.y))
    return bodies, loads


def _core_particles(
    s: _Symbols, frames: list[ReferenceFrame], centers: list[Point]
) -> tuple[list[Particle], list[Any]]:
    """The core's own mass along each segment, on its arc, and its weight."""
    *_, g_x, g_y, _relaxation = s.numbers
    world, particles, loads = s.world, [], []
    for i, phi in enumerate(s.phi):
        L = s.core[0][i] + s.e[i] if s.e else s.core[0][i]
        k, m, near = phi / L, sp.Rational(5, 12) * s.core[4][i], frames[i]
        for part in s.inside:
            x, y = sp.sin(part * phi) / k, (1 - sp.cos(part * phi)) / k
            name = f"core{i}_{len(particles)}"
            point = centers[i].locatenew(name, x * near.x + y * near.y)
            point.set_vel(near, s.rate(x) * near.x + s.rate(y) * near.y)
            point.v1pt_theory(centers[i], world, near)
            particles.append(Particle(name, point, m))
            loads.append((point, m * g_x * world.x + m * g_y * world.y))
    return particles, loads


@cache
def kane_equations(
    n: int,
    extends: bool,
    cables: int,
    step: int,
    carriers: tuple[int, ...] = (),
    core_points: int = 0,
    free: bool = False,
) -> tuple[_Symbols, sp.Matrix, sp.Matrix]:
    """Mass matrix M and forcing f of M u' = f: rates of all bends, all elongations, and of a ``free`` base.

    What holds such a base, or drives it, is for the caller to add.
    """
    s = _Symbols(n, extends, cables, step, len(carriers), core_points, free)
    frames, centers = _place_disks(s)
    disks = [
        RigidBody(f"disk{i}", centers[i], frames[i], m, (inertia(frames[i], 0, 0, I_xx), centers[i]))
        for i, (m, I_xx) in enumerate(zip(s.m, s.I_xx, strict=True), start=1)
    ]
    payloads, weights = _payload_bodies(s, carriers, frames, centers)
    core, core_weights = _core_particles(s, frames, centers)
    loads = [*_disk_loads(s, frames, centers), *_core_moments(s, frames), *weights, *core_weights]
    for c in range(cables):
        loads += _cable_forces(s, c, frames, centers)
    kane = KanesMethod(s.world, s.q, s.u, kd_eqs=[sp.diff(q, "t") - u for q, u in zip(s.q, s.u, strict=True)])
    kane.kanes_equations([*disks, *payloads, *core], loads)
    return s, kane.mass_matrix, kane.forcing + _axial_forces(s)


@cache
def _kane_function(
    n: int,
    extends: bool,
    cables: int,
    step: int,
    carriers: tuple[int, ...],
    core_points: int,
    free: bool,
    module: str,
) -> Callable[..., tuple[Any, Any]]:
    s, mass, forcing = kane_equations(n, extends, cables, step, carriers, core_points, free)
    return sp.lambdify(s.arguments, (mass, forcing), modules=module, cse=True)


def _arguments(arm: WholeArm, q: np.ndarray, u: np.ndarray, tension: np.ndarray) -> list[np.ndarray]:
    load = np.column_stack([arm.force, arm.moment, arm.follower])
    tensions, numbers = arm.tension_along(tension), [np.array(arm.numbers), *arm.core, arm.m, arm.I_xx]
    numbers.append(arm.r_h.ravel())
    numbers += [tensions.ravel(), load.ravel(), arm.payload.ravel()]
    base, base_rate = np.empty((2, 0)) if arm.base is None else arm.base
    return [np.append(q.T, base), np.append(u.T, base_rate), *numbers]


def _equations(arm: WholeArm, module: str) -> Callable[..., tuple[Any, Any]]:
    structure = (arm.n, arm.extends, len(arm.r_h), arm.step, arm.carriers, arm.core_points)
    return _kane_function(*structure, arm.base is not None, module)


def derived_mass_and_forcing(
    arm: WholeArm, q: np.ndarray, u: np.ndarray, tension: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """M and f as sympy derives them, with a base's three at the end: seconds for a new structure."""
    mass, forcing = _equations(arm, "numpy")(*_arguments(arm, q, u, tension))
    return mass, forcing[:, 0]


def precise_accelerations(arm: WholeArm, q: np.ndarray, u: np.ndarray, tension: np.ndarray) -> np.ndarray:
    """Likewise in 200 digits, with 1e-40 rad for the bend of a straight segment: an error of that size."""
    bent = q.astype(object)  # mpf takes numbers and text alike
    bent[q[:, 0] == 0, 0] = "1e-40"
    with mpmath.workdps(200):
        numbers = [[mpmath.mpf(value) for value in values] for values in _arguments(arm, bent, u, tension)]
        mass, forcing = _equations(arm, "mpmath")(*numbers)
        solution = mpmath.lu_solve(mass[: q.size, : q.size], forcing[: q.size, 0])
        return np.array(solution, dtype=float).reshape(-1, arm.n).T


# ---- equations of motion: Kane's method by numbers, in complex ones ----


def mass_and_forcing(
    arm: WholeArm, q: np.ndarray, u: np.ndarray, tension: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """M, shape (q.size, q.size), and f, shape (q.size,), at one state, on a base without acceleration."""
    mass, forcing = free_mass_and_forcing(arm, q, u, tension)
    return mass[: q.size, : q.size], forcing[: q.size]


def free_mass_and_forcing(
    arm: WholeArm, q: np.ndarray, u: np.ndarray, tension: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """M and f with a base's three at the end, where M u' - f is its wrench on the arm.

    The same as ``derived_mass_and_forcing``, by partial velocities of every body: derivatives of its pose.
    """
    assert np.isrealobj(q), "complex steps do not nest"
    base, base_rate = np.empty((2, 0)) if arm.base is None else arm.base
    z, rate = np.append(q.T, base), np.append(u.T, base_rate)
    partial = gradient(lambda z: bodies(*_at(arm, z)), z)
    inertia = body_inertia(arm)
    mass = np.einsum("abi,bi,cbi->ac", partial, inertia, partial)
    while_coasting = _second_derivative(lambda z: bodies(*_at(arm, z)), z, rate)
    loads = body_loads(arm, bodies(arm, q)) - inertia * while_coasting
    forcing = np.einsum("abi,bi->a", partial, loads)
    pulls = gradient(lambda z: cable_lengths(*_at(arm, z)), z)
    forcing -= np.einsum("aci,ci->a", pulls, arm.tension_along(tension))
    (n, relaxation), size = (arm.n, arm.relaxation), q.size
    forcing[:n] -= arm.EJ * ((q[:, 0] + relaxation * u[:, 0]) / arm.L0 - arm.k0)
    if arm.extends:
        forcing[n:size] -= arm.EA / arm.L0 * (q[:, 1] + relaxation * u[:, 1])
    return mass, forcing


def accelerations(arm: WholeArm, q: np.ndarray, u: np.ndarray, tension: np.ndarray) -> np.ndarray:
    """Time derivative of u by Kane's method, shape of q."""
    return np.linalg.solve(*mass_and_forcing(arm, q, u, tension)).reshape(-1, arm.n).T


def kinetic_slope(arm: WholeArm, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Derivatives of the kinetic energy by the coordinates at fixed rates, shape of q: by differences.

    Of eighth order, and so large that little is lost to rounding; they stay away from straight segments.
    """

    def kinetic_energy(q: np.ndarray) -> float:
        return float(np.sum(body_inertia(arm) * directional(lambda q: bodies(arm, q), q, u) ** 2) / 2)

    slope = np.empty(q.shape)
    for at in np.ndindex(*q.shape):
        step = np.zeros(q.shape)
        step[at] = 0.02 * [1.0, arm.L0[0]][at[1]]
        ahead = [kinetic_energy(q + k * step) - kinetic_energy(q - k * step) for k in (1, 2, 3, 4)]
        slope[at] = np.dot([4 / 5, -1 / 5, 4 / 105, -1 / 280], ahead) / step[at]
    return slope


def _at(arm: WholeArm, z: np.ndarray) -> tuple[WholeArm, np.ndarray]:
    """The arm on its base, and its coordinates, of all coordinates in one row."""
    size = arm.n * (2 if arm.extends else 1)
    here = arm if arm.base is None else replace(arm, base=np.array([z[size:], arm.base[1]]))
    return here, z[:size].reshape(-1, arm.n).T


def bodies(arm: WholeArm, q: np.ndarray) -> np.ndarray:
    """x, y, theta of all that has mass, shape (bodies, 3): segments' ends, payloads, points of the core."""
    x, y, theta = poses(arm, q)
    at = np.array(arm.carriers, dtype=int) - 1
    along, across = arm.payload.T[2:]
    cosine, sine = np.cos(theta[at]), np.sin(theta[at])
    payloads = x[at] + along * cosine - across * sine, y[at] + along * sine + across * cosine, theta[at]
    inside = [(*poses_along(arm, q, part), 0 * theta) for part in LOBATTO_INSIDE[: arm.core_points]]
    return np.concatenate([np.column_stack(part) for part in ((x, y, theta), payloads, *inside)])


def body_inertia(arm: WholeArm) -> np.ndarray:
    """Mass twice, and moment of inertia, of ``bodies``."""
    m, I = arm.payload.T[:2]  # noqa: E741
    inside = np.tile(5 / 12 * arm.m_c, arm.core_points)
    mass = np.concatenate([arm.m, m, inside])
    return np.column_stack([mass, mass, np.concatenate([arm.I_xx, I, 0 * inside])])


def body_loads(arm: WholeArm, pose: np.ndarray) -> np.ndarray:
    """Force and moment on each of ``bodies``: weights, dead loads, forces that turn with their disk."""
    loads = body_inertia(arm) * [*arm.g, 0.0]
    cosine, sine = np.cos(pose[: arm.n, 2]), np.sin(pose[: arm.n, 2])
    along, across = arm.follower.T
    turned = np.column_stack([cosine * along - sine * across, sine * along + cosine * across])
    loads[: arm.n] += np.column_stack([arm.force + turned, arm.moment])
    return loads


def _second_derivative(
    function: Callable[[np.ndarray], np.ndarray], z: np.ndarray, rate: np.ndarray
) -> np.ndarray:
    """Second derivative of a vector in time while z goes on at its rate: by steps of 0.005 rad."""
    step = 0.005 / max(1e-9, np.abs(rate).max())  # elongations change by less than bends
    moving = difference_matrix(
        lambda time: directional(function, z + time * rate, rate).ravel(), np.zeros(1), [step]
    )
    return moving.reshape(function(z).shape)


# ---- energy: numpy, in complex numbers ----


def poses(arm: WholeArm, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x, y, theta of all disks, each of shape (n,). Rone 2012, Eq. 10-12."""
    phi, L = q[:, 0], arm.L0 + (q[:, 1] if arm.extends else np.zeros(arm.n))
    k = phi / L
    x, y = np.sin(k * L) / k, (1 - np.cos(k * L)) / k
    base_x, base_y, base_theta = base_pose(arm)
    theta = base_theta + np.cumsum(phi)
    near = theta - phi
    return (
        base_x + np.cumsum(np.cos(near) * x - np.sin(near) * y),
        base_y + np.cumsum(np.sin(near) * x + np.cos(near) * y),
        theta,
    )


def base_pose(arm: WholeArm) -> np.ndarray:
    """x, y, theta of the base."""
    return np.zeros(3) if arm.base is None else arm.base[0]


def poses_along(arm: WholeArm, q: np.ndarray, part: float) -> tuple[np.ndarray, np.ndarray]:
    """X and y of a point on each segment's arc, that part of the way along, each of shape (n,)."""
    phi, L = q[:, 0], arm.L0 + (q[:, 1] if arm.extends else np.zeros(arm.n))
    ends = zip(base_pose(arm), poses(arm, q), strict=True)
    x, y, theta = (np.append(base, values)[:-1] for base, values in ends)
    k = phi / L
    along, across = np.sin(part * phi) / k, (1 - np.cos(part * phi)) / k
    return (
        x + np.cos(theta) * along - np.sin(theta) * across,
        y + np.sin(theta) * along + np.cos(theta) * across,
    )


def cable_lengths(arm: WholeArm, q: np.ndarray) -> np.ndarray:
    """Hole-to-hole lengths from the holes' positions, shape (cables, disks). Rone 2012, Eq. 22-23."""
    ends = zip(base_pose(arm), poses(arm, q), strict=True)
    x, y, theta = (np.concatenate([[start], values])[:: arm.step] for start, values in ends)
    lengths = np.empty((len(arm.r_h), arm.n // arm.step), dtype=q.dtype)
    for c, r_h in enumerate(arm.r_h):
        across, up = np.diff(x - r_h * np.sin(theta)), np.diff(y + r_h * np.cos(theta))
        lengths[c] = np.sqrt(across**2 + up**2)
    return lengths


def elastic_energy(arm: WholeArm, q: np.ndarray) -> Any:
    """Of the core, zero where it is unloaded, J."""
    energy = np.sum(arm.EJ / (2 * arm.L0) * (q[:, 0] - arm.k0 * arm.L0) ** 2)
    return energy + (np.sum(arm.EA / (2 * arm.L0) * q[:, 1] ** 2) if arm.extends else 0)


def gravity_energy(arm: WholeArm, q: np.ndarray) -> Any:
    """Of the masses, payloads included, zero at the origin, J."""
    x, y, theta = poses(arm, q)
    m, _, along, across = arm.payload.T
    at = np.array(arm.carriers, dtype=int) - 1
    cosine, sine = np.cos(theta[at]), np.sin(theta[at])
    weight_x = arm.m @ x + m @ (x[at] + along * cosine - across * sine)
    weight_y = arm.m @ y + m @ (y[at] + along * sine + across * cosine)
    for part in LOBATTO_INSIDE:
        x, y = poses_along(arm, q, part)
        weight_x, weight_y = weight_x + 5 / 12 * arm.m_c @ x, weight_y + 5 / 12 * arm.m_c @ y
    return -(arm.g[0] * weight_x + arm.g[1] * weight_y)


def load_energy(arm: WholeArm, q: np.ndarray) -> Any:
    """Of the dead loads: -F . p - M theta, J."""
    x, y, theta = poses(arm, q)
    return -(arm.force[:, 0] @ x + arm.force[:, 1] @ y + arm.moment @ theta)


def cable_energy(arm: WholeArm, q: np.ndarray, tension: np.ndarray) -> Any:
    """Tension times length up to the anchor, J."""
    return np.sum(arm.tension_along(tension) * cable_lengths(arm, q))


def potential_energy(arm: WholeArm, q: np.ndarray, tension: np.ndarray) -> Any:
    """Of all that acts at rest, J."""
    core = elastic_energy(arm, q) + gravity_energy(arm, q)
    return core + load_energy(arm, q) + cable_energy(arm, q, tension)


# ---- derivatives of any function ----


def directional(function: Callable[[np.ndarray], Any], q: np.ndarray, direction: np.ndarray) -> Any:
    """Slope along a direction by a complex step: no difference is taken, so none is lost."""
    return np.imag(function(q + 1e-30j * direction)) / 1e-30


def gradient(function: Callable[[np.ndarray], Any], q: np.ndarray) -> np.ndarray:
    """All derivatives by the entries of q, shape (*q.shape, *value's shape)."""
    columns = np.eye(q.size).reshape(-1, *q.shape)
    values = np.array([directional(function, q, column) for column in columns])
    return values.reshape(*q.shape, *values.shape[1:])


def difference_matrix(
    function: Callable[[np.ndarray], np.ndarray], y: np.ndarray, steps: Iterable[float]
) -> np.ndarray:
    """Matrix of a vector's derivatives, shape (values, y.size), by central differences of sixth order."""
    columns = []
    for column, step in zip(np.eye(y.size), steps, strict=True):
        ahead = [function(y + k * step * column) - function(y - k * step * column) for k in (1, 2, 3)]
        columns.append((45 * ahead[0] - 9 * ahead[1] + ahead[2]) / (60 * step))
    return np.column_stack(columns)
