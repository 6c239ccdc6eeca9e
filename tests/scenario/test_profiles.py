"""Tension profiles: values, corners, and no step across a corner."""

import tracemalloc
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from conftest import motion, moving, rone2012
from hypothesis import assume, example, given
from hypothesis import strategies as st
from pydantic import ValidationError

from continuum_dyn import Scenario, simulate
from continuum_dyn.integrators import METHODS
from continuum_dyn.integrators.chain_stepper import ChainStepper
from continuum_dyn.scenario import intervals
from continuum_dyn.scenario.intervals import cut_into_intervals, join_intervals
from continuum_dyn.scenario.profiles import (
    TIME_RESOLUTION,
    Constant,
    Profile,
    Ramp,
    Sine,
    SmoothRamp,
    Step,
    Table,
    change_times,
    lower_bound,
)
from continuum_dyn.scenario.rates import Rate
from continuum_dyn.scenario.solver import Method, Solver
from continuum_dyn.scenario.studies import MotionStudy
from statics import InputError


def sampled(profile: Profile | Rate, times: np.ndarray, duration: float) -> np.ndarray:
    stretches = cut_into_intervals((profile,), duration)
    values = np.empty(times.size)
    for interval in stretches:
        inside = (times >= interval.start) & (times <= interval.end)
        values[inside] = interval.inputs(times[inside])[:, 0]
    return values


TIMES = np.linspace(0.0, 2.0, 401)


@pytest.mark.parametrize(
    ("profile", "expected"),
    [
        (Constant(1.5), lambda t: np.full_like(t, 1.5)),
        (Step(before=1.0, after=3.0, at=0.7), lambda t: np.where(t < 0.7, 1.0, 3.0)),
        (Step(before=1.0, after=3.0), lambda t: np.full_like(t, 3.0)),
        (Ramp(1.0, 2.0, 0.5, 1.5), lambda t: np.interp(t, [0.5, 1.5], [1.0, 2.0])),
        (Ramp(1.0, 2.0, 0.0, 1.5), lambda t: np.interp(t, [0.0, 1.5], [1.0, 2.0])),
        (
            SmoothRamp(1.0, 2.0, 0.5, 1.5),
            lambda t: 1.5 - 0.5 * np.cos(np.pi * np.interp(t, [0.5, 1.5], [0.0, 1.0])),
        ),
        (Sine(1.0, 0.5, 2.0), lambda t: 1.0 + 0.5 * np.sin(4 * np.pi * t)),
        (Sine(1.0, 0.5, 2.0, phase=0.7), lambda t: 1.0 + 0.5 * np.sin(4 * np.pi * t + 0.7)),
        (Table((0.3, 0.9, 1.2), (1.0, 2.0, 0.0)), lambda t: np.interp(t, [0.3, 0.9, 1.2], [1.0, 2.0, 0.0])),
        (Table((-1.0, 1.0), (1.0, 2.0)), lambda t: np.interp(t, [-1.0, 1.0], [1.0, 2.0])),
        (Table((5.0,), (1.0,)), lambda t: np.full_like(t, 1.0)),
    ],
)
def test_profile_has_the_values_that_its_name_says(
    profile: Profile, expected: Callable[[np.ndarray], np.ndarray]
) -> None:
    np.testing.assert_allclose(sampled(profile, TIMES, 2.0), expected(TIMES), atol=1e-14)


@pytest.mark.parametrize("profile", [Sine(1.0, 0.5, 2.0, phase=0.7), SmoothRamp(1.0, 2.0, 0.5, 1.5)])
def test_rate_is_the_derivative_of_the_profile(profile: Profile) -> None:
    """By central differences, away from the kinks at 0.5 and 1.5 s."""
    times, step = np.array([0.1, 0.6, 1.0, 1.4, 1.9]), 1e-5
    for first, second in ((profile, Rate(profile)), (Rate(profile), Rate(Rate(profile)))):
        ahead, behind = (sampled(first, times + sign * step, 2.0) for sign in (1, -1))
        np.testing.assert_allclose(sampled(second, times, 2.0), (ahead - behind) / (2 * step), atol=1e-6)


@given(rows=st.dictionaries(st.floats(-3.0, 3.0).map(lambda t: t + 0.0), st.floats(0.0, 10.0), min_size=1))
@example(rows={0.0: 0.0, float(np.nextafter(0.3, 1.0)): 1.0, 0.3: 2.0})
def test_table_is_linear_between_its_rows(rows: dict[float, float]) -> None:
    times = tuple(sorted(rows))
    assume(min(np.diff(times), default=1.0) > TIME_RESOLUTION)
    values = tuple(rows[t] for t in times)
    found = sampled(Table(times, values), TIMES, 2.0)
    np.testing.assert_allclose(found, np.interp(TIMES, times, values), rtol=1e-9, atol=1e-9)


