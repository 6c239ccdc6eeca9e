"""The free oscillation in which a motion dies away, as one damped sinusoid."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from continuum_dyn.answers.turnings import turnings
from statics.errors import InputError

LEAST_SWING = 1e-3
"""Smallest swing, in parts of the signal's range."""
FEWEST_TURNINGS = 3
"""Smallest number of turning points for a fit: one period."""
MOST_TURNINGS = 200
"""Largest number of turning points that a fit uses."""
FEWEST_SAMPLES = 4
"""Smallest number of samples from one turning point to the next."""
WORST_MISFIT = 0.5
"""Largest misfit of a damped sinusoid."""


@dataclass(frozen=True)
class RingDown:
    """rest + amplitude exp(-decay_rate (t - start)) cos(turning (t - start) + phase) from ``start`` (s) on.

    ``decay_rate`` in 1/s, ``turning`` in rad/s, ``rest`` and ``amplitude`` in the signal's unit; ``misfit``
    is the root mean square of the residual, over that of the signal about its mean.
    """

    start: float
    decay_rate: float
    turning: float
    rest: float
    amplitude: float
    phase: float
    misfit: float

    @property
    def frequency(self) -> float:
        """Frequency (Hz) without its damping, as that of a mode."""
        return float(np.hypot(self.decay_rate, self.turning)) / (2.0 * np.pi)

    @property
    def damping_ratio(self) -> float:
        """Decay rate over 2 pi times the frequency."""
        return self.decay_rate / float(np.hypot(self.decay_rate, self.turning))

    @property
    def period(self) -> float:
        """Time from peak to peak, s."""
        return 2.0 * np.pi / self.turning

    def envelope(self, time: np.ndarray) -> np.ndarray:
        """Distance from rest of the curve that touches its peaks."""
        return self.amplitude * np.exp(-self.decay_rate * (time - self.start))


def fit_ring_down(time: np.ndarray, value: np.ndarray) -> RingDown:
    """Fit a damped sinusoid about a rest to a free motion, from its first turning point on.

    Least squares in decay rate and angular frequency; for each pair of them rest, amplitude and phase follow
    from linear equations. It starts from the spacing of the turning points and the slope of their swings.
    Raises ``InputError`` with the reason if there is none: no swing, too few of them, or too few samples.
    """
    turns = turnings(value, LEAST_SWING * float(np.ptp(value)))[:MOST_TURNINGS]
    _check(turns)
    last = turns[-1] + 1 if len(turns) == MOST_TURNINGS else len(value)
    since, signal = time[turns[0] : last] - time[turns[0]], value[turns[0] : last]

    def parts(rates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The basis at all times, and its coefficients by linear least squares."""
        decay = np.exp(-rates[0] * since)
        waves = (np.ones_like(since), decay * np.cos(rates[1] * since), decay * np.sin(rates[1] * since))
        basis = np.column_stack(waves)
        return basis, np.linalg.lstsq(basis, signal, rcond=None)[0]

    def misses(rates: np.ndarray) -> np.ndarray:
        basis, amounts = parts(rates)
        return basis @ amounts - signal

    start = _start(time[turns], value[turns])
    found = least_squares(misses, start, x_scale=start[1], xtol=1e-12, ftol=1e-12, gtol=1e-12)
    decay, turning = map(float, found.x)
    rest, cosine, sine = map(float, parts(found.x)[1])
    misfit = float(np.sqrt(np.mean(found.fun**2)) / np.std(signal))
    if misfit > WORST_MISFIT or turning <= 0.0:
        raise InputError("the free motion oscillates, but not as one damped sinusoid.")
    amplitude, phase = float(np.hypot(cosine, sine)), float(np.arctan2(-sine, cosine))
    return RingDown(float(time[turns[0]]), decay, turning, rest, amplitude, phase, misfit)


def _check(turns: np.ndarray) -> None:
    if not turns.size:
        raise InputError("no ring-down: the tip settles without oscillating.")
    if turns.size < FEWEST_TURNINGS:
        raise InputError(f"too few turning points for a frequency: {turns.size}, needed: {FEWEST_TURNINGS}.")
    between = float(np.median(np.diff(turns)))
    if between < FEWEST_SAMPLES:
        raise InputError(
            f"too few samples: {between:g} from one turning point to the next, needed: "
            f"{FEWEST_SAMPLES}. Increase [study] samples."
        )


def _start(time: np.ndarray, value: np.ndarray) -> np.ndarray:
    """Decay rate (1/s) and angular frequency (rad/s) from the turning points alone."""
    swings, middle = np.abs(np.diff(value)), 0.5 * (time[1:] + time[:-1])
    decay = -np.polyfit(middle, np.log(swings), 1)[0]
    return np.array([decay, np.pi / np.median(np.diff(time))])
