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
from statics.derivation.trace import derivative, jacobian
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
    """Time derivative of a scalar or vector displacement by the chain rule, with its shape."""
    if isinstance(displacement, Sequence):
        return tuple(velocity(component, coordinates, rates) for component in displacement)
    return sum(derivative(displacement, q) * u for q, u in zip(coordinates, rates, strict=True))


def partial_velocity(
    displacement: Any, coordinates: Sequence[sp.Symbol], rates: Sequence[sp.Symbol], i: int
) -> Any:
    """dr'/du_i of a scalar or vector displacement, with its shape. Kane and Levinson 1985."""
    moving = velocity(displacement, coordinates, rates)
    if isinstance(moving, Sequence):
        return tuple(derivative(component, rates[i]) for component in moving)
    return derivative(moving, rates[i])


@cache
def derive_dynamics(structure: Structure) -> SceneForces:
    """Forces, energies and powers of all effects of a scene.

    Raises ``InputError`` for an elastic or gravity load that has no potential.
    """
    return derive(structure, _on_moving_base if structure.base_moves else _in_motion)


def _in_motion(groups: Groups, site: Symbols) -> Forces:
    force = _total(groups, site)
    loads = _loads(groups, site)
    still = loads.subs(dict.fromkeys(site.rates, 0))
    mass, damping = -jacobian(force, site.accelerations), -jacobian(loads, site.rates)
    energies = by_account(
        [group for group in groups if group[0].account in ("elastic_energy", "gravity_energy")],
        lambda pair: potential(pair, site.coordinates),
    )
    energies["kinetic_energy"] = (sp.Matrix([site.rates]) * mass * sp.Matrix(site.rates))[0] / 2
    powers = by_account(
        [group for group in groups if group[0].account in ("input_power", "dissipated_power")],
        lambda pair: dot(pair.load, velocity(pair.displacement, site.coordinates, site.rates)),
    )
    if "dissipated_power" in powers:
        powers["dissipated_power"] *= -1
    return Forces(force, mass, damping, -jacobian(still, site.coordinates), energies, powers)


def _on_moving_base(groups: Groups, site: Symbols) -> Forces:
    part = _in_motion(groups, site)
    if isinstance(site, SegmentSymbols | SpanSymbols):
        return part
    return with_transport(part, _loads(groups, site), site)


def _loads(groups: Groups, site: Symbols) -> sp.Matrix:
    """Generalized forces of all effects but inertia."""
    return _total([group for group in groups if group[0].account != "kinetic_energy"], site)


def _total(groups: Groups, site: Symbols) -> sp.Matrix:
    pairs = [pair for _, group in groups for pair in group]
    return generalized_force(
        pairs, lambda r, i: partial_velocity(r, site.coordinates, site.rates, i), site.coordinates
    )
