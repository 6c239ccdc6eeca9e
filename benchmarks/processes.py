"""Python processes that benchmarks measure: of one checkout each, with a folder of kernels of its own."""

import os
import resource
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

CHECKOUT = Path(__file__).parents[1]
"""The one that these benchmarks are part of."""
SCENARIOS = CHECKOUT / "scenarios"
RUN = ("-m", "continuum_dyn", "run")
"""Arguments of Python that answer the scenarios after them."""


@dataclass(frozen=True)
class Ended:
    """A process that ended: what it wrote, and the seconds that it and its children took.

    ``status`` is None where it was given up.
    """

    status: int | None
    output: str
    errors: str
    wall: float
    processor: float


def ended(
    *arguments: str | Path,
    checkout: Path | None = None,
    kernels: Path | None = None,
    within: float | None = None,
) -> Ended:
    """Run Python on a checkout, by default that of ``PYTHONPATH``, and give it up after so many seconds."""
    environment = dict(os.environ)
    if checkout is not None:
        environment["PYTHONPATH"] = str(checkout)
    if kernels is not None:
        environment["CONTINUUM_DYN_CACHE"] = str(kernels)
    command = [sys.executable, "-P", *map(str, arguments)]
    spent, started = _processor_seconds(), time.perf_counter()
    status, output, errors = None, "", ""
    try:
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=within)
        status, output, errors = done.returncode, done.stdout, done.stderr
    except subprocess.TimeoutExpired:
        pass
    return Ended(status, output, errors, time.perf_counter() - started, _processor_seconds() - spent)


def succeeded(*arguments: str | Path, checkout: Path | None = None, kernels: Path | None = None) -> Ended:
    """Run Python as ``ended`` does. Raises ``RuntimeError`` with its last words where it fails."""
    done = ended(*arguments, checkout=checkout, kernels=kernels)
    if done.status != 0:
        raise RuntimeError(f"python {' '.join(map(str, arguments[:4]))}: {done.errors[-2000:]}")
    return done


def _processor_seconds() -> float:
    """What children that ended have taken so far, theirs included."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
