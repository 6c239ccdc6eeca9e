"""Layouts of rerun's viewer: views in containers, and the panels around them, as data."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal
from uuid import UUID, uuid4

import rerun_bindings as core

from continuum_dyn.views.rerun_core.stream import Stream, content

CONTAINERS = {"tabs": 1, "horizontal": 2, "vertical": 3}
HIDDEN, COLLAPSED = 1, 2
FOLLOWING = 3
SOLID = 3
RIGHT_TOP = 2


@dataclass(frozen=True)
class View:
    """A view of what is at ``origin`` and below; its ``look`` by what rerun calls its parts."""

    kind: Literal["2D", "TimeSeries", "TextDocument"]
    origin: str
    name: str | None = None
    look: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    id: UUID = field(default_factory=uuid4)

    @property
    def path(self) -> str:
        """The entity of the view in the layout."""
        return f"view/{self.id}"

    def send(self, layout: Stream) -> None:
        """Put the view into a layout."""
        _log(layout, f"{self.path}/ViewContents", "ViewContents", query=["$origin/**"])
        named = None if self.name is None else [self.name]
        about = {"class_identifier": [self.kind], "display_name": named, "space_origin": [self.origin]}
        _log(layout, self.path, "ViewBlueprint", **about)
        for name, columns in self.look.items():
            _log(layout, f"{self.path}/{name}", name, **columns)


@dataclass(frozen=True)
class Container:
    """Views and containers in ``tabs``, or beside each other with ``shares`` of the room."""

    kind: Literal["tabs", "horizontal", "vertical"]
    contents: Sequence["View | Container"]
    shares: Sequence[float] | None = None
    id: UUID = field(default_factory=uuid4)

    @property
    def path(self) -> str:
        """The entity of the container in the layout."""
        return f"container/{self.id}"

    def send(self, layout: Stream) -> None:
        """Put the container into a layout, with all that it holds."""
        for each in self.contents:
            each.send(layout)
        shared = {"col_shares" if self.kind == "horizontal" else "row_shares": self.shares}
        kind, contents = [CONTAINERS[self.kind]], [each.path for each in self.contents]
        _log(layout, self.path, "ContainerBlueprint", container_kind=kind, contents=contents, **shared)


@dataclass(frozen=True)
class Layout:
    """A whole layout: its outermost container, the state of the panels beside it, and the time line's."""

    root: Container
    beside: int
    time: Mapping[str, Any]

    def send(self, recording: Stream) -> None:
        """Send the layout to a recording, where it becomes the one that is shown."""
        application = core.get_application_id(recording.native)
        assert application is not None
        layout = Stream(core.new_blueprint(application, False, False, True))
        core.set_time_sequence("blueprint", 0, layout.native)
        self.root.send(layout)
        root = list(self.root.id.bytes)
        _log(layout, "viewport", "ViewportBlueprint", root_container=[root], auto_views=[False])
        for panel in ("blueprint_panel", "selection_panel"):
            _log(layout, panel, "PanelBlueprint", state=[self.beside])
        _log(layout, "time_panel", "TimePanelBlueprint", state=[COLLAPSED], **self.time)
        core.send_blueprint(content(layout), True, True, recording.native)
        core.disconnect(layout.native)


def _log(layout: Stream, entity: str, kind: str, /, **columns: Any) -> None:
    layout.log(entity, f"blueprint.archetypes.{kind}", static=False, **columns)
