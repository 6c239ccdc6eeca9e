"""From load-displacement pairs to generalized forces, by virtual work (Rone 2012, Eq. 1-5).

    Q_i = sum_j P_j . dr_j/dq_i

for one segment (q: its own coordinates) and for one disk (q: its pose). The passes along the chain put them
together, so that no whole-arm expression is ever formed.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from itertools import starmap
from typing import Any

import sympy as sp

from statics.derivation.segment import (
    CableSymbols,
    CorePointSymbols,
    DiskSymbols,
    SegmentSymbols,
    SpanSymbols,
)
from statics.derivation.trace import derivative, jacobian
from statics.effects import Effect, Pair
from statics.errors import InputError
from statics.structure import Structure

Groups = list[tuple[Effect, list[Pair]]]
"""Effects, each with its pairs at one site."""

Symbols = SegmentSymbols | SpanSymbols | DiskSymbols | CorePointSymbols
"""A site's symbols, in which its pairs are written."""


@dataclass(frozen=True)
class Forces:
    """Generalized forces at one site, and the energies (J) and powers (W) behind them, by account.

    ``force`` has shape (coordinates, 1), N for a length and N m for an angle; ``mass``, ``damping`` and
    ``stiffness`` are its negative derivatives by accelerations, rates and coordinates, as Newton's method
    takes them: damping without the inertia forces, stiffness at rest, so that all are symmetric. ``terms``
    are what adds up in a force at rest, a column for each pair.
    """

    force: sp.Matrix
    mass: sp.Matrix
    damping: sp.Matrix
    stiffness: sp.Matrix
    energies: dict[str, Any] = field(default_factory=dict)
    powers: dict[str, Any] = field(default_factory=dict)
    terms: tuple[sp.Matrix, ...] = ()


@dataclass(frozen=True, eq=False)
class SceneForces:
    """Forces of one segment, of one disk, and of one span, with the symbols that they are written in.

    A span that is one segment has no forces of its own: they are the segment's. ``core`` are the points
    along a segment that carry its core's mass, ``on_core`` the forces on them. ``inputs`` are the names of
    the numbers that drive the scene. If ``conservative``, every load at rest has a potential, and all
    matrices are symmetric. Compared by identity, so that steps can be kept by the forces they are made from.
    """

    conservative: bool
    inputs: tuple[str, ...]
    segment: SegmentSymbols
    disk: DiskSymbols
    on_segment: Forces
    on_disk: Forces
    span: SpanSymbols | None = None
    on_span: Forces | None = None
    core: tuple[CorePointSymbols, ...] = ()
    on_core: tuple[Forces, ...] = ()

    @property
    def cables(self) -> list[CableSymbols]:
        """Cables from disk to disk."""
        return (self.span or self.segment).cables

    @property
    def coupled(self) -> list[CableSymbols]:
        """Cables whose tension depends on all the segments that they pass."""
        return [cable for cable in self.cables if cable.kind.coupled]

    @property
    def sites(self) -> dict[str, Forces]:
        """Forces by the name of the site they act at."""
        sites = {"segment": self.on_segment, "disk": self.on_disk}
        if self.on_span is not None:
            sites["span"] = self.on_span
        return sites | {point.name: part for point, part in zip(self.core, self.on_core, strict=True)}


def dot(first: Any, second: Any) -> Any:
    """Product of two scalars, or scalar product of two vectors."""
    if isinstance(first, Sequence):
        return sum(a * b for a, b in zip(first, second, strict=True))
    return first * second


def generalized_force(
    pairs: Iterable[Pair], partials: Callable[[Any, int], Any], coordinates: Sequence[sp.Symbol]
) -> sp.Matrix:
    """Sum of P . partial_i(r) over the pairs, shape (coordinates, 1), N or N m. Rone 2012, Eq. 5."""
    total = sp.zeros(len(coordinates), 1)
    for load, displacement in pairs:
        for number in range(len(coordinates)):
            total[number] += dot(load, partials(displacement, number))
    return total


def partial_displacement(displacement: Any, coordinate: sp.Symbol) -> Any:
    """dr/dq of a scalar or vector displacement, with its shape. Rone 2012, Eq. 3."""
    if isinstance(displacement, Sequence):
        return tuple(derivative(component, coordinate) for component in displacement)
    return derivative(displacement, coordinate)


_OWN = sp.Dummy("r", real=True)


def _is_constant(load: Any, coordinates: Sequence[sp.Symbol]) -> bool:
    parts = load if isinstance(load, Sequence) else (load,)
    return not any(sp.sympify(part).has(*coordinates) for part in parts)


