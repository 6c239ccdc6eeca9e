"""Scenario files: TOML in, checked at the door.

A scenario is data; no text of it is ever evaluated. All errors of a file are reported at once, each
with its place, what was read, and the nearest allowed word.
"""

import csv
import json
import tomllib
from dataclasses import fields as dataclass_fields
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, Discriminator, Field, Tag, ValidationError, create_model

from continuum_dyn.effects import EFFECTS
from continuum_dyn.profiles import PROFILES, Constant, Profile, Ramp, Sine, Step, Table
from continuum_dyn.study import (
    STUDIES,
    Accuracy,
    EquilibriumStudy,
    MotionStudy,
    RampStudy,
    Scenario,
    Solver,
    StepResponseStudy,
)
from statics.arm import PRESETS, Arm, Cable, DiskNumber, Each, Payload, PerDisk
from statics.checked import STRICT, NonNegative, Positive, Vector
from statics.effects import Cables, DiskLoad, DiskLoads
from statics.errors import InputError, did_you_mean
from statics.scene import Scene

MAX_FILE_SIZE = 50_000_000
MAX_SHOWN = 12


class TableFile(BaseModel):
    """A profile kept in a CSV file beside the scenario."""

    model_config = STRICT
    profile: str
    file: str


def _tension_kind(value: Any) -> str:
    if isinstance(value, dict):
        kind = value.get("profile")
        return kind if isinstance(kind, str) and kind in PROFILES else "profile"
    return "list" if isinstance(value, list) else "number"


class UnknownProfile(BaseModel):
    """Where a profile's name is not one of ours: only there to say so."""

    profile: Annotated[str, Field(pattern="^(" + "|".join(PROFILES) + ")$")]


ProfileTable = (
    Annotated[Constant, Tag("constant")]
    | Annotated[Step, Tag("step")]
    | Annotated[Ramp, Tag("ramp")]
    | Annotated[Sine, Tag("sine")]
    | Annotated[TableFile, Tag("table")]
    | Annotated[UnknownProfile, Tag("profile")]
)
Tension = Annotated[
    Annotated[NonNegative, Tag("number")]
    | Annotated[list[NonNegative], Field(min_length=1), Tag("list")]
    | ProfileTable,
    Discriminator(_tension_kind),
]
Factor = Annotated[
    Annotated[float, Tag("number")] | Annotated[float, Tag("list")] | ProfileTable,
    Discriminator(_tension_kind),
]
"""A list is not allowed, and told so as a number that it is not."""


def _number_kind(value: Any) -> str:
    return "list" if isinstance(value, list) else "number"


PositiveEach = Annotated[
    Annotated[Positive, Tag("number")] | Annotated[PerDisk, Tag("list")], Discriminator(_number_kind)
]
NumberEach = Annotated[
    Annotated[float, Tag("number")]
    | Annotated[Annotated[tuple[float, ...], Field(strict=False)], Tag("list")],
    Discriminator(_number_kind),
]
"""One number, or a list of them: one for each disk."""


class ArmTable(BaseModel):
    """[arm]: what is given beats the preset."""

    model_config = STRICT
    preset: str | None = None
    disks: DiskNumber | None = None
    disk_spacing: PositiveEach | None = None
    youngs_modulus: PositiveEach | None = None
    core_radius: PositiveEach | None = None
    area: PositiveEach | None = None
    second_moment: PositiveEach | None = None
    disk_mass: PositiveEach | None = None
    disk_inertia: PositiveEach | None = None
    core_density: Positive | None = None
    reference_curvature: NumberEach | None = None
    subsegments: int | str | None = None


class CableTable(BaseModel):
    """One of [[cables]]."""

    model_config = STRICT
    name: Annotated[str, Field(min_length=1, max_length=40)] | None = None
    hole_offset: NumberEach
    anchor: DiskNumber | None = None
    tension: Tension


class LoadTable(BaseModel):
    """One of [[loads]]; with ``factor`` it changes in time."""

    model_config = STRICT
    disk: DiskNumber
    force: Vector = (0.0, 0.0)
    moment: float = 0.0
    factor: Factor | None = None


