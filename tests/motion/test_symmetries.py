"""What must not change an answer, in random scenes: the mirror, units, the view, order."""

from collections.abc import Callable
from dataclasses import fields, is_dataclass, replace
from math import prod
from typing import Any

import numpy as np
from hypothesis import strategies as st
from random_scenes import (
    KINDS,
    Case,
    accelerations,
    at_rest,
    dynamics_of,
    holds_in,
    let_out,
    powers,
    quantity_of,
    within,
)

from statics import Base, DiskLoads, Equilibrium, Gravity, Scene
from statics.quantities import QUANTITIES

Factor = Callable[[str], float | np.ndarray]
"""What the quantity of a name is multiplied by; of a vector, both components."""
SAME = 1e-11
"""rad, m per L0: answers closer than this are the same but for rounding."""
ANSWERS = ("bend_angle", "elongation", "curvature", "length", "disk_x", "disk_y", "disk_theta")
ANSWERS += ("base_x", "base_y", "base_theta", "tension", "cable_displacement", "load_factor")
ANSWERS += ("elastic_energy", "gravity_energy")


def multiplied(thing: Any, factor: Factor) -> Any:
    """A part of a scene with every number in it multiplied by the factor of its name."""
    return replace(thing, **{f.name: _product(f.name, getattr(thing, f.name), factor) for f in fields(thing)})


def _product(name: str, value: Any, factor: Factor) -> Any:
    if is_dataclass(value):
        return multiplied(value, factor)
    if isinstance(value, float):
        return float(value * factor(name))
    if isinstance(value, tuple) and value and isinstance(value[0], float):
        return tuple((np.array(value) * factor(name)).tolist())
    return tuple(multiplied(part, factor) for part in value) if isinstance(value, tuple) else value


def changed(case: Case, factor: Factor) -> Case:
    """The case with every number multiplied by the factor of its name."""
    scene = Scene(multiplied(case.scene.arm, factor), (multiplied(e, factor) for e in case.scene.effects))
    inputs = {name: value * float(factor(quantity_of(name))) for name, value in case.inputs.items()}
    of_q, of_u = np.array([[factor(name), factor(f"{name}_rate")] for name in scene.coordinates]).T
    return Case(scene, inputs, case.q * of_q, case.u * of_u)


def assert_multiplied(found: Equilibrium, plain: Equilibrium, factor: Factor) -> None:
    """Every answer has gone by its factor to the last bit, in as many iterations."""
    assert found.outcome is plain.outcome
    assert found.iterations == plain.iterations
    for name in ANSWERS:
        if (value := getattr(plain, name)) is not None:
            np.testing.assert_array_equal(getattr(found, name), value * factor(name), err_msg=name)


# ---- the mirror ----

ODD = {"reference_curvature", "hole_offset", "angle", "y", "moment", "curvature"}
ODD |= {"bend_angle", "bend_angle_rate", "disk_y", "disk_theta", "base_y", "base_theta"}
ODD |= {"base_velocity_y", "base_angular_velocity", "base_acceleration_y", "base_angular_acceleration"}
VECTORS = {"force", "acceleration", "offset"}


def mirror(name: str) -> float | np.ndarray:
    """Across the x axis: what has a sense of rotation or points along y changes its sign."""
    if name in VECTORS:
        return np.array([1.0, -1.0])
    return -1.0 if name in ODD else 1.0


# ---- units ----


def units(length: float, mass: float, time: float) -> Factor:
    """Numbers by the units of the glossary, in units of length, mass and time that are this much smaller."""
    known = {"1": 1.0, "rad": 1.0, "m": length, "kg": mass, "s": time, "Hz": 1 / time}
    known["N"] = mass * length / time**2
    known |= {"J": known["N"] * length, "W": known["N"] * length / time, "Pa": known["N"] / length**2}

    def product(text: str) -> float:
        parts = (part.partition("^") for part in text.split())
        return prod(known[unit] ** int(power or 1) for unit, _, power in parts)

    def factor(name: str) -> float:
        above, _, below = QUANTITIES[name].unit.partition("/")
        return product(above) / product(below)

    return factor


POWER_OF_TWO = st.integers(-6, 6).map(lambda power: 2.0**power)
"""Then nothing is rounded differently, and any number without its unit shows."""


# ---- the view ----


def rotated(vector: tuple[float, float], angle: float) -> tuple[float, float]:
    turned = complex(*vector) * np.exp(1j * angle)
    return turned.real, turned.imag


def turned_effect(effect: Any, angle: float) -> Any:
    """Gravity and dead forces; what follows its disk turns with the arm."""
    if isinstance(effect, Gravity):
        return Gravity(rotated(effect.acceleration, angle))
    if not isinstance(effect, DiskLoads):
        return effect
    dead = (replace(load, force=rotated(load.force, angle)) for load in effect.loads)
    pairs = zip(effect.loads, dead, strict=True)
    return DiskLoads(tuple(load if load.follower else turned for load, turned in pairs))


def turned(case: Case, angle: float) -> Case:
    """Base, gravity and dead loads turned about the origin; an arm without a base has one then."""
    arm, inputs = case.scene.arm, dict(case.inputs)
    x, y, theta = arm.base_pose
    mounted = Base(*rotated((x, y), angle), theta + angle, moves=arm.base_moves)
    inputs |= {"base_x": mounted.x, "base_y": mounted.y, "base_theta": mounted.angle}
    for rate in ("velocity", "acceleration") if arm.base_moves else ():
        names = f"base_{rate}_x", f"base_{rate}_y"
        inputs |= dict(zip(names, rotated((inputs[names[0]], inputs[names[1]]), angle), strict=True))
    effects = [turned_effect(effect, angle) for effect in case.scene.effects]
    return Case(Scene(replace(arm, base=mounted), effects), inputs, case.q, case.u)


