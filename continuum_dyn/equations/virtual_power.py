"""From load-displacement pairs to generalized forces by virtual power: Kane's method.

    Q_i = sum_j P_j . dr'_j/du_i

r' is the time derivative of the displacement and dr'/du_i its partial velocity. Generalized inertia
forces are pairs like any other, so motion is Q_i = 0 (Kane and Levinson 1985, sec. 6.1).
"""

from collections.abc import Sequence
from functools import cache
from typing import Any

import sympy as sp

from continuum_dyn.equations.transport import with_transport
from statics.derivation.segment import SegmentSymbols, SpanSymbols
from statics.derivation.virtual_work import (
    Forces,
    Groups,
    SceneForces,
    Symbols,
    by_account,
    derive,
    dot,
    generalized_force,
    potential,
)
from statics.structure import Structure


def velocity(displacement: Any, coordinates: Sequence[sp.Symbol], rates: Sequence[sp.Symbol]) -> Any:
    """Time derivative of a displacement by the chain rule."""
    if isinstance(displacement, Sequence):
        return tuple(velocity(component, coordinates, rates) for component in displacement)
    return sum(sp.diff(displacement, q) * u for q, u in zip(coordinates, rates, strict=True))


def partial_velocity(
    displacement: Any, coordinates: Sequence[sp.Symbol], rates: Sequence[sp.Symbol], i: int
) -> Any:
    """dr'/du_i, with the shape of the displacement."""
    moving = velocity(displacement, coordinates, rates)
    if isinstance(moving, Sequence):
        return tuple(sp.diff(component, rates[i]) for component in moving)
    return sp.diff(moving, rates[i])


@cache
def derive_dynamics(structure: Structure) -> SceneForces:
    """Forces, energies and powers of all effects of the scene."""
    return derive(structure, _on_moving_base if structure.base_moves else _in_motion)


def _in_motion(groups: Groups, at: Symbols) -> Forces:
    force = _total(groups, at)
    loads = _loads(groups, at)
    still = loads.subs(dict.fromkeys(at.rates, 0))
    mass, damping = -force.jacobian(at.accelerations), -loads.jacobian(at.rates)
    energies = by_account(
        [group for group in groups if group[0].account in ("elastic_energy", "gravity_energy")],
        lambda pair: potential(pair, at.coordinates),
    )
    energies["kinetic_energy"] = (sp.Matrix([at.rates]) * mass * sp.Matrix(at.rates))[0] / 2
    powers = by_account(
        [group for group in groups if group[0].account in ("input_power", "dissipated_power")],
        lambda pair: dot(pair.load, velocity(pair.displacement, at.coordinates, at.rates)),
    )
    if "dissipated_power" in powers:
        powers["dissipated_power"] *= -1
    return Forces(force, mass, damping, -still.jacobian(at.coordinates), energies, powers)


def _on_moving_base(groups: Groups, at: Symbols) -> Forces:
    part = _in_motion(groups, at)
    if isinstance(at, SegmentSymbols | SpanSymbols):
        return part
    return with_transport(part, _loads(groups, at), at)


def _loads(groups: Groups, at: Symbols) -> sp.Matrix:
    """Generalized forces of all but inertia."""
    return _total([group for group in groups if group[0].account != "kinetic_energy"], at)


def _total(groups: Groups, at: Symbols) -> sp.Matrix:
    pairs = [pair for _, group in groups for pair in group]
    return generalized_force(
        pairs, lambda r, i: partial_velocity(r, at.coordinates, at.rates, i), at.coordinates
    )
