"""One writer at a time: a run keeps others from writing the same log until it ends, in any way."""

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from secrets import token_hex

from statics.errors import LogError

try:
    import fcntl
except ImportError:  # on Windows
    fcntl = None


class LogBusyError(LogError):
    """A log is being written by another process."""


BUSY = (errno.EWOULDBLOCK, errno.EACCES)


def temporary_name(path: Path) -> Path:
    """A name beside a file that no other process uses."""
    return path.with_name(f".continuum-dyn-{token_hex(8)}.new")


@contextmanager
def sole_writer(path: Path) -> Iterator[None]:
    """Hold the log at ``path`` for this process. Raises ``LogError`` at once if another one holds it.

    The lock is on a hidden file beside the log, as readers have locks of their own on the log; the system
    frees it when the process ends, be it killed. Where the file system knows no locks, none is taken.
    """
    lock = path.with_name(f".{path.name}.lock")
    held = _lock(lock, path)
    try:
        yield
    finally:
        if held is not None:
            with suppress(OSError):
                lock.unlink()
            os.close(held)


def _lock(lock: Path, path: Path) -> int | None:
    """Descriptor of the locked file; None if locks are not known here."""
    while fcntl is not None:
        try:
            opened = os.open(lock, os.O_CREAT | os.O_RDWR, 0o666)
        except OSError:
            return None  # nothing can be written here, which the writer will say
        try:
            fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if _is_at(opened, lock):
                return opened
        except OSError as error:
            os.close(opened)
            if error.errno not in BUSY:
                return None
            raise LogBusyError(
                f"{path} is being written by another run. Wait for it, or write another log with --name or "
                "--out."
            ) from error
        os.close(opened)  # its holder has just removed it
    return None


def _is_at(opened: int, path: Path) -> bool:
    """Whether the opened file is the one of that name."""
    try:
        return os.path.samestat(os.fstat(opened), path.stat())
    except FileNotFoundError:
        return False
