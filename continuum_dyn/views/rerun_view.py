"""The rerun view: a log as a recording to play, the arm on the left and its series on the right.

A motion plays along ``sim_time``, a sequence of equilibria along ``point``. Positions become float32 and
long motions are thinned out, so the log stays the truth. The layout is stored in the recording.
"""

import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from continuum_dyn.record import Log
from continuum_dyn.views.backbone import backbone, poses
from statics.errors import LogError
from statics.interruption import held
from statics.quantities import QUANTITIES

APPLICATION = "continuum-dyn"

VIEWER = (
    *(sys.executable, "-c", "import sys; from rerun_cli.__main__ import main; sys.exit(main())"),
    *("--bind", "127.0.0.1", "--port", "auto"),
)
"""The viewer of this Python environment; ``-m rerun_cli`` would lose its exit status. Its server is for this
computer only, on a free port: on the default one, a viewer that already runs would take the file over."""

FRAMES_PER_SECOND = 60
SHORTEST_PLAYBACK = 10.0
"""Shorter motions play in slow motion, to take this long (s)."""

MOST_FRAMES = 2000
MOST_POSES = 1_000_000
"""Most frames times disks; arms of many disks are drawn in fewer frames."""

MOST_SAMPLES = 20_000
MOST_SERIES = 8
MOST_DISKS = 100
POINTS_PER_SEGMENT = 12
MOST_POINTS = 600
"""Points of a backbone, as far as one for each segment allows."""

# RRGGBBAA. Okabe and Ito 2008, for colour-blind readers; grey and brown instead of its yellow and black,
# which would not show on white or on dark.
PALETTE = np.array(
    [0x0072B2FF, 0xD55E00FF, 0x009E73FF, 0xE69F00FF, 0xCC79A7FF, 0x56B4E9FF, 0x8C8C8CFF, 0x8C5A3CFF],
    dtype=np.uint32,
)
BLACK, GREY, LIGHT_GREY, PURPLE, WHITE = 0x000000FF, 0x8C8C8CFF, 0xBEBEBEFF, 0xCC79A7FF, 0xFFFFFFFF


@dataclass(frozen=True)
class Story:
    """What is told: ``columns`` by glossary name, one row for each of ``times`` on the time line."""

    timeline: str
    times: np.ndarray
    columns: Mapping[str, np.ndarray]

    @property
    def duration(self) -> float:
        """Length of a motion in s; 0 for equilibria."""
        return float(np.ptp(self.columns["time"])) if self.timeline == "sim_time" else 0.0

    def when(self, rows: np.ndarray) -> rr.TimeColumn:
        """Those rows' places on the time line."""
        if self.timeline == "sim_time":
            return rr.TimeColumn(self.timeline, duration=self.times[rows])
        return rr.TimeColumn(self.timeline, sequence=self.times[rows])


@dataclass(frozen=True)
class Lines:
    """Line strips, shape (frames, strips, points, 2), m; ``width`` in points of the screen."""

    strips: np.ndarray
    color: int
    width: float
    order: float
    label: str | None = None


@dataclass(frozen=True)
class Plot:
    """Time series that share their axis: ``series`` by name, each of shape (rows,)."""

    title: str
    series: Mapping[str, np.ndarray]


def save(log: Log, path: Path) -> None:
    """Write a log as a recording for rerun (.rrd).

    The recording of a log without any pose says how the run ended. Raises ``LogError`` if the file cannot
    be written; then nothing is left behind.
    """
    content = _recording(log)
    part = path.with_name(path.name + ".part")
    with held():
        try:
            part.write_bytes(content)
            part.replace(path)
        except OSError as error:
            raise LogError(f"cannot write the recording {path}: {error.strerror or error}.") from error
        finally:
            with suppress(OSError):
                part.unlink()


def show(log: Log) -> None:
    """Open a log in rerun's viewer, and return when its window is closed.

    Raises ``LogError`` if the viewer cannot run here.
    """
    with TemporaryDirectory(prefix="continuum-dyn-", ignore_cleanup_errors=True) as folder:
        path = Path(folder) / f"{log.path.stem}.rrd"
        save(log, path)
        try:
            viewer = subprocess.run([*VIEWER, path], stderr=subprocess.PIPE, text=True, check=False)
        except OSError as error:
            raise LogError(f"cannot start the rerun viewer: {error}.") from error
    if viewer.returncode:
        reason = (viewer.stderr.strip().splitlines() or [f"exit status {viewer.returncode}"])[-1]
        raise LogError(f"the rerun viewer cannot run here: {reason}")


