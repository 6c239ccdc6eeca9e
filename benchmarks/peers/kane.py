"""sympy's KanesMethod, lambdify and SciPy's solve_ivp: the equations of the whole arm, derived at once.

The arm is the paper's (Rone and Ben-Tzvi 2012, Eq. 10-24): constant curvature, disks as rigid bodies, the
cable's pulls from hole to hole. Arcs are written as power series in the bend angle, so that a straight
segment divides nothing by zero; at the angles of this motion the terms left out are below 1e-17.
"""

from collections.abc import Callable, Iterator
from math import factorial
from typing import Any

import numpy as np
import sympy as sp
from numba import njit  # pyright: ignore[reportMissingImports]: a peer's, see requirements.txt
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve
from sympy.physics.mechanics import KanesMethod, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia

from .case import PAPER_DISKS, Answer, Case, Stopwatch, timed

PACKAGES = ("sympy", "scipy", "numba")
LACKS = "a cache of what it derives and compiles; the whole arm's equations grow steeply with the disks"
BENDING_LACKS = "extension, left out for speed; " + LACKS
SETTINGS = [("Radau", 10.0**-k) for k in (2, 3, 4)] + [("LSODA", 10.0**-k) for k in (3, 4, 5, 6, 7)]
QUICKEST = [("LSODA", 10.0**-k) for k in (3, 4, 5)]
"""Those, without extension and by numba, that stay when the arm is cut finer than the paper's."""
REPEATS = 5
TERMS = 6
"""Terms of the power series of an arc."""

Forces = Callable[[np.ndarray, np.ndarray, float], tuple[np.ndarray, np.ndarray]]
"""Mass matrix and forcing at bends and elongations, their rates, and a tension."""


def answers(case: Case) -> Iterator[Answer]:
    """With and without extension, on lambdified numpy and on the same source compiled by numba."""
    papers = case.disks == PAPER_DISKS
    for extends, lacks in ((False, BENDING_LACKS), (True, LACKS))[: 2 if papers else 1]:
        watch = Stopwatch()
        written = _lambdified(case, extends)
        derived = f"derived in {watch.seconds():.1f} s"
        start = _at_rest(case, written, extends)
        for compiled in (False, True) if papers else (True,):
            model = f"Kane, {'extension' if extends else 'bending only'}, {'numba' if compiled else 'numpy'}"
            rate = _rate(njit(written) if compiled else written, compiled)
            for method, rtol in SETTINGS if papers else QUICKEST:
                solve = _solver(case, rate, start, method, rtol)
                answer = timed(solve, REPEATS)
                yield Answer(f"{model}, {derived}", f"{method}, rtol {rtol:.0e}", *answer, lacks)


def _lambdified(case: Case, extends: bool) -> Forces:
    """Mass matrix and forcing by Kane's method, as one numpy function."""
    q = dynamicsymbols(f"q1:{case.disks * (1 + extends) + 1}")
    u = dynamicsymbols(f"u1:{case.disks * (1 + extends) + 1}")
    tension = sp.Symbol("tension")
    frames, centers = _disks(case, q, u)
    base, bodies, loads = frames[0], [], []
    for frame, center in zip(frames[1:], centers[1:], strict=True):
        moment = inertia(frame, 0, 0, case.inertia)
        bodies.append(RigidBody(f"body_{center.name}", center, frame, case.mass, (moment, center)))
        weight = case.mass * (case.gravity[0] * base.x + case.gravity[1] * base.y)
        loads.append((center, weight))
    loads += _cable(case, tension, frames, centers)
    kane = KanesMethod(base, q, u, kd_eqs=[sp.diff(x, "t") - v for x, v in zip(q, u, strict=True)])
    kane.kanes_equations(bodies, loads)
    stiffness = [case.EJ / case.L0] * case.disks + [case.EA / case.L0] * (case.disks * extends)
    core = [-k * (x + case.retardation * v) for k, x, v in zip(stiffness, q, u, strict=True)]
    return sp.lambdify([q, u, tension], (kane.mass_matrix, kane.forcing + sp.Matrix(core)), "numpy", cse=True)