def assert_same_motion(found: Case, plain: Case) -> None:
    """Accelerations differ by less than what 1e-11 rad, or that part of a segment, would change them."""
    dynamics, y, interval = dynamics_of(plain)
    size, parts = dynamics.size, len(plain.scene.coordinates)
    unit = np.tile([1.0, plain.scene.arm.rest_length][:parts], plain.scene.arm.segments)
    slopes = np.abs(dynamics.jacobian(0.0, y, interval)[size : 2 * size, :size]) @ unit
    difference = np.abs(accelerations(found) - accelerations(plain)).ravel()
    assert (difference <= SAME * slopes).all()


# ---- order ----


def reordered(case: Case) -> Case:
    """Effects, cables, loads and payloads from the last to the first."""
    arm, inputs = case.scene.arm, dict(case.inputs)
    effects = [
        DiskLoads(effect.loads[::-1]) if isinstance(effect, DiskLoads) else effect
        for effect in reversed(case.scene.effects)
    ]
    scene = Scene(replace(arm, cables=arm.cables[::-1], payloads=arm.payloads[::-1]), effects)
    counts = {"load_factor": scene.driven_loads} | dict.fromkeys(OF_CABLES, scene.cables)
    for quantity, count in counts.items():
        for number in range(1, count + 1):
            if (name := f"{quantity}_{number}") in inputs:
                inputs[name] = case.inputs[f"{quantity}_{count + 1 - number}"]
    return Case(scene, inputs, case.q, case.u)


OF_CABLES = ("tension", "cable_displacement", "cable_displacement_rate")


# ---- claims: each case costs most where it is drawn and solved as it stands, so it serves for all ----

CHANGES: dict[str, Any] = {
    "length": POWER_OF_TWO,
    "mass": POWER_OF_TWO,
    "time": POWER_OF_TWO,
    "angle": within(7.0),
}


@holds_in(*KINDS, **CHANGES)
def test_neither_the_mirror_nor_units_nor_the_view_nor_order_change_the_arm_at_rest(
    case: Case, length: float, mass: float, time: float, angle: float
) -> None:
    """In the mirror and in other units to the last bit: no operation prefers a side, or has its own unit."""
    plain, factor = let_out(case), units(length, mass, time)
    assert_multiplied(let_out(changed(case, mirror)), plain, mirror)
    assert_multiplied(let_out(changed(case, factor)), plain, factor)
    plain = at_rest(case)
    assert plain.found
    assert_turned_by(angle, at_rest(turned(case, angle)), plain, case)
    assert_in_another_order(at_rest(reordered(case)), plain, case)


def assert_turned_by(angle: float, found: Equilibrium, plain: Equilibrium, case: Case) -> None:
    """The arm has turned with its base and loads."""
    arm = case.scene.arm
    assert found.outcome is plain.outcome
    unit = np.array([1.0, arm.rest_length])[: len(case.scene.coordinates)]
    np.testing.assert_allclose(found.coordinates / unit, plain.coordinates / unit, atol=SAME)
    np.testing.assert_allclose(found.disk_theta, plain.disk_theta + angle, atol=SAME)
    places = [point.disk_x + 1j * point.disk_y for point in (found, plain)]
    np.testing.assert_allclose(places[0], places[1] * np.exp(1j * angle), atol=SAME * arm.total_length)


def assert_in_another_order(found: Equilibrium, plain: Equilibrium, case: Case) -> None:
    unit = np.array([1.0, case.scene.arm.rest_length])[: len(case.scene.coordinates)]
    assert found.outcome is plain.outcome
    np.testing.assert_allclose(found.coordinates / unit, plain.coordinates / unit, atol=SAME)
    np.testing.assert_allclose(found.tension[::-1], plain.tension, rtol=1e-9, atol=1e-9)


@holds_in(*KINDS, **CHANGES)
def test_neither_the_mirror_nor_units_nor_the_view_nor_order_change_the_motion(
    case: Case, length: float, mass: float, time: float, angle: float
) -> None:
    """In the mirror and in other units to the last bit."""
    plain, power = accelerations(case), powers(case)
    mirrored, signs = changed(case, mirror), [mirror(name) for name in case.scene.coordinates]
    np.testing.assert_array_equal(accelerations(mirrored), plain * signs)
    np.testing.assert_array_equal(powers(mirrored), power)
    factor = units(length, mass, time)
    converted = changed(case, factor)
    per_time = [factor(f"{name}_rate") / time for name in case.scene.coordinates]
    np.testing.assert_array_equal(accelerations(converted), plain * per_time)
    np.testing.assert_array_equal(powers(converted), power * factor("input_power"))
    closest = error_for_the_same(case)
    for other in (turned(case, angle), reordered(case)):
        assert (np.abs(accelerations(other) - plain).ravel() <= closest).all()


def error_for_the_same(case: Case) -> np.ndarray:
    """What 1e-11 rad, or that part of a segment, would change each acceleration by."""
    dynamics, y, interval = dynamics_of(case)
    size, parts = dynamics.size, len(case.scene.coordinates)
    unit = np.tile([1.0, case.scene.arm.rest_length][:parts], case.scene.arm.segments)
    return SAME * (np.abs(dynamics.jacobian(0.0, y, interval)[size : 2 * size, :size]) @ unit)
