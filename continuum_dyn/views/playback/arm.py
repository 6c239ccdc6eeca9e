"""The arm as it is drawn: core, disks, cables, loads, the way of its tip, and where it would rest."""

import numpy as np
import rerun as rr

from continuum_dyn.views.figures.backbone import backbone, poses
from continuum_dyn.views.playback.colors import (
    BLACK,
    GREEN,
    GREY,
    LIGHT_GREY,
    PALETTE,
    PURPLE,
    diverging,
    packed,
    told_apart,
)
from continuum_dyn.views.playback.drawing import Arrows, Drawn, Lines, every_frame
from continuum_dyn.views.playback.loads import ActingLoad, acting_loads
from continuum_dyn.views.playback.measures import Measures
from continuum_dyn.views.playback.story import Story, spread
from continuum_dyn.views.playback.targets import resting_rows

MOST_DISKS = 100
POINTS_PER_SEGMENT = 12
MOST_POINTS = 300
"""Points of a backbone, as far as one for each segment allows."""

CORE_WIDTH = 4.0
RIM = 1.5
"""Width of the rim around the core, which shows where the core is white, points of the screen."""
TAUT_WIDTH = (1.0, 5.0)
"""Of a cable under next to no tension, and under the largest one."""
DASHES = 3
"""Dashes of a slack cable from hole to hole."""

FORCE_REACH = 0.25
"""Length of the largest force's arrow, in the arm's length."""
MOMENT_RADIUS = 0.06
MOMENT_SWEEP = 1.5 * np.pi
"""Angle of the largest moment's arrow."""
MOST_LABELLED = 6
"""Loads that are labelled with what they are; more would hide the arm."""


def half_width(story: Story) -> float:
    """Half the drawn width of a disk, m."""
    arm = story.log.arm
    outermost_hole = float(np.abs(arm["hole_offset"]).max(initial=0.0))
    spacing = story.columns["length"][0].sum() / story.columns["disk_x"].shape[1]
    return 1.2 * outermost_hole or 0.25 * float(spacing)


def own_color(story: Story, color: int) -> int:
    """The color, or the run's where several are shown."""
    return int(PALETTE[story.rank]) if story.name else color


def moving_parts(story: Story, rows: np.ndarray, measures: Measures) -> dict[str, Drawn]:
    """What changes with time, by entity, at those rows."""
    centre, normal = poses(story.columns, rows)
    reach = half_width(story) * normal
    across = np.stack([centre - reach, centre + reach], axis=2)
    shown = 1 + spread(centre.shape[1] - 1, MOST_DISKS)
    parts: dict[str, Drawn] = {
        "disks": Lines(**every_frame(across[:, shown]), color=own_color(story, GREY), width=2.0, order=10.0)
    }
    parts |= _core(story, rows, measures)
    if "base_x" in story.columns:
        parts["base"] = Lines(**every_frame(across[:, :1]), color=BLACK, width=4.0, order=25.0)
    parts |= _cables(story, rows, measures, centre, normal)
    parts |= _loads(story, rows, measures)
    if story.moves:
        parts |= _equilibrium(story, rows)
    return {story.at("arm", name): drawn for name, drawn in parts.items()}


def still_parts(story: Story) -> dict[str, Drawn]:
    """What stays, by entity: the way of the tip, and a base that does not move."""
    rows = story.samples
    tip = np.stack([story.columns["disk_x"][rows, -1], story.columns["disk_y"][rows, -1]], axis=-1)
    parts: dict[str, Drawn] = {"tip_trace": Lines(tip[None], own_color(story, PURPLE), 1.5, 16.0)}
    if "base_x" not in story.columns:
        base = half_width(story) * np.array([[[0.0, -1.0], [0.0, 1.0]]])
        parts["base"] = Lines(base, BLACK, 4.0, 25.0)
    return {story.at("arm", name): drawn for name, drawn in parts.items()}


