"""How far a slow motion lags behind its static path."""

import numpy as np


def gap(tip: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """Distance (m) of the tip from where it would rest, both of shape (samples, 2), m."""
    return np.hypot(*(tip - rest).T)


def delay(time: np.ndarray, tip: np.ndarray, rest: np.ndarray) -> float | None:
    """The time (s) by which the tip is late on its static path; None if the path stays where it is.

    Least squares of tip(t) = rest(t) - delay rest'(t): to first order rest(t - delay). What the tip swings
    about that averages out.
    """
    velocity = np.diff(rest, axis=0) / np.diff(time)[:, None]
    ahead = 0.5 * ((tip - rest)[1:] + (tip - rest)[:-1])
    squared = float(np.sum(velocity**2))
    return None if squared == 0.0 else -float(np.sum(ahead * velocity)) / squared


def rate_within(error: float, rates: np.ndarray, lags: np.ndarray) -> float | None:
    """The rate up to which the lag stays below ``error`` (m), by the lags at some rates, or None.

    Between two rates the lag is a power of the rate. Beyond the least and the most it is not known.
    """
    order = np.argsort(rates)
    rates, lags = rates[order], lags[order]
    above = np.flatnonzero(lags > error)
    if not above.size or above[0] == 0:
        return None
    ends = slice(above[0] - 1, above[0] + 1)
    return float(np.exp(np.interp(np.log(error), np.log(lags[ends]), np.log(rates[ends]))))
