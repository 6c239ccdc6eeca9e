"""Forces in the names of the chain: written by an outward pass, read by inward passes."""

from typing import Any

import sympy as sp

from statics.derivation.segment import CableSymbols
from statics.derivation.trace import Trace, column_by_name, derivative
from statics.derivation.virtual_work import SceneForces

Known = dict[Any, Any]
"""The chain's names for poses and motions, by the symbols in which forces are written."""


def rewrite(expression: Any, known: Known) -> Any:
    """Write an expression in the chain's names."""
    return expression.xreplace(known) if hasattr(expression, "xreplace") else sp.sympify(expression)


def account_total(forces: SceneForces, kind: str, account: str, known: Known) -> Any:
    """One ledger account, summed over all sites; ``kind`` is "energies" (J) or "powers" (W)."""
    return sum(rewrite(getattr(part, kind).get(account, 0), known) for part in forces.sites.values())


def name_forces(trace: Trace, forces: SceneForces, known: Known) -> None:
    """Name the generalized forces and their derivatives for the inward passes."""
    for site, part in forces.sites.items():
        trace.name(f"{site}_force", rewrite(part.force, known))
        for name in ("mass", "damping", "stiffness"):
            trace.matrix(f"{site}_{name}", rewrite(getattr(part, name), known), forces.conservative)
    for cable in forces.coupled:
        trace.name(f"cable_pull_{cable.number}", rewrite(_cable_pull(forces, cable), known))


def _cable_pull(forces: SceneForces, cable: CableSymbols) -> sp.Matrix:
    """Derivative of a cable's length, where it passes, by the span's coordinates, shape (coordinates, 1)."""
    coordinates = (forces.span or forces.segment).coordinates
    return sp.Matrix([cable.passes * derivative(cable.length, q) for q in coordinates])


def force_by_name(forces: SceneForces, site: str) -> sp.Matrix:
    """The generalized force at a site as ``name_forces`` left it, shape (coordinates, 1)."""
    return column_by_name(f"{site}_force", forces.sites[site].force)


def cable_pull_by_name(forces: SceneForces, cable: CableSymbols) -> sp.Matrix:
    """The derivative of a cable's length as ``name_forces`` left it, shape (coordinates, 1)."""
    return column_by_name(f"cable_pull_{cable.number}", _cable_pull(forces, cable))
