"""The names and Arrow types by which rerun (0.41) knows the columns that are sent to it.

Arrays become Arrow's as they lie in memory: Arrow's own conversion loads pandas wherever that is installed.
"""

from typing import Any

import numpy as np
import pyarrow as pa

from statics.support.plain_text import plain

TEXT, FLAG, CODE = pa.utf8(), pa.bool_(), pa.uint8()
COLOR, SINGLE, DOUBLE, COUNT = pa.uint32(), pa.float32(), pa.float64(), pa.int64()
NUMBERS = {CODE: np.uint8, COLOR: np.uint32, SINGLE: np.float32, DOUBLE: np.float64, COUNT: np.int64}


def _item(kind: pa.DataType) -> pa.Field:
    return pa.field("item", kind, nullable=False)


POINT, RANGE = pa.list_(_item(SINGLE), 2), pa.list_(_item(DOUBLE), 2)
STRIP, BYTES, IDENTITY = pa.list_(_item(POINT)), pa.list_(_item(CODE)), pa.list_(_item(CODE), 16)
BOUNDS = pa.struct(pa.field(f"{axis}_range", RANGE, nullable=False) for axis in "xy")
SIZES = [pa.field(name, COLOR, nullable=False) for name in ("width", "height")]
PICTURE = pa.struct(SIZES + [pa.field(n, CODE) for n in ("pixel_format", "color_model", "channel_datatype")])
ABSOLUTE = 2
MOMENT = pa.dense_union(
    [
        pa.field("_null_markers", pa.null()),
        pa.field("CursorRelative", COUNT, nullable=False),
        pa.field("Absolute", COUNT, nullable=False),
        pa.field("Infinite", pa.null()),
    ]
)
TIMES = pa.struct([pa.field("start", MOMENT), pa.field("end", MOMENT)])

COMPONENTS: dict[str, dict[str, tuple[str, pa.DataType]]] = {
    "archetypes.Arrows2D": {
        "vectors": ("components.Vector2D", POINT),
        "origins": ("components.Position2D", POINT),
        "radii": ("components.Radius", SINGLE),
        "colors": ("components.Color", COLOR),
        "draw_order": ("components.DrawOrder", SINGLE),
    },
    "archetypes.Image": {
        "buffer": ("components.ImageBuffer", BYTES),
        "format": ("components.ImageFormat", PICTURE),
        "draw_order": ("components.DrawOrder", SINGLE),
    },
    "archetypes.LineStrips2D": {
        "strips": ("components.LineStrip2D", STRIP),
        "radii": ("components.Radius", SINGLE),
        "colors": ("components.Color", COLOR),
        "labels": ("components.Text", TEXT),
        "show_labels": ("components.ShowLabels", FLAG),
        "draw_order": ("components.DrawOrder", SINGLE),
    },
    "archetypes.Scalars": {"scalars": ("components.Scalar", DOUBLE)},
    "archetypes.SeriesLines": {
        "colors": ("components.Color", COLOR),
        "widths": ("components.StrokeWidth", SINGLE),
        "names": ("components.Name", TEXT),
        "aggregation_policy": ("components.AggregationPolicy", CODE),
    },
    "archetypes.SeriesPoints": {
        "colors": ("components.Color", COLOR),
        "names": ("components.Name", TEXT),
        "marker_sizes": ("components.MarkerSize", SINGLE),
    },
    "archetypes.TextDocument": {
        "text": ("components.Text", TEXT),
        "media_type": ("components.MediaType", TEXT),
    },
    "blueprint.archetypes.Background": {
        "kind": ("blueprint.components.BackgroundKind", CODE),
        "color": ("components.Color", COLOR),
    },
    "blueprint.archetypes.ContainerBlueprint": {
        "container_kind": ("blueprint.components.ContainerKind", CODE),
        "contents": ("blueprint.components.IncludedContent", TEXT),
        "col_shares": ("blueprint.components.ColumnShare", SINGLE),
        "row_shares": ("blueprint.components.RowShare", SINGLE),
    },
    "blueprint.archetypes.PanelBlueprint": {"state": ("blueprint.components.PanelState", CODE)},
    "blueprint.archetypes.PlotBackground": {
        "color": ("components.Color", COLOR),
        "show_grid": ("blueprint.components.Enabled", FLAG),
    },
    "blueprint.archetypes.PlotLegend": {
        "corner": ("blueprint.components.Corner2D", CODE),
        "visible": ("components.Visible", FLAG),
    },
    "blueprint.archetypes.ScalarAxis": {"range": ("components.Range1D", RANGE)},
    "blueprint.archetypes.TimeAxis": {"view_range": ("blueprint.components.TimeRange", TIMES)},
    "blueprint.archetypes.TimePanelBlueprint": {
        "state": ("blueprint.components.PanelState", CODE),
        "timeline": ("blueprint.components.TimelineName", TEXT),
        "playback_speed": ("blueprint.components.PlaybackSpeed", DOUBLE),
        "fps": ("blueprint.components.Fps", DOUBLE),
        "play_state": ("blueprint.components.PlayState", CODE),
    },
    "blueprint.archetypes.ViewBlueprint": {
        "class_identifier": ("blueprint.components.ViewClass", TEXT),
        "display_name": ("components.Name", TEXT),
        "space_origin": ("blueprint.components.ViewOrigin", TEXT),
    },
    "blueprint.archetypes.ViewContents": {"query": ("blueprint.components.QueryExpression", TEXT)},
    "blueprint.archetypes.ViewportBlueprint": {
        "root_container": ("blueprint.components.RootContainer", IDENTITY),
        "auto_views": ("blueprint.components.AutoViews", FLAG),
    },
    "blueprint.archetypes.VisualBounds2D": {"range": ("blueprint.components.VisualBounds2D", BOUNDS)},
}
"""Component and type of each column, by what it belongs to; all names begin with ``rerun.``."""


