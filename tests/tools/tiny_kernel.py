"""The smallest kernel, made and kept as every other, and what calls it; for tests of how code is kept.

It is compiled in a tenth of a second. ``python tests/tools/tiny_kernel.py 3 5`` says that it is ready, waits
for a line, and prints the answers of two of them.
"""

import sys
from dataclasses import dataclass
from importlib import import_module, reload
from pathlib import Path
from typing import NamedTuple

from statics import Arm, Bending, Scene
from statics.kernels import loading
from statics.kernels.loading import Family
from statics.structure import Structure

STRUCTURE = Scene(Arm.preset("rone2012"), (Bending(),)).structure

TEXT = '''"""Generated."""

INPUTS = ()
CONSERVATIVE = True
SEGMENT_COLUMNS = ()
DISK_COLUMNS = ()
CHAIN_COLUMNS = ()
WIDTHS = {{'chain': 0}}
PASSES = {{'times': ('outward', ('slowing',), ('largest',), ())}}


def times_start(inputs, segments, chain):
    return (0.0,)


def times_step(i, carried, given):
    slowing, = given
    return ({factor!r}*slowing,)
'''


class TinyPasses(NamedTuple):
    """The address of the only pass."""

    times: int


@dataclass(frozen=True)
class TinyFamily(Family):
    """A kernel of its own for each factor, which needs no derivation."""

    factor: float = 1.0

    @property
    def sources(self) -> list[Path]:
        """This file."""
        return [Path(__file__)]

    def write(self, structure: Structure) -> str:
        """The text above."""
        return TEXT.format(factor=self.factor)


def family(factor: float) -> TinyFamily:
    """Of a kernel that multiplies by the factor."""
    return TinyFamily(f"times_{factor}", "Tiny.", "", TinyPasses, factor)


def answer(factor: float) -> float:
    """What the kernel and its caller make of 2: the factor times 2, plus 1. No function is compiled yet."""
    functions = reload(import_module("tiny_functions"))
    return functions.times_plus_one(loading.load(STRUCTURE, family(factor)).passes.times, 2.0)


def main() -> None:
    """Answer in a process of its own, when told to."""
    import statics.kernels.compiled  # noqa: F401, so that what takes long is done before

    print("ready", flush=True)
    sys.stdin.readline()
    for factor in sys.argv[1:]:
        print(answer(float(factor)))


if __name__ == "__main__":
    main()