def _points_per_segment(segments: int) -> int:
    return int(np.clip(MOST_POINTS // segments, 1, POINTS_PER_SEGMENT))


def _core(story: Story, rows: np.ndarray, measures: Measures) -> dict[str, Drawn]:
    """An arc for each segment in the colour of its curvature, and a rim around them all."""
    curvature = story.columns["curvature"][rows]
    segments = curvature.shape[1]
    per_segment = _points_per_segment(segments)
    points = backbone(story.columns, rows, per_segment)
    arc = per_segment * np.arange(segments)[:, None] + np.arange(per_segment + 1)
    color = packed(diverging(curvature, measures.curvature)).ravel()
    rim = 2.0 * RIM if story.name else RIM
    return {
        "rim": Lines(
            **every_frame(points[:, None]),
            color=own_color(story, BLACK),
            width=CORE_WIDTH + 2 * rim,
            order=19.0,
        ),
        "backbone": Lines(**every_frame(points[:, arc]), color=color, width=CORE_WIDTH, order=20.0),
    }


def _cables(
    story: Story, rows: np.ndarray, measures: Measures, centre: np.ndarray, normal: np.ndarray
) -> dict[str, Drawn]:
    """Each cable through its holes to its anchor: as wide as its tension, and dashed while it has none."""
    arm = story.log.arm
    parts: dict[str, Lines] = {}
    cables = zip(
        story.log.cables, arm["hole_offset"], arm["anchor"], told_apart(len(story.log.cables)), strict=True
    )
    for number, (name, offset, anchor, color) in enumerate(cables):
        holes = (centre + offset[:, None] * normal)[:, : anchor + 1]
        tension = story.columns["tension"][rows, number]
        taut, drawn = tension > 0.0, own_color(story, int(color))
        entity = f"cables/{rr.escape_entity_path_part(name)}"
        least, most = TAUT_WIDTH
        width = least + (most - least) * tension[taut] / measures.tension
        parts[entity] = Lines(holes[taut], drawn, width, 30.0, taut.astype(int))
        if not taut.all():
            dashes = _dashed(holes[~taut])
            counts = np.where(taut, 0, dashes.shape[1])
            parts[f"{entity}/slack"] = Lines(dashes.reshape(-1, 2, 2), drawn, least, 30.0, counts)
    return {name: drawn for name, drawn in parts.items() if len(drawn.strips)}


def _dashed(holes: np.ndarray) -> np.ndarray:
    """Dashes from hole to hole, shape (frames, dashes, 2, 2)."""
    start, way = holes[:, :-1, None, None], np.diff(holes, axis=1)[:, :, None, None]
    along = (np.arange(DASHES)[:, None] + np.array([0.25, 0.75])) / DASHES
    return (start + along[..., None] * way).reshape(len(holes), -1, 2, 2)


def _loads(story: Story, rows: np.ndarray, measures: Measures) -> dict[str, Drawn]:
    """Forces as straight arrows, moments as round ones, and what they are, unless they are many."""
    parts: dict[str, Drawn] = {}
    loads, color = acting_loads(story, rows), own_color(story, GREEN)
    for number, load in enumerate(loads, start=1):
        if load.force.any():
            vector = FORCE_REACH * measures.length / measures.force * load.force
            parts[f"loads/{number}/force"] = Arrows(load.place, vector, color, 3.0, 40.0)
        if load.moment.any():
            parts[f"loads/{number}/moment"] = _moment(load, measures, color)
        if len(loads) <= MOST_LABELLED:
            parts[f"loads/{number}/size"] = _size(load, measures)
    return parts


def _size(load: ActingLoad, measures: Measures) -> Lines:
    """A label beside the disk."""
    force, moment = np.linalg.norm(load.force, axis=1), load.moment
    labels = [
        ", ".join(([f"{f:.3g} N"] if load.force.any() else []) + ([f"{m:.3g} N m"] if moment.any() else []))
        for f, m in zip(force, moment, strict=True)
    ]
    beside = load.place + measures.length * np.array([0.1, 0.0])
    strips = beside[:, None] + measures.length * np.array([[-0.01, 0.0], [0.01, 0.0]])
    return Lines(**every_frame(strips[:, None]), color=BLACK, width=0.0, order=41.0, labels=labels)


def _moment(load: ActingLoad, measures: Measures, color: int) -> Lines:
    """An arc about the disk's centre with a head at its end, as long as the moment is large."""
    sweep = MOMENT_SWEEP * load.moment / measures.moment
    radius = MOMENT_RADIUS * measures.length
    angle = sweep[:, None] * np.linspace(0.0, 1.0, 24)
    arc = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    back = sweep - 0.4 * np.clip(sweep, -1.0, 1.0)
    barbs = np.stack([np.cos(back), np.sin(back)], axis=-1)[:, None] * np.array([0.75, 1.25])[:, None]
    head = np.concatenate([barbs[:, :1], arc[:, -1:], barbs[:, 1:]], axis=1)
    strips = load.place[:, None] + radius * np.concatenate([arc, head], axis=1)
    return Lines(**every_frame(strips[:, None]), color=color, width=3.0, order=40.0)


def _equilibrium(story: Story, rows: np.ndarray) -> dict[str, Drawn]:
    """Where the arm would rest under the inputs of the moment, where the log knows."""
    resting = resting_rows(story.log)[rows]
    known = resting >= 0
    if not known.any():
        return {}
    per_segment = _points_per_segment(story.columns["curvature"].shape[1])
    ghost = backbone(story.log.equilibria, resting[known], per_segment)
    return {"equilibrium": Lines(ghost, LIGHT_GREY, CORE_WIDTH + 8.0, 15.0, known.astype(int))}
