"""The scenario that a log carries is the one that was run, and needs no file beside the log."""

from dataclasses import replace
from pathlib import Path

import pytest
from conftest import SCENARIOS, rone2012

from continuum_dyn import Run, Scenario, load_scenario
from continuum_dyn.record import Log, read_log, write_log
from continuum_dyn.record.logged_scenario import logged_scenario
from continuum_dyn.scenario.profiles import Constant
from continuum_dyn.scenario.studies import EquilibriumStudy
from statics import Outcome
from statics.errors import LogError


def logged(scenario: Scenario, folder: Path) -> Log:
    write_log(Run(scenario, Outcome.COMPLETED), folder / "log.h5")
    return read_log(folder / "log.h5")


@pytest.mark.parametrize("path", sorted(SCENARIOS.glob("*.toml")), ids=lambda path: path.stem)
def test_scenario_in_a_log_is_the_one_that_was_run(path: Path, tmp_path: Path) -> None:
    given = load_scenario(path)
    found = logged_scenario(logged(given, tmp_path))
    assert vars(found) | {"scene": None} == vars(given) | {"scene": None}
    assert found.scene.arm == given.scene.arm
    assert found.scene.effects == given.scene.effects


def test_table_in_a_subfolder_is_in_the_log_by_the_name_that_the_scenario_gives_it(tmp_path: Path) -> None:
    (tmp_path / "measured").mkdir()
    table = tmp_path / "measured" / "pull.csv"
    table.write_text("time,tension\n0.0,0.1\n1.0,0.3\n")
    text = (SCENARIOS / "slow_ramp.toml").read_text().replace("slow_ramp.csv", "measured/pull.csv")
    (tmp_path / "ramp.toml").write_text(text)
    log = logged(load_scenario(tmp_path / "ramp.toml"), tmp_path)
    assert log.tables == {"measured/pull.csv": table.read_text()}
    table.unlink()
    assert logged_scenario(log).profiles[0].initial == 0.1


def test_scenario_made_in_python_is_told_to_carry_no_text(tmp_path: Path) -> None:
    log = logged(Scenario(rone2012(), (Constant(1.0),), EquilibriumStudy()), tmp_path)
    with pytest.raises(LogError, match="from Python"):
        logged_scenario(log)


def test_scenario_that_is_none_is_refused_by_the_log_that_carries_it(tmp_path: Path) -> None:
    log = logged(load_scenario(SCENARIOS / "slow_ramp.toml"), tmp_path)
    with pytest.raises(LogError, match=r"log\.h5: not a TOML file"):
        logged_scenario(replace(log, scenario="disks = = 4"))
    with pytest.raises(LogError, match=r"log\.h5: the table 'slow_ramp.csv' is not in the log"):
        logged_scenario(replace(log, tables={}))
