"""Bordered systems of equilibrium paths: coordinates and the ramp's parameter are unknown together.

Along a ramp of inputs both the coordinates q and the ramp's parameter are unknown, and the step is given as
a length along the path (Riks 1979; Crisfield 1981; Keller 1977):

    r(q, parameter) = 0      t . (q - q0, parameter - parameter0) = length

with t the path's unit tangent. The bordered system takes two solutions with the elimination along the chain,
for -r and for -dr/dparameter, so a step costs O(n).
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from statics.equilibria import StaticSolver
from statics.passes import newton, search

SHORTEST_STEP = 1e-9
"""Shortest step along the path: rad, and points of the ramp."""
MOST_CORRECTIONS = 10
INVERSE_ITERATIONS = 3
"""Number of iterations for the least stiff mode."""
STIFFNESS_DIFFERENCE = 1e-4
"""Length along the path by which the stiffness is differenced."""
HALF_DIFFERENCE = 0.5
"""Change of the parameter by which the residual is differenced: tensions and factors are linear in it."""
NEARBY = 1e-6
"""Change of the parameter instead if cables driven by their length may go slack or catch nearby."""
LOCATED = 1e-13
"""Part of a step's length within which folds, limits and points of the ramp are located."""


class PathPoint(NamedTuple):
    """A point of the path: coordinates, parameter of the ramp, unit tangent, results of the elimination.

    ``leg`` is the ramp's leg that the path is on, counted from 0: its inputs are linear from the point of
    that number to the next one, and beyond both.
    """

    q: np.ndarray
    parameter: float
    leg: int
    along: np.ndarray
    along_parameter: float
    negative: int
    clearance: float
    corrections: int = 0


class _LostError(Exception):
    """A point between two of the path is not found: the step was too long."""


