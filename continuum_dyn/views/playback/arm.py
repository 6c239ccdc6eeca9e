"""The arm as it is drawn: core, disks, cables, loads, the path of its tip, and its equilibrium."""

import numpy as np
from rerun_bindings import escape_entity_path_part

from continuum_dyn.views.figures.backbone import backbone, disk_reach, poses
from continuum_dyn.views.figures.loads import ActingLoad
from continuum_dyn.views.playback.colors import (
    BLACK,
    GREEN,
    GREY,
    LIGHT_GREY,
    PALETTE,
    PURPLE,
    distinct_colors,
    diverging,
    pack,
)
from continuum_dyn.views.playback.drawing import Arrows, Drawn, Lines, every_frame
from continuum_dyn.views.playback.measures import Measures
from continuum_dyn.views.playback.playback import Playback, spread
from continuum_dyn.views.playback.targets import resting_rows
from statics.support.plain_text import plain_line

MOST_DISKS = 100
POINTS_PER_SEGMENT = 12
MOST_POINTS = 300
"""Largest number of points of a backbone, but at least one for each segment."""

CORE_WIDTH = 4.0
RIM = 1.5
"""Width of the rim around the core, which shows where the core is white, points of the screen."""
TAUT_WIDTH = (1.0, 5.0)
"""Width of a cable under next to no tension, and under the largest one, points of the screen."""
DASHES = 3
"""Number of dashes of a slack cable from hole to hole."""

FORCE_REACH = 0.25
"""Length of the largest force's arrow, in the arm's length."""
MOMENT_RADIUS = 0.06
MOMENT_SWEEP = 1.5 * np.pi
"""Angle of the largest moment's arrow."""
MOST_LABELLED = 6
"""Largest number of loads that are labelled; more would hide the arm."""


def own_color(playback: Playback, color: int) -> int:
    """The color, or the run's own if several are shown."""
    return int(PALETTE[playback.rank]) if playback.name else color


def moving_parts(playback: Playback, rows: np.ndarray, measures: Measures) -> dict[str, Drawn]:
    """Parts that change with time, by entity, at those rows."""
    centre, across = poses(playback.columns, rows)
    reach = disk_reach(playback.log.arm, playback.columns) * across
    bars = np.stack([centre - reach, centre + reach], axis=2)
    shown = 1 + spread(centre.shape[1] - 1, MOST_DISKS)
    parts: dict[str, Drawn] = {
        "disks": Lines(**every_frame(bars[:, shown]), color=own_color(playback, GREY), width=2.0, order=10.0)
    }
    parts |= _core(playback, rows, measures)
    if "base_x" in playback.columns:
        parts["base"] = Lines(**every_frame(bars[:, :1]), color=BLACK, width=4.0, order=25.0)
    parts |= _cables(playback, rows, measures, centre, across)
    parts |= _loads(playback, rows, measures)
    if playback.moves:
        parts |= _equilibrium(playback, rows)
    return {playback.at("arm", name): drawn for name, drawn in parts.items()}


def still_parts(playback: Playback) -> dict[str, Drawn]:
    """Parts that do not change, by entity: the path of the tip, and a base that does not move."""
    rows = playback.samples
    tip = np.stack([playback.columns["disk_x"][rows, -1], playback.columns["disk_y"][rows, -1]], axis=-1)
    parts: dict[str, Drawn] = {"tip_trace": Lines(tip[None], own_color(playback, PURPLE), 1.5, 16.0)}
    if "base_x" not in playback.columns:
        base = disk_reach(playback.log.arm, playback.columns) * np.array([[[0.0, -1.0], [0.0, 1.0]]])
        parts["base"] = Lines(base, BLACK, 4.0, 25.0)
    return {playback.at("arm", name): drawn for name, drawn in parts.items()}


def _points_per_segment(segments: int) -> int:
    return int(np.clip(MOST_POINTS // segments, 1, POINTS_PER_SEGMENT))


def _core(playback: Playback, rows: np.ndarray, measures: Measures) -> dict[str, Drawn]:
    """An arc for each segment in the colour of its curvature, and a rim around them all."""
    curvature = playback.columns["curvature"][rows]
    segments = curvature.shape[1]
    per_segment = _points_per_segment(segments)
    points = backbone(playback.columns, rows, per_segment)
    arc = per_segment * np.arange(segments)[:, None] + np.arange(per_segment + 1)
    color = pack(diverging(curvature, measures.curvature)).ravel()
    rim = 2.0 * RIM if playback.name else RIM
    return {
        "rim": Lines(
            **every_frame(points[:, None]),
            color=own_color(playback, BLACK),
            width=CORE_WIDTH + 2 * rim,
            order=19.0,
        ),
        "backbone": Lines(**every_frame(points[:, arc]), color=color, width=CORE_WIDTH, order=20.0),
    }


def _cables(
    playback: Playback, rows: np.ndarray, measures: Measures, centre: np.ndarray, across: np.ndarray
) -> dict[str, Drawn]:
    """Each cable from its start to its anchor: as wide as its tension, and dashed while it has none."""
    arm = playback.log.arm
    parts: dict[str, Lines] = {}
    cables = zip(
        playback.log.cables,
        arm["hole_offset"],
        playback.log.bare_disks,
        distinct_colors(len(playback.log.cables)),
        strict=True,
    )
    for number, (name, offset, bare, color) in enumerate(cables):
        holes = (centre + offset[:, None] * across)[:, bare]
        tension = playback.columns["tension"][rows, number]
        taut, drawn = tension > 0.0, own_color(playback, int(color))
        entity = f"cables/{escape_entity_path_part(plain_line(name))}"
        least, most = TAUT_WIDTH
        width = least + (most - least) * tension[taut] / measures.tension
        parts[entity] = Lines(holes[taut], drawn, width, 30.0, taut.astype(int))
        if not taut.all():
            dashes = _dash(holes[~taut])
            counts = np.where(taut, 0, dashes.shape[1])
            parts[f"{entity}/slack"] = Lines(dashes.reshape(-1, 2, 2), drawn, least, 30.0, counts)
    return {name: drawn for name, drawn in parts.items() if len(drawn.strips)}


def _dash(holes: np.ndarray) -> np.ndarray:
    """Dashes from hole to hole, shape (frames, dashes, 2, 2)."""
    start, way = holes[:, :-1, None, None], np.diff(holes, axis=1)[:, :, None, None]
    along = (np.arange(DASHES)[:, None] + np.array([0.25, 0.75])) / DASHES
    return (start + along[..., None] * way).reshape(len(holes), -1, 2, 2)


def _loads(playback: Playback, rows: np.ndarray, measures: Measures) -> dict[str, Drawn]:
    """Forces as straight arrows, moments as round ones, and what they are, unless they are many."""
    parts: dict[str, Drawn] = {}
    loads, color = playback.loads(rows), own_color(playback, GREEN)
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


def _equilibrium(playback: Playback, rows: np.ndarray) -> dict[str, Drawn]:
    """The equilibrium under the inputs of the moment, if the log has it."""
    resting = resting_rows(playback.log)[rows]
    known = resting >= 0
    if not known.any():
        return {}
    per_segment = _points_per_segment(playback.columns["curvature"].shape[1])
    ghost = backbone(playback.log.equilibria, resting[known], per_segment)
    return {"equilibrium": Lines(ghost, LIGHT_GREY, CORE_WIDTH + 8.0, 15.0, known.astype(int))}