def has_potential(pair: Pair, coordinates: Sequence[sp.Symbol]) -> bool:
    """Whether the load is constant, or depends on its own displacement alone; a follower load does not."""
    load, displacement = pair
    if _is_constant(load, coordinates) or isinstance(displacement, Sequence):
        return _is_constant(load, coordinates)
    return _is_constant(sp.sympify(load).subs(displacement, _OWN), coordinates)


def have_potentials(groups: Groups, coordinates: Sequence[sp.Symbol]) -> bool:
    """Whether every load that acts at rest has a potential; a dissipating effect never has one."""
    at_rest = [(effect, group) for effect, group in groups if effect.acts_at_rest]
    if any(group and effect.account == "dissipated_power" for effect, group in at_rest):
        return False
    return all(has_potential(pair, coordinates) for _, group in at_rest for pair in group)


def potential(pair: Pair, coordinates: Sequence[sp.Symbol]) -> Any:
    """Energy V (J) with P = -dV/dr of a constant load, or of one that depends on its own displacement alone.

    A linear load's energy is zero where the load is, any other's where the displacement is. Raises
    ``InputError`` for a load that depends on anything else.
    """
    load, displacement = pair
    if not has_potential(pair, coordinates):
        raise InputError(f"no potential is known for the load {load} along {displacement}")
    if _is_constant(load, coordinates):
        return -dot(load, displacement)
    return _stored(sp.sympify(load).subs(displacement, _OWN)).subs(_OWN, displacement)


def _stored(load: Any) -> Any:
    """Energy of a load that depends on ``_OWN``."""
    stiffness = -sp.diff(load, _OWN)
    if not stiffness.has(_OWN):
        return stiffness * sp.expand(load / stiffness) ** 2 / 2
    return -sp.integrate(load, (_OWN, 0, _OWN))


def collect(effects: Iterable[Effect], kinds: Iterable[str], site: Any) -> Groups:
    """Pairs of every effect at a site of these kinds, without displacements that the scene does not have."""
    return [
        (effect, [pair for pair in effect.pairs(site) if pair.displacement != 0])
        for effect in effects
        if effect.site in kinds
    ]


def derive_statics(structure: Structure) -> SceneForces:
    """Forces of effects that act at rest, with their potentials, those of the loads included.

    A load without a potential, as a follower load, has no part in the energies.
    """
    return derive(structure, _at_rest)


def derive(structure: Structure, forces_at: Callable[[Groups, Any], Forces]) -> SceneForces:
    """Forces at a segment and at a disk; at a span and at points of the core, if the scene has them.

    ``forces_at`` makes a site's forces from the pairs there and the site's symbols.
    """
    cables, holes_differ, effects = structure.cable_kinds, structure.holes_differ, structure.forms
    segment = SegmentSymbols(structure.coordinates, cables, holes_differ)
    disk = DiskSymbols(structure.payloads, structure.followers_among_driven, structure.has_followers)
    span = SpanSymbols(cables, holes_differ) if structure.has_subsegments else None
    core = tuple(starmap(CorePointSymbols, enumerate(structure.core_fractions, start=1)))
    on_segment = collect(effects, ("segment",), segment)
    on_disk = collect(effects, ("disk", "mass"), disk)
    on_span = collect(effects, ("span",), span or segment)
    on_core = [collect(effects, ("mass",), point) for point in core]
    if span is None:
        on_segment, on_span = on_segment + on_span, []
    sites = [(on_segment, segment), (on_disk, disk), (on_span, span or segment)]
    sites += zip(on_core, core, strict=True)
    return SceneForces(
        all(have_potentials(groups, site.coordinates) for groups, site in sites),
        structure.inputs,
        segment,
        disk,
        forces_at(on_segment, segment),
        forces_at(on_disk, disk),
        span,
        None if span is None else forces_at(on_span, span),
        core,
        tuple(map(forces_at, on_core, core)),
    )


def _at_rest(groups: Groups, site: Symbols) -> Forces:
    coordinates = site.coordinates
    pairs = [pair for _, group in groups for pair in group]

    def force_of(pairs: list[Pair]) -> sp.Matrix:
        return generalized_force(pairs, lambda r, i: partial_displacement(r, coordinates[i]), coordinates)

    force, terms = force_of(pairs), tuple(force_of([pair]) for pair in pairs)
    none = sp.zeros(len(coordinates))
    with_potential = [group for group in groups if have_potentials([group], coordinates)]
    energies = by_account(with_potential, lambda pair: potential(pair, coordinates))
    return Forces(force, none, none, -jacobian(force, coordinates), energies, terms=terms)


def by_account(groups: Groups, amount: Callable[[Pair], Any]) -> dict[str, Any]:
    """Sum of an amount over the pairs of the effects that share an account."""
    sums: dict[str, Any] = {}
    for effect, group in groups:
        sums[effect.account] = sums.get(effect.account, 0) + sum(amount(pair) for pair in group)
    return sums
