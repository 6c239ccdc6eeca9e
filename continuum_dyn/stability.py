"""Stability of equilibria without a potential: whether small motions about them grow.

Loads without a potential can make an arm flutter, which its stiffness alone does not show (Beck 1952, Bolotin
1963). So the eigenvalues of the linearized motion decide.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from continuum_dyn.modes import NEUTRAL, check, linearized, still
from continuum_dyn.passes.dynamics import Dynamics
from statics.equilibria import Equilibrium
from statics.errors import InputError
from statics.outcome import Outcome
from statics.scene import Scene


@dataclass(frozen=True)
class Growth:
    """The modes that grow about an equilibrium: how many, and how the fastest does.

    ``rate`` in 1/s; ``frequency`` in Hz, zero if it does not oscillate.
    """

    modes: int
    rate: float
    frequency: float

    def __str__(self) -> str:
        more = f" (the fastest of {self.modes} growing modes)" if self.modes > 1 else ""
        if self.frequency:
            return f"flutter at {self.frequency:.4g} Hz that grows at {self.rate:.3g} 1/s{more}"
        return f"divergence that grows at {self.rate:.3g} 1/s{more}"


def growth_about(dynamics: Dynamics, point: Equilibrium) -> Growth | None:
    """Fastest growing small motion about an equilibrium under its inputs; None if nothing grows."""
    rates = _eigenvalues(dynamics, point)
    growth, turning, sizes = np.real(rates), np.imag(rates), np.abs(rates)
    grow = (growth > NEUTRAL * sizes) & (turning >= 0.0) & (sizes > NEUTRAL * sizes.max())
    if not grow.any():
        return None
    fastest = np.argmax(np.where(grow, growth, 0.0))
    return Growth(int(grow.sum()), float(growth[fastest]), float(turning[fastest]) / (2.0 * np.pi))


def _eigenvalues(dynamics: Dynamics, point: Equilibrium) -> Any:
    """Rates of the linearized motion, 1/s; without damping only one of each two of opposite sign."""
    size, interval = dynamics.size, still(point.inputs)
    jacobian = linearized(dynamics, dynamics.state(point.coordinates), interval)
    if jacobian[size : 2 * size, size : 2 * size].any():
        return np.linalg.eigvals(jacobian[: 2 * size, : 2 * size])
    return np.sqrt(np.linalg.eigvals(jacobian[size : 2 * size, :size]).astype(complex))


def why_not_judged(scene: Scene) -> str | None:
    """Why nothing can be said of the stability of the scene's equilibria, and what to add; or None."""
    try:
        check(scene)
    except InputError as reason:
        loads = " and ".join(scene.without_potential)
        return (
            f"stability is not checked: {loads} have no potential, so it follows from the modes, and {reason}"
        )
    return None


def judged(dynamics: Dynamics, point: Equilibrium) -> tuple[Equilibrium, Growth | None]:
    """The equilibrium with an outcome by its modes, and what grows about it."""
    growth = growth_about(dynamics, point)
    outcome = Outcome.COMPLETED if growth is None else Outcome.UNSTABLE_EQUILIBRIUM
    directions = 0 if growth is None else growth.modes
    return replace(point, outcome=outcome, unstable_directions=directions), growth
