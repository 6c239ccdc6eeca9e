"""The folder of the generated kernels, and its files: sealed, whole or not there, the user's own.

Kernels are code, so nobody else may be able to write what is loaded from here. A seal covers a file's name
and its content; a file that does not match is as good as missing, and is made again.
"""

import hashlib
import os
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from platformdirs import user_cache_path

from statics.errors import KernelCacheError
from statics.support.interruption import defer_interruption

FOLDER = "CONTINUUM_DYN_CACHE"
"""The environment variable that names another folder."""
ADVICE = f"Name another folder with the environment variable {FOLDER}, or try --no-cache."


def kernel_folder() -> Path:
    """Folder of the generated kernels: ``CONTINUUM_DYN_CACHE``, or the user's own cache folder.

    Raises ``KernelCacheError`` if others could write to it.
    """
    named = os.environ.get(FOLDER)
    folder = Path(named) if named else user_cache_path("continuum-dyn") / "kernels"
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        status = folder.stat()
    except OSError as error:
        raise KernelCacheError(
            f"cannot make the folder for generated kernels, {folder}: {error.strerror}. {ADVICE}"
        ) from error
    if not _is_ours(status):
        raise KernelCacheError(
            f"the folder for generated kernels, {folder}, {_whose(status, folder)} {ADVICE}"
        )
    return folder


def _whose(status: os.stat_result, folder: Path) -> str:
    """Why a folder is not safe, and what to do."""
    if status.st_uid != os.getuid():
        return "belongs to another user, and kernels are code."
    return f"may be written to by others, and kernels are code. Try: chmod 700 {folder}."


@contextmanager
def no_cache() -> Iterator[None]:
    """Within, kernels are kept in a folder of their own, which is removed at the end.

    Raises ``KernelCacheError`` if no such folder can be made.
    """
    before = os.environ.get(FOLDER)
    try:
        temporary = tempfile.TemporaryDirectory(prefix="continuum-dyn-", ignore_cleanup_errors=True)
    except OSError as error:
        raise KernelCacheError(
            f"cannot make a temporary folder for generated kernels: {error.strerror}. "
            "Name a folder for temporary files with the environment variable TMPDIR."
        ) from error
    with temporary as folder:
        os.environ[FOLDER] = folder
        try:
            yield
        finally:
            del os.environ[FOLDER]
            if before is not None:
                os.environ[FOLDER] = before


def _is_ours(status: os.stat_result) -> bool:
    """Whether a file or folder is the user's, and only the user may write to it."""
    if os.name != "posix":
        return True
    return status.st_uid == os.getuid() and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def read_sealed(path: Path) -> bytes | None:
    """Content once written to that file; None if it is missing, damaged, or not the user's own."""
    try:
        with path.open("rb") as file:
            if not _is_ours(os.fstat(file.fileno())):
                return None
            seal, content = file.readline(), file.read()
    except OSError:
        return None
    return content if seal == _seal(path, content) else None


def write_sealed(path: Path, content: bytes) -> None:
    """Write a file whole. Raises ``KernelCacheError`` if it cannot be; then nothing is left behind."""
    with defer_interruption():
        part = None
        try:
            handle, part = tempfile.mkstemp(dir=path.parent, suffix=".tmp")
            with os.fdopen(handle, "wb") as file:
                file.write(_seal(path, content))
                file.write(content)
            Path(part).replace(path)
        except OSError as error:
            if part is not None:
                with suppress(OSError):
                    Path(part).unlink()
            raise KernelCacheError(
                f"cannot write the generated kernel {path}: {error.strerror}. {ADVICE}"
            ) from error


def _seal(path: Path, content: bytes) -> bytes:
    """A line that is a comment in Python."""
    digest = hashlib.sha256(path.name.encode() + b"\n" + content).hexdigest()
    return f"# sha256 of this file's name and of what follows: {digest}\n".encode()