def _recording(log: Log) -> bytes:
    rr.set_strict_mode(True)  # otherwise bad data only warns, and leaves an empty column
    recording = rr.RecordingStream(APPLICATION)
    memory = recording.memory_recording()  # its file sink waits for ever on a full disk (0.41)
    recording.send_recording_name(log.title or log.path.stem)
    story = _story(log)
    if story is None:
        _send_ending(recording, log)
    else:
        _send_story(recording, log, story)
    return memory.drain_as_bytes()


def _story(log: Log) -> Story | None:
    """The motion, or else the equilibria; None if the run ended before its first pose."""
    if log.trajectory and log.trajectory["time"].size:
        # rerun truncates seconds given as floats, so they are rounded to ns here.
        times = np.round(1e9 * log.trajectory["time"]).astype("timedelta64[ns]")
        return Story("sim_time", times, log.trajectory)
    return Story("point", log.equilibria["point"], log.equilibria) if log.equilibria else None


def _ending(log: Log) -> str:
    return ": ".join(filter(None, (log.title, log.outcome.replace("_", " "), log.message)))


def _send_ending(recording: rr.RecordingStream, log: Log) -> None:
    recording.log("outcome", rr.TextDocument(_ending(log)), static=True)
    recording.send_blueprint(rrb.Blueprint(rrb.TextDocumentView(origin="outcome"), collapse_panels=True))


def _send_story(recording: rr.RecordingStream, log: Log, story: Story) -> None:
    frames = _frames(story)
    moving, still = _moving_lines(log, story, frames), _still_lines(log, story)
    still["arm/scale"] = _scale(moving | still)
    plots = _plots(log, story)
    # It becomes the active layout: bounds and ranges of the log before would not fit this one.
    recording.send_blueprint(_blueprint(log, story, moving | still, plots))
    for entity, lines in still.items():
        _send_still(recording, entity, lines)
    for entity, lines in moving.items():
        _send_moving(recording, entity, story.when(frames), lines)
    for entity, plot in plots.items():
        _send_plot(recording, entity, story, plot)


def _spread(count: int, most: int) -> np.ndarray:
    """At most ``most`` of the numbers below ``count``, spread evenly, both ends among them."""
    return np.linspace(0, count - 1, min(count, most)).round().astype(int)


