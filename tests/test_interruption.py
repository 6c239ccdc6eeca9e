"""Ctrl-C at any time: exit 130, a readable log of what was computed, nothing else left."""

import os
import signal
from pathlib import Path
from random import Random

import pytest
from conftest import SCENARIOS
from interrupting import Interrupted, interrupted

from statics import Outcome
from statics.interruption import allowed, held

pytestmark = pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")


def press() -> None:
    signal.raise_signal(signal.SIGINT)


def long_motion(folder: Path) -> Path:
    """The step response, driven for a day."""
    text = (SCENARIOS / "step_response.toml").read_text().replace("duration = 1.0", "duration = 1e5")
    drive = '"sine", mean = 1.0, amplitude = 0.9, frequency = 20.0'
    path = folder / "long.toml"
    path.write_text(text.replace('"step", before = 0.0, after = 1.0', drive))
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


def test_interrupted_motion_is_logged_up_to_there(tmp_path: Path) -> None:
    found = interrupted(long_motion(tmp_path), tmp_path / "out", 6.0)
    check(found)
    assert found.log is not None
    assert found.log.trajectory["time"][-1] > 0


def test_interrupted_while_compiling_leaves_a_log_that_says_so(tmp_path: Path) -> None:
    found = interrupted(long_motion(tmp_path), tmp_path / "out", 2.5, "--no-cache")
    check(found)
    assert found.log is not None
    assert "before" in found.log.message
    assert not found.log.trajectory


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "options"),
    [*((number, ()) for number in range(20)), *((number, ("--no-cache",)) for number in range(4))],
)
def test_interrupted_at_any_time(tmp_path: Path, number: int, options: tuple[str, ...]) -> None:
    rng = Random(number)
    static = SCENARIOS / "tension_ramp.toml"
    scenario = rng.choice([SCENARIOS / "step_response.toml", long_motion(tmp_path), static])
    after = rng.uniform(0.0, 25.0 if options and scenario != static else 4.0)
    found = interrupted(scenario, tmp_path / "out", after, *options)
    check(found, finished=(Outcome.SETTLED, Outcome.COMPLETED))


def test_what_holds_ctrl_c_comes_to_its_end() -> None:
    done = []
    with pytest.raises(KeyboardInterrupt), held():  # noqa: PT012, what comes after the signal is the claim
        press()
        done.append("end")
    assert done == ["end"]


def test_answered_ctrl_c_raises_nothing() -> None:
    with held() as interruption:
        press()
        interruption.asked = False
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_pressed_twice_it_raises_at_once() -> None:
    done = []
    with pytest.raises(KeyboardInterrupt), held():  # noqa: PT012
        press()
        press()
        done.append("end")
    assert not done


def test_where_it_is_allowed_it_raises_at_once_and_is_answered() -> None:
    with held() as interruption:
        with pytest.raises(KeyboardInterrupt), allowed():  # noqa: PT012
            press()
            pytest.fail("not reached")
        assert not interruption.asked
        press()
        with pytest.raises(KeyboardInterrupt), allowed():
            pytest.fail("not reached")


def test_a_file_is_written_whole_even_where_ctrl_c_is_allowed() -> None:
    done = []
    with held(), pytest.raises(KeyboardInterrupt), allowed():  # noqa: PT012
        with held():
            press()
            done.append("written")
        pytest.fail("not reached")
    assert done == ["written"]


def test_items_end_where_it_was_pressed() -> None:
    seen = []
    with held() as interruption:
        for item in interruption.until_asked(range(5)):
            seen.append(item)
            if item == 2:
                press()
        interruption.asked = False
    assert seen == [0, 1, 2]
