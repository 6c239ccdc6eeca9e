"""Ctrl-C at any time: exit 130, a readable log of what was computed, nothing else left."""

import os
import signal
from concurrent.futures import ThreadPoolExecutor
from math import inf
from pathlib import Path
from random import Random

import pytest
from conftest import SCENARIOS
from interrupting import Interrupted, at_call, interrupted, left_over
from typer.testing import CliRunner

from continuum_dyn.cli import app
from continuum_dyn.record import read_log
from statics import Outcome
from statics.support.interruption import allowed, defer_interruption

pytestmark = pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")

MOMENTS = 40
WITHOUT_CACHE = 50
"""One of so many moments lies in a run that makes its kernels anew."""


def press() -> None:
    signal.raise_signal(signal.SIGINT)


def long_motion(folder: Path) -> Path:
    """The step response, driven for a day."""
    text = (SCENARIOS / "step_response.toml").read_text().replace("duration = 1.0", "duration = 1e5")
    drive = '"sine", mean = 1.0, amplitude = 0.9, frequency = 20.0'
    path = folder / "long.toml"
    path.write_text(text.replace('"step", before = 0.0, after = 1.0', drive))
    return path


def long_ramp(folder: Path) -> Path:
    """From 0 to 2 N in a thousand points."""
    text = (SCENARIOS / "tension_ramp.toml").read_text()
    path, points = folder / "ramp.toml", [number / 500 for number in range(1001)]
    path.write_text(text.replace("[0.0, 0.05, 0.1, 0.5, 1.0, 2.0]", str(points)))
    assert path.read_text() != text
    return path


def check(found: Interrupted, finished: tuple[Outcome, ...] = ()) -> None:
    """It ended by the interruption, or was through; and left what it should."""
    assert "Traceback" not in found.errors
    assert not found.left_over
    if found.log is None:
        assert found.status == 130
    elif found.log.outcome in finished:
        assert found.status in (0, 130)
    else:
        assert found.status == 130
        assert found.log.outcome is Outcome.INTERRUPTED


@pytest.mark.parametrize(
    ("name", "place", "call", "outcome", "told"),
    [
        ("tension_ramp", "statics.ramp:_continued", 2, "interrupted", "after 3 of 6 points"),
        ("snap_through", "statics.arc_length:_Follower._step", 5, "interrupted", "interrupted at"),
        ("step_response", "continuum_dyn.scenario_files.reading:build", 1, None, ""),
        ("step_response", "statics.equilibria:StaticSolver.solve", 2, "interrupted", "before the motion"),
        (
            "step_response",
            "continuum_dyn.simulation.in_motion:_integrate",
            1,
            "interrupted",
            "interrupted at t =",
        ),
        ("step_response", "continuum_dyn.simulation.in_motion:_find_end", 1, "settled", ""),
        (
            "slow_ramp",
            "continuum_dyn.simulation.in_motion:_find_static_path",
            1,
            "interrupted",
            "after the motion, with 0 of",
        ),
        ("step_response", "continuum_dyn.record.streaming:StreamedLog.finish", 1, "settled", ""),
        ("step_response", "continuum_dyn.views.playback.recording:record_logs", 1, "settled", ""),
        ("step_response", "continuum_dyn.commands.run:_show", 1, "settled", ""),
    ],
)
def test_interrupted_in_each_of_its_stages(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    place: str,
    call: int,
    outcome: str | None,
    told: str,
) -> None:
    """What was through by then is logged as such."""
    at_call(place, call, press, monkeypatch.setattr)
    scenario, folder = SCENARIOS / f"{name}.toml", tmp_path / "out"
    result = CliRunner().invoke(app, ["run", str(scenario), "--out", str(folder)])
    assert result.exit_code == 130
    if outcome is None:
        assert not folder.exists()
        return
    log = read_log(folder / f"{name}.h5")
    assert (log.outcome, told in log.message) == (outcome, True)
    assert (folder / f"{name}.rrd").exists()
    assert not left_over(folder, scenario)


