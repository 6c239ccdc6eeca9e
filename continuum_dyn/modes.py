"""Rates and frequencies of small motion about a state."""

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigs

from continuum_dyn.dynamics import Dynamics
from continuum_dyn.profiles import Span

MOST_DENSE = 128
"""Most coordinates whose linearized motion is written out as a matrix."""
SMALL = 1e-6
"""Change of a bend angle (rad) by which accelerations are differenced."""
WITHIN = 1e-3
"""Relative error allowed to the iteration for the largest eigenvalue."""


def rates(dynamics: Dynamics, y: np.ndarray, span: Span) -> tuple[float, float]:
    """Smallest and largest absolute eigenvalue (1/s) of the motion linearized at ``y``."""
    size = 2 * dynamics.size
    found = np.abs(np.linalg.eigvals(dynamics.jacobian(span.start, y, span)[:size, :size]))
    return float(found.min()), float(found.max())


def fastest_frequency(dynamics: Dynamics, span: Span, y: np.ndarray) -> float:
    """Largest natural frequency (rad/s) of the undamped motion linearized at a state at rest."""
    size = dynamics.size
    if size <= MOST_DENSE:
        stiffness = dynamics.jacobian(span.start, y, span)[size : 2 * size, :size]
        return float(np.sqrt(np.abs(np.linalg.eigvals(stiffness)).max()))
    scale = SMALL * dynamics.scales()[:size]

    def accelerations(change: np.ndarray) -> np.ndarray:
        """Change of the accelerations, in units of ``scale``, by a change of coordinates in the same."""
        shift = np.zeros_like(y)
        shift[:size] = scale * change.ravel() / np.abs(change).max()
        ahead, behind = (dynamics.rate(span.start, y + sign * shift, span) for sign in (1, -1))
        return (ahead - behind)[size : 2 * size] / (2 * scale) * np.abs(change).max()

    operator = LinearOperator((size, size), matvec=accelerations, dtype=float)
    start = np.random.default_rng(0).standard_normal(size)
    largest = eigs(operator, k=1, v0=start, tol=WITHIN, return_eigenvectors=False)
    return float(np.sqrt(np.abs(largest).max()))
