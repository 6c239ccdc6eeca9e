"""Rone and Ben-Tzvi 2012: its table, and what its text says of Fig. 4."""

import numpy as np
import pytest

from statics import Scene, equilibrium, tension_ramp

TABLE_2_Y = np.array([-5.7854e-5, -2.0610e-4, -4.0136e-4, -6.1469e-4])
"""Unactuated disk positions, m; Rone 2012, Table 2, virtual-work column (its rows are disks 1 to 4)."""


def test_unactuated_disks_are_where_table_2_has_them(paper_arm: Scene) -> None:
    rest = equilibrium(paper_arm, 0.0)
    assert rest.stable
    np.testing.assert_allclose(rest.disk_y, TABLE_2_Y, rtol=2e-4)
    np.testing.assert_allclose(rest.disk_x, [1.9999e-2, 3.9999e-2, 5.9998e-2, 7.9997e-2], atol=1e-6)


@pytest.mark.parametrize(
    ("tension", "below"), [(0.05, True), (0.1, True), (0.5, False), (1.0, False), (2.0, False)]
)
def test_tip_is_below_the_horizontal_up_to_a_tenth_newton_and_above_from_half(
    paper_arm: Scene, tension: float, below: bool
) -> None:
    rest = equilibrium(paper_arm, tension)
    assert rest.stable
    assert (rest.tip[1] < 0) == below


def test_tension_lifts_the_tip_steadily(paper_arm: Scene) -> None:
    tips = [point.tip[1] for point in tension_ramp(paper_arm, [0.0, 0.05, 0.1, 0.5, 1.0, 2.0])]
    assert np.all(np.diff(tips) > 0)


@pytest.mark.parametrize("tension", [0.0, 0.05, 0.1, 0.5, 1.0, 2.0, 5.0])
def test_residual_at_rest_is_rounding(paper_arm: Scene, tension: float) -> None:
    assert equilibrium(paper_arm, tension).residual < 1e-14  # N and N m
