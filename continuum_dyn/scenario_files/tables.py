"""Tables of a scenario file, their keys and the types of their values."""

from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    ValidatorFunctionWrapHandler,
    WithJsonSchema,
    WrapValidator,
    create_model,
)
from pydantic_core import PydanticCustomError

from continuum_dyn.effects import EFFECTS
from continuum_dyn.scenario.expect import Expect
from continuum_dyn.scenario.profiles import PROFILES, Constant, Ramp, Sine, SmoothRamp, Step
from continuum_dyn.scenario.solver import Accuracy, Solver
from continuum_dyn.scenario.studies import EquilibriumStudy, MotionStudy, RampStudy, StepResponseStudy
from continuum_dyn.scenario_files.csv_table import MAX_ROWS
from statics.arm import MAX_SEGMENTS, PRESETS, DiskNumber, MassList, Payload, PositiveList
from statics.errors import InputError
from statics.materials import MATERIALS
from statics.support.checked import STRICT, Line, NonNegative, Positive, Vector

REFUSED = "refused"
"""Type of pydantic's errors that stand for an ``InputError``."""


def _collect(value: Any, check: ValidatorFunctionWrapHandler) -> Any:
    try:
        return check(value)
    except InputError as error:
        raise PydanticCustomError(REFUSED, "{message}", {"message": str(error)}) from error


Collected = WrapValidator(_collect)
"""Makes an ``InputError``, which would end the check of a file, one of the errors that it collects."""


class TableFile(BaseModel):
    """A profile from a CSV file in the scenario's folder, repeated for several ``periods``."""

    model_config = STRICT
    profile: Literal["table"]
    file: Annotated[
        Line, Field(description="CSV file in the scenario's folder, with a first line such as time,tension")
    ]
    periods: Annotated[int, Field(ge=1, le=MAX_ROWS, description="number of repetitions of its rows")] = 1


UNKNOWN_PROFILE = "profile"
"""The tag of a profile of an unknown name; it is part of the place in messages."""


def _drive_kind(value: Any) -> str:
    if isinstance(value, dict):
        kind = value.get("profile")
        return kind if isinstance(kind, str) and kind in PROFILES else UNKNOWN_PROFILE
    return "list" if isinstance(value, list) else "number"


class UnknownProfile(BaseModel):
    """A profile of an unknown name, which is always refused."""

    profile: Annotated[str, Field(pattern="^(" + "|".join(PROFILES) + ")$")]


ProfileTable = (
    Annotated[Constant, Tag("constant")]
    | Annotated[Step, Tag("step")]
    | Annotated[Ramp, Tag("ramp")]
    | Annotated[SmoothRamp, Tag("smooth_ramp")]
    | Annotated[Sine, Tag("sine")]
    | Annotated[TableFile, Tag("table")]
    | Annotated[UnknownProfile, Tag(UNKNOWN_PROFILE)]
)
Tension = Annotated[
    Annotated[NonNegative, Tag("number")]
    | Annotated[list[NonNegative], Field(min_length=1), Tag("list")]
    | ProfileTable,
    Discriminator(_drive_kind),
    Collected,
]
AnyDrive = Annotated[
    Annotated[float, Tag("number")] | Annotated[list[float], Field(min_length=1), Tag("list")] | ProfileTable,
    Discriminator(_drive_kind),
    Collected,
]
NumberOrProfile = Annotated[
    Annotated[float, Tag("number")] | Annotated[float, Tag("list")] | ProfileTable,
    Discriminator(_drive_kind),
    Collected,
]
"""A list is refused with the message for a wrong number."""


def _number_kind(value: Any) -> str:
    return "list" if isinstance(value, list) else "number"


PositiveEach = Annotated[
    Annotated[Positive, Tag("number")] | Annotated[PositiveList, Tag("list")], Discriminator(_number_kind)
]
MassEach = Annotated[
    Annotated[NonNegative, Tag("number")] | Annotated[MassList, Tag("list")], Discriminator(_number_kind)
]
NumberEach = Annotated[
    Annotated[float, Tag("number")]
    | Annotated[Annotated[tuple[float, ...], Field(strict=False)], Tag("list")],
    Discriminator(_number_kind),
]
"""One number, or a list of them: one for each disk."""


Preset = Annotated[Line, WithJsonSchema({"type": "string", "enum": list(PRESETS)})]
"""Others are refused where the arm is made, with the nearest of them."""


def _count_kind(value: Any) -> str:
    return "word" if isinstance(value, str) else "number"


def _auto(word: str) -> str:
    if word != "auto":
        raise ValueError('a whole number from 1 on, or "auto"')
    return word


Subsegments = Annotated[
    Annotated[int, Field(ge=1, le=MAX_SEGMENTS), Tag("number")]
    | Annotated[str, AfterValidator(_auto), WithJsonSchema({"const": "auto"}), Tag("word")],
    Discriminator(_count_kind),
]


MaterialName = Annotated[Line, WithJsonSchema({"type": "string", "enum": list(MATERIALS)})]


