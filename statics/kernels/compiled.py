"""Machine code of functions that know no scene: lowered once a machine, and kept from run to run.

Every function has a file for each set of kinds of its arguments, named by all that the code depends on, all
sources of its folder among it, and sealed.
"""

import ctypes
import hashlib
import struct
from collections.abc import Callable
from functools import cache, update_wrapper
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from statics.kernels.calling import address_of
from statics.kernels.functions import (
    BOOL,
    FLOAT,
    INT,
    SCALAR_KINDS,
    ArrayKind,
    Kind,
    TupleKind,
    cells,
    declared_kinds,
    lower_function,
)
from statics.kernels.kept_files import kernel_folder, read_sealed, write_sealed
from statics.kernels.machine_code import MachineCode, compile_text, machine_name
from statics.support.stages import stage

SHARED = (Path(__file__).parent, Path(__file__).parent.parent / "passes")
"""Folders of what compiled functions everywhere may call."""
FORMATS = {FLOAT: "d", INT: "q", BOOL: "q", "ptr": "q"}

AnyFunction = TypeVar("AnyFunction", bound=Callable[..., Any])


def compiled(function: AnyFunction) -> AnyFunction:
    """The function, compiled when it is first called with arguments of some kinds, and kept.

    As plain Python it is its attribute ``python``.
    """
    return update_wrapper(_Compiled(function), function)  # pyright: ignore[reportReturnType]


class _Compiled:
    """A function that is called with numbers, contiguous arrays, and tuples of these."""

    def __init__(self, python: Callable[..., Any]) -> None:
        self.python = python
        self.declared = declared_kinds(python)
        self.codes: dict[tuple[Kind, ...], _Code] = {}

    def __call__(self, *arguments: Any) -> Any:
        """The result. Raises ``ValueError`` for arrays with strides, ``TypeError`` for other faults."""
        expected = len(self.declared)
        if len(arguments) != expected:
            raise TypeError(f"{self.python.__name__} takes {expected} arguments, not {len(arguments)}")
        given: list[Any] = []
        kinds = tuple(
            _flatten(argument, kind, given) for argument, kind in zip(arguments, self.declared, strict=True)
        )
        code = self.codes.get(kinds)
        if code is None:
            code = self.codes[kinds] = _Code(self.python, kinds)
        return code.call(given)


def _flatten(value: Any, declared: str | None, given: list[Any]) -> Kind:
    """Kind of an argument, whose cells are added to those given."""
    if isinstance(value, np.ndarray):
        given.append(address_of(value))
        given.extend(value.shape)
        return ArrayKind(value.ndim)
    if isinstance(value, tuple):
        parts = tuple(_flatten(part, None, given) for part in value)
        return TupleKind(parts, getattr(value, "_fields", ()))
    given.append(value)
    return declared or _scalar_kind(value)


def _scalar_kind(value: Any) -> str:
    for known, kind in SCALAR_KINDS.items():
        if isinstance(value, known):
            return kind
    raise TypeError(f"compiled code takes numbers, arrays and tuples of these, no {type(value).__name__}")


class _Code:
    """Machine code of a function for arguments of some kinds."""

    def __init__(self, function: Callable[..., Any], kinds: tuple[Kind, ...]) -> None:
        file = Path(function.__code__.co_filename)
        name = f"{file.stem}.{function.__name__}"
        shape = repr((name, _digest(file.parent), kinds, machine_name()))
        path = kernel_folder() / f"{name}.{hashlib.sha256(shape.encode()).hexdigest()[:24]}"
        kept = read_sealed(path)
        if kept is None:
            with stage(f"compiled {name}"):
                kept = _compile(function, kinds)
            write_sealed(path, kept)
        result, _, machine_code = kept.partition(b"\n")
        self.machine_code = MachineCode(machine_code)
        self.entry = ctypes.CFUNCTYPE(None, ctypes.c_char_p, ctypes.c_char_p)(
            self.machine_code.address("entry")
        )
        self.arguments = struct.Struct("".join(FORMATS[cell] for kind in kinds for cell in cells(kind)))
        self.shape, *self.kinds = result.decode().split()
        self.results = struct.Struct("".join(FORMATS[kind] for kind in self.kinds))

    def call(self, given: list[Any]) -> Any:
        """Run the code with these cells of arguments; returns what the function does."""
        results = bytes(8 * len(self.kinds))
        self.entry(self.arguments.pack(*given), results)
        if self.shape == "nothing":
            return None
        found = self.results.unpack(results)
        values = tuple(bool(v) if kind == BOOL else v for kind, v in zip(self.kinds, found, strict=True))
        return values if self.shape == "several" else values[0]


def _compile(function: Callable[..., Any], kinds: tuple[Kind, ...]) -> bytes:
    """A line with the kinds of the results, and machine code."""
    text, result = lower_function(function, kinds)
    shape = "nothing" if result is None else "several" if isinstance(result, TupleKind) else "one"
    head = " ".join([shape, *(cells(result) if result is not None else ())])
    return head.encode() + b"\n" + compile_text(text)


@cache
def _digest(folder: Path) -> str:
    """Hash of all sources that a function of that folder may call."""
    whole = hashlib.sha256()
    for file in sorted(
        {file for each in (folder, folder.parent / "passes", *SHARED) for file in each.glob("*.py")}
    ):
        whole.update(file.name.encode() + file.read_bytes())
    return whole.hexdigest()
