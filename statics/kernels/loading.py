"""Kernels: a scene's passes, derived once for its structure, kept as text, and compiled in this process.

A kernel is found by a hash of the structure, of the sources that derive and print it, and of the versions
that shape its text. A warm start finds its text and imports no sympy.
"""

import ast
import ctypes
import gc
import hashlib
import platform
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from statics.kernels.kept_files import kernel_folder, read_sealed, write_sealed
from statics.kernels.lowering import PassSignature, lower
from statics.kernels.slots import SCALARS, SLOTS
from statics.structure import Structure, file_digest
from statics.support.stages import stage

_HERE = Path(__file__).parent
_PRINTING = tuple(_HERE / f"{stem}.py" for stem in ("printing", "liveness", "loading"))
_LOWERING = _HERE / "lowering.py"
_SHARED = _HERE.parent / "derivation"

_loaded: dict[tuple[Structure, "Family"], "Kernel"] = {}


@dataclass(frozen=True)
class Family:
    """A set of passes that are derived together.

    ``derive`` names the function of a structure that returns its forces and steps, "module:function"; it is
    imported when a text has to be made. ``passes`` is a named tuple of integers: addresses of the passes,
    zero if the scene has none, and sizes of the arrays.
    """

    name: str
    title: str
    derive: str
    passes: type[tuple[Any, ...]]

    @property
    def sources(self) -> list[Path]:
        """Every source that the text is made from."""
        package = import_module(self.derive.partition(":")[0].rpartition(".")[0])
        folder = Path(package.__file__ or "").parent
        return sorted({*folder.glob("*.py"), *_SHARED.rglob("*.py"), *_PRINTING})

    def write(self, structure: Structure) -> str:
        """Text of the steps; derives everything with sympy."""
        from statics.kernels.printing import module_text

        module, _, function = self.derive.partition(":")
        with _without_garbage_collection():
            forces, steps = getattr(import_module(module), function)(structure)
            return module_text(self.title, forces, structure.names, steps)


@contextmanager
def _without_garbage_collection() -> Iterator[None]:
    """Look for no garbage within: what sympy makes lives on, and to look it through takes a seventh."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


Loader = Callable[[Structure, Family], "Kernel"]
"""``load`` or ``load_interpreted``."""


class Kernel:
    """The passes of one structure, ready to be called by address.

    ``passes`` is what compiled code takes; ``signatures`` says how each is called. ``segment_columns`` and
    ``disk_columns`` name the columns of the tables that a scene fills, ``chain_columns`` those of ``chain``.
    """

    def __init__(
        self, text: str, family: Family, compile_passes: "Callable[[Kernel], Mapping[str, int]]"
    ) -> None:
        self.text, self.family = text, family
        self.tree = ast.parse(text)
        constants = _constants(self.tree)
        self.inputs: tuple[str, ...] = constants["INPUTS"]
        self.conservative: bool = constants["CONSERVATIVE"]
        self.segment_columns: tuple[str, ...] = constants["SEGMENT_COLUMNS"]
        self.disk_columns: tuple[str, ...] = constants["DISK_COLUMNS"]
        self.chain_columns: tuple[str, ...] = constants["CHAIN_COLUMNS"]
        self.widths: dict[str, int] = constants["WIDTHS"]
        self.signatures = {name: PassSignature(*parts) for name, parts in constants["PASSES"].items()}
        self.addresses = compile_passes(self)
        sizes = {
            "inputs": len(self.inputs),
            "chain_columns": self.widths["chain"],
            "pivot_columns": self.widths.get("pivots", 0),
            "size_columns": self.widths.get("sizes", 0),
        }
        fields: Any = family.passes
        self.passes = fields(*(self.addresses.get(name, sizes.get(name, 0)) for name in fields._fields))

    def run(self, name: str, *arrays: np.ndarray, **given: float) -> dict[str, float]:
        """Run one pass, outside compiled code; returns its results by name.

        ``arrays`` are those of its signature, in order.
        """
        from statics.kernels.calling import run

        scalars = np.full(SCALARS, np.nan)
        for key, value in given.items():
            scalars[SLOTS[key]] = value
        rows = {"q", "segments", "disks", "chain"}.intersection(self.signatures[name].arrays)
        n = len(arrays[self.signatures[name].arrays.index(sorted(rows)[0])])
        run(self.addresses[name], n, scalars, *arrays)
        return {key: float(scalars[SLOTS[key]]) for key in self.signatures[name].results}

    @cached_property
    def steps(self) -> ModuleType:
        """The text as a module of plain Python."""
        module = ModuleType(f"interpreted_{self.family.name}")
        exec(compile(self.tree, module.__name__, "exec"), module.__dict__)
        return module


def _constants(tree: ast.Module) -> dict[str, Any]:
    """Values of the module's constants."""
    return {
        target.id: ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    }


