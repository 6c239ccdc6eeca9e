"""The table of a ramp shows every point, or says which it leaves out."""

from dataclasses import replace
from pathlib import Path

import pytest
from conftest import SCENARIOS
from typer.testing import CliRunner

from continuum_dyn import Scenario, load_scenario, simulate
from continuum_dyn.cli import app
from continuum_dyn.commands.terminal.ramp_table import left_out, print_ramp, rows_shown
from statics import Equilibrium
from statics.equilibria import Critical
from statics.outcome import Outcome

RAMP = SCENARIOS / "tension_ramp.toml"


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario(RAMP)


@pytest.fixture(scope="module")
def point(scenario: Scenario) -> Equilibrium:
    return simulate(scenario).equilibria[-1]


def test_fifty_points_are_all_shown(point: Equilibrium) -> None:
    assert rows_shown([point] * 50) == list(range(50))
    assert left_out([point] * 50) == ""


def test_many_points_are_shown_with_both_ends_and_every_event(point: Equilibrium) -> None:
    points = [point] * 402
    events = {
        7: replace(point, critical=Critical.FOLD),
        13: replace(point, critical=Critical.BRANCHING),
        101: replace(point, lost_at=point, jumped=True),
        203: replace(point, lost_at=point),
        301: replace(point, outcome=Outcome.NO_EQUILIBRIUM),
    }
    for number, event in events.items():
        points[number] = event
    shown = rows_shown(points)
    assert {0, 401, 302, *events} <= set(shown)
    assert len(shown) < 40
    said = left_out(points)
    assert said.startswith("points 2-7, 9-13, 15-17, ... are left out, ")
    assert said.endswith(f"{402 - len(shown)} of 402; all are in the log")


def test_numbers_are_whole_however_narrow_the_terminal_is(
    scenario: Scenario,
    point: Equilibrium,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("COLUMNS", "30")
    lost = replace(point, outcome=Outcome.NO_EQUILIBRIUM, tension=point.tension + 0.123456)
    print_ramp(scenario, [point, lost])
    shown = capsys.readouterr().out
    for text in ("78.8538", "11.6092", "0.29690", "2.12346", "not found"):
        assert text in shown


def test_ramp_names_its_points_that_were_not_found_and_the_last_tip(tmp_path: Path) -> None:
    asked = ["run", str(RAMP), "--out", str(tmp_path), "--set", "cables.upper.tension=[1.0, 500.0]"]
    shown = CliRunner(env={"COLUMNS": "80"}).invoke(app, asked)
    assert shown.exit_code == 1
    assert "the last one found" in shown.stdout
    assert "not found" in shown.stdout


def test_one_of_two_cables_that_are_ramped_may_be_driven_by_length(tmp_path: Path) -> None:
    """Its rate is an input, too, which the others' rows once lay around."""
    path = tmp_path / "both.toml"
    cables = (
        'hole_offset = -0.008\nname = "lower"\ncable_displacement = [0.0, 0.001]\ncable_stiffness = 1e4\n'
    )
    text = RAMP.read_text().replace("[0.0, 0.05, 0.1, 0.5, 1.0, 2.0]", "[0.0, 1.0]")
    path.write_text(text.replace("[study]", f"[[cables]]\n{cables}\n[study]"))
    run = simulate(load_scenario(path))
    assert run.outcome is Outcome.COMPLETED
    assert [point.cable_displacement[1] for point in run.equilibria] == [0.0, 0.001]
