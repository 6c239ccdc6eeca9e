"""Logs held against their format: what is not as it should be is named, with what was read and is allowed."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import SCENARIOS
from typer.testing import CliRunner

from continuum_dyn import load_scenario, simulate
from continuum_dyn.cli import app
from continuum_dyn.integrators import Budget
from continuum_dyn.record import read_log, write_log
from continuum_dyn.record.comparison import compare
from continuum_dyn.record.log_format import ATTRIBUTES, COUNTERS, GROUPS, OPTIONAL_ATTRIBUTES
from statics.errors import LogError
from statics.quantities import QUANTITIES

runner = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1"})
STEP = SCENARIOS / "step_response.toml"
FORMAT = Path(__file__).parents[2] / "docs" / "reference" / "log_format.md"


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("log") / "step.h5"
    write_log(simulate(load_scenario(STEP)), path)
    return path


def spoiled(log: Path, folder: Path, spoil: Callable[[h5py.File], None]) -> Path:
    path = folder / "log.h5"
    path.write_bytes(log.read_bytes())
    with h5py.File(path, "r+") as file:
        spoil(file)
    return path


def replaced(name: str, values: object) -> Callable[[h5py.File], None]:
    def spoil(file: h5py.File) -> None:
        del file[name]
        file[name] = values

    return spoil


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda file: file["trajectory"].move("disk_y", "y"), "/trajectory/disk_y is missing"),
        (
            replaced("trajectory/disk_y", np.zeros((7, 4))),
            r"/trajectory/disk_y: shape \(1001, 4\) of \('time', 'disk'\) is expected; read .* \(7, 4\)",
        ),
        (
            replaced("trajectory/tension", np.zeros((1001, 1), "f4")),
            "/trajectory/tension: 64-bit floating point is expected; read float32",
        ),
        (
            replaced("trajectory/time", "soon"),
            "/trajectory/time: 64-bit floating point is expected",
        ),
        (replaced("arm/anchor", [1.5]), "/arm/anchor: 64-bit integer is expected; read float64"),
        (
            lambda file: file["trajectory/input_work"].write_direct(np.full(1001, np.nan)),
            "/trajectory/input_work holds numbers that are not finite",
        ),
        (lambda file: file.attrs.__delitem__("outcome"), "attribute outcome is missing"),
        (
            lambda file: file.attrs.__setitem__("outcome", "fine"),
            "outcome: read 'fine'. Allowed: compl",
        ),
        (
            lambda file: file.attrs.__setitem__("solve_time", "1 s"),
            "solve_time: a finite number is exp",
        ),
        (
            lambda file: file.attrs.__setitem__("format_version", 1),
            "log format 1; .* reads format 2",
        ),
        (lambda file: file.__delitem__("arm"), "group arm is missing"),
        (
            lambda file: file["arm"].attrs.__delitem__("disk_spacing"),
            "/arm: attribute disk_spacing is missing",
        ),
        (replaced("arm", h5py.ExternalLink("other.h5", "/")), "/arm: a link to elsewhere"),
        (
            replaced("trajectory/disk_x", h5py.SoftLink("/arm/disk")),
            "/disk_x: a link to elsewhere",
        ),
    ],
)
def test_log_that_departs_from_the_format_is_refused_by_the_name_of_what_does(
    log: Path, tmp_path: Path, spoil: Callable[[h5py.File], None], said: str
) -> None:
    path = spoiled(log, tmp_path, spoil)
    with pytest.raises(LogError, match=said):
        read_log(path)
    result = runner.invoke(app, ["validate", str(path)])
    assert result.exit_code == 1


def test_sizes_that_are_declared_but_not_there_are_not_read(log: Path, tmp_path: Path) -> None:
    def spoil(file: h5py.File) -> None:
        del file["tables"]
        file.create_group("tables").create_dataset("1", (2**44,), "u1", chunks=(2**20,)).attrs["file"] = (
            "a.csv"
        )

    with pytest.raises(LogError, match=r"datasets of 1.76e\+13 bytes in a file of"):
        read_log(spoiled(log, tmp_path, spoil))


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (
            lambda file: file["trajectory/disk_x"].attrs.__setitem__("units", "mm"),
            "units 'm' is expected; read 'mm'",
        ),
        (
            lambda file: file["trajectory"].__setitem__("notes", [1.0]),
            "/notes: not a name of the format",
        ),
        (lambda file: file.create_group("mine"), "/mine: not a name of the format"),
        (
            lambda file: file["trajectory/disk_x"].dims[1].detach_scale(file["trajectory/disk"]),
            "/trajectory/disk_x: disk is not attached to its axis 1",
        ),
    ],
)
def test_what_a_log_can_be_read_in_spite_of_is_told_by_validate_alone(
    log: Path, tmp_path: Path, spoil: Callable[[h5py.File], None], said: str
) -> None:
    path = spoiled(log, tmp_path, spoil)
    read_log(path)
    result = runner.invoke(app, ["validate", str(path)])
    assert result.exit_code == 1
    assert said in result.stdout


def test_logs_that_are_as_they_should_be_validate(log: Path, tmp_path: Path) -> None:
    write_log(simulate(load_scenario(SCENARIOS / "tension_ramp.toml")), tmp_path / "ramp.h5")
    result = runner.invoke(app, ["validate", str(log), str(tmp_path / "ramp.h5")])
    assert (result.exit_code, result.stdout.count("a log of format 2")) == (0, 2)
    (tmp_path / "text.h5").write_text("not HDF5")
    assert runner.invoke(app, ["validate", str(tmp_path / "text.h5")]).exit_code == 2


def test_format_names_quantities_of_the_glossary_and_its_page_names_all_of_them() -> None:
    page = FORMAT.read_text()
    names = {name for columns in GROUPS.values() for name in columns}
    assert names <= set(QUANTITIES)
    for name in (*names, *ATTRIBUTES, *OPTIONAL_ATTRIBUTES, *COUNTERS):
        assert f"`{name}`" in page, name


def test_viewers_of_hdf5_find_a_plot_in_each_group(log: Path) -> None:
    with h5py.File(log) as file:
        assert file.attrs["NX_class"] == "NXroot"
        assert file.attrs["default"] == "trajectory"
        for name in ("trajectory", "equilibria"):
            group = file[name]
            assert group.attrs["NX_class"] == "NXdata"
            assert group[group.attrs["signal"]].ndim == len(group.attrs["axes"])
            assert [group[axis].shape[0] for axis in group.attrs["axes"]] == list(
                group[group.attrs["signal"]].shape
            )


def test_info_shows_what_is_inside_in_80_columns(log: Path) -> None:
    result = runner.invoke(app, ["info", str(log)])
    assert result.exit_code == 0
    assert "settled" in result.stdout
    assert "disk_theta" in result.stdout
    assert "1001 x 4" in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 80
    assert runner.invoke(app, ["info", str(log), "--scenario"]).stdout == STEP.read_text()


def test_log_that_is_run_again_is_the_same(log: Path, tmp_path: Path) -> None:
    result = runner.invoke(app, ["run", str(log), "--out", str(tmp_path)])
    assert result.exit_code == 0
    assert "same as" in result.stdout
    assert sorted(path.name for path in tmp_path.iterdir()) == ["step_again.h5", "step_again.rrd"]


def test_log_that_tells_otherwise_than_its_scenario_is_found_out(log: Path, tmp_path: Path) -> None:
    def spoil(file: h5py.File) -> None:
        moved = file["trajectory/disk_y"][()]
        moved[500, -1] += 1e-4
        file["trajectory/disk_y"][...] = moved

    path = spoiled(log, tmp_path, spoil)
    result = runner.invoke(app, ["run", str(path), "--json", "--out", str(tmp_path)])
    assert result.exit_code == 1
    found = compare(read_log(path), read_log(log))
    assert found.tip_distance == pytest.approx(1e-4, rel=1e-6)
    assert found.place == "at t = 0.5 s"
    assert not found.same


def test_run_that_stopped_early_is_not_the_same_though_its_samples_are(log: Path, tmp_path: Path) -> None:
    write_log(simulate(load_scenario(STEP), budget=Budget(steps=50)), tmp_path / "early.h5")
    found = compare(read_log(log), read_log(tmp_path / "early.h5"))
    assert found.tip_distance is not None
    assert found.tip_distance < 1e-6
    assert not found.same
    assert replace(found, outcomes=("settled", "settled")).same
