"""Whether the energies of a motion add up: an account of its own, which no error control looks at."""

from continuum_dyn.simulation.trajectory import Trajectory

OPEN = 0.1
"""Part of the largest energy that may be unaccounted for in a motion that its tolerance resolves well."""
PER_TOLERANCE = 10.0
"""And for each part that the tolerance is of the travel: energies go with the square of displacements."""


def broken_ledger(found: Trajectory, tolerance: float) -> str | None:
    """In words, that so much energy is unaccounted for that the motion cannot be the scene's; else None.

    ``tolerance`` is the displacement (m) that one step's error may make. A motion that is hardly larger may
    do with its energy what it likes.
    """
    if found.time.size == 0 or found.travel == 0.0:
        return None
    gap, whole = float(abs(found.ledger_gap).max()), found.largest_energy
    if gap <= (OPEN + PER_TOLERANCE * tolerance / found.travel) * whole:
        return None
    return (
        f"energies do not add up: {gap:.2g} J of at most {whole:.2g} J are not accounted for, so the motion "
        'is wrong. Lower rtol, or let method = "auto" choose'
    )
