"""Scenarios changed where they are run: `--set arm.disks=16`."""

import json
import tomllib
from pathlib import Path

import pytest
from conftest import SCENARIOS
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from continuum_dyn import load_scenario
from continuum_dyn.cli import app
from continuum_dyn.record import read_log
from continuum_dyn.scenario.profiles import Constant, Sine, Step
from continuum_dyn.scenario_files.overrides import apply_overrides
from continuum_dyn.scenario_files.toml_text import toml_text
from statics import DiskLoads, InputError

STEP = SCENARIOS / "step_response.toml"
TWO_CABLES = SCENARIOS / "antagonistic.toml"
EVERY = sorted(SCENARIOS.rglob("*.toml"))

runner = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1"})
text = st.text(st.characters(exclude_categories=["Cs"]))
value = st.recursive(
    st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False) | text,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(text, inner, max_size=3),
    max_leaves=12,
)


@given(st.dictionaries(text, value, max_size=4))
def test_toml_that_is_written_reads_back_as_it_was(content: dict[str, object]) -> None:
    read = tomllib.loads(toml_text(content))
    assert read == content
    assert repr(read) == repr(dict(sorted(content.items(), key=lambda item: list(read).index(item[0]))))


@pytest.mark.parametrize("path", EVERY, ids=lambda path: path.stem)
def test_every_scenario_written_anew_says_the_same(path: Path) -> None:
    content = tomllib.loads(path.read_text())
    assert tomllib.loads(apply_overrides(path.read_text(), path.name, ["study.kind=motion"])) == content | {
        "title": f"{content['title']}, study.kind=motion",
        "study": content["study"] | {"kind": "motion"},
    }


def test_keys_lead_through_tables_and_through_lists_by_name() -> None:
    changes = ["arm.disks=16", "cables.upper.tension.amplitude=0.5", "cables.lower.tension=2"]
    scenario = load_scenario(TWO_CABLES, changes)
    assert scenario.scene.arm.disks == 16
    assert scenario.drives == (Sine(1.0, 0.5, 2.0), Constant(2.0))


def test_a_list_entry_without_a_name_is_called_by_its_number() -> None:
    scenario = load_scenario(TWO_CABLES, ["loads.load_1.disk=5"])
    (loads,) = (effect for effect in scenario.scene.effects if isinstance(effect, DiskLoads))
    assert loads.loads[0].disk == 5


def test_values_are_typed_as_in_toml_and_a_word_needs_no_quotes() -> None:
    profile = "{ profile = 'step', before = 1.0, after = 0, at = 1e-1 }"
    changes = [f"cables.upper.tension={profile}", "solver.method=Radau", 'title="two = words"']
    scenario = load_scenario(STEP, changes)
    assert scenario.drives == (Step(1.0, 0.0, 0.1),)
    assert (scenario.solver.method, scenario.title) == ("Radau", "two = words")
    assert load_scenario(STEP, ["effects.gravity.acceleration=[0.0, 0.0]"]).scene.has("gravity")
    (cable,) = load_scenario(STEP, ["cables.'upper'.hole_offset = 0.004"]).scene.arm.cables
    assert cable.hole_offset == 0.004


def test_tables_that_the_file_leaves_out_are_made_and_the_last_change_counts() -> None:
    scenario = load_scenario(STEP, ["accuracy.tip=1e-5", "accuracy.tip=1e-6"])
    assert scenario.accuracy is not None
    assert scenario.accuracy.tip == 1e-6


def test_title_and_text_tell_of_the_changes_and_read_as_the_same_scenario(tmp_path: Path) -> None:
    scenario = load_scenario(STEP, ["arm.disks=16"])
    assert scenario.title == "Step response to 1 N, arm.disks=16"
    assert scenario.text.startswith("# step_response.toml, with\n#   arm.disks=16\n")
    again = tmp_path / "again.toml"
    again.write_text(scenario.text)
    assert load_scenario(again).scene.arm == scenario.scene.arm
    assert load_scenario(again).title == scenario.title


def test_no_change_leaves_the_text_as_it_is() -> None:
    assert load_scenario(STEP).text == STEP.read_text()


@pytest.mark.parametrize(
    ("override", "said"),
    [
        ("arm.disk=16", "[arm]: unknown key 'disk'. Did you mean 'disks'?"),
        ("amr.disks=16", "(top level): unknown key 'amr'. Did you mean 'arm'?"),
        ("effects.gravty={}", "unknown effect 'gravty'. Did you mean 'gravity'?"),
        ("effects.linear_drag.drag=1", "unknown key 'drag'"),
        ("cables.uper.tension.after=2", "no cable is named 'uper'. Did you mean 'upper'? Known: upper."),
        ("cables.upper.tension.aftr=2", "Did you mean 'after'?"),
        ("cables.upper.tension.after.at=2", "cables.upper.tension.after is 1.0, without keys."),
        ("arm.preset.name.of=2", 'arm.preset is "rone2012", without keys.'),
        ("cables.upper=2", "cables is a list of tables. Name a table and its key."),
        ("loads.load_1.disk=2", "the scenario has no [[loads]]"),
        ("solver.method=chian", "'chain'"),
        ("arm.disks=16.5", "[arm] disks: a whole number is expected"),
        ("arm.disks='16'", '[arm] disks: a whole number is expected, without quotes and unit; read "16"'),
        ("arm.disks", "not KEY=VALUE"),
        ("arm.disks=", "not KEY=VALUE"),
        ("=16", "not KEY=VALUE"),
        ("arm disks=16", "'arm disks' is not a key"),
        ("[arm]=16", "'[arm]' is not a key"),
        ("title=two words", "'two words' is not a value"),
        ("arm.disks=4\ntitle=3", "not KEY=VALUE"),
        ("accuracy.tip=1e-310", "too small a number"),
    ],
)
def test_what_leads_nowhere_is_named_with_what_is_near(override: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        load_scenario(STEP, [override])
    assert said in str(caught.value)
    assert str(STEP) in str(caught.value)


def test_run_logs_the_scenario_as_it_was_run(tmp_path: Path) -> None:
    options = ["--set", "cables.upper.tension.after=0.5", "--set", "study.samples=11"]
    result = runner.invoke(app, ["run", str(STEP), *options, "--json", "--out", str(tmp_path)])
    assert result.exit_code == 0
    log = read_log(Path(json.loads(result.stdout)["log"]))
    assert tomllib.loads(log.scenario)["cables"][0]["tension"]["after"] == 0.5
    assert log.trajectory["tension"].shape == (11, 1)
    assert log.trajectory["tension"][-1] == 0.5


@pytest.mark.parametrize("name", ["run", "explain", "modes", "cost"])
def test_unknown_keys_are_refused_before_anything_is_written(name: str, tmp_path: Path) -> None:
    folder = [] if name == "explain" else ["--out", str(tmp_path / "logs")]
    result = runner.invoke(app, [name, str(STEP), "--set", "arm.disk=16", *folder])
    assert result.exit_code == 2
    assert "Did you mean 'disks'?" in result.stderr
    assert not (tmp_path / "logs").exists()


def test_explain_tells_of_the_arm_as_it_is_changed() -> None:
    result = runner.invoke(app, ["explain", str(STEP), "--set", "arm.disks=5"])
    assert "5 segments, 10 coordinates" in result.stdout


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ("study.samples=" + "9" * 5000, "a number of too many digits"),
        ("a." * 40 + "a=1", "more than 32 words"),
    ],
)
def test_what_would_take_too_long_to_read_is_said_to_be_too_long(change: str, why: str) -> None:
    with pytest.raises(InputError, match=why):
        load_scenario(STEP, [change])
