"""Whether the samples of a motion are close enough to show it."""

from collections.abc import Mapping

import numpy as np

COARSE = 0.25
"""Largest difference of the tip's turn by its rates from its turn by its angles, over the latter.

For a sine it is reached at 3.7 samples per period; at two samples per period it is 1.
"""
ENOUGH = 10
"""Number of samples per period that a message recommends."""
NOTHING = 1e-12
"""Smallest turn of the tip that counts as a motion, rad."""


def describe_coarse_samples(columns: Mapping[str, np.ndarray]) -> str:
    """Message about samples too far apart for what moves; empty if they show it.

    ``columns`` are a trajectory's, by glossary name.
    The trapezoidal rule on the rates at two samples gives the tip's turn between them, unless it swings
    there and back.
    """
    if not columns or columns["time"].size < 3:
        return ""
    time = columns["time"]
    angle, rate = columns["bend_angle"].sum(axis=1), columns["bend_angle_rate"].sum(axis=1)
    with np.errstate(all="ignore"):  # columns may hold any numbers
        turns = np.diff(angle)
        by_rates = 0.5 * np.diff(time) * (rate[1:] + rate[:-1])
        turned, away = np.linalg.norm(turns), np.linalg.norm(by_rates - turns)
        frequency = np.linalg.norm(rate) / np.linalg.norm(angle - angle.mean()) / (2.0 * np.pi)
        duration = float(time[-1] - time[0])
        needed = duration * frequency * ENOUGH
    if not (turned > NOTHING and away > COARSE * turned and time.size < needed < np.inf):
        return ""
    per_period = (time.size - 1) / (duration * frequency)
    return (
        f"too few: {time.size} in {duration:g} s, {per_period:.2g} per period of a motion at about "
        f"{frequency:.3g} Hz. Plots of them do not show the motion; try samples = {int(needed) + 1}"
    )