class BorderedSystem:
    """The bordered systems of one scene along one ramp of inputs, shape (points, inputs)."""

    def __init__(self, solver: StaticSolver, ramp: np.ndarray) -> None:
        self.solver, self.kernel = solver, solver.kernel
        self.ramp = np.ascontiguousarray(ramp, dtype=float)
        segments, dofs = solver.scene.arm.segments, len(solver.scene.coordinates)
        self.chain = np.empty((segments, self.kernel.widths["chain"]))
        units = np.array([1.0, solver.scene.arm.rest_length])[:dofs]
        self.by_length = solver.scene.driven_by_length
        self.half_difference = NEARBY if self.by_length else HALF_DIFFERENCE
        self.push = np.random.default_rng(0).standard_normal((segments, dofs)) / units
        self.weight = segments / units**2
        """Scale by which a uniform bend of the arm counts as its angle, for any number of segments."""

    def inputs(self, parameter: float, leg: int) -> np.ndarray:
        """Inputs at a parameter, on a leg of the ramp or on its straight continuation."""
        if parameter == leg + 1:
            return self.ramp[leg + 1]
        return self.ramp[leg] + (parameter - leg) * (self.ramp[leg + 1] - self.ramp[leg])

    def leg_from(self, point: float, way: float) -> int:
        """The leg that starts at a point of the ramp, forwards or backwards; at its ends the only one."""
        return min(max(int(point) - (way < 0.0), 0), len(self.ramp) - 2)

    def residual(self, q: np.ndarray, inputs: np.ndarray) -> tuple[np.ndarray, float]:
        """Unbalanced generalized forces, shape of q, and the clearance."""
        solver, residual = self.solver, np.empty_like(q)
        numbers = (inputs, solver.segments, solver.disks, self.chain)
        return residual, newton.unbalanced(self.kernel.passes, q, *numbers, residual)

    def by_parameter(self, q: np.ndarray, parameter: float, leg: int) -> np.ndarray:
        """Derivative of the residual by the ramp's parameter."""
        way = self.ramp[leg + 1] - self.ramp[leg]
        ahead, behind = (self.inputs(parameter, leg) + sign * self.half_difference * way for sign in (1, -1))
        return (self.residual(q, ahead)[0] - self.residual(q, behind)[0]) / (2 * self.half_difference)

    def taut(self, at: PathPoint) -> list[bool]:
        """Whether each cable pulls at a point: those driven by their length may be slack."""
        solver, pose = self.solver, np.empty((len(at.q), 3))
        inputs = self.inputs(at.parameter, at.leg)
        numbers = (inputs, solver.segments, solver.disks, self.chain)
        self.kernel.run("observe", at.q, *numbers, pose)
        disks = pose[solver.scene.arm.disk_nodes].T
        return (solver.scene.driven_by(inputs, *disks)["tension"] > 0.0).tolist()

    def solve(self, right: np.ndarray) -> tuple[np.ndarray, int]:
        """-H^-1 right, for the q of the last ``residual``; and the number of H's negative eigenvalues."""
        solver, change = self.solver, np.empty_like(right)
        numbers = (solver.segments, solver.disks, self.chain, right, change)
        return change, newton.solve_exactly(self.kernel.passes, *numbers)

    def softest_push(self, at: PathPoint) -> np.ndarray:
        """Forces, shape of q, near those of the least stiff mode, by inverse iteration."""
        self.residual(at.q, self.inputs(at.parameter, at.leg))
        push = self.push
        for _ in range(INVERSE_ITERATIONS):
            push = self.solve(push)[0] * self.weight
            push /= np.abs(push).max()
        return push

    def stiffness(self, q: np.ndarray, inputs: np.ndarray, push: np.ndarray) -> float:
        """Stiffness against a push: it changes its sign where the matrix is singular."""
        self.residual(q, inputs)
        return -1.0 / float(np.sum(push * self.solve(push)[0]))

    def stiffness_along(self, at: PathPoint, push: np.ndarray) -> tuple[float, float]:
        """The stiffness at a point, and its derivative along the path."""
        step = STIFFNESS_DIFFERENCE
        nearby = self.inputs(at.parameter + step * at.along_parameter, at.leg)
        here = self.stiffness(at.q, self.inputs(at.parameter, at.leg), push)
        return here, (self.stiffness(at.q + step * at.along, nearby, push) - here) / step

    def tangent_at(self, q: np.ndarray, parameter: float, leg: int = 0) -> tuple[np.ndarray, int, float]:
        """dq/dplace along the path, the number of unstable directions, and the clearance."""
        by_parameter = self.by_parameter(q, parameter, leg)
        clearance = self.residual(q, self.inputs(parameter, leg))[1]
        return *self.solve(by_parameter), clearance

    def point_at(
        self,
        q: np.ndarray,
        parameter: float,
        leg: int,
        towards: tuple[np.ndarray, float],
        corrections: int = 0,
    ) -> PathPoint:
        """An equilibrium as a point of the path, with the tangent in that direction."""
        by_parameter, negative, clearance = self.tangent_at(q, parameter, leg)
        length = np.sqrt(self.inner(by_parameter, by_parameter) + 1.0)
        ahead = self.inner(by_parameter, towards[0]) + towards[1] >= 0.0
        length = length if ahead else -length
        tangent = by_parameter / length, 1.0 / length
        return PathPoint(q, parameter, leg, *tangent, negative, clearance, corrections)

    def inner(self, one: np.ndarray, other: np.ndarray) -> float:
        """Scalar product of two changes of coordinates, in rad^2."""
        return float(np.sum(self.weight * one * other))

    def corrected(self, here: PathPoint, length: float) -> PathPoint | None:
        """The point of the path that far along its tangent, by Newton's method; None if it is not found."""
        q, parameter = here.q + length * here.along, here.parameter + length * here.along_parameter
        size, leg = np.inf, here.leg
        for correction in range(1, MOST_CORRECTIONS + 1):
            by_parameter = self.by_parameter(q, parameter, leg)
            residual, _ = self.residual(q, self.inputs(parameter, leg))
            change, _ = self.solve(residual)
            turning, _ = self.solve(by_parameter)
            lacking = length - self.inner(here.along, q - here.q)
            lacking -= here.along_parameter * (parameter - here.parameter) + self.inner(here.along, change)
            step = lacking / (self.inner(here.along, turning) + here.along_parameter)
            change += step * turning
            last, size = size, np.abs(change * np.sqrt(self.weight)).max() + abs(step)
            if not size < 10.0 * max(length, SHORTEST_STEP):
                return None
            q, parameter = q + change, parameter + step
            if size < search.AT_REST and not (self.by_length and size < search.FALLING * last):
                return self.point_at(q, parameter, leg, (here.along, here.along_parameter), correction)
        return None

    def at_point(self, near: PathPoint, point: float, way: float) -> tuple[PathPoint, PathPoint]:
        """The equilibrium at exactly a point of the ramp, from one within rounding of it.

        One point before it and one after it, in the direction ``way``, 1 or -1: the ramp may have a corner
        there, or turn back.
        """
        residual, _ = self.residual(near.q, self.inputs(point, near.leg))
        q = near.q + self.solve(residual)[0]
        towards = 0.0 * q, way
        coming, going = (
            self.point_at(q, point, leg, towards) for leg in (near.leg, self.leg_from(point, way))
        )
        return coming, going

    def located(
        self, here: PathPoint, there: float, value: Callable[[PathPoint], float], within: float = LOCATED
    ) -> tuple[PathPoint, float] | None:
        """Point up to ``there`` at which a value changes sign, and its distance; None if lost."""
        from scipy.optimize import brentq  # every run loads this module, few follow a path, and SciPy is slow

        found: dict[float, PathPoint] = {0.0: here}

        def value_at(length: float) -> float:
            if length not in found:
                point = self.corrected(here, length)
                if point is None:
                    raise _LostError
                found[length] = point
            return value(found[length])

        try:
            length = float(brentq(value_at, 0.0, there, xtol=within * there, rtol=8.9e-16))  # pyright: ignore[reportArgumentType]
        except _LostError:
            return None
        return found[length], length
