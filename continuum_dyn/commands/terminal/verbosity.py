"""Verbosity of the commands: ``--quiet``, ``--verbose`` or neither."""

import logging
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, redirect_stdout
from pathlib import Path

from continuum_dyn.commands.terminal.output import say
from statics.kernels.kept_files import kernel_folder
from statics.support.stages import LOG


class _OnStandardError(logging.Handler):
    def emit(self, record: logging.LogRecord) -> None:
        say(f"  {record.getMessage()}", err=True)


def shows_progress() -> bool:
    """Whether to show progress: neither with ``--quiet``, nor among the lines of ``--verbose``."""
    return LOG.getEffectiveLevel() == logging.WARNING


@contextmanager
def quiet(json: bool) -> Iterator[None]:
    """Print errors only, and JSON if requested, within the block."""
    with ExitStack() as silence:
        silence.enter_context(_level(logging.ERROR))
        if not json:
            nowhere = silence.enter_context(Path(os.devnull).open("w"))
            silence.enter_context(redirect_stdout(nowhere))
        yield


@contextmanager
def verbose() -> Iterator[None]:
    """Report compilation, kernel folder and the time of each stage on standard error, within the block."""
    handler = _OnStandardError()
    LOG.addHandler(handler)
    try:
        with _level(logging.INFO):
            LOG.info("kernels are kept in %s", kernel_folder())
            yield
    finally:
        LOG.removeHandler(handler)


@contextmanager
def _level(level: int) -> Iterator[None]:
    before = LOG.level
    LOG.setLevel(level)
    try:
        yield
    finally:
        LOG.setLevel(before)