EffectsTable: type[BaseModel] = create_model(
    "EffectsTable",
    __config__=STRICT,
    **{name: (effect | None, None) for name, effect in EFFECTS.items() if name not in ("cables", "loads")},  # pyright: ignore[reportArgumentType, reportCallIssue]
)

StudyTable = Annotated[
    EquilibriumStudy | RampStudy | MotionStudy | StepResponseStudy,
    Field(discriminator="kind"),
]


class ScenarioFile(BaseModel):
    """The whole file."""

    model_config = STRICT
    title: Annotated[str, Field(max_length=200)] = ""
    arm: ArmTable
    effects: EffectsTable  # pyright: ignore[reportInvalidTypeForm]
    cables: list[CableTable] = []
    loads: list[LoadTable] = []
    payloads: list[Payload] = []
    study: StudyTable
    solver: Solver = Solver()
    accuracy: Accuracy | None = None


_KEYS: dict[str, Any] = {
    "": ScenarioFile,
    "arm": ArmTable,
    "effects": EffectsTable,
    "cables": CableTable,
    "loads": LoadTable,
    "payloads": Payload,
    "solver": Solver,
    "accuracy": Accuracy,
    **{f"study.{name}": study for name, study in STUDIES.items()},
    **{f"effects.{name}": effect for name, effect in EFFECTS.items()},
    **{f"cables.tension.{name}": profile for name, profile in PROFILES.items()},
    **{f"loads.factor.{name}": profile for name, profile in PROFILES.items()},
    "cables.tension.table": TableFile,
    "loads.factor.table": TableFile,
}


def load_scenario(path: str | Path) -> Scenario:
    """Read and check a scenario file.

    Raises ``InputError`` whose text names the file, every place in it that is wrong, what is allowed
    there and the nearest match.
    """
    path = Path(path)
    text = _read(path)
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: not a TOML file: {error}.") from error
    try:
        file = ScenarioFile.model_validate_json(json.dumps(content, default=str))
        _check_tolerances(content)
        return _build(file, path, text)
    except ValidationError as error:
        raise InputError(_explain(path, error)) from error
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    except RecursionError as error:
        raise InputError(f"{path}: nested too deeply to be a scenario.") from error


def _check_tolerances(content: dict[str, Any]) -> None:
    settings = content.get("solver", {})
    given = [name for name in ("rtol", "atol") if name in settings]
    if given and settings.get("method") == "midpoint":
        raise InputError(
            f'[solver] {" and ".join(given)} beside method = "midpoint": its steps are equal. Give step (s).'
        )
    if given and "accuracy" in content:
        raise InputError(
            f"[solver] {' and '.join(given)} beside [accuracy]: the accuracy decides the tolerances. "
            "Give one or the other."
        )


def _read(path: Path) -> str:
    try:
        if path.stat().st_size > MAX_FILE_SIZE:
            raise InputError(f"{path}: larger than {MAX_FILE_SIZE // 1_000_000} MB.")
        return path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        known = [p.name for p in sorted(path.parent.glob("*.toml"))] if path.parent.is_dir() else []
        hint = did_you_mean(path.name, known) if known else ""
        raise InputError(f"{path}: no such file.{hint}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not a text file in UTF-8.") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}.") from error


def _build(file: ScenarioFile, path: Path, text: str) -> Scenario:
    is_ramp = isinstance(file.study, RampStudy)
    effects = [
        effect for name in EffectsTable.model_fields if (effect := getattr(file.effects, name)) is not None
    ]
    if file.cables:
        effects.append(Cables())
    if file.loads:
        effects.append(DiskLoads(loads=tuple(map(_load, file.loads))))
    tension = tuple(_ramp_or_profile(cable, path, is_ramp) for cable in file.cables)
    if is_ramp:
        tension = _repeated(tension)
    return Scenario(
        scene=Scene(_arm(file), effects),
        tension=tension,
        study=file.study,
        solver=file.solver,
        accuracy=file.accuracy,
        load_factors=tuple(
            _profile(load.factor, path, "factor") for load in file.loads if load.factor is not None
        ),
        chooses_mesh=file.arm.subsegments == "auto",
        title=file.title or path.stem,
        text=text,
    )