def test_every_corner_of_every_profile_ends_a_span() -> None:
    profiles = (Step(0.0, 1.0, at=0.3), Ramp(0.0, 1.0, 0.3, 0.8), Table((0.5, 0.6), (0.0, 1.0)))
    stretches = cut_into_intervals(profiles, 1.0)
    assert [interval.start for interval in stretches] == [0.0, 0.3, 0.5, 0.6, 0.8]
    assert all(earlier.end == later.start for earlier, later in pairwise(stretches))


@pytest.mark.parametrize("method", ["chain", pytest.param("midpoint", marks=pytest.mark.slow), "LSODA"])
def test_no_step_crosses_a_corner(monkeypatch: pytest.MonkeyPatch, method: Method) -> None:
    taken: list[tuple[float, float]] = []
    plain_step = METHODS[method].stepper.step

    def noted(solver: object) -> object:
        message = plain_step(solver)  # pyright: ignore[reportArgumentType]
        ends = np.array([solver.t_old, solver.t])  # pyright: ignore[reportAttributeAccessIssue]
        if isinstance(solver, ChainStepper):
            ends = solver.records[0][: solver.internal_steps + 1]
        taken.extend(pairwise(ends.tolist()))
        return message

    monkeypatch.setattr(METHODS[method].stepper, "step", noted)
    corners = (0.0123, 0.0301, 0.0456)
    profile = Table((0.0, *corners), (0.0, 1.0, 0.2, 0.9))
    scene = moving(rone2012(), damping=method != "midpoint")
    run = simulate(Scenario(scene, (profile,), MotionStudy(0.08, samples=9), Solver(method)))
    assert run.trajectory is not None
    assert not [(a, b, c) for a, b in taken for c in corners if a < c < b]
    assert set(corners) <= {end for _, end in taken}


@pytest.mark.parametrize("method", ["chain", "explicit"])
def test_a_step_keeps_its_size_across_corners_where_nothing_jumps(method: Method) -> None:
    """A straight ramp costs as much in one piece as in four hundred, but for one step a piece."""
    scene = moving(rone2012()).without("extension")
    fine = np.linspace(0.0, 0.2, 401)
    whole, cut = (
        motion(Scenario(scene, (profile,), MotionStudy(0.2, samples=11), Solver(method, rtol=1e-10)))
        for profile in (
            Table((0.0, 0.2), (0.0, 1.0)),
            Table(tuple(fine.tolist()), tuple((5.0 * fine).tolist())),
        )
    )
    assert cut.counters["steps"] < whole.counters["steps"] + 420
    assert np.abs(cut.disk_y - whole.disk_y).max() < 2e-8  # m, by some 500 steps of 8e-12


def test_a_jump_and_a_wave_start_the_steps_anew() -> None:
    profile = Table((0.0, 0.1, 0.2), (0.0, 1.0, 0.5))
    step, wave = Step(0.0, 1.0, at=0.15), SmoothRamp(0.0, 1.0, start=0.17, end=0.3)
    (block,) = cut_into_intervals((profile, step, wave), 0.4).blocks()
    joined = join_intervals(block)
    assert [[interval.start for interval in group] for group in joined] == [
        [0.0, 0.1],
        [0.15],
        [0.17, 0.2, 0.3],
    ]


def test_motion_starts_from_the_equilibrium_before_a_step_at_zero() -> None:
    run = simulate(Scenario(moving(rone2012()), (Step(before=0.4, after=1.0),), MotionStudy(0.01, samples=3)))
    assert run.trajectory is not None
    assert run.equilibria[0].tension == [0.4]
    np.testing.assert_array_equal(run.trajectory.disk_y[0], run.equilibria[0].disk_y)
    np.testing.assert_array_equal(run.trajectory.tension[:, 0], 1.0)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: Ramp(0.0, 1.0, 1.0, 1.0),
        lambda: SmoothRamp(0.0, 1.0, 1.0, 0.5),
        lambda: Table((0.0, 1.0, 0.5), (0.0, 1.0, 2.0)),
        lambda: Table((0.0, 1.0), (0.0,)),
        lambda: Table((0.0, 5e-324), (0.0, 1.0)),
        lambda: Constant(float("nan")),
    ],
)
def test_profiles_that_cannot_be_are_refused(wrong: Callable[[], Profile]) -> None:
    with pytest.raises((InputError, ValidationError)):
        wrong()