def test_interrupted_while_it_is_loaded_it_ends_in_a_word(tmp_path: Path) -> None:
    found = interrupted(SCENARIOS / "step_response.toml", tmp_path / "out")
    assert (found.status, found.errors, found.log, found.left_over) == (130, "interrupted\n", None, [])


@pytest.mark.slow
def test_interrupted_motion_is_logged_up_to_there(tmp_path: Path) -> None:
    place = "continuum_dyn.record.streaming:StreamedLog.add"
    found = interrupted(long_motion(tmp_path), tmp_path / "out", place=place, call=2)
    check(found)
    assert found.log is not None
    assert found.log.trajectory["time"][-1] > 0


@pytest.mark.parametrize(
    "place",
    [
        pytest.param("statics.kernels.loading:Family.write", marks=pytest.mark.slow),
        pytest.param("statics.kernels.loading:_compiled", marks=pytest.mark.slow),
        "statics.kernels.compiled:_compile",
    ],
)
def test_interrupted_while_compiling_leaves_a_log_that_says_so(tmp_path: Path, place: str) -> None:
    """While passes are derived, while they are lowered, or while a function is compiled."""
    found = interrupted(long_motion(tmp_path), tmp_path / "out", "--no-cache", place=place)
    check(found)
    assert found.log is not None
    assert "before" in found.log.message
    assert not found.log.trajectory


@pytest.mark.slow
def test_interrupted_at_any_of_many_random_moments(tmp_path: Path) -> None:
    """They are drawn over the whole of a run, as long as that takes beside another one."""
    finite = [SCENARIOS / "step_response.toml", long_ramp(tmp_path)]

    def whole(scenario: Path) -> float:
        return interrupted(scenario, tmp_path / f"whole_{scenario.stem}", after=inf).seconds

    def at_a_moment(number: int) -> Interrupted:
        rng = Random(number)
        options = ("--no-cache",) if number % WITHOUT_CACHE == 0 else ()
        scenario, length = rng.choice(runs)
        return interrupted(scenario, tmp_path / f"out_{number}", *options, after=rng.uniform(0.0, length))

    with ThreadPoolExecutor(2) as pool:
        lengths = list(pool.map(whole, finite))
        runs = [*zip(finite, lengths, strict=True), (long_motion(tmp_path), lengths[0])]
        found = list(pool.map(at_a_moment, range(MOMENTS)))
    for each in found:
        check(each, finished=(Outcome.SETTLED, Outcome.COMPLETED))
    assert {each.log is None for each in found} == {True, False}


def test_what_holds_ctrl_c_comes_to_its_end() -> None:
    done = []
    with pytest.raises(KeyboardInterrupt), defer_interruption():  # noqa: PT012, what comes after the signal is the claim
        press()
        done.append("end")
    assert done == ["end"]


def test_answered_ctrl_c_raises_nothing() -> None:
    with defer_interruption() as interruption:
        press()
        interruption.asked = False
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_pressed_twice_it_raises_at_once() -> None:
    done = []
    with pytest.raises(KeyboardInterrupt), defer_interruption():  # noqa: PT012
        press()
        press()
        done.append("end")
    assert not done


def test_where_it_is_allowed_it_raises_at_once_and_is_answered() -> None:
    with defer_interruption() as interruption:
        with pytest.raises(KeyboardInterrupt), allowed():  # noqa: PT012
            press()
            pytest.fail("not reached")
        assert not interruption.asked
        press()
        with pytest.raises(KeyboardInterrupt), allowed():
            pytest.fail("not reached")


def test_a_file_is_written_whole_even_where_ctrl_c_is_allowed() -> None:
    done = []
    with defer_interruption(), pytest.raises(KeyboardInterrupt), allowed():  # noqa: PT012
        with defer_interruption():
            press()
            done.append("written")
        pytest.fail("not reached")
    assert done == ["written"]


def test_items_end_where_it_was_pressed() -> None:
    seen = []
    with defer_interruption() as interruption:
        for item in interruption.until_asked(range(5)):
            seen.append(item)
            if item == 2:
                press()
        interruption.asked = False
    assert seen == [0, 1, 2]