def _frames(story: Story) -> np.ndarray:
    rows, disks = story.columns["disk_x"].shape
    played = int(FRAMES_PER_SECOND * max(story.duration, SHORTEST_PLAYBACK))
    return _spread(rows, max(1, min(played, MOST_FRAMES, MOST_POSES // disks)))


def _core(columns: Mapping[str, np.ndarray], rows: np.ndarray) -> np.ndarray:
    """The backbone as one strip for each row, with no more points than can be seen."""
    points = int(np.clip(MOST_POINTS // columns["length"].shape[1], 1, POINTS_PER_SEGMENT))
    return backbone(columns, rows, points)[:, None]


def _half_width(log: Log) -> float:
    """Half the drawn width of a disk, m."""
    outermost_hole = float(np.abs(log.arm["hole_offset"]).max(initial=0.0))
    return 1.2 * outermost_hole or 0.25 * float(np.mean(log.arm["disk_spacing"]))


def _moving_lines(log: Log, story: Story, frames: np.ndarray) -> dict[str, Lines]:
    centre, normal = poses(story.columns, frames)
    reach = _half_width(log) * normal
    shown = 1 + _spread(centre.shape[1] - 1, MOST_DISKS)
    disks = np.stack([centre - reach, centre + reach], axis=2)[:, shown]
    lines = {
        "arm/disks": Lines(disks, GREY, 2.0, 10.0),
        "arm/backbone": Lines(_core(story.columns, frames), BLACK, 2.5, 20.0),
    }
    if "base_x" in story.columns:
        base = np.stack([centre - reach, centre + reach], axis=2)[:, :1]
        lines["arm/base"] = Lines(base, BLACK, 4.0, 25.0)
    cables = zip(log.cables, log.arm["hole_offset"], log.arm["anchor"], _colors(len(log.cables)), strict=True)
    for name, hole_offset, anchor, color in cables:
        holes = (centre + hole_offset[:, None] * normal)[:, None, : anchor + 1]
        lines[f"arm/cables/{rr.escape_entity_path_part(name)}"] = Lines(holes, color, 1.5, 30.0)
    return lines


def _still_lines(log: Log, story: Story) -> dict[str, Lines]:
    rows = _spread(len(story.times), MOST_SAMPLES)
    tip = np.stack([story.columns["disk_x"][rows, -1], story.columns["disk_y"][rows, -1]], axis=-1)
    lines = {"arm/tip_trace": Lines(tip[None, None], PURPLE, 2.0, 16.0)}
    if "base_x" not in story.columns:
        base = _half_width(log) * np.array([[0.0, -1.0], [0.0, 1.0]])
        lines["arm/base"] = Lines(base[None, None], BLACK, 4.0, 25.0)
    if story.timeline == "sim_time" and _ends_at_rest(log):
        last = np.array([len(log.equilibria["point"]) - 1])
        lines["arm/equilibrium"] = Lines(_core(log.equilibria, last), LIGHT_GREY, 5.0, 15.0)
    return lines


def _ends_at_rest(log: Log) -> bool:
    """Whether the last equilibrium belongs to the motion's end and is not known to be unstable."""
    rest = log.equilibria
    if not rest or rest["time"][-1] < log.trajectory["time"][-1]:
        return False
    return "stable" not in rest or bool(rest["stable"][-1])


def _plots(log: Log, story: Story) -> dict[str, Plot]:
    """What is plotted, by entity; what the log does not know is left out."""
    columns = story.columns
    disks, segments = columns["disk_x"].shape[1], columns["curvature"].shape[1]
    tension = dict(zip(log.cables, columns["tension"].T, strict=True))
    tip_x, tip_y = ({f"disk {disks}": columns[name][:, -1]} for name in ("disk_x", "disk_y"))
    curvature = {f"segment {n + 1}": columns["curvature"][:, n] for n in _spread(segments, MOST_SERIES)}
    factors = columns.get("load_factor", np.empty((0, 0))).T
    plots = {
        "tension": Plot(QUANTITIES["tension"].label, tension),
        "load_factor": Plot(
            QUANTITIES["load_factor"].label, {f"load {k + 1}": f for k, f in enumerate(factors)}
        ),
        "tip_x": Plot(f"tip: {QUANTITIES['disk_x'].label}", tip_x),
        "tip_y": Plot(f"tip: {QUANTITIES['disk_y'].label}", tip_y),
        "energy": Plot("energy", _labelled(columns, "kinetic_energy", "elastic_energy", "gravity_energy")),
        "power": Plot("power", _labelled(columns, "input_power", "dissipated_power")),
        "curvature": Plot(QUANTITIES["curvature"].label, curvature),
    }
    return {f"series/{name}": plot for name, plot in plots.items() if plot.series}


def _labelled(columns: Mapping[str, np.ndarray], *names: str) -> dict[str, np.ndarray]:
    return {QUANTITIES[name].label: columns[name] for name in names if name in columns}


def _colors(count: int) -> np.ndarray:
    return PALETTE[np.arange(count) % len(PALETTE)]


def _on_screen(points: np.ndarray) -> np.ndarray:
    # A 2D view of rerun has y pointing down and cannot flip it (0.41), so y is drawn negated.
    return points * np.array([1.0, -1.0])


def _style(lines: Lines) -> rr.LineStrips2D:
    return rr.LineStrips2D.from_fields(
        radii=rr.Radius.ui_points(0.5 * lines.width),
        colors=np.array([lines.color], dtype=np.uint32),
        draw_order=lines.order,
        labels=None if lines.label is None else [lines.label],
    )


def _send_still(recording: rr.RecordingStream, entity: str, lines: Lines) -> None:
    strips = rr.LineStrips2D.from_fields(strips=_on_screen(lines.strips[0]))
    recording.log(entity, strips, _style(lines), static=True)


def _send_moving(recording: rr.RecordingStream, entity: str, when: rr.TimeColumn, lines: Lines) -> None:
    frames, strips, points, _ = lines.strips.shape
    flat = _on_screen(lines.strips).reshape(frames * strips, points, 2)
    columns = rr.LineStrips2D.columns(strips=flat).partition(np.full(frames, strips))
    recording.log(entity, _style(lines), static=True)
    recording.send_columns(entity, [when], columns)


def _send_plot(recording: rr.RecordingStream, entity: str, story: Story, plot: Plot) -> None:
    rows = _spread(len(story.times), MOST_SAMPLES)
    values = np.column_stack([series[rows] for series in plot.series.values()])
    count = len(plot.series)
    style = {"names": list(plot.series), "colors": _colors(count)}
    recording.log(entity, rr.SeriesLines(**style, widths=[1.5] * count), static=True)
    if story.timeline == "point":
        recording.log(entity, rr.SeriesPoints(**style, marker_sizes=[3.0] * count), static=True)
    columns = rr.Scalars.columns(scalars=values.ravel()).partition(np.full(len(rows), count))
    recording.send_columns(entity, [story.when(rows)], columns)


def _blueprint(
    log: Log, story: Story, lines: Mapping[str, Lines], plots: Mapping[str, Plot]
) -> rrb.Blueprint:
    arm = rrb.Spatial2DView(
        origin="arm",
        name=_ending(log),
        background=WHITE,
        visual_bounds=_bounds(lines),
    )
    series = [
        rrb.TimeSeriesView(
            origin=entity,
            name=plot.title,
            axis_x=rrb.TimeAxis(view_range=_time_range(story)),
            axis_y=rrb.ScalarAxis(range=_value_range(plot)),
            plot_legend=rrb.Corner2D.RightTop,
        )
        for entity, plot in plots.items()
    ]
    shares = [3 + len(plot.series) for plot in plots.values()]
    speed = min(1.0, story.duration / SHORTEST_PLAYBACK) or 1.0
    return rrb.Blueprint(
        rrb.Horizontal(arm, rrb.Vertical(*series, row_shares=shares), column_shares=[3, 2]),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        rrb.TimePanel(state="collapsed", timeline=story.timeline, playback_speed=speed, fps=2.0),
        auto_views=False,
    )


def _time_range(story: Story) -> rrb.TimeRange:
    """The whole time line, and room for the legend after it."""
    first, last = (int(story.times[row].astype(np.int64)) for row in (0, -1))
    # A number in a sequence is an integer for rerun, just as a count of ns is.
    start, end = (rrb.TimeRangeBoundary.absolute(nanos=n) for n in (first, last + 2 * (last - first) // 5))
    return rrb.TimeRange(start=start, end=end)


def _value_range(plot: Plot) -> tuple[float, float]:
    """All values with a margin of a tenth; for a constant, from zero to twice of it."""
    low = min(float(values.min()) for values in plot.series.values())
    high = max(float(values.max()) for values in plot.series.values())
    margin = 0.1 * (high - low) or abs(high) or 1.0
    return low - margin, high + margin


def _extent(lines: Mapping[str, Lines]) -> tuple[np.ndarray, np.ndarray, float]:
    """Lower left and upper right corner of all that is ever drawn, and its larger side; m."""
    low = np.min([each.strips.min(axis=(0, 1, 2)) for each in lines.values()], axis=0)
    high = np.max([each.strips.max(axis=(0, 1, 2)) for each in lines.values()], axis=0)
    return low, high, float((high - low).max())


def _scale(lines: Mapping[str, Lines]) -> Lines:
    """A bar of 1, 2 or 5 times a power of ten, below the arm: the view has no axes."""
    (left, bottom), _, size = _extent(lines)
    steps = np.array([1.0, 2.0, 5.0]) * 10.0 ** np.floor(np.log10(size / 3))
    length = steps[np.sum(steps[1:] <= size / 3)]
    below = bottom - 0.1 * size
    bar = np.array([[left, below], [left + length, below]])
    return Lines(bar[None, None], BLACK, 2.0, 5.0, f"{length:g} m")


def _bounds(lines: Mapping[str, Lines]) -> rrb.VisualBounds2D:
    """All that is ever drawn, with a margin of a tenth."""
    low, high, size = _extent(lines)
    (left, bottom), (right, top) = _on_screen(low - 0.1 * size), _on_screen(high + 0.1 * size)
    return rrb.VisualBounds2D(x_range=(left, right), y_range=(top, bottom))
