"""Loops there and back, against areas that are known."""

import numpy as np
import pytest

from continuum_dyn.answers.loops import Loop, on_both_branches, widest_gap, widest_loop, work_around
from continuum_dyn.answers.turnings import monotonic_branches

TURN = np.linspace(0.0, 4.0 * np.pi, 4001)
PULL, DRAW, LATE = 0.8, 3e-3, 0.3
"""Amplitudes of a tension, N, and of a displacement, m, and the phase by which this one is late, rad."""


def loop_of(drive: np.ndarray) -> tuple[Loop, np.ndarray]:
    loop = widest_loop(drive, monotonic_branches(drive, 0.01 * float(np.ptp(drive))))
    assert loop is not None
    return loop, drive


@pytest.mark.parametrize("driven", ["by tension", "by length"])
@pytest.mark.parametrize("start", [0.0, 1.0, np.pi, 5.0])
def test_work_around_an_ellipse_is_its_area(driven: str, start: float) -> None:
    """Of a hysteretic spring under a sine: pi times both amplitudes and the sine of the phase."""
    tension = 1.0 + PULL * np.cos(TURN + start)
    draw = DRAW * np.cos(TURN + start - LATE)
    loop, drive = loop_of(tension if driven == "by tension" else draw)
    area = np.pi * PULL * DRAW * np.sin(LATE)
    assert work_around(loop, drive, tension, draw) == pytest.approx(area, rel=1e-5)


def test_parallelogram_of_dry_friction_has_its_exact_area() -> None:
    """Sticks at 1 N and 0 N while the tension changes by 0.4 N; slips 2 mm in between."""
    tension = np.array([0.0, 0.4, 1.0, 0.6, 0.0])
    draw = np.array([0.0, 0.0, 2e-3, 2e-3, 0.0])
    loop, drive = loop_of(tension)
    assert work_around(loop, drive, tension, draw) == pytest.approx(0.4 * 2e-3, rel=1e-12)


def test_part_of_a_way_back_is_closed_at_its_end() -> None:
    tension = np.array([0.0, 2.0, 1.0])
    draw = np.array([0.0, 2e-3, 1.5e-3])
    loop, drive = loop_of(tension)
    assert work_around(loop, drive, tension, draw) == pytest.approx(0.5 * 1.0 * 0.5e-3, rel=1e-12)
    there, back = on_both_branches(loop, drive, draw)
    np.testing.assert_allclose([there[0], back[0]], [1e-3, 1.5e-3])
    assert widest_gap(loop, drive, np.column_stack([draw, 0.0 * draw])) == pytest.approx(0.5e-3)


def test_widest_of_several_loops_is_taken_and_the_later_of_equals() -> None:
    drive = np.array([0.0, 1.0, 0.5, 3.0, 0.5, 3.0])
    loop = widest_loop(drive, monotonic_branches(drive, 0.1))
    assert loop is not None
    assert (loop.there, loop.back, loop.rises) == (slice(3, 5), slice(4, 6), False)
    assert widest_loop(np.arange(4.0), monotonic_branches(np.arange(4.0), 0.1)) is None