def _arm(file: ScenarioFile) -> Arm:
    given = {name: value for name, value in file.arm if value is not None}
    preset, _ = given.pop("preset", None), given.pop("subsegments", None)
    if preset is not None and preset not in PRESETS:
        raise InputError(f"[arm] unknown preset '{preset}'.{did_you_mean(preset, PRESETS)}")
    numbers = {**({} if preset is None else PRESETS[preset]), **_with_radius(given)}
    missing = [name for name in ("disks", "disk_spacing") if name not in numbers]
    if missing:
        raise InputError(
            f"[arm] missing {' and '.join(missing)}. Give them, or a preset: {', '.join(PRESETS)}."
        )
    cables = tuple(
        Cable(cable.name or f"cable_{number}", cable.hole_offset, cable.anchor)
        for number, cable in enumerate(file.cables, start=1)
    )
    lists = {name: values for name, values in numbers.items() if isinstance(values, tuple)}
    if isinstance(numbers["disk_spacing"], tuple):
        numbers["disk_spacing"] = sum(lists["disk_spacing"]) / len(lists["disk_spacing"])
    single = {name: value for name, value in numbers.items() if not isinstance(value, tuple)}
    subsegments, payloads = _subsegments(file.arm.subsegments), tuple(file.payloads)
    return Arm(**single, subsegments=subsegments, each=Each(**lists), cables=cables, payloads=payloads)


def _subsegments(given: int | str | None) -> int:
    """Segments from disk to disk; where the program chooses them it starts from one."""
    if given is None or given == "auto":
        return 1
    if isinstance(given, str) or given < 1:
        raise InputError(f'[arm] subsegments: a number from 1 on, or "auto"; read {given!r}.')
    return given


def _with_radius(given: dict[str, Any]) -> dict[str, Any]:
    if "core_radius" not in given:
        return given
    both = [name for name in ("area", "second_moment") if name in given]
    if both:
        raise InputError(f"[arm] core_radius already sets {' and '.join(both)}. Give one or the other.")
    radius = given["core_radius"]
    rest = {name: value for name, value in given.items() if name != "core_radius"}
    if not isinstance(radius, tuple):
        return {**rest, **Arm.round_core(radius)}
    cores = [Arm.round_core(each) for each in radius]
    return {**rest, **{name: tuple(core[name] for core in cores) for name in cores[0]}}


def _ramp_or_profile(cable: CableTable, path: Path, is_ramp: bool) -> Any:
    tension = cable.tension
    if is_ramp:
        if isinstance(tension, float | int):
            return (float(tension),)
        if not isinstance(tension, list):
            raise InputError(
                '[[cables]] a "ramp" study takes a number or a list of numbers for each tension.'
            )
        return tuple(map(float, tension))
    if isinstance(tension, list):
        raise InputError('[[cables]] a list of tensions belongs to [study] kind = "ramp".')
    return _profile(tension, path, "tension")


def _profile(given: Any, path: Path, quantity: str) -> Profile:
    """A profile from a number, a table in the file, or a CSV file beside it."""
    if isinstance(given, float | int):
        return Constant(float(given))
    return _table(path, given.file, quantity) if isinstance(given, TableFile) else given


def _load(load: LoadTable) -> DiskLoad:
    return DiskLoad(load.disk, load.force, load.moment, driven=load.factor is not None)


def _repeated(ramps: tuple[tuple[float, ...], ...]) -> tuple[tuple[float, ...], ...]:
    longest = max((len(values) for values in ramps), default=0)
    return tuple(values * longest if len(values) == 1 else values for values in ramps)


