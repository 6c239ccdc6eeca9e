"""First natural frequency of an unloaded arm, to which a damping ratio refers.

Unloaded: in the shape it is made in, straight or of its reference curvature, without gravity, tension and
loads. There the stiffness is the core's alone, and Kelvin-Voigt damping is that stiffness times the
retardation time, so a mode's damping ratio is half its angular frequency times that time, exactly.
"""

from collections.abc import Iterator

import numpy as np

from statics.arm import Arm
from statics.core_mass import FRACTIONS
from statics.errors import InputError
from statics.scene import Scene

MOST_SEGMENTS = 500
"""Largest number of segments whose first mode is found: the matrices are dense."""
STEP = 1e-30
"""Imaginary step of derivatives."""


def retardation_time(scene: Scene, damping_ratio: float) -> float:
    """Retardation time (s) at which the first mode of the unloaded arm has this damping ratio.

    Raises ``InputError`` like ``first_frequency``.
    """
    return 2.0 * damping_ratio / first_frequency(scene)


def first_frequency(scene: Scene) -> float:
    """First natural frequency of the unloaded arm without damping, rad/s; its base is fixed.

    Masses count if the scene has ``inertia``, moments of inertia if it has ``rotary_inertia``. Raises
    ``InputError`` if numbers are missing, nothing has mass, or the segments are too many.
    """
    _check(scene)
    scaled = _momenta(scene) * np.sqrt(_flexibility(scene))
    largest = float(np.linalg.eigvalsh(scaled.T @ scaled).max())
    if largest <= 0.0:
        raise InputError(
            "damping_ratio: nothing has mass, so no mode has a frequency. Give retardation_time."
        )
    return 1.0 / np.sqrt(largest)


def _check(scene: Scene) -> None:
    arm, needed = scene.arm, ["youngs_modulus", "second_moment"]
    needed += ["area"] if "elongation" in scene.coordinates else []
    needed += ["disk_mass"] if scene.has("inertia") else []
    needed += ["disk_inertia"] if scene.has("rotary_inertia") else []
    for name in needed:
        if not arm.has(name):
            raise InputError(f"damping_ratio needs the arm's {name}. Give it, or retardation_time instead.")
    if not (scene.has("inertia") or scene.has("rotary_inertia")):
        raise InputError("damping_ratio needs inertia. Add inertia = {} to [effects].")
    if arm.segments > MOST_SEGMENTS:
        raise InputError(
            f"damping_ratio: {arm.segments} segments are too many to find their first mode. Allowed: "
            f"{MOST_SEGMENTS}. Give retardation_time, such as that of fewer segments."
        )


def _flexibility(scene: Scene) -> np.ndarray:
    """Inverse stiffness of each coordinate: all bend angles, then all elongations, if any."""
    columns = scene.arm.segment_columns()
    found = [columns["rest_length"] / columns["bending_stiffness"]]
    if "elongation" in scene.coordinates:
        found.append(columns["rest_length"] / columns["axial_stiffness"])
    return np.concatenate(found)


def _momenta(scene: Scene) -> np.ndarray:
    """Velocities times square roots of masses, by the rates of the coordinates, shape (rows, coordinates)."""
    arm, size = scene.arm, scene.arm.segments * len(scene.coordinates)
    changes = np.zeros((size, 2 * arm.segments), dtype=complex)
    changes[:, :size] = 1j * STEP * np.eye(size)
    bend_angle = arm.rest_lengths * _curvatures(arm) + changes[:, : arm.segments]
    length = arm.rest_lengths + changes[:, arm.segments :]
    rows = [
        np.sqrt(mass) * np.imag(displacement) / STEP
        for mass, displacements in _bodies(scene, bend_angle, length)
        for displacement in displacements
    ]
    return np.concatenate(rows, axis=-1).T


def _curvatures(arm: Arm) -> np.ndarray:
    return np.repeat(arm.per_disk("reference_curvature"), arm.subsegments)


def _bodies(
    scene: Scene, bend_angle: np.ndarray, length: np.ndarray
) -> Iterator[tuple[np.ndarray, tuple[np.ndarray, ...]]]:
    """Masses with their x and y, and moments of inertia with their angles, each (..., segments)."""
    arm, nodes = scene.arm, scene.arm.node_columns()
    theta = np.cumsum(bend_angle, axis=-1)
    near = theta - bend_angle

    def reach(part: float) -> tuple[np.ndarray, np.ndarray]:
        half = part * bend_angle / 2
        chord = part * length * np.sinc(half / np.pi)
        return chord * np.cos(near + half), chord * np.sin(near + half)

    along, across = reach(1.0)
    x, y = np.cumsum(along, axis=-1), np.cumsum(across, axis=-1)
    payloads = range(1, scene.payloads + 1)
    if scene.has("inertia"):
        yield nodes["node_mass"], (x, y)
        for number in payloads:
            d_x, d_y = nodes[f"payload_offset_x_{number}"], nodes[f"payload_offset_y_{number}"]
            place_x = x + d_x * np.cos(theta) - d_y * np.sin(theta)
            yield nodes[f"payload_mass_{number}"], (place_x, y + d_x * np.sin(theta) + d_y * np.cos(theta))
        for part in FRACTIONS if arm.core_density is not None else ():
            point_x, point_y = reach(part)
            yield arm.segment_columns()["core_point_mass"], (x - along + point_x, y - across + point_y)
    if scene.has("rotary_inertia"):
        for name in ("node_inertia", *(f"payload_inertia_{number}" for number in payloads)):
            yield nodes[name], (theta,)
