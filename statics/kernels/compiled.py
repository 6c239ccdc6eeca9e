"""Machine code of functions that know no scene, compiled once a machine and kept from run to run.

This stands in for numba's own cache, which trusts its files: a damaged one is unpickled or called as it is,
of two processes that compile at once one may be given the other's code, and a change in what a function calls
is not seen. Here every signature of a function has a file of its own, named by all that its code depends on,
all sources of its folder among it, and sealed.
"""

import hashlib
import pickle
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from numba import njit
from numba.core.compiler import CompileResult
from numba.core.dispatcher import Dispatcher
from numba.core.serialize import dumps

from statics.kernels.kept_files import kernel_folder, read_sealed, write_sealed
from statics.support.stages import LOG

SHARED = (Path(__file__).parent, Path(__file__).parent.parent / "passes")
"""Folders of what compiled functions everywhere may call."""

Result = TypeVar("Result")


def compiled(function: Callable[..., Result]) -> Callable[..., Result]:
    """The function, compiled when it is first called with arguments of some types, and kept."""
    result: Any = njit(nogil=True, error_model="numpy")(function)
    if isinstance(result, Dispatcher):
        file = Path(function.__code__.co_filename)
        result._cache = _KeptCode(f"{file.stem}.{function.__name__}", file.parent)  # pyright: ignore
    return result


@cache
def _digest(folder: Path) -> str:
    """Hash of all sources that a function of that folder may call, and of the versions that compile them."""
    from importlib.metadata import version

    whole = hashlib.sha256(repr([version(name) for name in ("numba", "llvmlite", "numpy")]).encode())
    for file in sorted(
        {file for each in (folder, folder.parent / "passes", *SHARED) for file in each.glob("*.py")}
    ):
        whole.update(file.name.encode() + file.read_bytes())
    return whole.hexdigest()


class _KeptCode:
    """The cache that numba's dispatcher consults: that of one function."""

    def __init__(self, name: str, folder: Path) -> None:
        self.name, self.folder = name, folder
        self.requested = 0.0

    @property
    def cache_path(self) -> str:
        """Folder of the kept files."""
        return str(kernel_folder())

    def load_overload(self, signature: Any, target: Any) -> CompileResult | None:
        """The code for these types of arguments, or None if it has to be compiled."""
        target.refresh()
        kept = read_sealed(self._file(signature, target.codegen()))
        self.requested = time.perf_counter()
        return None if kept is None else CompileResult._rebuild(target, *pickle.loads(kept))

    def save_overload(self, signature: Any, result: CompileResult) -> None:
        """Keep the code, which was compiled since it was requested. Raises ``KernelCacheError``."""
        LOG.info("compiled %s: %.3g s", self.name, time.perf_counter() - self.requested)
        write_sealed(self._file(signature, result.codegen), dumps(result._reduce()))

    def _file(self, signature: Any, codegen: Any) -> Path:
        """Its name says the function, the sources, the types of the arguments and the processor."""
        shape = repr((self.name, _digest(self.folder), signature, codegen.magic_tuple()))
        return kernel_folder() / f"{self.name}.{hashlib.sha256(shape.encode()).hexdigest()[:24]}"
