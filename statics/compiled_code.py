"""Machine code of a kernel's functions, kept from run to run.

This stands in for numba's own cache, which trusts its files: a damaged one is unpickled or called as it is,
and of two processes that compile at once one may be handed the other's code. Here every signature of a
function has a file of its own, named by all that its code depends on, and sealed.
"""

import hashlib
import pickle
import time
from pathlib import Path
from types import ModuleType
from typing import Any

from numba.core.compiler import CompileResult
from numba.core.dispatcher import Dispatcher
from numba.core.serialize import dumps

from statics.kernel_files import read_sealed, write_sealed
from statics.stages import LOG


def keep_compiled(module: ModuleType, path: Path, digest: str) -> None:
    """Keep what the functions of a kernel are compiled to beside its text ``path`` of that ``digest``."""
    for name, function in vars(module).items():
        if isinstance(function, Dispatcher):
            kept = _KeptCode(path.with_suffix(f".{name}"), digest)
            function._cache = kept  # pyright: ignore[reportAttributeAccessIssue]


class _KeptCode:
    """What numba's dispatcher asks of a cache: that of one function."""

    def __init__(self, stem: Path, digest: str) -> None:
        self.stem, self.digest = stem, digest
        self.cache_path = str(stem.parent)
        self.asked = 0.0

    def load_overload(self, signature: Any, target: Any) -> CompileResult | None:
        """The code for these types of arguments, or None if it has to be compiled."""
        target.refresh()
        kept = read_sealed(self._file(signature, target.codegen()))
        self.asked = time.perf_counter()
        return None if kept is None else CompileResult._rebuild(target, *pickle.loads(kept))

    def save_overload(self, signature: Any, result: CompileResult) -> None:
        """Keep the code, which was compiled since it was asked for. Raises ``KernelCacheError``."""
        LOG.info("compiled %s: %.3g s", self.stem.suffix[1:], time.perf_counter() - self.asked)
        write_sealed(self._file(signature, result.codegen), dumps(result._reduce()))

    def _file(self, signature: Any, codegen: Any) -> Path:
        """Its name says the function, the kernel's text, the types of the arguments and the processor."""
        shape = repr((self.digest, signature, codegen.magic_tuple()))
        return self.stem.with_name(f"{self.stem.name}.{hashlib.sha256(shape.encode()).hexdigest()[:24]}")
