"""Durations of stages, reported to the logger ``continuum_dyn``."""

import logging
import time
from collections.abc import Iterator
from contextlib import contextmanager

LOG = logging.getLogger("continuum_dyn")


@contextmanager
def stage(name: str) -> Iterator[None]:
    """Report the time of the block at its end."""
    started = time.perf_counter()
    yield
    LOG.info("%s: %.3g s", name, time.perf_counter() - started)
