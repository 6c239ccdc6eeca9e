"""Assertions about figures: their grammar, and what they say of a figure that is not there."""

import pytest

from continuum_dyn.commands.terminal.assertions import judge, parse
from statics import InputError

FIGURES = {"settling_time_2": 0.3, "static_gap": 1e-8, "frequency": None}


@pytest.mark.parametrize(
    ("text", "holds"),
    [
        ("settling_time_2 < 0.8", True),
        ("settling_time_2<0.3", False),
        ("settling_time_2<=0.3", True),
        (" settling_time_2 >= .3 ", True),
        ("settling_time_2 > 3e-1", False),
        ("static_gap < 1E-7", True),
        ("static_gap > -1.", True),
    ],
)
def test_assertion_compares_a_figure_with_a_number(text: str, holds: bool) -> None:
    (verdict,) = judge(parse([text], list(FIGURES)), FIGURES)
    assert verdict.holds is holds


@pytest.mark.parametrize(
    "text",
    [
        *("settling_time_2", "settling_time_2 = 1", "settling_time_2 == 1", "1 > settling_time_2", ""),
        *("settling_time_2 < 2 * 3", "settling_time_2 < nan", "settling_time_2 < inf", "a < b < 1"),
        *("settling_time_2 < __import__('os')", "settling_time_2 < 0.8 s", "settling_time_2 < 1_0"),
        "settling_time_2 < \N{ARABIC-INDIC DIGIT ONE}",
    ],
)
def test_nothing_but_name_comparison_and_number_is_taken(text: str) -> None:
    with pytest.raises(InputError, match=r"takes NAME < NUMBER"):
        parse([text], list(FIGURES))


def test_unknown_name_is_refused_with_the_nearest() -> None:
    with pytest.raises(InputError, match=r"Did you mean 'settling_time_2'\?"):
        parse(["setling_time_2 < 1"], list(FIGURES))


@pytest.mark.parametrize("text", ["frequency < 1e9", "frequency >= 0"])
def test_figure_that_was_not_found_holds_nothing(text: str) -> None:
    (verdict,) = judge(parse([text], list(FIGURES)), FIGURES)
    assert not verdict.holds
    assert verdict.record == {"assert": str(verdict.assertion), "value": None, "holds": False}
