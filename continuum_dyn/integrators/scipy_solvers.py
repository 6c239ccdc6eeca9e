"""Our own methods as SciPy's: for ``solve_ivp(..., method=ChainSolver)``."""

from scipy.integrate import OdeSolver

from continuum_dyn.integrators.chain_stepper import ChainStepper
from continuum_dyn.integrators.midpoint_stepper import MidpointStepper


class ChainSolver(ChainStepper, OdeSolver):
    """``ChainStepper`` for ``solve_ivp``, with the same options."""


class MidpointSolver(MidpointStepper, OdeSolver):
    """``MidpointStepper`` for ``solve_ivp``, with the same options."""
