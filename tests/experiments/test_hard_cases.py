"""Hard cases: each ends as its file says, within its bounds, by every method that claims it."""

import csv
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
from continuum_dyn.experiments.bounds import bounds_of, energies
from continuum_dyn.experiments.hard_cases import HardCase, judge, load_cases
from continuum_dyn.integrators import METHODS
from continuum_dyn.record import write_log
from continuum_dyn.scenario.solver import Method
from statics import InputError, Outcome

HARD = SCENARIOS / "hard"
UNUSUAL = {
    "cables_that_go_slack_and_catch",
    "disks_without_mass",
    "friction_that_sticks_and_slips",
    "nodes_without_mass",
    "payload_of_a_million_disks",
    "upright_arm_that_falls",
}
"""Cases with equations of their own to compile: the tests run them as they stand in their files, and only
``continuum-dyn hard`` the same with extension, or without it."""
SLOW = {
    *UNUSUAL,
    "a_step_every_5_ms",
    "duration_of_1e4_s",
    "profile_of_1e5_rows",
    "release_from_20_newtons",
    "sine_above_the_highest_bending_mode",
    "soft_core",
    "step_to_25_newtons",
    "tolerance_of_1e-12",
    "tolerance_of_1e-9",
    "undamped_for_1e5_periods",
    "whip_through_several_turns",
}
"""Cases that take seconds, too."""
PARTS = {"undamped_for_1e5_periods": 10, "profile_of_1e5_rows": 10}
"""Long cases in which every part is like the others: the tests go through the first of so many, within its
share of the bounds; ``continuum-dyn hard`` goes through all."""

BY_ITSELF = "sine_above_the_highest_bending_mode"
"""The case whose second method takes most of the time: the tests hold the first against its own tighter
solution, and against the second without extension; ``continuum-dyn hard`` runs both."""


def claimed_by(case: HardCase, *methods: Method, **changes: Any) -> HardCase:
    """The case claimed by those alone."""
    steps = {method: case.expected.steps[method] for method in methods}
    return replace(case, expected=replace(case.expected, **{"steps": steps, **changes}))


