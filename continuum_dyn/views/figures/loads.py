"""Forces and moments on disks at rows of a log, from the scenario in it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from continuum_dyn.scenario.scenario import Scenario
from statics.effects import DiskLoad, DiskLoads


@dataclass(frozen=True)
class ActingLoad:
    """A load at each row: its place (m) and force (N), shape (rows, 2), and moment (N m), shape (rows,)."""

    place: np.ndarray
    force: np.ndarray
    moment: np.ndarray


def acting_loads(
    scenario: Scenario | None, columns: Mapping[str, np.ndarray], rows: np.ndarray
) -> list[ActingLoad]:
    """The loads of the scene, turned with their disk if they follow it, times their factor if driven."""
    if scenario is None:
        return []
    given = [
        load for effect in scenario.scene.effects if isinstance(effect, DiskLoads) for load in effect.loads
    ]
    numbers = np.cumsum([load.driven for load in given]) - 1
    return [_acting(columns, rows, load, int(number)) for load, number in zip(given, numbers, strict=True)]


def _acting(columns: Mapping[str, np.ndarray], rows: np.ndarray, load: DiskLoad, number: int) -> ActingLoad:
    disk = load.disk - 1
    factor = columns["load_factor"][rows, number] if load.driven else np.ones(len(rows))
    theta = columns["disk_theta"][rows, disk] if load.follower else np.zeros(len(rows))
    along, across = load.force
    turned = np.stack(
        [
            along * np.cos(theta) - across * np.sin(theta),
            along * np.sin(theta) + across * np.cos(theta),
        ],
        axis=-1,
    )
    place = np.stack([columns["disk_x"][rows, disk], columns["disk_y"][rows, disk]], axis=-1)
    return ActingLoad(place, factor[:, None] * turned, factor * load.moment)
