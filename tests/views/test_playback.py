"""A recording for rerun shows what the log holds, or says why it cannot."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import logged
from playback_entities import entities_of
from rerun.chunk import RrdReader
from typer.testing import CliRunner

from continuum_dyn.cli import app
from continuum_dyn.record import Log
from continuum_dyn.views.playback import playback
from continuum_dyn.views.playback.arm import POINTS_PER_SEGMENT
from continuum_dyn.views.playback.recording import save
from statics import Outcome
from statics.errors import LogError

LEDGER = ("kinetic_energy", "elastic_energy", "gravity_energy", "input_work", "dissipated_energy")


def assert_close(actual: Any, expected: Any, within: float = 1e-8) -> None:
    """Equal within so many m: rerun keeps positions as float32."""
    np.testing.assert_allclose(actual, expected, rtol=0.0, atol=within)


@pytest.fixture(scope="module")
def motion(tmp_path_factory: pytest.TempPathFactory) -> Log:
    return logged("step_response", tmp_path_factory.mktemp("motion"))


@pytest.fixture(scope="module")
def ramp(tmp_path_factory: pytest.TempPathFactory) -> Log:
    return logged("tension_ramp", tmp_path_factory.mktemp("ramp"))


def shown(log: Log, folder: Path) -> dict[str, dict[str, list[Any]]]:
    """Entities of the recording of a log, by path: their columns by name, those that never change too."""
    path = folder / "shown.rrd"
    save([log], path)
    return entities_of(path)


def points(entity: Mapping[str, list[Any]]) -> np.ndarray:
    """Shape (frames, strips, points, 2), m, y pointing up again."""
    return np.array(entity["LineStrips2D:strips"]) * [1.0, -1.0]


def seconds(entity: Mapping[str, list[Any]]) -> np.ndarray:
    return np.array(entity["sim_time"], dtype="timedelta64[ns]").astype(float) * 1e-9


def nearest_samples(log: Log, entity: Mapping[str, list[Any]]) -> np.ndarray:
    return np.searchsorted(log.trajectory["time"], seconds(entity) - 1e-9)


def test_series_of_a_motion_are_those_of_the_log(motion: Log, tmp_path: Path) -> None:
    entities, columns = shown(motion, tmp_path), motion.trajectory
    for name, expected in {
        "tension": columns["tension"],
        "energy": 1e3 * np.column_stack([columns[name] - columns[name][0] for name in LEDGER]),  # mJ
        "power": np.column_stack([columns["input_power"], columns["dissipated_power"]]),
        "curvature": columns["curvature"],
    }.items():
        np.testing.assert_array_equal(np.array(entities[f"/series/{name}"]["Scalars:scalars"]), expected)
    assert_close(seconds(entities["/series/tension"]), columns["time"], within=0.5e-9)


def test_series_carry_names(motion: Log, tmp_path: Path) -> None:
    entities = shown(motion, tmp_path)
    assert entities["/series/tension"]["SeriesLines:names"] == [["upper"]]
    assert entities["/series/power"]["SeriesLines:names"] == [["input power", "dissipated power"]]
    assert "kinetic energy" in entities["/series/energy"]["SeriesLines:names"][0]


def test_the_arm_is_drawn_where_the_log_has_it(motion: Log, tmp_path: Path) -> None:
    entities, columns = shown(motion, tmp_path), motion.trajectory
    rows = nearest_samples(motion, entities["/arm/backbone"])
    assert rows[0] == 0
    assert rows[-1] == len(columns["time"]) - 1
    centres = np.stack([columns["disk_x"], columns["disk_y"]], axis=-1)[rows]
    backbone = points(entities["/arm/rim"])[:, 0]
    ends_of_arcs = backbone[:, POINTS_PER_SEGMENT::POINTS_PER_SEGMENT]
    np.testing.assert_array_equal(backbone[:, 0], 0.0)
    assert_close(ends_of_arcs, centres)
    assert_close(points(entities["/arm/disks"]).mean(axis=2), centres)
    tip_trace = points(entities["/arm/tip_trace"])[0, 0]
    assert_close(tip_trace[:, 1], columns["disk_y"][:, -1])


def test_arcs_are_as_long_as_their_segments(ramp: Log, tmp_path: Path) -> None:
    backbone = points(shown(ramp, tmp_path)["/arm/rim"])[:, 0]
    drawn = np.linalg.norm(np.diff(backbone, axis=1), axis=2).sum(axis=1)
    assert_close(drawn, ramp.equilibria["length"].sum(axis=1), within=1e-6)


def test_cables_run_through_their_holes_to_their_anchor(motion: Log, tmp_path: Path) -> None:
    shortened = replace(motion, arm={**motion.arm, "anchor": np.array([3])})
    entities, columns = shown(shortened, tmp_path), motion.trajectory
    rows = nearest_samples(motion, entities["/arm/cables/upper"])
    theta, offset = columns["disk_theta"][rows, :3], motion.arm["hole_offset"][0, 0]
    holes = points(entities["/arm/cables/upper"])[:, 0]
    assert_close(holes[:, 0], [[0.0, offset]] * len(rows))
    assert_close(holes[:, 1:, 0], columns["disk_x"][rows, :3] - offset * np.sin(theta))
    assert_close(holes[:, 1:, 1], columns["disk_y"][rows, :3] + offset * np.cos(theta))


def test_a_sheathed_cable_is_drawn_from_its_start(motion: Log, tmp_path: Path) -> None:
    sheathed = replace(motion, arm={**motion.arm, "start": np.array([2])})
    holes = points(shown(sheathed, tmp_path)["/arm/cables/upper"])[:, 0]
    whole = points(shown(motion, tmp_path)["/arm/cables/upper"])[:, 0]
    assert_close(holes, whole[:, 2:])


def test_a_settled_arm_lies_on_its_equilibrium(motion: Log, tmp_path: Path) -> None:
    entities = shown(motion, tmp_path)
    equilibrium, backbone = points(entities["/arm/equilibrium"]), points(entities["/arm/rim"])
    assert_close(backbone[-1], equilibrium[-1], within=1e-6)


def test_an_equilibrium_that_is_not_of_the_end_is_not_drawn(motion: Log, tmp_path: Path) -> None:
    only_first = {name: values[:1] for name, values in motion.equilibria.items()}  # of 0 N
    assert "/arm/equilibrium" not in shown(replace(motion, equilibria=only_first), tmp_path)


def test_a_ramp_is_a_sequence_of_points(ramp: Log, tmp_path: Path) -> None:
    entities = shown(ramp, tmp_path)
    assert entities["/arm/backbone"]["point"] == ramp.equilibria["point"].tolist()
    tension = np.array(entities["/series/tension"]["Scalars:scalars"])
    np.testing.assert_array_equal(tension, ramp.equilibria["tension"])
    assert_close(points(entities["/arm/rim"])[:, 0, -1, 1], ramp.equilibria["disk_y"][:, -1])
    assert "/series/power" not in entities
    assert "/arm/equilibrium" not in entities


def test_an_arm_without_cables_is_drawn_without_them(tmp_path: Path) -> None:
    entities = shown(logged("unactuated", tmp_path), tmp_path)
    assert "/series/tension" not in entities
    assert not [path for path in entities if path.startswith("/arm/cables")]
    disk_width = np.ptp(points(entities["/arm/disks"])[0, 0, :, 1])
    assert disk_width == pytest.approx(0.01, rel=1e-3)  # half of the spacing


def test_a_straight_arm_is_drawn_straight(ramp: Log, tmp_path: Path) -> None:
    straight = {name: np.zeros_like(values) for name, values in ramp.equilibria.items()}
    straight |= {"length": ramp.equilibria["length"], "disk_x": ramp.equilibria["length"].cumsum(axis=1)}
    straight["point"] = ramp.equilibria["point"]
    backbone = points(shown(replace(ramp, equilibria=straight), tmp_path)["/arm/rim"])
    np.testing.assert_array_equal(backbone[..., 1], 0.0)
    assert_close(backbone[:, 0, -1, 0], ramp.equilibria["length"].sum(axis=1))


def test_long_arms_and_long_motions_are_thinned_out(
    motion: Log, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(playback, "MOST_POSES", 20_000)
    samples, disks = 500, 200
    many = {name: np.zeros((samples, disks)) for name in ("disk_x", "disk_y", "disk_theta", "curvature")}
    many |= {"length": np.full((samples, disks), 4e-4), "tension": np.zeros((samples, 1))}
    arm = {**motion.arm, "anchor": np.array([disks]), "hole_offset": np.full((1, disks + 1), 0.008)}
    long = replace(
        motion, trajectory={"time": np.linspace(0.0, 50.0, samples), **many}, arm=arm, equilibria={}
    )
    entities = shown(long, tmp_path)
    assert np.shape(entities["/arm/rim"]["LineStrips2D:strips"]) == (100, 1, 201, 2)
    assert np.shape(entities["/arm/disks"]["LineStrips2D:strips"]) == (100, 100, 2, 2)
    names = entities["/series/curvature"]["SeriesLines:names"][0]
    assert (len(names), names[0], names[-1]) == (8, "segment 1", "segment 200")


def test_a_log_without_a_pose_says_how_the_run_ended(ramp: Log, tmp_path: Path) -> None:
    nothing = replace(ramp, equilibria={}, outcome=Outcome.NO_EQUILIBRIUM, message="try less tension")
    (text,) = shown(nothing, tmp_path)["/outcome"]["TextDocument:text"]
    assert text == ["Tension ramp, 0 to 2 N: no equilibrium: try less tension"]


def test_the_layout_is_in_the_file(ramp: Log, tmp_path: Path) -> None:
    save([ramp], tmp_path / "ramp.rrd")
    assert len(RrdReader(tmp_path / "ramp.rrd").blueprints()) == 1


@pytest.mark.parametrize("place", ["missing/motion.rrd", "file/motion.rrd", "folder"])
def test_nothing_is_left_where_it_cannot_be_written(motion: Log, tmp_path: Path, place: str) -> None:
    (tmp_path / "file").touch()
    (tmp_path / "folder").mkdir()
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(LogError, match="cannot write the recording"):
        save([motion], tmp_path / place)
    assert sorted(tmp_path.rglob("*")) == before


def test_play_keeps_the_recording_in_a_file(motion: Log, tmp_path: Path) -> None:
    kept = tmp_path / "kept.rrd"
    result = CliRunner().invoke(app, ["play", str(motion.path), "--save", str(kept)])
    assert result.exit_code == 0
    assert points(entities_of(kept)["/arm/rim"]).shape == points(shown(motion, tmp_path)["/arm/rim"]).shape
    refused = CliRunner().invoke(app, ["play", str(motion.path), "--web", "--save", str(kept)])
    assert refused.exit_code == 2
    assert "Give one of them" in refused.output
