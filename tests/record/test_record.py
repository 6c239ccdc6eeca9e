"""Logs: everything that a run has, named and with units, whole or not there."""

from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr
from conftest import SCENARIOS, moving, rone2012

from continuum_dyn import Run, Scenario, load_scenario, simulate
from continuum_dyn.integrators import Budget
from continuum_dyn.record import FORMAT_VERSION, read_log, write_log
from continuum_dyn.scenario.profiles import Step
from continuum_dyn.scenario.studies import MotionStudy, RampStudy
from statics import Outcome, Scene
from statics.errors import LogError
from statics.quantities import QUANTITIES

TRAJECTORY = {
    *("time", "bend_angle", "bend_angle_rate", "elongation", "elongation_rate", "curvature"),
    *("length", "disk_x", "disk_y", "disk_theta", "tension", "cable_displacement", "kinetic_energy"),
    *("step_size", "elastic_energy", "gravity_energy", "input_power", "dissipated_power", "input_work"),
    *("dissipated_energy", "segment", "disk"),
}


@pytest.fixture(scope="module")
def run() -> Run:
    return simulate(load_scenario(SCENARIOS / "step_response.toml"))


@pytest.fixture(scope="module")
def log(run: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("log") / "step_response.h5"
    write_log(run, path)
    return path


def test_log_holds_the_trajectory_and_the_equilibria(run: Run, log: Path) -> None:
    found = read_log(log)
    assert run.trajectory is not None
    assert set(found.trajectory) == TRAJECTORY
    np.testing.assert_array_equal(found.trajectory["disk_y"], run.trajectory.disk_y)
    np.testing.assert_array_equal(found.trajectory["input_work"], run.trajectory.ledger["input_work"])
    np.testing.assert_array_equal(found.equilibria["disk_y"], [point.disk_y for point in run.equilibria])
    np.testing.assert_array_equal(found.equilibria["stable"], True)
    assert found.outcome is Outcome.SETTLED
    assert found.cables == ("upper",)


def test_log_says_where_it_comes_from(run: Run, log: Path) -> None:
    attributes = read_log(log).attributes
    assert attributes["format_version"] == FORMAT_VERSION
    assert attributes["scenario"] == run.scenario.text
    assert "llvmlite" in attributes["versions"]
    assert attributes["method"] == "chain"
    assert attributes["static_gap"] == run.static_gap


def test_every_dataset_has_units_a_meaning_and_its_scales(log: Path) -> None:
    with h5py.File(log) as file:
        for group in ("trajectory", "equilibria", "arm"):
            for name, dataset in file[group].items():
                assert dataset.attrs["units"] == QUANTITIES[name].unit
                assert dataset.attrs["long_name"] == QUANTITIES[name].meaning
                if not dataset.is_scale:
                    assert all(len(dimension) == 1 for dimension in dataset.dims)


@pytest.mark.parametrize("group", ["trajectory", "equilibria", "arm"])
def test_log_opens_in_xarray(log: Path, group: str) -> None:
    with xr.open_dataset(log, engine="h5netcdf", group=group) as dataset:
        assert list(dataset["cable"].values) == ["upper"]
        if group == "trajectory":
            late = dataset["disk_y"].sel(disk=4, time=1.0)
            assert float(late) == pytest.approx(5.4826e-3, abs=1e-7)


def test_scene_without_extension_stores_one_coordinate(tmp_path: Path) -> None:
    plain = rone2012()
    scene = Scene(plain.arm, (effect for effect in plain.effects if effect.name != "extension"))
    scenario = Scenario(moving(scene), (Step(before=0.0, after=1.0),), MotionStudy(0.01, samples=3))
    write_log(simulate(scenario), tmp_path / "log.h5")
    found = read_log(tmp_path / "log.h5")
    assert set(found.trajectory) == TRAJECTORY - {"elongation", "elongation_rate"}
    assert "elongation" not in found.equilibria


def test_static_path_is_stored_with_its_times(tmp_path: Path) -> None:
    study = MotionStudy(0.1, samples=5, static_path=True)
    write_log(simulate(Scenario(moving(rone2012()), (Step(0.0, 1.0, at=0.05),), study)), tmp_path / "log.h5")
    found = read_log(tmp_path / "log.h5")
    np.testing.assert_array_equal(found.equilibria["time"], found.trajectory["time"])
    np.testing.assert_array_equal(found.equilibria["tension"], found.trajectory["tension"])
    np.testing.assert_array_equal(found.trajectory["tension"][:, 0], [0.0, 0.0, 1.0, 1.0, 1.0])


@pytest.mark.parametrize("name", ["unactuated", "tension_ramp"])
def test_static_studies_have_equilibria_alone(tmp_path: Path, name: str) -> None:
    run = simulate(load_scenario(SCENARIOS / f"{name}.toml"))
    write_log(run, tmp_path / "log.h5")
    found = read_log(tmp_path / "log.h5")
    assert not found.trajectory
    assert len(found.equilibria["point"]) == len(run.equilibria)
    assert found.equilibria["tension"].shape == (len(run.equilibria), len(run.scenario.scene.arm.cables))


def test_point_that_was_not_found_leaves_its_number_free(tmp_path: Path) -> None:
    run = simulate(Scenario(rone2012(), ((50.0, 90.0, 60.0),), RampStudy()))
    write_log(run, tmp_path / "log.h5")
    found = read_log(tmp_path / "log.h5").equilibria
    np.testing.assert_array_equal(found["point"], [1, 3])
    np.testing.assert_array_equal(found["tension"][:, 0], [50.0, 60.0])


def test_run_that_stopped_early_is_on_disk(tmp_path: Path) -> None:
    scenario = load_scenario(SCENARIOS / "step_response.toml")
    run = simulate(scenario, budget=Budget(steps=50))
    write_log(run, tmp_path / "log.h5")
    found = read_log(tmp_path / "log.h5")
    assert found.outcome is Outcome.BUDGET_EXCEEDED
    assert "max_steps = 50" in found.message
    assert found.trajectory["time"][-1] > 0


def test_numbers_that_are_not_finite_reach_no_log(run: Run, tmp_path: Path) -> None:
    assert run.trajectory is not None
    spoiled = replace(run, trajectory=replace(run.trajectory, disk_y=run.trajectory.disk_y * np.nan))
    with pytest.raises(LogError, match="disk_y"):
        write_log(spoiled, tmp_path / "log.h5")
    assert not list(tmp_path.iterdir())


def test_nothing_is_left_where_a_log_cannot_be_written(run: Run, tmp_path: Path) -> None:
    with pytest.raises(LogError, match="cannot write"):
        write_log(run, tmp_path / "none" / "log.h5")
    (tmp_path / "file").touch()
    with pytest.raises(LogError, match="cannot write"):
        write_log(run, tmp_path / "file" / "log.h5")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize("kind", ["missing", "text", "other", "version"])
def test_files_that_are_not_logs_are_refused(log: Path, tmp_path: Path, kind: str) -> None:
    path = tmp_path / "log.h5"
    if kind == "text":
        path.write_text("not HDF5")
    elif kind == "other":
        h5py.File(path, "w").close()
    elif kind == "version":
        path.write_bytes(log.read_bytes())
        with h5py.File(path, "a") as file:
            file.attrs["format_version"] = 99
    with pytest.raises(LogError, match=r"log\.h5"):
        read_log(path)