def load(structure: Structure, family: Family) -> Kernel:
    """The compiled kernel of a structure.

    Raises ``KernelCacheError`` if the cache folder cannot be used safely.
    """
    if (structure, family) not in _loaded:
        text = _kept_text(structure, family, kernel_path(structure, family))
        _loaded[structure, family] = Kernel(text, family, _compiled)
    return _loaded[structure, family]


def load_interpreted(structure: Structure, family: Family) -> Kernel:
    """The kernel with its passes as plain Python, called back from compiled code: for tests and debuggers."""
    return Kernel(_kept_text(structure, family, kernel_path(structure, family)), family, _interpreted)


def _compiled(kernel: Kernel) -> Mapping[str, int]:
    from statics.kernels.machine_code import MachineCode, compile_text, machine_name

    made_from = kernel.text, file_digest(_LOWERING, _LOWERING.stat().st_mtime_ns), machine_name()
    key = hashlib.sha256(repr(made_from).encode()).hexdigest()[:24]
    path = kernel_folder() / f"{kernel.family.name}.{key}"
    file = read_sealed(path)
    if file is None:
        with stage(f"compiled passes of {kernel.family.name}"):
            tree = ast.parse(kernel.text)
            file = compile_text(lower(tree, kernel.signatures, kernel.widths, SLOTS))
        write_sealed(path, file)
    code = MachineCode(file)
    kernel.code = code  # pyright: ignore[reportAttributeAccessIssue]: keeps the machine code alive
    return {name: code.address(name) for name in kernel.signatures}


def _interpreted(kernel: Kernel) -> Mapping[str, int]:
    callbacks = {name: _callback(kernel, name) for name in kernel.signatures}
    kernel.callbacks = callbacks  # pyright: ignore[reportAttributeAccessIssue]: keeps them alive
    return {name: ctypes.cast(callback, ctypes.c_void_p).value or 0 for name, callback in callbacks.items()}


def _callback(kernel: Kernel, name: str) -> Any:
    """A C function that runs the interpreted steps of a pass."""
    signature = kernel.signatures[name]

    def call(n: int, scalars: int, *pointers: int) -> None:
        arrays = {
            array: np.ctypeslib.as_array(
                ctypes.cast(pointer, ctypes.POINTER(ctypes.c_double)), _shape(kernel, array, n)
            )
            for array, pointer in zip(signature.arrays, pointers, strict=True)
        }
        values = np.ctypeslib.as_array(ctypes.cast(scalars, ctypes.POINTER(ctypes.c_double)), (SCALARS,))
        run_interpreted(kernel, name, n, values, arrays)

    kind = ctypes.CFUNCTYPE(None, ctypes.c_int64, *([ctypes.c_void_p] * (1 + len(signature.arrays))))
    return kind(call)


def _shape(kernel: Kernel, array: str, n: int) -> tuple[int, ...]:
    return (max(1, len(kernel.inputs)),) if array == "inputs" else (n, kernel.widths.get(array, 0))


def run_interpreted(
    kernel: Kernel, name: str, n: int, scalars: np.ndarray, arrays: Mapping[str, np.ndarray]
) -> None:
    """A pass as plain Python: what the compiled one does, step by step."""
    signature, steps = kernel.signatures[name], kernel.steps
    given = tuple(float(scalars[SLOTS[key]]) for key in signature.given)
    carried = getattr(steps, f"{name}_start")(*(arrays.get(key) for key in ("inputs", "segments", "chain")))
    step = getattr(steps, f"{name}_step")
    with np.errstate(all="ignore"):
        for i in _order(signature, n):
            carried = step(i, carried, given, *arrays.values())
    for key, value in zip(signature.results, carried, strict=False):
        scalars[SLOTS[key]] = value


def _order(signature: PassSignature, n: int) -> Iterator[int]:
    return iter(range(n) if signature.direction == "outward" else range(n - 1, -1, -1))


def kernel_path(structure: Structure, family: Family) -> Path:
    """File of a kernel's text."""
    return kernel_folder() / f"{family.name}_{kernel_key(structure, family)}.py"


def kernel_key(structure: Structure, family: Family) -> str:
    """Hash of the structure, of the sources behind a kernel, and of the versions that shape its text."""
    sources = [(file.name, file_digest(file, file.stat().st_mtime_ns)) for file in family.sources]
    versions = platform.python_version(), version("sympy")
    return hashlib.sha256(repr((family.name, structure.text, versions, sources)).encode()).hexdigest()[:24]


def _kept_text(structure: Structure, family: Family, path: Path) -> str:
    """The kernel's text from its file; made, or made again if it is not what was once written."""
    kept = read_sealed(path)
    if kept is None:
        with stage(f"derived {family.name}, {path.name}"):
            kept = family.write(structure).encode()
        write_sealed(path, kept)
    return kept.decode()
