"""How much a command says: ``--quiet``, ``--verbose`` or neither."""

import logging
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, redirect_stdout
from pathlib import Path

import typer

from statics.kernels.kept_files import kernel_folder
from statics.support.stages import LOG


class _OnStandardError(logging.Handler):
    def emit(self, record: logging.LogRecord) -> None:
        typer.echo(f"  {record.getMessage()}", err=True)


def shows_progress() -> bool:
    """Whether progress is wanted: neither silence, nor lines that a progress bar would be in the way of."""
    return LOG.getEffectiveLevel() == logging.WARNING


@contextmanager
def quiet(json: bool) -> Iterator[None]:
    """Within, errors alone are said, and JSON where it is asked for."""
    with ExitStack() as silence:
        silence.enter_context(_level(logging.ERROR))
        if not json:
            nowhere = silence.enter_context(Path(os.devnull).open("w"))
            silence.enter_context(redirect_stdout(nowhere))
        yield


@contextmanager
def verbose() -> Iterator[None]:
    """Within, what is compiled, where it is kept, and how long each stage takes is told on standard error."""
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