def shortened(case: HardCase, parts: int) -> HardCase:
    """The first of the parts of a case, and its share of the steps and of the energy's trend."""
    if case.name == BY_ITSELF:
        return claimed_by(case, "chain")
    study, expected = case.scenario.require_motion("to be shortened"), case.expected
    first = replace(study, duration=study.duration / parts)
    steps = {m: count if m in expected.until else count // parts for m, count in expected.steps.items()}
    trend = None if expected.energy_trend is None else expected.energy_trend / parts
    scenario = replace(case.scenario, study=first)
    return replace(case, scenario=scenario, expected=replace(expected, steps=steps, energy_trend=trend))


CASES = [
    pytest.param(
        shortened(case, PARTS.get(path.stem, 1)),
        id=case.name,
        marks=pytest.mark.slow if path.stem in SLOW or case.name != path.stem else (),
    )
    for path in sorted(HARD.glob("*.toml"))
    for case in load_cases(path)[: 1 if path.stem in UNUSUAL else None]
]
"""By default as their files have them; the slow ones also with extension, or without it."""


def numbers(path: Path) -> list[np.ndarray]:
    """Every dataset of numbers in a log."""
    found: list[np.ndarray] = []

    def visit(_name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f":
            found.append(item[()])

    with h5py.File(path) as file:
        file.visititems(visit)
    return found


@pytest.mark.parametrize("case", CASES)
def test_case_keeps_its_bounds_and_its_log_holds_numbers_alone(case: HardCase, tmp_path: Path) -> None:
    for verdict in judge(case):
        assert verdict.missed == (), verdict.method
        assert verdict.run is not None
        write_log(verdict.run, tmp_path / "log.h5")
        assert all(np.isfinite(values).all() for values in numbers(tmp_path / "log.h5"))


def test_each_case_says_in_one_sentence_why_it_is_hard() -> None:
    titles = {path: load_cases(path)[0].scenario.title for path in sorted(HARD.glob("*.toml"))}
    assert len(set(titles.values())) == len(titles)
    assert all(len(title.split()) > 10 for title in titles.values())


ALONE = {"disks_1024", "mass_at_the_tip_alone", "nodes_without_mass"}
"""Cases that one method can do; their files say why."""


def test_each_case_but_three_is_claimed_by_two_methods_with_and_without_extension() -> None:
    for path in sorted(HARD.glob("*.toml")):
        cases = load_cases(path)
        assert path.stem in ALONE or all(len(case.expected.steps) > 1 for case in cases), path.stem
        names = {case.name for case in cases}
        once = path.stem in ("profile_of_1e5_rows", "undamped_for_1e5_periods")
        assert len(names) == (1 if once else 2), path.stem


def test_the_variant_of_a_case_differs_by_extension_alone() -> None:
    extending, not_extending = load_cases(HARD / "one_disk.toml")
    assert extending.name, not_extending.name == ("one_disk", "one_disk, without extension")
    assert extending.scenario.scene.without("extension") == not_extending.scenario.scene
    not_falling, falling = load_cases(HARD / "upright_arm_that_falls.toml")
    assert falling.name == "upright_arm_that_falls, with extension"
    assert falling.scenario.scene.without("extension") == not_falling.scenario.scene


@pytest.fixture
def one_disk() -> HardCase:
    case, _ = load_cases(HARD / "one_disk.toml")
    return claimed_by(case, "chain")


def test_bounds_go_with_tolerance_and_steps_and_the_ledgers_with_the_travel(one_disk: HardCase) -> None:
    run = simulate(one_disk.scenario)
    assert run.trajectory is not None
    found = {bound.name: bound.allowed for bound in bounds_of(run, one_disk.expected, 0.0)}
    steps, tolerance = run.trajectory.counters["steps"], 1.01e-7 * 0.02  # m, of an arm of 20 mm
    assert found["tip_error"] == pytest.approx(steps * tolerance, rel=1e-9)
    assert found["ledger"] == pytest.approx(2 * steps * tolerance / run.trajectory.travel, rel=1e-6)
    assert found["energy_growth"] == pytest.approx(found["ledger"] / 10, rel=1e-9)  # under one tension
    assert found["settled_gap"] == pytest.approx(10 * tolerance, rel=1e-9)


def test_errors_are_measured_against_the_last_method(one_disk: HardCase) -> None:
    """The chain is off from LSODA's tight solution by what it is off from its own."""
    case, _ = load_cases(HARD / "one_disk.toml")
    by_itself, by_another = judge(one_disk)[0], judge(claimed_by(case, "chain", "LSODA"))[0]
    assert by_itself.tip_error == pytest.approx(by_another.tip_error, rel=1e-2)


def test_a_method_that_claims_the_beginning_is_held_to_that(one_disk: HardCase) -> None:
    case, _ = load_cases(HARD / "one_disk.toml")
    brief = claimed_by(case, "chain", "LSODA", until={"LSODA": 0.0105})
    whole, beginning = judge(brief)
    assert (whole.missed, beginning.missed) == ((), ())
    assert beginning.run is not None
    assert beginning.run.trajectory is not None
    assert beginning.run.outcome is Outcome.COMPLETED
    assert beginning.run.trajectory.time[-1] == pytest.approx(0.010, rel=1e-12)


@pytest.mark.parametrize(
    ("bound", "change"),
    [
        ("tip_error", {"tip_error": {"chain": 1e-25}}),
        ("energy_trend", {"energy_trend": 1e-25}),
        ("steps", {"steps": {"chain": 1}}),
    ],
)
def test_a_bound_that_is_broken_is_named(one_disk: HardCase, bound: str, change: dict[str, Any]) -> None:
    (verdict,) = judge(replace(one_disk, expected=replace(one_disk.expected, **change)))
    assert [missed.split()[0] for missed in verdict.missed] == [bound]


def test_another_outcome_is_named(one_disk: HardCase) -> None:
    (verdict,) = judge(claimed_by(one_disk, "chain", outcome=Outcome.GEOMETRY_LIMIT))
    assert verdict.missed == ("ended as settled, not geometry_limit",)


def test_a_motion_without_anything_to_hold_it_against_is_not_let_through(one_disk: HardCase) -> None:
    bounds = bounds_of(simulate(one_disk.scenario), one_disk.expected, None)
    assert [bound.name for bound in bounds if not bound.kept] == ["tip_error"]


def test_energy_that_grows_without_drive_is_seen(one_disk: HardCase) -> None:
    run = simulate(one_disk.scenario)
    assert run.trajectory is not None
    last = run.trajectory.ledger["kinetic_energy"]
    last[-1] += 1e-2 * run.trajectory.ledger["input_work"].max()
    assert energies(run.trajectory)["energy_growth"] > 1e-3
    missed = [bound.name for bound in bounds_of(run, one_disk.expected, 0.0) if not bound.kept]
    assert missed == ["ledger", "energy_growth"]


def test_a_tip_beside_its_rest_is_seen(one_disk: HardCase) -> None:
    run = replace(simulate(one_disk.scenario), static_gap=1e-6)  # m; settled_within is 2e-5
    missed = [bound.name for bound in bounds_of(run, one_disk.expected, 0.0) if not bound.kept]
    assert missed == ["settled_gap"]


def test_a_scenario_that_expects_nothing_is_no_hard_case() -> None:
    with pytest.raises(InputError, match=r"no table \[expect\]"):
        load_cases(SCENARIOS / "step_response.toml")


def test_a_variant_that_the_scenario_is_by_itself_is_refused(tmp_path: Path) -> None:
    folder = folder_with(tmp_path, ("expect.without_extension", "expect.with_extension"))
    with pytest.raises(InputError, match="itself is with extension"):
        load_cases(folder / "one_disk.toml")


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
    shown = [line for line in result.output.splitlines() if not line.startswith("written:")]
    assert max(map(len, shown)) <= 80
    rows = [line.split(" | ") for line in table.read_text().splitlines() if line.startswith("| ")]
    found = [(row[0].strip("| "), row[1]) for row in rows if row[1] != "outcome"]
    methods = ("chain", "Radau", "LSODA", "chain", "explicit", "LSODA")
    assert found == [(method, "settled") for method in methods]


def test_command_tries_the_other_methods_and_fails_by_a_broken_bound(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("continuum_dyn.commands.hard.PATIENCE", 0.05)
    folder, table = folder_with(tmp_path, ("chain = 660, Radau", "chain = 2, Radau")), tmp_path / "table.csv"
    result = CliRunner().invoke(app, ["hard", str(folder), "--every-method", "--out", str(table)])
    assert result.exit_code == 1
    assert "one_disk, chain: steps" in result.output
    rows = [row for row in csv.reader(table.read_text().splitlines()[1:]) if row[0] == "one_disk"]
    claiming = ("chain", "Radau", "LSODA")
    assert [row[1] for row in rows] == [*claiming, *(m for m in METHODS if m not in claiming)]
    assert next(row for row in rows if row[1] == "midpoint")[3] == "refused"


def test_page_of_all_methods_counts_how_each_did(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("continuum_dyn.commands.hard.PATIENCE", 0.05)
    folder, page = folder_with(tmp_path), tmp_path / "page.md"
    CliRunner().invoke(app, ["hard", str(folder), "--every-method", "--out", str(page)])
    lines = page.read_text().splitlines()
    assert max(len(line) for line in lines if not line.startswith("#")) <= 100
    assert "| chain | 2 |  |  |  |  |" in lines
    assert "| midpoint |  |  |  |  | 2 |" in lines
    assert any(line.startswith("| (RK23) | budget_exceeded |") for line in lines)


@pytest.mark.parametrize("suffix", [".txt", ""])
def test_command_writes_no_other_kind_of_table(tmp_path: Path, suffix: str) -> None:
    out = str(tmp_path / f"table{suffix}")
    result = CliRunner().invoke(app, ["hard", str(folder_with(tmp_path)), "--out", out])
    assert result.exit_code == 2
    assert ".md or .csv" in result.output