def arrow(kind: pa.DataType, values: Any) -> pa.Array:
    """The values of a column, shape (rows, ...), as Arrow's.

    A list is as long as its axis, a struct a mapping of columns, a moment the count on the time line, and
    None a single row without a value.
    """
    if values is None:
        return pa.nulls(1, kind)
    if isinstance(kind, pa.StructType):
        columns = [arrow(field.type, values[field.name]) for field in kind]
        return pa.StructArray.from_arrays(columns, fields=list(kind))
    if isinstance(kind, pa.DenseUnionType):
        count = len(values)
        which, where = np.full(count, ABSOLUTE, np.int8), np.arange(count, dtype=np.int32)
        children = [arrow(COUNT, values) if n == ABSOLUTE else pa.nulls(0, kind[n].type) for n in range(4)]
        return pa.Array.from_buffers(kind, count, _buffers(which, where), children=children)
    if kind == TEXT:
        texts = [plain(text).encode() for text in values]
        return pa.Array.from_buffers(kind, len(texts), _buffers(_ends(texts), b"".join(texts)))
    values = np.asarray(values)
    if isinstance(kind, pa.FixedSizeListType | pa.ListType):
        rows = [arrow(kind.value_type, values.reshape(-1, *values.shape[2:]))]
        ends = () if isinstance(kind, pa.FixedSizeListType) else (_ends(values),)
        return pa.Array.from_buffers(kind, len(values), _buffers(*ends), children=rows)
    if kind == FLAG:
        return pa.Array.from_buffers(kind, len(values), _buffers(np.packbits(values, bitorder="little")))
    with np.errstate(over="ignore"):  # single precision ends at 3e38
        values = np.ascontiguousarray(values, NUMBERS[kind])
    return pa.Array.from_buffers(kind, len(values), _buffers(values))


def parts(values: pa.Array, counts: np.ndarray) -> pa.Array:
    """The values in lists of this length."""
    ends = np.cumsum([0, *counts], dtype=np.int32)
    return pa.Array.from_buffers(pa.list_(values.type), len(counts), _buffers(ends), children=[values])


def moments(times: np.ndarray, moves: bool) -> pa.Array:
    """Places on a time line: ns if time passes on it, otherwise numbers."""
    kind = pa.duration("ns") if moves else COUNT
    return pa.Array.from_buffers(kind, len(times), _buffers(np.ascontiguousarray(times, np.int64)))


def _ends(rows: Any) -> np.ndarray:
    return np.cumsum([0, *map(len, rows)], dtype=np.int32)


def _buffers(*arrays: np.ndarray | bytes) -> list[pa.Buffer | None]:
    """The buffers of a column: no row is missing in it."""
    return [None, *map(pa.py_buffer, arrays)]
