"""Rone and Ben-Tzvi 2012 as printed: the whole arm, dense, in the printed coordinates (k, L).

Kept to reproduce the paper and for nothing else: the axial force of Eq. 21 does not balance and is not
conservative (docs/theory/rone2012.md). Equations 6 to 25 stand here in the paper's letters, Eq. 22-25 in
``statics.effects.cables.disk_loads``; the poses of all disks have shape (n, 3), the generalized coordinates
(k_1, L_1, ... k_n, L_n) shape (2 n,). Nothing here knows the segment, the chain or the kernels.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import root
from scipy.special import spherical_jn

from statics.effects import Bending, Cables, Extension, Gravity
from statics.effects.cables import disk_loads
from statics.errors import ContinuumError, InputError
from statics.scene import Scene

EFFECTS = (Bending.name, Cables.name, Extension.name, Gravity.name)

ACCEPTED = 1e-9  # N and N m^2: "the maximum error in constraint is on the order of 1e-9", section IV
STEP_TOLERANCE = 1e-14  # relative: rounding of L alone leaves 2e-11 N, as EA (L - L0) / L0


class PrintedError(ContinuumError):
    """No solution of the printed equations was found."""


@dataclass(frozen=True)
class PrintedShape:
    """A solution of the printed equations: arrays of shape (n,), SI units.

    ``residual`` is the largest generalized force left over, N or N m^2.
    """

    curvature: np.ndarray
    length: np.ndarray
    disk_x: np.ndarray
    disk_y: np.ndarray
    disk_theta: np.ndarray
    residual: float

    @property
    def tip(self) -> tuple[float, float, float]:
        """x, y (m) and theta (rad) of the last disk."""
        return float(self.disk_x[-1]), float(self.disk_y[-1]), float(self.disk_theta[-1])


@dataclass(frozen=True)
class PrintedArm:
    """The equations of one scene, from bending, extension, gravity and cables.

    ``axial_sign`` is 1 for Eq. 21 as printed, -1 for the same with its sign reversed, 0 to leave it out.
    Raises ``InputError`` for a scene that the paper's equations do not describe.
    """

    scene: Scene
    axial_sign: float = 1.0

    def __post_init__(self) -> None:
        arm = self.scene.arm
        if tuple(effect.name for effect in self.scene.at_rest.effects) != EFFECTS:
            raise InputError(f"the printed equations have these effects, all of them: {', '.join(EFFECTS)}.")
        if arm.base is not None:
            raise InputError("the printed equations have the base at the origin, along x: leave out base.")
        if arm.subsegments > 1 or arm.core_density is not None or arm.reference_curvature:
            raise InputError(
                "the printed equations have one segment from disk to disk, straight at rest, "
                "and no mass of the core: leave out subsegments, reference_curvature and core_density."
            )

    def generalized_force(self, q: np.ndarray, tension: np.ndarray) -> np.ndarray:
        """Q_i, zero at rest, shape (2 n,), N m^2 for each k and N for each L. Rone 2012, Eq. 5, 7 and 8."""
        k, L = q[0::2], q[1::2]
        p = poses(k, L)
        F_act, M_act = disk_loads(self.scene.arm, tension, *p.T)
        F = self.weights() + self.axial_forces(L, p[:, 2]) + F_act
        M = self.bending_moments(k) + M_act
        return np.einsum("ja,jai->i", np.column_stack([F, M]), jacobians(k, L))

    def weights(self) -> np.ndarray:
        """F_g of each disk, shape (n, 2), N. Rone 2012, Eq. 19."""
        gravity = next(effect for effect in self.scene.effects if isinstance(effect, Gravity))
        return np.outer(self.scene.arm.node_columns()["node_mass"], gravity.acceleration)

    def bending_moments(self, k: np.ndarray) -> np.ndarray:
        """M_b on each disk, shape (n,), N m. Rone 2012, Eq. 20."""
        EJ = self.scene.arm.segment_columns()["bending_stiffness"]
        return EJ * np.diff(k, append=0.0)

    def axial_forces(self, L: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """F_ax on each disk, shape (n, 2), N. Rone 2012, Eq. 21."""
        L0, EA = self.scene.arm.rest_length, self.scene.arm.segment_columns()["axial_stiffness"]
        along = self.axial_sign * EA / L0 * -np.diff(L, append=L0)
        return along[:, None] * np.column_stack([np.cos(theta), np.sin(theta)])

    def solve(self, tension: object) -> PrintedShape:
        """The solution reached from the straight arm under one tension for each cable, N.

        Powell's hybrid method, a trust-region dogleg like the paper's, on k L0 and L / L0, for which the
        equations have one unit, N m. Raises ``PrintedError`` if more than the paper's 1e-9 is left.
        """
        values, L0 = self.scene.check_tension(tension), self.scene.arm.rest_length
        unit = np.tile([1.0 / L0, L0], self.scene.arm.segments)
        found = root(
            lambda x: unit * self.generalized_force(unit * x, values),
            np.tile([0.0, 1.0], self.scene.arm.segments),
            method="hybr",
            options={"xtol": STEP_TOLERANCE},
        )
        q = unit * found.x
        residual = float(np.abs(self.generalized_force(q, values)).max())
        if residual > ACCEPTED:
            raise PrintedError(
                f"the printed equations are not solved under {values.tolist()} N: {residual:.1e} N is left."
            )
        k, L = q[0::2], q[1::2]
        x, y, theta = poses(k, L).T
        return PrintedShape(k, L, x, y, theta, residual)


def local_poses(k: np.ndarray, L: np.ndarray) -> np.ndarray:
    """p_lcl, each segment's end in its own frame, shape (n, 3). Rone 2012, Eq. 11.

    sin(k L) / k and (1 - cos(k L)) / k, written so that a straight segment divides nothing by zero.
    """
    half = k * L / 2
    x = L * _sinc(k * L)
    y = L * _sinc(half) * np.sin(half)
    return np.column_stack([x, y, k * L])


def local_jacobians(k: np.ndarray, L: np.ndarray) -> np.ndarray:
    """Derivatives of p_lcl by its own k and L, shape (n, 3, 2). Rone 2012, Eq. 14 and 18.

    (k L cos(k L) - sin(k L)) / k^2 is -L^2 j_1(k L), with the spherical Bessel function j_1, and
    (k L sin(k L) + cos(k L) - 1) / k^2 is L^2 (sinc(k L) - sinc(k L / 2)^2 / 2): both exact where k is 0.
    """
    phi = k * L
    x_k = -(L**2) * spherical_jn(1, phi)
    y_k = L**2 * (_sinc(phi) - _sinc(phi / 2) ** 2 / 2)
    by_k, by_L = [x_k, y_k, L], [np.cos(phi), np.sin(phi), k]
    return np.stack([np.column_stack(by_k), np.column_stack(by_L)], axis=-1)


def transformation(theta: float) -> np.ndarray:
    """T of a disk at that angle, shape (3, 3). Rone 2012, Eq. 12."""
    c, s = np.cos(theta), np.sin(theta)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def transformation_slope(theta: float) -> np.ndarray:
    """Derivative of T by theta, shape (3, 3). Rone 2012, Eq. 17."""
    c, s = np.cos(theta), np.sin(theta)
    return np.array([[-s, -c, 0.0], [c, -s, 0.0], [0.0, 0.0, 0.0]])


def poses(k: np.ndarray, L: np.ndarray) -> np.ndarray:
    """p, x, y and theta of every disk, shape (n, 3), m and rad. Rone 2012, Eq. 9 and 10."""
    p = np.zeros((k.size + 1, 3))
    for i, p_lcl in enumerate(local_poses(k, L), start=1):
        p[i] = p[i - 1] + transformation(p[i - 1, 2]) @ p_lcl
    return p[1:]


def jacobians(k: np.ndarray, L: np.ndarray) -> np.ndarray:
    """Derivatives of every disk's pose by (k_1, L_1, ... k_n, L_n), shape (n, 3, 2 n).

    Rone 2012, Eq. 13-18.
    """
    p_lcl, by_own = local_poses(k, L), local_jacobians(k, L)
    theta = np.cumsum(k * L) - k * L  # of the disk before
    by_q = np.zeros((k.size + 1, 3, 2 * k.size))
    for i in range(k.size):
        by_theta = transformation_slope(theta[i]) @ p_lcl[i]
        by_q[i + 1] = by_q[i] + np.outer(by_theta, by_q[i, 2])  # Eq. 15-16
        by_q[i + 1][:, 2 * i : 2 * i + 2] += transformation(theta[i]) @ by_own[i]
    return by_q[1:]


def _sinc(angle: np.ndarray) -> np.ndarray:
    return np.sinc(angle / np.pi)
