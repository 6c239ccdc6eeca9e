"""Hard cases: each ends as its file says, within its bounds, by every method that claims it."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from conftest import SCENARIOS
from typer.testing import CliRunner

from continuum_dyn import simulate
from continuum_dyn.cli import app
from continuum_dyn.hard_cases import HardCase, energies, judge, load_case, missed_by
from continuum_dyn.integrators import METHODS
from continuum_dyn.record import write_log
from statics import InputError, Outcome

HARD = SCENARIOS / "hard"
SLOW = {
    "a_step_every_5_ms",
    "disks_without_rotary_inertia",
    "friction_that_sticks_and_slips",
    "payload_of_a_million_disks",
    "profile_of_1e5_rows",
    "sine_above_the_highest_bending_mode",
    "tolerance_of_1e-12",
    "undamped_for_1e5_periods",
    "upright_arm_that_falls",
    "whip_through_several_turns",
}
"""Cases that take seconds, or equations of their own to compile."""
CASES = [
    pytest.param(path, id=path.stem, marks=pytest.mark.slow if path.stem in SLOW else ())
    for path in sorted(HARD.glob("*.toml"))
]


def numbers(path: Path) -> list[np.ndarray]:
    """Every dataset of numbers in a log."""
    found: list[np.ndarray] = []

    def visit(_name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f":
            found.append(item[()])

    with h5py.File(path) as file:
        file.visititems(visit)
    return found


@pytest.mark.parametrize("path", CASES)
def test_case_keeps_its_bounds_and_its_log_holds_numbers_alone(path: Path, tmp_path: Path) -> None:
    for verdict in judge(load_case(path)):
        assert verdict.missed == (), verdict.method
        assert verdict.run is not None
        write_log(verdict.run, tmp_path / "log.h5")
        assert all(np.isfinite(values).all() for values in numbers(tmp_path / "log.h5"))


def test_each_case_says_in_one_sentence_why_it_is_hard() -> None:
    titles = [load_case(path).scenario.title for path in sorted(HARD.glob("*.toml"))]
    assert len(set(titles)) == len(titles)
    assert all(len(title.split()) > 10 for title in titles)


@pytest.fixture
def one_disk() -> HardCase:
    return load_case(HARD / "one_disk.toml")


@pytest.mark.parametrize("bound", ["tip_error", "settled_gap", "ledger", "energy_growth", "energy_trend"])
def test_a_bound_that_is_broken_is_named(one_disk: HardCase, bound: str) -> None:
    strict = replace(one_disk, expect=replace(one_disk.expect, steps={"chain": 2000}, **{bound: 1e-25}))
    (verdict,) = judge(strict)
    assert [missed.split()[0] for missed in verdict.missed] == [bound]


def test_too_many_steps_and_another_outcome_are_named(one_disk: HardCase) -> None:
    (verdict,) = judge(replace(one_disk, expect=replace(one_disk.expect, steps={"chain": 1})))
    assert "steps" in verdict.missed[0]
    hole = replace(one_disk.expect, outcome=Outcome.GEOMETRY_LIMIT, steps={"chain": 2000})
    (verdict,) = judge(replace(one_disk, expect=hole))
    assert verdict.missed == ("ended as settled, not geometry_limit",)


def test_energy_that_grows_without_drive_is_seen(one_disk: HardCase) -> None:
    run = simulate(one_disk.scenario)
    assert run.trajectory is not None
    last = run.trajectory.ledger["kinetic_energy"]
    last[-1] += 1e-2 * run.trajectory.ledger["input_work"].max()
    assert energies(run.trajectory)["energy_growth"] > 1e-3
    assert any("energy_growth" in missed for missed in missed_by(run, "chain", 0.0, one_disk.expect))


def test_a_scenario_that_expects_nothing_is_no_hard_case() -> None:
    with pytest.raises(InputError, match="expects nothing"):
        load_case(SCENARIOS / "step_response.toml")


def folder_with(tmp_path: Path, *changes: tuple[str, str]) -> Path:
    text = (HARD / "one_disk.toml").read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "one_disk.toml").write_text(text)
    return tmp_path


def test_command_shows_and_writes_every_claiming_method(tmp_path: Path) -> None:
    folder, table = folder_with(tmp_path), tmp_path / "table.md"
    result = CliRunner().invoke(app, ["hard", str(folder), "--out", str(table)])
    assert result.exit_code == 0, result.output
    assert max(map(len, result.output.splitlines())) <= 80
    rows = [line for line in table.read_text().splitlines() if line.startswith("| one_disk")]
    assert [row.split(" | ")[1:3] for row in rows] == [["chain", "settled"], ["Radau", "settled"]]


def test_command_tries_the_other_methods_and_fails_by_a_broken_bound(tmp_path: Path) -> None:
    folder, table = folder_with(tmp_path, ("chain = 2000", "chain = 2")), tmp_path / "table.csv"
    result = CliRunner().invoke(app, ["hard", str(folder), "--every-method", "--out", str(table)])
    assert result.exit_code == 1
    assert "one_disk, chain: steps" in result.output
    rows = [line.split(",") for line in table.read_text().splitlines()[1:]]
    assert [row[1] for row in rows] == [
        "chain",
        "Radau",
        *(m for m in METHODS if m not in ("chain", "Radau")),
    ]
    assert next(row for row in rows if row[1] == "midpoint")[3] == "refused"


@pytest.mark.parametrize("suffix", [".txt", ""])
def test_command_writes_no_other_kind_of_table(tmp_path: Path, suffix: str) -> None:
    out = str(tmp_path / f"table{suffix}")
    result = CliRunner().invoke(app, ["hard", str(folder_with(tmp_path)), "--out", out])
    assert result.exit_code == 2
    assert ".md or .csv" in result.output
