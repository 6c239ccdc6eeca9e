"""Logs made to take memory or time are refused unread, and those of odd numbers are shown or refused."""

import tracemalloc
import zlib
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import SCENARIOS
from typer.testing import CliRunner

from continuum_dyn import load_scenario, simulate
from continuum_dyn.cli import app
from continuum_dyn.record import read_log, write_log
from continuum_dyn.record.checking import LARGEST
from continuum_dyn.record.datasets import VERSIONS
from continuum_dyn.record.logged_scenario import logged_scenario
from statics.errors import LogError

MEMORY = 100_000_000
"""Most memory that Python and NumPy may take to refuse a log, bytes."""


@pytest.fixture
def log(tmp_path: Path) -> Path:
    write_log(simulate(load_scenario(SCENARIOS / "step_response.toml")), tmp_path / "log.h5")
    return tmp_path / "log.h5"


def refusal(log: Path) -> str:
    tracemalloc.start()
    try:
        with pytest.raises(LogError) as caught:
            read_log(log)
        assert tracemalloc.get_traced_memory()[1] < MEMORY
    finally:
        tracemalloc.stop()
    return str(caught.value)


def test_chunk_larger_than_the_file_may_hold_is_not_read(log: Path) -> None:
    rows = 400_000_000
    with h5py.File(log, "r+", libver=VERSIONS) as file:
        group = file["trajectory"]
        del group["kinetic_energy"]
        made = group.create_dataset(
            "kinetic_energy", (1001,), "f8", maxshape=(None,), chunks=(rows,), compression="gzip"
        )
        made.id.write_direct_chunk((0,), zlib.compress(bytes(8_000_000)))
    assert "datasets of 3.2e+09 bytes in a file of" in refusal(log)


@pytest.mark.parametrize(("count", "said"), [(100_000, "100000 names"), (500, "a name of 2000000 ch")])
def test_names_that_are_all_one_long_text_are_not_read(log: Path, count: int, said: str) -> None:
    with h5py.File(log, "r+", libver=VERSIONS) as file:
        arm = file["arm"]
        holes = arm["hole"].size
        for name in ("cable", "hole_offset", "friction", "cable_stiffness", "anchor"):
            del arm[name]
        names = arm.create_dataset("cable", (count,), h5py.string_dtype(), chunks=(count,))
        names[0] = "x" * 2_000_000
        for name, kind in (("friction", "f8"), ("cable_stiffness", "f8"), ("anchor", "i8")):
            arm.create_dataset(name, (count,), kind)
        arm.create_dataset("hole_offset", (count, holes), "f8")
        file.flush()
        at = names.id.get_chunk_info(0).byte_offset
    content = bytearray(log.read_bytes())
    content[at : at + 16 * count] = content[at : at + 16] * count
    log.write_bytes(content)
    assert said in refusal(log)


def test_file_larger_than_any_log_is_not_read(log: Path) -> None:
    with log.open("r+b") as file:
        file.truncate(LARGEST + 1)
    assert "larger than 8 GB, and no log is" in refusal(log)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (".".join(["a"] * 20_000) + " = 1\n", "a key of more than 32 words"),
        ("[" + ".".join(['"a b"'] * 20_000) + "]\n", "a key of more than 32 words"),
        (f"x = {'1' * 5000}\n", "too many digits"),
        (f"x = {'1' * 3000}\n", "too large a number"),
        (f"x = 0x{'1' * 9000}\n", "too large a number"),
    ],
    ids=["key", "header", "5000 digits", "3000 digits", "hexadecimal"],
)
def test_scenario_that_takes_long_to_read_is_refused_at_once(log: Path, text: str, said: str) -> None:
    with h5py.File(log, "r+", libver=VERSIONS) as file:
        file.attrs["scenario"] = text
    with pytest.raises(LogError, match=said) as caught:
        logged_scenario(read_log(log))
    assert len(str(caught.value)) < 1000


def test_numbers_at_the_end_of_floating_point_are_shown_but_not_drawn(log: Path, tmp_path: Path) -> None:
    with h5py.File(log, "r+", libver=VERSIONS) as file:
        file["trajectory/disk_x"][:] = 1e308
        file["trajectory/disk_y"][:] = -1e308
    runner = CliRunner()
    assert runner.invoke(app, ["info", str(log)]).exit_code == 0
    drawn = runner.invoke(app, ["plot", str(log), "--out", str(tmp_path / "x.png")])
    assert drawn.exit_code == 2
    assert "disk_x holds numbers beyond 1e+100" in drawn.output
    assert runner.invoke(app, ["play", str(log), "--save", str(tmp_path / "x.rrd")]).exit_code == 0


def test_attributes_without_a_meaning_are_not_read(log: Path) -> None:
    with h5py.File(log, "r+", libver=VERSIONS) as file:
        file["arm"].attrs["x"] = np.zeros(1_000_000)
        file["arm"].attrs["y"] = 1.0
    assert not {"x", "y"} & set(read_log(log).arm)


@pytest.mark.parametrize(
    "change", [f"arm.disks={'1' * 5000}", ".".join(["a"] * 20_000) + "=1", "arm.disks=1e400"]
)
def test_changes_that_take_long_to_read_are_refused_in_a_line(change: str, tmp_path: Path) -> None:
    scenario = str(SCENARIOS / "tension_ramp.toml")
    result = CliRunner().invoke(app, ["run", scenario, "--out", str(tmp_path), "--set", change])
    assert result.exit_code == 2
    assert len(result.output) < 600


def test_lack_of_memory_is_an_error_in_words(log: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_: Path) -> None:
        raise MemoryError

    monkeypatch.setattr("continuum_dyn.record.read_log", fail)
    result = CliRunner().invoke(app, ["info", str(log)])
    assert result.exit_code == 2
    assert "out of memory" in result.output