class ArmTable(BaseModel):
    """[arm]: its numbers, directly or from dimensions and materials; they override the preset."""

    model_config = STRICT
    preset: Annotated[
        Preset | None, Field(description="the arm of a paper, whose numbers apply to all keys not given")
    ] = None
    disks: DiskNumber | None = None
    length: Annotated[
        Positive | None,
        Field(description="undeformed length of the core, base to last disk, m; sets disk_spacing, or disks"),
    ] = None
    disk_spacing: PositiveEach | None = None
    core_material: MaterialName | None = None
    youngs_modulus: PositiveEach | None = None
    core_radius: PositiveEach | None = None
    core_outer_radius: PositiveEach | None = None
    core_inner_radius: PositiveEach | None = None
    area: PositiveEach | None = None
    second_moment: PositiveEach | None = None
    core_density: Positive | None = None
    disk_radius: PositiveEach | None = None
    disk_inner_radius: PositiveEach | None = None
    disk_thickness: PositiveEach | None = None
    disk_material: MaterialName | None = None
    disk_density: PositiveEach | None = None
    disk_mass: MassEach | None = None
    disk_inertia: MassEach | None = None
    reference_curvature: NumberEach | None = None
    subsegments: Annotated[
        Subsegments | None,
        Field(description='number of segments from disk to disk; "auto": as many as [accuracy] needs'),
    ] = None


class CableTable(BaseModel):
    """One of [[cables]]: driven by its tension, or by its displacement and stiffness."""

    model_config = STRICT
    name: Annotated[
        Annotated[Line, Field(min_length=1, max_length=40)] | None,
        Field(description="name of the cable in results, logs and plots"),
    ] = None
    hole_offset: NumberEach
    start: Annotated[
        DiskNumber | None,
        Field(description="disk where it leaves a sheath that the disks before do not feel; else the base"),
    ] = None
    anchor: DiskNumber | None = None
    tension: Tension | None = None
    cable_displacement: AnyDrive | None = None
    cable_stiffness: Positive | None = None
    friction: NonNegative = 0.0
    slip_speed: Positive | None = None


class LoadTable(BaseModel):
    """One of [[loads]]: with ``factor`` it changes in time, as ``follower`` its force turns with the disk."""

    model_config = STRICT
    disk: DiskNumber
    force: Vector = (0.0, 0.0)
    moment: float = 0.0
    follower: bool = False
    factor: AnyDrive | None = None


class BaseTable(BaseModel):
    """[base]: its pose, as numbers or as profiles over time."""

    model_config = STRICT
    x: NumberOrProfile = 0.0
    y: NumberOrProfile = 0.0
    angle: NumberOrProfile = 0.0


class MaterialDampingTable(BaseModel):
    """[effects] material_damping: by its retardation time, or by the first mode's damping ratio."""

    model_config = STRICT
    retardation_time: NonNegative | None = None
    damping_ratio: Annotated[
        Positive | None,
        Field(
            description="damping ratio of the first mode of the unloaded arm (no gravity, tension or loads); "
            "sets retardation_time"
        ),
    ] = None


OF_EFFECTS: dict[str, type] = EFFECTS | {"material_damping": MaterialDampingTable}
"""The tables of effects by name: their own fields, but where a description leads to them."""

NAMED_ELSEWHERE = ("cables", "cable_friction", "loads")
"""Effects that come with a table of their own, or with a key in it."""

EffectsTable: type[BaseModel] = create_model(
    "EffectsTable",
    __config__=STRICT,
    __doc__="[effects]: the effects to include; others are left out of the equations.",
    **{name: (effect | None, None) for name, effect in OF_EFFECTS.items() if name not in NAMED_ELSEWHERE},  # pyright: ignore[reportArgumentType, reportCallIssue]
)

StudyTable = Annotated[
    EquilibriumStudy | RampStudy | MotionStudy | StepResponseStudy,
    Field(discriminator="kind", description="[study]: the kind of simulation."),
]


class ScenarioFile(BaseModel):
    """A scenario of continuum-dyn: an arm, its effects, its drives, and a study."""

    model_config = STRICT
    title: Annotated[Line, Field(description="title of results, logs and plots")] = ""
    arm: ArmTable
    base: BaseTable | None = None
    effects: EffectsTable  # pyright: ignore[reportInvalidTypeForm]
    cables: list[CableTable] = []
    loads: list[LoadTable] = []
    payloads: list[Payload] = []
    study: StudyTable
    solver: Annotated[Solver, Collected] = Solver()
    accuracy: Accuracy | None = None
    expect: Expect | None = None


class SoundTables(BaseModel):
    """The tables of a file that are free of mistakes; in lists None stands for the others."""

    model_config = ConfigDict(STRICT, extra="ignore", defer_build=True)
    arm: ArmTable | None = None
    base: BaseTable | None = None
    effects: EffectsTable | None = None  # pyright: ignore[reportInvalidTypeForm]
    cables: list[CableTable | None] = []
    loads: list[LoadTable | None] = []
    payloads: list[Payload | None] = []
    study: StudyTable | None = None
    solver: Annotated[Solver, Collected] = Solver()
    accuracy: Accuracy | None = None