@pytest.mark.parametrize(
    ("profile", "least"),
    [
        (Constant(-2.0), -2.0),
        (Step(1.0, -1.0), -1.0),
        (Ramp(3.0, 1.0, 0.0, 1.0), 1.0),
        (Sine(1.0, -1.5, 2.0), -0.5),
        (SmoothRamp(3.0, 1.0, 0.0, 1.0), 1.0),
        (Table((0.0, 1.0), (2.0, -3.0)), -3.0),
    ],
)
def test_lowest_value_of_a_profile(profile: Profile, least: float) -> None:
    assert lower_bound(profile) == least
    values = np.concatenate(
        [
            interval.inputs(np.linspace(interval.start, interval.end, 999))
            for interval in cut_into_intervals((profile,), 2.0)
        ]
    )
    assert values.min() == pytest.approx(least, abs=1e-4)


def test_cable_that_would_push_is_refused() -> None:
    scene = moving(rone2012())
    for profile in (Sine(1.0, 1.5, 2.0), Step(1.0, -1.0), Constant(-0.1)):
        with pytest.raises(InputError, match="cannot push"):
            Scenario(scene, (profile,), MotionStudy(1.0))


def test_a_million_corners_take_memory_for_a_block_of_them() -> None:
    count = 300_000
    time = np.linspace(0.0, 1.0, count)
    zigzag = Table(tuple(time.tolist()), tuple((np.arange(count) % 2.0).tolist()))
    many = Table((0.0, 1.0 / count), (0.0, 1.0), periods=count)
    for profile, most in ((zigzag, 50e6), (many, 30e6)):
        timeline = cut_into_intervals((profile, Constant(1.0)), 1.0)
        tracemalloc.start()
        found = sum(len(block) for block in timeline.blocks())
        largest = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert abs(found - count) <= 1
        assert largest < most
    cut = 0.5 * (time[-2] + time[-3])
    rest = cut_into_intervals((zigzag, Constant(1.0)), 1.0).after(cut)
    assert [(each.start, each.end) for each in rest] == [(cut, time[-2]), (time[-2], 1.0)]


@pytest.mark.parametrize("values", [(0.5, 2.0, 0.5), (0.5, 2.0, 1.0)])
@pytest.mark.parametrize("begin", [0.0, 0.7, -0.9])
def test_periods_of_a_table_repeat_its_rows(begin: float, values: tuple[float, ...]) -> None:
    """Also where it jumps between them, and where they begin before the motion does."""
    rows = np.array([0.0, 0.1, 0.3])
    table = Table(tuple((begin + rows).tolist()), values, periods=4)
    times = np.linspace(0.0, 3.0, 1009)  # no corner among them
    since = times - begin
    within = np.where((since > 0.0) & (since < 1.2), since % 0.3, np.clip(since, 0.0, 0.3))
    timeline = cut_into_intervals((table,), 3.0)
    np.testing.assert_allclose(timeline.inputs(times)[:, 0], np.interp(within, rows, values), atol=1e-12)
    assert table.initial == pytest.approx(np.interp(max(-begin, 0.0) % 0.3, rows, values))
    assert lower_bound(table) == 0.5


def test_blocks_meet_where_the_intervals_of_one_block_would(monkeypatch: pytest.MonkeyPatch) -> None:
    profiles = (
        Table((0.0, 0.1, 0.25), (0.0, 1.0, 0.5), periods=7),
        Ramp(0.0, 1.0, 0.3, 0.8),
        Sine(1.0, 0.5, 2.0),
    )
    whole = list(cut_into_intervals(profiles, 2.0))
    monkeypatch.setattr(intervals, "BLOCK", 3)
    timeline = cut_into_intervals(profiles, 2.0)
    assert len(list(timeline.blocks())) > 3
    assert [(each.start, each.end) for each in timeline] == [(each.start, each.end) for each in whole]
    for found, expected in zip(timeline, whole, strict=True):
        np.testing.assert_array_equal(found.pieces, expected.pieces)


@pytest.mark.parametrize(
    ("profile", "changes"),
    [
        (Constant(1.0), None),
        (Step(1.0, 1.0), None),
        (Step(1.0, 2.0, at=0.5), (0.5, 0.5)),
        (SmoothRamp(1.0, 2.0, 0.5, 1.5), (0.5, 1.5)),
        (Sine(1.0, 0.0, 2.0), None),
        (Sine(1.0, 0.5, 2.0), (0.0, np.inf)),
        (Table((0.0, 1.0, 2.0, 3.0), (1.0, 1.0, 2.0, 2.0)), (1.0, 2.0)),
        (Table((0.0, 1.0), (1.0, 2.0), periods=3), (0.0, 3.0)),
        (Table((-2.0, -1.0), (1.0, 2.0)), None),
    ],
)
def test_times_at_which_a_profile_changes(profile: Profile, changes: tuple[float, float] | None) -> None:
    assert change_times(profile) == changes
