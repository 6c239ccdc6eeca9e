"""Numbers of an arm from its description: a rod or a tube, disks by their measures, materials by name.

Each step replaces keys of the table [arm] by those that they set, and refuses what sets a number twice.
"""

from collections.abc import Callable, Iterable
from math import isclose, pi
from typing import Any

from continuum_dyn.scenario_files.tables import ArmTable
from statics.arm import PRESETS, Arm
from statics.errors import InputError, did_you_mean
from statics.materials import material

Numbers = dict[str, Any]
"""Numbers by key; a tuple has one for each disk."""

WHOLE = 1e-9
"""Largest relative difference at which lengths are the same."""


def arm_numbers(table: ArmTable) -> Numbers:
    """The arguments of ``Arm`` and ``PerDisk`` that a table [arm] leads to, those of its preset included.

    Raises ``InputError`` where keys are missing, contradict one another, or set the same number.
    """
    given = {name: value for name, value in table if value is not None}
    preset, _ = given.pop("preset", None), given.pop("subsegments", None)
    if preset is not None and preset not in PRESETS:
        raise InputError(f"[arm] unknown preset '{preset}'.{did_you_mean(preset, PRESETS)}")
    known = {} if preset is None else PRESETS[preset]
    for step in (replace_materials, _section, _disk_masses):
        given = step(given)
    numbers = known | _spacing(given, known)
    missing = [name for name in ("disks", "disk_spacing") if name not in numbers]
    if missing:
        raise InputError(
            f"[arm] missing {' and '.join(missing)}. Give disks with length or disk_spacing, or a preset: "
            f"{', '.join(PRESETS)}."
        )
    return numbers


def replace_materials(given: Numbers) -> Numbers:
    """Replace materials by the core's modulus and density, and by the disks' density."""
    given = dict(given)
    if "core_material" in given:
        _refuse_twice(given, "core_material", ("youngs_modulus", "core_density"))
        core = _material(given.pop("core_material"), "core_material")
        given |= {"youngs_modulus": core.youngs_modulus, "core_density": core.density}
    if "disk_material" in given:
        _refuse_twice(given, "disk_material", ("disk_density",))
        given |= {"disk_density": _material(given.pop("disk_material"), "disk_material").density}
    return given


def _material(name: str, key: str) -> Any:
    try:
        return material(name)
    except InputError as error:
        raise InputError(f"[arm] {key}: {error}") from error


def _section(given: Numbers) -> Numbers:
    """Radii of a rod or a tube replaced by area and second moment."""
    if "core_radius" in given and ("core_outer_radius" in given or "core_inner_radius" in given):
        raise InputError(
            "[arm] core_radius beside the radii of a tube. Give core_radius of a solid core, or "
            "core_outer_radius and core_inner_radius of a tube."
        )
    outer = "core_radius" if "core_radius" in given else "core_outer_radius"
    radii = _take(given, (outer, "core_inner_radius"), (outer,))
    if not radii:
        return given
    _refuse_twice(given, outer, ("area", "second_moment"))
    _check_inside(radii, "core_inner_radius", outer)
    return given | _for_each(Arm.round_core, radii)


def _disk_masses(given: Numbers) -> Numbers:
    """Measures and density of round disks replaced by mass and moment of inertia."""
    measures = ("disk_radius", "disk_thickness", "disk_inner_radius")
    found = _take(given, (*measures, "disk_density"), ("disk_radius", "disk_thickness"))
    if not found:
        return given
    _refuse_twice(given, "disk_radius", ("disk_inertia",))
    _check_inside(found, "disk_inner_radius", "disk_radius")
    if "disk_density" in found:
        _refuse_twice(given, "disk_density", ("disk_mass",))
        ring = {"disk_inner_radius": 0.0} | found
        found["mass"] = _for_each(_ring_mass, {name: ring[name] for name in (*measures, "disk_density")})[
            "mass"
        ]
    elif "disk_mass" in given:
        found["mass"] = given["disk_mass"]
    else:
        raise InputError(
            "[arm] disk_radius without what the disks weigh. Give disk_material, disk_density (kg/m^3) or "
            "disk_mass (kg)."
        )
    ordered = {name: found[name] for name in ("mass", *measures) if name in found}
    return given | _for_each(Arm.round_disk, ordered)


def _ring_mass(radius: float, thickness: float, inner_radius: float, density: float) -> Numbers:
    return {"mass": density * pi * (radius**2 - inner_radius**2) * thickness}


def _spacing(given: Numbers, preset: Numbers) -> Numbers:
    """The arm's length replaced by its number of disks or by their spacing, whichever is not given."""
    if "length" not in given:
        return given
    length, spacing = given.pop("length"), given.get("disk_spacing")
    if spacing is None:
        disks = given.get("disks", preset.get("disks"))
        return given if disks is None else given | {"disk_spacing": length / disks}
    if "disks" not in given:
        count = len(spacing) if isinstance(spacing, tuple) else max(1, round(length / spacing))
        given = given | {"disks": count}
    whole = sum(spacing) if isinstance(spacing, tuple) else given["disks"] * spacing
    if not isclose(whole, length, rel_tol=WHOLE):
        raise InputError(
            f"[arm] length = {length:g} m, but {given['disks']} disks with the given disk_spacing make "
            f"{whole:g} m. Give two of length, disks and disk_spacing."
        )
    return given


def _take(given: Numbers, names: Iterable[str], needed: Iterable[str]) -> Numbers:
    """Remove and return the given ones among names. Raises ``InputError`` if some are needed and missing."""
    found = {name: given.pop(name) for name in names if name in given}
    missing = [name for name in needed if name not in found] if found else []
    if missing:
        raise InputError(f"[arm] {' and '.join(found)} without {' and '.join(missing)}. Give that, too.")
    return found


def _refuse_twice(given: Numbers, key: str, names: Iterable[str]) -> None:
    both = [name for name in names if name in given]
    if both:
        raise InputError(f"[arm] {key} already sets {' and '.join(both)}. Give one or the other.")


def _check_inside(found: Numbers, inner: str, outer: str) -> None:
    if inner in found:
        pairs = _rows([found[inner], found[outer]], (inner, outer))
        if any(inside >= outside for inside, outside in pairs):
            raise InputError(f"[arm] {inner} must be less than {outer}.")


def _for_each(formula: Callable[..., Numbers], arguments: Numbers) -> Numbers:
    """Results of a formula, by name: one, or a tuple for each disk if some argument is one."""
    values = list(arguments.values())
    if not any(isinstance(value, tuple) for value in values):
        return formula(*values)
    results = [formula(*row) for row in _rows(values, arguments)]
    return {name: tuple(result[name] for result in results) for name in results[0]}


def _rows(values: list[Any], names: Iterable[str]) -> list[tuple[float, ...]]:
    """The values disk by disk. Raises ``InputError`` for lists of different lengths."""
    counts = {len(value) for value in values if isinstance(value, tuple)} or {1}
    if len(counts) > 1:
        raise InputError(
            f"[arm] lists of different lengths: {', '.join(names)}. Give one number for each disk."
        )
    (count,) = counts
    return list(zip(*(v if isinstance(v, tuple) else (v,) * count for v in values), strict=True))
