"""A check that the energies of a motion add up, independent of all error control."""

from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.trajectory import Trajectory

TOLERATED = 0.1
"""Largest part of the energy that may be unaccounted for if the tolerance is far below the travel."""
PER_TOLERANCE = 10.0
"""Increase of that part with the ratio of tolerance to travel: energies go with displacements squared."""


def unbalanced_message(found: Trajectory, solver: Solver, length: float, chosen: bool) -> str | None:
    """Message about a gap in the energies that is too large for a motion of the scene, otherwise None.

    ``length`` (m) is the arm's, ``chosen`` whether the program has chosen the method. A motion that is hardly
    larger than the error of one step passes whatever its energies.
    """
    if found.time.size == 0 or found.travel == 0.0:
        return None
    tolerance = solver.tolerance(length)
    gap, whole = float(abs(found.ledger_gap).max()), found.largest_energy
    if gap <= (TOLERATED + PER_TOLERANCE * tolerance / found.travel) * whole:
        return None
    return (
        f"energies do not balance: {gap:.2g} J are missing, of at most {whole:.2g} J, so the motion is "
        f"wrong. {_advice(solver, chosen)}"
    )


def _advice(solver: Solver, chosen: bool) -> str:
    if solver.has_fixed_step:
        return f"Give a [solver] step shorter than {solver.step or 0.0:.3g} s"
    other = "" if chosen else ', or let method = "auto" choose'
    return f"Give [solver] rtol below {solver.rtol:.3g}{other}"