def _table(scenario: Path, name: str, quantity: str) -> Profile:
    """Read a table profile: CSV with the header ``time,tension`` (s, N) or ``time,factor``."""
    folder = scenario.parent.resolve()
    path = (folder / name).resolve()
    if not path.is_relative_to(folder):
        raise InputError(f"{quantity}: the table '{name}' lies outside the scenario's folder.")
    rows = list(csv.reader(_read(path).splitlines()))
    if not rows or [cell.strip() for cell in rows[0]] != ["time", quantity]:
        found = ",".join(rows[0])[:60] if rows else "nothing"
        raise InputError(f"table '{name}': the first line must be time,{quantity}; read: {found}")
    values = [_row(name, number, row) for number, row in enumerate(rows[1:], start=1) if row]
    if not values:
        raise InputError(f"table '{name}': no rows below the header.")
    negative = [row for row, (_, value) in enumerate(values, start=1) if value < 0]
    if quantity == "tension" and negative:
        raise InputError(
            f"table '{name}', row {negative[0]}: a cable cannot push; read {values[negative[0] - 1][1]:g}"
        )
    try:
        return Table(tuple(t for t, _ in values), tuple(tau for _, tau in values))
    except InputError as error:
        raise InputError(f"table '{name}': {error}") from error
    except ValidationError as error:
        detail = error.errors()[0]
        row = int(detail["loc"][-1]) + 1
        raise InputError(f"table '{name}', row {row}: {detail['msg']}; read {detail['input']!r}") from error


def _row(name: str, number: int, row: list[str]) -> tuple[float, float]:
    try:
        t, tension = map(float, row)
    except ValueError as error:
        raise InputError(
            f"table '{name}', row {number}: two numbers expected; read: {','.join(row)[:60]}"
        ) from error
    return t, tension


def _explain(path: Path, error: ValidationError) -> str:
    found = [_one(detail) for detail in error.errors(include_url=False)]
    lines = [f"{path} {line}" for line in found[:MAX_SHOWN]]
    if len(found) > MAX_SHOWN:
        lines.append(f"and {len(found) - MAX_SHOWN} more.")
    return "\n".join(lines)


def _one(detail: Any) -> str:
    place = [str(part) for part in detail["loc"]]
    kind, key = detail["type"], place[-1] if place else ""
    inside = _section(place[:-1])
    if kind in ("extra_forbidden", "unexpected_keyword_argument"):
        what = "effect" if inside == "effects" else "key"
        return f"{_where(place[:-1])}: unknown {what} '{key}'.{did_you_mean(key, _known(inside))}"
    if kind in ("missing", "missing_argument"):
        return f"{_where(place[:-1])}: missing '{key}'. Known: {', '.join(_known(inside))}."
    if kind == "union_tag_invalid":
        tag = detail["ctx"]["tag"]
        return f"{_where(place)}: unknown kind '{tag}'.{did_you_mean(tag, STUDIES)}"
    if kind == "union_tag_not_found":
        return f"{_where(place)}: missing 'kind'. Known: {', '.join(STUDIES)}."
    read = repr(detail["input"])
    read = read if len(read) <= 60 else f"{read[:57]}..."
    if kind == "string_pattern_mismatch":
        return f"{_where(place)}: unknown profile {read}.{did_you_mean(str(detail['input']), PROFILES)}"
    message = detail["msg"][0].lower() + detail["msg"][1:]
    return f"{_where(place)}: {message}; read {read}."


def _where(place: list[str]) -> str:
    """How the place is written in the file: [arm] disks, [[cables]] 1 tension."""
    if not place:
        return "(top level)"
    head, *rest = place
    if rest and rest[0].isdigit():
        rest[0] = f"number {int(rest[0]) + 1}"
        return f"[[{head}]] {' '.join(rest)}"
    return f"[{head}] {' '.join(rest)}".rstrip()


def _section(place: list[str]) -> str:
    return ".".join(part for part in place if not part.isdigit())


def _known(section: str) -> list[str]:
    owner = _KEYS.get(section, ScenarioFile)
    if isinstance(owner, type) and issubclass(owner, BaseModel):
        return list(owner.model_fields)
    return [field.name for field in dataclass_fields(owner)]
