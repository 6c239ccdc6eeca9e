"""The protocol of an effect: the shape that every file beside this one has."""

from collections.abc import Mapping
from typing import Any, ClassVar, Literal, NamedTuple, Protocol

import numpy as np

from statics.arm import Arm

Site = Literal["segment", "span", "disk", "mass"]
Account = Literal["elastic_energy", "gravity_energy", "kinetic_energy", "input_power", "dissipated_power"]


class Pair(NamedTuple):
    """A load P and the displacement r it works along; scalars, or vectors as tuples (Eq. 1)."""

    load: Any
    displacement: Any


class Effect(Protocol):
    """A frozen dataclass of parameters with one verb: ``pairs``.

    ``name`` is its key in scenario files; ``site`` says where the pairs stand (on each segment, on
    each span from disk to disk, on each disk and other node, or on each mass: a disk's, a payload's, the
    core's own); ``account`` in which line of the power ledger its work is booked; ``acts_at_rest`` is False
    for what exists in motion only; ``coordinates`` are those that it frees on a segment, beside the bend
    angle: ``elongation`` or none; ``arm_quantities`` are the numbers of the arm that it needs, ``quantities``
    its own (glossary names); ``source`` is where it comes from.
    """

    name: ClassVar[str]
    site: ClassVar[Site]
    account: ClassVar[Account]
    acts_at_rest: ClassVar[bool]
    coordinates: ClassVar[tuple[str, ...]]
    arm_quantities: ClassVar[tuple[str, ...]]
    quantities: ClassVar[tuple[str, ...]]
    source: ClassVar[str]

    def pairs(self, at: Any) -> list[Pair]:
        """The pairs at one such site, by arithmetic on the given symbols.

        They never depend on the values of parameters, which reach the kernel by ``columns``: kernels are kept
        for scenes of the same effects, whatever their numbers.
        """
        ...

    def columns(self, arm: Arm) -> Mapping[str, np.ndarray | float]:
        """Values of ``quantities``: scalars, or one for each segment or disk."""
        ...


def effects_among(names: Mapping[str, Any]) -> dict[str, type[Effect]]:
    """The effects among the names of a module, in their order there, by the name of each."""
    return {
        value.name: value
        for value in names.values()
        if isinstance(value, type) and hasattr(value, "pairs") and value is not Effect
    }
