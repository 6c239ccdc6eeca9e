"""What a warm ``continuum-dyn run`` of the step response costs as a whole process.

Reported in seconds; asserted against the bare imports of the libraries that it needs, in turn with it.
"""

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCENARIO = Path(__file__).parents[1] / "scenarios" / "step_response.toml"
RUN = "from continuum_dyn.__main__ import main; main()"
IMPORTS = "import numpy, scipy.integrate, numba, h5py, rerun, pydantic, typer, rich.table"
REPEATS = 5
WITHIN = 3.0
"""Largest allowed ratio of the whole run to its imports."""


def seconds(code: str, *arguments: str) -> float:
    """Wall time of a Python process."""
    started = time.perf_counter()
    subprocess.run([sys.executable, "-c", code, *arguments], check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - started


def main() -> None:
    """Print the medians and check their ratio."""
    with tempfile.TemporaryDirectory() as folder:
        seconds(RUN, "run", str(SCENARIO), "--out", folder)
        pairs = [
            (seconds(RUN, "run", str(SCENARIO), "--out", folder), seconds(IMPORTS)) for _ in range(REPEATS)
        ]
    run, imports = (statistics.median(column) for column in zip(*pairs, strict=True))
    ratio = statistics.median(whole / bare for whole, bare in pairs)
    print(f"warm run of the step response: {run:.2f} s; its imports alone: {imports:.2f} s")
    print(f"ratio: {ratio:.2f} (allowed: {WITHIN})")
    assert ratio < WITHIN


if __name__ == "__main__":
    main()
