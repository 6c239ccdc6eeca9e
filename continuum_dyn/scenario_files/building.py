"""Builds the scenario from the checked tables of its file."""

from typing import Any

from continuum_dyn.effects import MaterialDamping
from continuum_dyn.scenario.first_mode import retardation_time
from continuum_dyn.scenario.profiles import Constant, Profile
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario_files.arm_numbers import Numbers, arm_numbers
from continuum_dyn.scenario_files.csv_table import Tables
from continuum_dyn.scenario_files.self_contained import self_contained
from continuum_dyn.scenario_files.tables import (
    ArmTable,
    BaseTable,
    CableTable,
    LoadTable,
    MaterialDampingTable,
    ScenarioFile,
    TableFile,
)
from statics.arm import Arm, Base, Cable, Payload, PerDisk
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
        effects.append(DiskLoads(loads=tuple(map(build_load, file.loads))))
    drives = tuple(build_drive(cable, tables, is_ramp) for cable in file.cables)
    factors = tuple(build_factor(load, tables, is_ramp) for load in file.loads if load.factor is not None)
    if is_ramp:
        repeated = _repeat_single((*drives, *factors))
        drives, factors = repeated[: len(drives)], repeated[len(drives) :]
    motion = build_base_motion(file.base, tables) if file.base is not None else ()
    moves = not all(isinstance(profile, Constant) for profile in motion)
    base = Base(*(profile.initial for profile in motion), moves=moves) if motion else None
    cables = tuple(build_cable(cable, number) for number, cable in enumerate(file.cables, start=1))
    arm = build_arm(file.arm, arm_numbers(file.arm), cables, tuple(file.payloads), base)
    scene = Scene(arm, effects)
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
    check_damping(damping)
    time, ratio = damping.retardation_time, damping.damping_ratio
    if ratio is None:
        return Scene(scene.arm, (*scene.effects, MaterialDamping(time or 0.0)))
    try:
        return Scene(scene.arm, (*scene.effects, MaterialDamping(retardation_time(scene, ratio))))
    except InputError as error:
        raise InputError(f"[effects] material_damping: {error}") from error


def check_damping(damping: MaterialDampingTable) -> None:
    """Raise ``InputError`` unless the damping is given by one number."""
    if (damping.retardation_time is None) == (damping.damping_ratio is None):
        raise InputError(
            "[effects] material_damping: give retardation_time (s) or damping_ratio, and not both."
        )


def build_arm(
    table: ArmTable,
    numbers: Numbers,
    cables: tuple[Cable, ...] = (),
    payloads: tuple[Payload, ...] = (),
    base: Base | None = None,
) -> Arm:
    """The arm of a table [arm] and of the numbers that it leads to. Raises ``InputError`` like ``Arm``."""
    numbers = dict(numbers)
    lists = {name: values for name, values in numbers.items() if isinstance(values, tuple)}
    if isinstance(numbers["disk_spacing"], tuple):
        numbers["disk_spacing"] = sum(lists["disk_spacing"]) / len(lists["disk_spacing"])
    single = {name: value for name, value in numbers.items() if not isinstance(value, tuple)}
    return Arm(
        **single,
        subsegments=_subsegments(table.subsegments),
        each=PerDisk(**lists),
        cables=cables,
        payloads=payloads,
        base=base,
    )


def _subsegments(given: int | str | None) -> int:
    """Segments from disk to disk; if the program chooses them it starts from one."""
    return given if isinstance(given, int) else 1


def build_cable(cable: CableTable, number: int) -> Cable:
    """The cable of a table; its number from 1 on names it if the table does not."""
    slip = {} if cable.slip_speed is None else {"slip_speed": cable.slip_speed}
    return Cable(
        cable.name or f"cable_{number}",
        cable.hole_offset,
        cable.anchor,
        cable_stiffness=cable.cable_stiffness,
        friction=cable.friction,
        start=cable.start,
        **slip,
    )


def build_drive(cable: CableTable, tables: Tables, is_ramp: bool) -> Any:
    """A profile of a cable's input, or a list for a ramp. Raises ``InputError`` if they do not fit."""
    return _ramp_or_profile(*given_drive(cable), tables, is_ramp)


def build_factor(load: LoadTable, tables: Tables, is_ramp: bool) -> Any:
    """A profile of a driven load's factor, or a list for a ramp. Raises ``InputError`` like a cable's."""
    return _ramp_or_profile(load.factor, "factor", tables, is_ramp, "loads")


def given_drive(cable: CableTable) -> tuple[Any, str]:
    """The input of a cable, and its name: tension or cable_displacement. Raises ``InputError`` unless one."""
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


def build_base_motion(base: BaseTable, tables: Tables) -> tuple[Profile, ...]:
    """Profiles of the base's x, y and angle. Raises ``InputError`` for a CSV file that is wrong."""
    return tuple(_profile(getattr(base, name), tables, name) for name in BaseTable.model_fields)


def build_load(load: LoadTable) -> DiskLoad:
    """The load of a table."""
    driven = load.factor is not None
    return DiskLoad(load.disk, load.force, load.moment, driven=driven, follower=load.follower)


def _repeat_single(ramps: tuple[tuple[float, ...], ...]) -> tuple[tuple[float, ...], ...]:
    longest = max((len(values) for values in ramps), default=0)
    return tuple(values * longest if len(values) == 1 else values for values in ramps)
