"""A check that the energies of a motion add up, independent of all error control."""

from continuum_dyn.simulation.trajectory import Trajectory

TOLERATED = 0.1
"""Largest part of the energy that may be unaccounted for if the tolerance is far below the travel."""
PER_TOLERANCE = 10.0
"""Increase of that part with the ratio of tolerance to travel: energies go with displacements squared."""


def unbalanced_message(found: Trajectory, tolerance: float) -> str | None:
    """Message about a gap in the energies that is too large for a motion of the scene, otherwise None.

    ``tolerance`` is the largest displacement (m) by the error of one step. A motion that is hardly larger
    passes whatever its energies.
    """
    if found.time.size == 0 or found.travel == 0.0:
        return None
    gap, whole = float(abs(found.ledger_gap).max()), found.largest_energy
    if gap <= (TOLERATED + PER_TOLERANCE * tolerance / found.travel) * whole:
        return None
    return (
        f"energies do not add up: {gap:.2g} J of at most {whole:.2g} J are not accounted for, so the motion "
        'is wrong. Lower rtol, or let method = "auto" choose'
    )
