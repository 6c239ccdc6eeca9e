"""The lag of a slow motion behind its static path."""

import numpy as np


def gap(tip: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """Distance (m) of the tip from its static path, both of shape (samples, 2), m."""
    return np.hypot(*(tip - rest).T)


def delay(time: np.ndarray, tip: np.ndarray, rest: np.ndarray) -> float | None:
    """The time (s) by which the tip is late on its static path; None if the path does not move.

    Least squares of tip(t) = rest(t) - delay rest'(t): to first order rest(t - delay). Swings
    about that average out.
    """
    velocity = np.diff(rest, axis=0) / np.diff(time)[:, None]
    ahead = 0.5 * ((tip - rest)[1:] + (tip - rest)[:-1])
    squared = float(np.sum(velocity**2))
    return None if squared == 0.0 else -float(np.sum(ahead * velocity)) / squared


def rate_within(error: float, rates: np.ndarray, lags: np.ndarray) -> float | None:
    """The rate up to which the lag stays below ``error`` (m), from the lags at some rates, or None.

    Between two rates the lag is a power of the rate. Outside their range it is not known.
    """
    order = np.argsort(rates)
    rates, lags = rates[order], lags[order]
    above = np.flatnonzero(lags > error)
    if not above.size or above[0] == 0:
        return None
    ends = slice(above[0] - 1, above[0] + 1)
    return float(np.exp(np.interp(np.log(error), np.log(lags[ends]), np.log(rates[ends]))))
