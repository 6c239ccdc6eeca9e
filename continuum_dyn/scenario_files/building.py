"""Builds the scenario from the checked tables of its file."""

from dataclasses import replace
from typing import Any

from continuum_dyn.effects import MaterialDamping
from continuum_dyn.scenario.first_mode import retardation_time
from continuum_dyn.scenario.profiles import Constant, Profile
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario_files.arm_numbers import Numbers, arm_numbers
from continuum_dyn.scenario_files.csv_table import Tables
from continuum_dyn.scenario_files.self_contained import self_contained
from continuum_dyn.scenario_files.tables import (
    BaseTable,
    CableTable,
    LoadTable,
    MaterialDampingTable,
    ScenarioFile,
    TableFile,
)
from statics.arm import Arm, Base, Cable, PerDisk
from statics.effects import CableFriction, Cables, DiskLoad, DiskLoads
from statics.errors import InputError
from statics.scene import Scene


def build(file: ScenarioFile, name: str, text: str, tables: Tables) -> Scenario:
    """Build the scenario of a checked file; ``name`` is its title if the file gives none."""
    is_ramp = file.study.takes_lists
    given = {name: effect for name, effect in file.effects if effect is not None}
    damping = given.pop("material_damping", None)
    effects = list(given.values())
    if file.cables:
        effects.append(Cables())
    if any(cable.friction > 0 for cable in file.cables):
        effects.append(CableFriction())
    if file.loads:
        effects.append(DiskLoads(loads=tuple(map(_load, file.loads))))
    drives = tuple(_ramp_or_profile(*_drive(cable), tables, is_ramp) for cable in file.cables)
    factors = tuple(
        _ramp_or_profile(load.factor, "factor", tables, is_ramp, "loads")
        for load in file.loads
        if load.factor is not None
    )
    if is_ramp:
        repeated = _repeat_single((*drives, *factors))
        drives, factors = repeated[: len(drives)], repeated[len(drives) :]
    motion = _base_motion(file.base, tables) if file.base is not None else ()
    moves = not all(isinstance(profile, Constant) for profile in motion)
    base = Base(*(profile.initial for profile in motion), moves=moves) if motion else None
    scene = Scene(replace(_arm(file, arm_numbers(file.arm)), base=base), effects)
    if damping is not None:
        scene = _damped(scene, damping)
    return Scenario(
        scene=scene,
        drives=drives,
        study=file.study,
        solver=file.solver,
        accuracy=file.accuracy,
        load_factors=factors,
        base_motion=motion if moves else (),
        chooses_mesh=file.arm.subsegments == "auto",
        title=file.title or name,
        text=self_contained(text, scene),
        tables=tables.texts,
    )


def _damped(scene: Scene, damping: MaterialDampingTable) -> Scene:
    """The scene with its core's damping, whose retardation time is given or follows from a damping ratio."""
    time, ratio = damping.retardation_time, damping.damping_ratio
    if time is not None and ratio is None:
        return Scene(scene.arm, (*scene.effects, MaterialDamping(time)))
    if ratio is None or time is not None:
        raise InputError(
            "[effects] material_damping: give retardation_time (s) or damping_ratio, and not both."
        )
    try:
        return Scene(scene.arm, (*scene.effects, MaterialDamping(retardation_time(scene, ratio))))
    except InputError as error:
        raise InputError(f"[effects] material_damping: {error}") from error


def _arm(file: ScenarioFile, numbers: Numbers) -> Arm:
    numbers = dict(numbers)
    cables = tuple(_cable(cable, f"cable_{number}") for number, cable in enumerate(file.cables, start=1))
    lists = {name: values for name, values in numbers.items() if isinstance(values, tuple)}
    if isinstance(numbers["disk_spacing"], tuple):
        numbers["disk_spacing"] = sum(lists["disk_spacing"]) / len(lists["disk_spacing"])
    single = {name: value for name, value in numbers.items() if not isinstance(value, tuple)}
    subsegments, payloads = _subsegments(file.arm.subsegments), tuple(file.payloads)
    return Arm(**single, subsegments=subsegments, each=PerDisk(**lists), cables=cables, payloads=payloads)


def _subsegments(given: int | str | None) -> int:
    """Segments from disk to disk; if the program chooses them it starts from one."""
    return given if isinstance(given, int) else 1


def _cable(cable: CableTable, numbered: str) -> Cable:
    slip = {} if cable.slip_speed is None else {"slip_speed": cable.slip_speed}
    return Cable(
        cable.name or numbered,
        cable.hole_offset,
        cable.anchor,
        cable_stiffness=cable.cable_stiffness,
        friction=cable.friction,
        start=cable.start,
        **slip,
    )


def _drive(cable: CableTable) -> tuple[Any, str]:
    """The input of a cable, and its name: tension or cable_displacement."""
    given = {"tension": cable.tension, "cable_displacement": cable.cable_displacement}
    known = [name for name, value in given.items() if value is not None]
    where = "[[cables]]" if cable.name is None else f"[[cables]] '{cable.name}'"
    if len(known) == 2:
        raise InputError(f"{where}: both tension and cable_displacement. A cable is driven by one: give one.")
    if not known:
        raise InputError(f"{where}: missing what drives it. Give tension (N), or cable_displacement (m).")
    if known == ["cable_displacement"] and cable.cable_stiffness is None:
        raise InputError(
            f"{where}: cable_displacement needs the stiffness behind it. Give cable_stiffness (N/m)."
        )
    if known == ["tension"] and cable.cable_stiffness is not None:
        raise InputError(
            f"{where}: cable_stiffness belongs to cable_displacement; a given tension stretches no cable. "
            "Leave it out, or give cable_displacement (m) instead of tension."
        )
    return given[known[0]], known[0]


def _ramp_or_profile(drive: Any, quantity: str, tables: Tables, is_ramp: bool, table: str = "cables") -> Any:
    if is_ramp:
        if isinstance(drive, float | int):
            return (float(drive),)
        if not isinstance(drive, list):
            raise InputError(
                f'[[{table}]] a "ramp" study takes a number or a list of numbers for each {quantity}.'
            )
        return tuple(map(float, drive))
    if isinstance(drive, list):
        raise InputError(f'[[{table}]] a list for {quantity} belongs to [study] kind = "ramp".')
    return _profile(drive, tables, quantity)


def _profile(given: Any, tables: Tables, quantity: str) -> Profile:
    """A profile from a number, a table in the file, or a CSV file beside it."""
    if isinstance(given, float | int):
        return Constant(float(given))
    return tables.profile(given.file, quantity, given.periods) if isinstance(given, TableFile) else given


def _base_motion(base: BaseTable, tables: Tables) -> tuple[Profile, ...]:
    return tuple(_profile(getattr(base, name), tables, name) for name in BaseTable.model_fields)


def _load(load: LoadTable) -> DiskLoad:
    driven = load.factor is not None
    return DiskLoad(load.disk, load.force, load.moment, driven=driven, follower=load.follower)


def _repeat_single(ramps: tuple[tuple[float, ...], ...]) -> tuple[tuple[float, ...], ...]:
    longest = max((len(values) for values in ramps), default=0)
    return tuple(values * longest if len(values) == 1 else values for values in ramps)
