"""Where a signal turns back."""

import numpy as np

from continuum_dyn.answers.turnings import monotonic_branches, turnings


def test_turning_points_are_the_extremes_of_a_sine() -> None:
    time = np.linspace(0.0, 2.0, 2001)
    found = turnings(np.sin(2 * np.pi * time), 0.1)
    np.testing.assert_allclose(time[found], [0.25, 0.75, 1.25, 1.75], atol=1e-3)


def test_ripples_that_are_smaller_are_no_turning_points() -> None:
    time = np.linspace(0.0, 1.0, 1001)
    rippled = time * (1.0 - time) + 1e-3 * np.sin(400.0 * time)
    assert len(turnings(rippled, 1e-2)) == 1
    assert len(turnings(rippled, 1e-4)) > 10


def test_what_stays_or_only_rises_has_no_turning_points() -> None:
    assert turnings(np.ones(5), 0.0).size == 0
    assert turnings(np.arange(5.0), 0.0).size == 0
    assert monotonic_branches(np.ones(5), 0.0) == []


def test_ways_leave_out_where_the_signal_stays() -> None:
    signal = np.array([0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 1.5, 1.0, 1.0])
    assert monotonic_branches(signal, 0.1) == [slice(1, 4), slice(5, 8)]