def _disks(case: Case, q: list[Any], u: list[Any]) -> tuple[list[ReferenceFrame], list[Point]]:
    """Frames and centres of the base and of all disks, with their velocities."""
    frames, centers = [ReferenceFrame("N")], [Point("O")]
    base = frames[0]
    centers[0].set_vel(base, 0)
    phis, rates = q[: case.disks], u[: case.disks]
    to_rates = {sp.diff(x, "t"): v for x, v in zip(q, u, strict=True)}
    for i, phi in enumerate(phis):
        length = case.L0 + (q[case.disks + i] if len(q) > case.disks else 0)
        x = length * sum((-1) ** k * phi ** (2 * k) / factorial(2 * k + 1) for k in range(TERMS))
        y = length * sum((-1) ** k * phi ** (2 * k + 1) / factorial(2 * k + 2) for k in range(TERMS))
        near, frame = frames[-1], ReferenceFrame(f"A{i + 1}")
        frame.orient_axis(base, sum(phis[: i + 1]), base.z)
        frame.set_ang_vel(base, sum(rates[: i + 1]) * base.z)
        center = centers[-1].locatenew(f"P{i + 1}", x * near.x + y * near.y)
        center.set_vel(near, sum((sp.diff(r, "t").subs(to_rates) * e for r, e in ((x, near.x), (y, near.y)))))
        center.v1pt_theory(centers[-1], base, near)
        frames.append(frame)
        centers.append(center)
    return frames, centers


def _cable(case: Case, tension: Any, frames: list[ReferenceFrame], centers: list[Point]) -> list[Any]:
    """The cable's pulls on the two disks of every segment (Eq. 22-24)."""
    holes = []
    for frame, center in zip(frames, centers, strict=True):
        holes.append(center.locatenew(f"{center.name}_hole", case.hole * frame.y))
        holes[-1].v2pt_theory(center, frames[0], frame)
    loads: list[Any] = []
    for near, hole, frame in zip(holes, holes[1:], frames, strict=False):
        pull = tension * hole.pos_from(near).express(frame).normalize()
        loads += [(near, pull), (hole, -pull)]
    return loads


def _rate(forces: Any, compiled: bool) -> Callable[[float, np.ndarray, float], np.ndarray]:
    """Right-hand side for ``solve_ivp``."""

    def rate(_t: float, state: np.ndarray, tension: float) -> np.ndarray:
        size = state.size // 2
        mass, forcing = forces(state[:size], state[size:], tension)
        return np.concatenate((state[size:], np.linalg.solve(mass, forcing)[:, 0]))

    return njit(rate) if compiled else rate


def _at_rest(case: Case, forces: Forces, extends: bool) -> np.ndarray:
    """State at rest without tension."""
    rest = case.rest.T.ravel()
    if not extends:  # with extension, the same equations rest where the program's do
        guess = rest[: case.disks]
        rest = fsolve(lambda q: forces(q, 0.0 * q, 0.0)[1][:, 0], guess, xtol=1e-10)
    return np.concatenate([rest, 0.0 * rest])


def _solver(case: Case, rate: Any, start: np.ndarray, method: Any, rtol: float) -> Callable[[], np.ndarray]:
    """Solve, and return the tip at the samples."""
    scale = np.ones(case.disks) if start.size == 2 * case.disks else np.repeat([1.0, case.L0], case.disks)
    atol = 1e-2 * rtol * np.concatenate([scale, scale * 100.0])

    def solve() -> np.ndarray:
        found = solve_ivp(
            rate,
            (0.0, case.duration),
            start,
            method,
            case.samples,
            rtol=rtol,
            atol=atol,
            args=(case.tension,),
        )
        return _tip(case, found.y[: start.size // 2])

    return solve


def _tip(case: Case, q: np.ndarray) -> np.ndarray:
    """Tip from bends and elongations, shape (samples, 2). Rone 2012, Eq. 10-12."""
    phi = q[: case.disks]
    length = case.L0 + (q[case.disks :] if len(q) > case.disks else 0.0 * phi)
    chord, angle = length * np.sinc(phi / (2 * np.pi)), np.cumsum(phi, axis=0) - phi / 2
    return np.column_stack([np.sum(chord * np.cos(angle), axis=0), np.sum(chord * np.sin(angle), axis=0)])
