"""SoRoMoX: planar piecewise constant strain (PCS), which is this arm's own kinematics, integrated by Diffrax.

SoRoMoX spreads a segment's mass along it. Here the core's segments weigh next to nothing, and each disk is a
rigid segment a nanometre thick, whose density and radius give it the disk's mass and in-plane inertia. Its
stock tendon runs at a fixed distance along the arc; the straight way from hole to hole is a ``Transmission``
of our own, through the interface that SoRoMoX has for that.
"""

# pyright: reportMissingImports=false

from collections.abc import Callable, Iterator
from functools import partial
from math import pi, sqrt

import diffrax
import jax
import jax.numpy as jnp
import numpy as np
from scipy.optimize import fsolve
from soromox.actuation.core import (
    Actuator,
    ActuatorMetadata,
    DirectEffort,
    IdentityActuatorParams,
    Transmission,
)
from soromox.actuation.threadlike import ThreadlikeActuator, ThreadlikeRouting
from soromox.systems import LinkSpec, PlanarPCS, PlanarPCSStructure, SystemState

from .case import PAPER_DISKS, Answer, Case, Stopwatch, timed

jax.config.update("jax_enable_x64", True)

PACKAGES = ("soromox", "jax", "diffrax")
LACKS = "rigid disks and straight cables of its own; a cache of what it compiles, half a minute at 4 disks"
BENDING_LACKS = "extension, left out for speed; " + LACKS
ALONG_LACKS = "a cable straight from hole to hole: it bends along the arc; " + BENDING_LACKS
THICKNESS = 1e-8
"""Of the segments that stand for disks, m."""
WEIGHTLESS = 1e-6
"""Density of the core, kg/m^3."""
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
TOLERANCES_IF_STIFF = (1e-3, 1e-5)
TOLERANCES_IF_FINER = (1e-2, 1e-3, 1e-4, 1e-5)
MAX_STEPS = 2_000_000
REPEATS = 5


def answers(case: Case) -> Iterator[Answer]:
    """Diffrax's Kvaerno5: the straight cable without and with extension, and SoRoMoX's stock tendon.

    An arm cut finer than the paper's: the first of them, for each takes minutes to compile.
    """
    straight = StraightCable(Holes(jnp.arange(case.disks + 1) * case.L0, case.hole))
    route = ThreadlikeRouting.linear(
        intercept=jnp.array([0.0, case.hole, 0.0]),
        start_segment_index=0,
        end_segment_index=2 * case.disks - 1,
    )
    along = ThreadlikeActuator.tendons(route)
    models = (
        ("PCS, bending only", straight, False, BENDING_LACKS),
        ("PCS, extension", straight, True, LACKS),
        ("PCS, bending only, stock tendon", along, False, ALONG_LACKS),
    )
    papers = case.disks == PAPER_DISKS
    for model, cable, extends, lacks in models if papers else models[:1]:
        watch = Stopwatch()
        robot = _robot(case, cable, extends)
        start, solve = _at_rest(case, robot, extends), _solver(case, robot)
        solve(start, 1.0)
        ready = f"ready in {watch.seconds():.0f} s"
        tolerances = TOLERANCES if papers else TOLERANCES_IF_FINER
        for rtol in TOLERANCES_IF_STIFF if extends else tolerances:
            answer = timed(partial(solve, start, rtol), REPEATS if papers else 2)
            yield Answer(f"{model}, {ready}", f"Kvaerno5, rtol {rtol:.0e}", *answer, lacks)


class Holes(Transmission):
    """Minus the length of a cable, straight from hole to hole."""

    places: jax.Array
    offset: float

    @property
    def num_channels(self) -> int:
        """One cable."""
        return 1

    def coordinates(self, robot: PlanarPCS, q: jax.Array) -> jax.Array:
        """Minus its length, m."""
        theta, x, y = robot.forward_kinematics_abscissa_batched(q, self.places).T
        across, up = jnp.diff(x - self.offset * jnp.sin(theta)), jnp.diff(y + self.offset * jnp.cos(theta))
        return -jnp.sum(jnp.sqrt(across**2 + up**2))[None]

    def moment_matrix(self, robot: PlanarPCS, q: jax.Array) -> jax.Array:
        """Its derivatives by the coordinates."""
        return jax.jacfwd(lambda q: self.coordinates(robot, q))(q).T


class StraightCable(Actuator):
    """A cable through holes whose control is its tension."""

    holes: Holes

    transmission = property(lambda self: self.holes)
    effort_model = property(lambda self: DirectEffort())
    params = property(lambda self: IdentityActuatorParams())
    metadata = property(lambda self: ActuatorMetadata(labels=("cable",), units="N", kind="tendon"))

    def with_params(self, params: IdentityActuatorParams) -> "StraightCable":
        """Nothing can be changed."""
        del params
        return self


def _robot(case: Case, cable: Actuator, extends: bool) -> PlanarPCS:
    """Core and disks by turns; of all strains, the core's bending, and maybe extension, are free."""
    radius = 2 * sqrt(case.inertia / case.mass)
    density = case.mass / (pi * radius**2 * THICKNESS)
    stiffness = np.diag([case.EJ * case.L0, case.EA * case.L0, 1.0])
    links = []
    for disk in range(case.disks):
        core = case.L0 - THICKNESS * (1.0 if disk else 0.5)
        links += [
            LinkSpec.circular(
                radius=radius,
                length=length,
                density=dense,
                reference_strain=jnp.array([0.0, 1.0, 0.0]),
                stiffness=stiffness,
                damping=case.retardation * stiffness,
            )
            for length, dense in ((core, WEIGHTLESS), (THICKNESS, density))
        ]
    free = jnp.array(([True, extends, False] + [False] * 3) * case.disks)
    structure = PlanarPCSStructure(num_gauss_points=1, strain_selector=free)
    gravity = jnp.array(case.gravity)
    return PlanarPCS.from_links(
        links, structure=structure, gravity=gravity, actuators=cable, base_pose=jnp.zeros(3)
    )


def _at_rest(case: Case, robot: PlanarPCS, extends: bool) -> jax.Array:
    """State at rest without tension: strains, and no rates."""
    strains = case.rest[:, : 1 + extends].ravel() / case.L0
    if not extends:  # with extension, the same equations rest where the program's do
        force = jax.jit(lambda q: robot.elastic_force(q) + robot.gravitational_force(q))
        strains = fsolve(lambda q: np.array(force(q)), strains, xtol=1e-10)
    return jnp.concatenate([jnp.array(strains), jnp.zeros(strains.size)])


def _solver(case: Case, robot: PlanarPCS) -> Callable[[jax.Array, float], np.ndarray]:
    """Solve from a state at a tolerance, compiled once, and return the tip at the samples."""
    samples, end = jnp.array(case.samples), jnp.array(case.disks * case.L0)

    def solve(start: jax.Array, rtol: float) -> jax.Array:
        states = robot.rollout_to(
            SystemState(t=0.0, y=start, u=jnp.array([case.tension])),
            t1=case.duration,
            solver_dt=1e-6,
            save_ts=samples,
            solver=diffrax.Kvaerno5(),
            stepsize_controller=diffrax.PIDController(rtol=rtol, atol=rtol),
            max_steps=MAX_STEPS,
        ).y
        return jax.vmap(lambda q: robot.forward_kinematics(q, end)[1:])(states[:, : robot.num_internal_dofs])

    compiled = jax.jit(solve)
    return lambda start, rtol: np.array(compiled(start, rtol))
