"""Step figures and ring-downs of systems of first and second order, whose closed forms are known."""

from collections.abc import Callable
from math import exp, log, pi, sqrt

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from continuum_dyn.answers.ring_down import fit_ring_down
from continuum_dyn.answers.step_figures import overshoot, rise_time, settling_time
from statics import InputError

SPEED = 2 * pi * 5.0
"""Natural frequency, rad/s."""
TIME = np.linspace(0.0, 2.0, 2001)


def second_order(ratio: float) -> Callable[[np.ndarray], np.ndarray]:
    """Unit step response of x'' + 2 ratio SPEED x' + SPEED^2 x; Ogata 2010, Eq. 5-12."""
    turning = SPEED * sqrt(1 - ratio**2)

    def response(time: np.ndarray) -> np.ndarray:
        wave = np.cos(turning * time) + ratio / sqrt(1 - ratio**2) * np.sin(turning * time)
        return 1.0 - np.exp(-ratio * SPEED * time) * wave

    return response


def last_time_outside(response: Callable[..., np.ndarray], band: float) -> float:
    """By bisection of the closed form after the last of many instants at which it is outside."""
    dense = np.linspace(0.0, 2.0, 200_001)
    last = np.flatnonzero(np.abs(response(dense) - 1.0) > band)[-1]
    return brentq(lambda t: abs(float(response(t)) - 1.0) - band, dense[last], dense[last + 1])


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.5, 0.8])
def test_overshoot_is_that_of_the_damping_ratio(ratio: float) -> None:
    """Ogata 2010, Eq. 5-21."""
    part = CubicSpline(TIME, second_order(ratio)(TIME))
    assert overshoot(part, 0.0) == pytest.approx(exp(-pi * ratio / sqrt(1 - ratio**2)), abs=1e-7)


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.5, 0.8])
def test_times_are_those_of_the_closed_form(ratio: float) -> None:
    response = second_order(ratio)
    part = CubicSpline(TIME, response(TIME))
    peak = pi / (SPEED * sqrt(1 - ratio**2))
    tenth, ninety = (brentq(lambda t, at=at: float(response(t)) - at, 0.0, peak) for at in (0.1, 0.9))
    assert rise_time(part, 0.0) == pytest.approx(ninety - tenth, abs=1e-8)
    for band in (0.05, 0.02, 0.01):
        if exp(-ratio * SPEED * TIME[-1]) < band:
            last = last_time_outside(response, band)
            assert settling_time(part, band, 0.0) == pytest.approx(last, abs=1e-7)


def test_times_of_a_first_order_lag_are_logarithms() -> None:
    part = CubicSpline(TIME, 1.0 - np.exp(-TIME / 0.1))
    assert rise_time(part, 0.0) == pytest.approx(0.1 * log(9), abs=1e-8)
    assert settling_time(part, 0.02, 0.0) == pytest.approx(0.1 * log(50), abs=1e-8)
    assert overshoot(part, 0.0) == 0.0


def test_times_count_from_the_beginning_of_the_change() -> None:
    late = CubicSpline(TIME, np.where(TIME < 0.5, 0.0, 1.0 - np.exp(-np.maximum(TIME - 0.5, 0.0) / 0.1)))
    assert settling_time(late, 0.02, 0.5) == pytest.approx(0.1 * log(50), abs=1e-8)


def test_what_ends_outside_the_band_or_has_just_come_in_has_not_settled() -> None:
    part = CubicSpline(TIME, second_order(0.02)(TIME))
    assert settling_time(part, 0.01, 0.0) is None
    band = 0.05
    last = settling_time(part, band, 0.0)
    if last is not None:
        assert settling_time(part, band, 0.0, stays=TIME[-1] - last + 1e-3) is None
    assert rise_time(CubicSpline(TIME, 0.4 * TIME), 0.0) is None


# ---- the ring-down ----


def ringing(ratio: float, rest: float = 0.0) -> np.ndarray:
    return rest + second_order(ratio)(TIME)


@pytest.mark.parametrize("ratio", [0.0, 0.01, 0.1, 0.3, 0.5])
def test_fit_finds_frequency_and_damping_ratio(ratio: float) -> None:
    found = fit_ring_down(TIME, ringing(ratio, rest=0.3))
    assert found.frequency == pytest.approx(5.0, rel=1e-8)
    assert found.damping_ratio == pytest.approx(ratio, abs=1e-8)
    assert found.rest == pytest.approx(1.3, abs=1e-8)
    assert found.misfit < 1e-8


def test_envelope_touches_the_peaks() -> None:
    signal = ringing(0.1)
    found = fit_ring_down(TIME, signal)
    away = np.abs(signal - found.rest)
    later = found.start <= TIME
    gap = found.envelope(TIME[later]) - away[later]
    assert gap.min() == pytest.approx(0.0, abs=1e-6)
    assert gap.min() > -1e-9


def test_second_mode_and_noise_hardly_move_the_fit() -> None:
    noise = 1e-3 * np.random.default_rng(0).standard_normal(TIME.size)
    second = 0.05 * np.exp(-10.0 * TIME) * np.cos(6.3 * SPEED * TIME)
    found = fit_ring_down(TIME, ringing(0.05) + second + noise)
    assert found.frequency == pytest.approx(5.0, rel=1e-3)
    assert found.damping_ratio == pytest.approx(0.05, rel=0.02)
    assert 1e-3 < found.misfit < 0.1


def test_no_ring_down_is_told_with_its_reason() -> None:
    with pytest.raises(InputError, match="without oscillating"):
        fit_ring_down(TIME, 1.0 - np.exp(-TIME / 0.1))
    with pytest.raises(InputError, match="too few turning points for a frequency: 1,"):
        fit_ring_down(TIME, second_order(0.85)(TIME))
    with pytest.raises(InputError, match="too few samples: 2 "):
        fit_ring_down(TIME[::50], second_order(0.01)(TIME[::50]))
