"""The smallest kernel, made and kept as every other; for tests of how kernels are kept.

It is compiled in a tenth of a second. ``python tests/tools/tiny_kernel.py 3 5`` says that it is ready, waits
for a line, and prints the answers of two of them.
"""

import sys
from pathlib import Path

from statics import Arm, Bending, Scene, codegen
from statics.codegen import Recipe
from statics.compose import HEADER

SCENE = Scene(Arm.preset("rone2012"), (Bending(),))

DECORATORS = HEADER.split('"""')[2].lstrip()


def recipe(factor: float) -> Recipe:
    """Of a kernel of its own for each factor."""

    def write(_scene: Scene) -> str:
        return DECORATORS + (
            f"\n\n\n@compiled\ndef times(x):\n    return {factor!r} * x\n"
            "\n\n@compiled\ndef times_plus_one(x):\n    return times(x) + 1.0\n"
        )

    return Recipe(f"times_{factor}", write, (Path(__file__),))


def answer(factor: float) -> float:
    """What the kernel makes of 2: the factor times 2, plus 1."""
    return codegen.load(SCENE, recipe(factor)).times_plus_one(2.0)


def main() -> None:
    """Answer in a process of its own, when told to."""
    import statics.compiled_code  # noqa: F401, so that what takes long is done before

    print("ready", flush=True)
    sys.stdin.readline()
    for factor in sys.argv[1:]:
        print(answer(float(factor)))


if __name__ == "__main__":
    main()
