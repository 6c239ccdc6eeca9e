"""What accuracy costs: every method measured against one reference, every effect left out in turn."""

import csv
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import SCENARIOS
from typer.testing import CliRunner

from continuum_dyn import Scenario, load_scenario
from continuum_dyn.cli import app
from continuum_dyn.experiments import cost
from continuum_dyn.scenario.solver import Method
from continuum_dyn.scenario.studies import MotionStudy
from continuum_dyn.views.figures import plots
from statics import InputError, Payload


@pytest.fixture(scope="module")
def brief() -> Iterator[Scenario]:
    """A fiftieth of a second of the step response, at a few tolerances, each run once."""
    few: dict[Method, tuple[float, ...]] = {
        "chain": (1e-4, 1e-6, 1e-8),
        "LSODA": (1e-4, 1e-7),
        "RK45": (1e-3,),
    }
    scenario = load_scenario(SCENARIOS / "step_response.toml")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cost, "TOLERANCES", few)
        patch.setattr(cost, "REPEATS", 1)
        patch.setattr(cost, "SUBSEGMENTS", (1, 2, 4))
        patch.setattr(cost, "PATIENCE", 0.5)
        yield replace(scenario, study=MotionStudy(0.02, samples=21))


@pytest.fixture(scope="module")
def prices(brief: Scenario) -> cost.Cost:
    """Its cost without the effects, each of which is a structure to compile."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cost, "effects", lambda *_: [])
        return cost.measure(brief)


def test_tighter_tolerances_give_smaller_errors_for_more_work(prices: cost.Cost) -> None:
    assert prices.reference_gap < 1e-10
    for method in ("chain", "LSODA"):
        rows = [price for price in prices.prices if price.method == method]
        assert np.all(np.diff([row.error for row in rows]) < 0)
        assert np.all(np.diff([row.segment_evaluations for row in rows]) > 0)


def test_method_beyond_the_patience_is_given_up_by_name(prices: cost.Cost) -> None:
    assert prices.over_budget == {"RK45": 1e-3}  # explicit, with axial modes of 3e7 1/s


def test_frontier_is_of_least_work_whatever_a_single_clock_says(prices: cost.Cost) -> None:
    """Each method's runs together tell what an evaluation takes; the slowest run of all changes no choice."""
    chain = [price for price in prices.prices if price.method == "chain"]
    slow = replace(prices, prices=tuple(chain))
    for target, price in slow.frontier().items():
        good = [p for p in chain if p.error <= target]
        assert price == min(good, key=lambda p: p.segment_evaluations)
    disturbed = tuple(replace(p, seconds=100.0) if p is chain[0] else p for p in chain)
    assert [p and p.rtol for p in replace(slow, prices=disturbed).frontier().values()] == [
        p and p.rtol for p in slow.frontier().values()
    ]


def test_frontier_weighs_work_by_the_methods_time_for_it(prices: cost.Cost) -> None:
    weights = prices.evaluation_seconds()
    for target, price in prices.frontier().items():
        good = [p for p in prices.prices if p.error <= target]
        assert price == min(good, key=lambda p: weights[p.method] * p.segment_evaluations)


def test_fastest_rate_is_that_of_the_axial_modes(prices: cost.Cost) -> None:
    # The prototype measured 5.75e6 1/s at a fifth of this damping; an overdamped rate goes with the damping.
    assert prices.fastest_rate == pytest.approx(5 * 5.75e6, rel=0.01)


def test_picture_has_a_curve_for_each_method(prices: cost.Cost) -> None:
    by_time, by_work, by_mesh = plots.cost(prices).axes
    assert [line.get_label() for line in by_work.lines] == ["chain", "LSODA", "least work"]
    assert np.shape(by_time.lines[0].get_xdata()) == (3,)
    assert [line.get_label() for line in by_mesh.lines] == [
        "segments from disk to disk",
        "extrapolated from two meshes",
    ]


def test_meshes_are_held_against_the_exact_rod(prices: cost.Cost) -> None:
    one, two, four = prices.meshes
    assert one.tip_error > 3.5 * two.tip_error > 12 * four.tip_error
    assert one.limit_error is None
    assert two.limit_error is not None
    assert four.limit_error is not None
    assert two.limit_error > 12 * four.limit_error
    assert four.motion_seconds is not None
    assert four.segment_evaluations % 16 == 0


@pytest.mark.slow
def test_scene_that_the_exact_rod_does_not_know_has_no_meshes(
    brief: Scenario, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cost, "effects", lambda *_: [])
    heavy = replace(brief.scene.arm, payloads=(Payload(4, 0.01),))
    found = cost.measure(replace(brief, scene=replace(brief.scene, arm=heavy)))
    assert found.meshes == ()
    assert "payloads" in found.no_meshes


def test_equilibrium_has_no_cost_over_time() -> None:
    with pytest.raises(InputError, match='"equilibrium"'):
        cost.measure(load_scenario(SCENARIOS / "unactuated.toml"))


@pytest.mark.slow
def test_each_effect_is_left_out_in_turn(brief: Scenario) -> None:
    found = {effect.name: effect for effect in cost.measure(brief).effects}
    assert set(found) == {"bending", "cables", "extension", "gravity", "material_damping", "rotary_inertia"}
    assert found["bending"].tip_shift is None  # without it the arm hangs folded: no such motion
    for name in set(found) - {"bending"}:
        assert found[name].tip_shift
        assert found[name].time_ratio
    shift = {name: effect.tip_shift or 0.0 for name, effect in found.items()}
    assert shift["extension"] < 1e-5 < shift["gravity"]
    assert (found["extension"].fastest_rate or np.inf) < 1e5


def test_command_prints_and_writes_what_it_measured(
    prices: cost.Cost, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cost, "measure", lambda *_: prices)
    result = CliRunner(env={"COLUMNS": "80"}).invoke(
        app, ["cost", str(SCENARIOS / "step_response.toml"), "--out", str(tmp_path)]
    )
    assert result.exit_code == 0, result.output
    assert "Cheapest way to a tip error" in result.stdout
    assert "given up" in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 80 + len(str(tmp_path))
    with (tmp_path / "step_response_cost.csv").open() as file:
        assert len(list(csv.DictReader(file))) == len(prices.prices)
    with h5py.File(tmp_path / "step_response_cost.h5") as file:
        np.testing.assert_array_equal(file["cost/tip_error"], [p.error for p in prices.prices])
        assert file["cost/tip_error"].attrs["units"] == "m"
    assert (tmp_path / "step_response_cost.png").stat().st_size > 10_000
