"""The passes of a scene at rest, as compiled code takes them."""

from typing import NamedTuple

from statics.kernels.loading import Family


class RestPasses(NamedTuple):
    """Addresses of the passes, zero if the scene has none, and sizes of the arrays.

    ``lengths`` and ``beyond`` measure coupled cables; ``eliminate_held`` keeps their tensions as they are;
    ``sizes`` are those of the forces that meet in a residual.
    """

    lengths: int
    beyond: int
    pose: int
    residual: int
    sizes: int
    eliminate: int
    substitute: int
    observe: int
    eliminate_held: int
    inputs: int
    chain_columns: int
    size_columns: int
    pivot_columns: int


REST = Family(
    "rest",
    "Statics of a planar cable-driven arm.",
    "statics.derivation.steps.at_rest:derive_rest",
    RestPasses,
)
