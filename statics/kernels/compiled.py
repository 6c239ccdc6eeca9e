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
from typing import Any, Generic, TypeVar

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

Result = TypeVar("Result")


class compiled(Generic[Result]):  # noqa: N801, a decorator
    """A function that is compiled when it is first called with arguments of some kinds, and kept.

    It is called with numbers, contiguous arrays and tuples of these; ``python`` is the function itself.
    """

    def __init__(self, python: Callable[..., Result]) -> None:
        self.python = python
        update_wrapper(self, python)
        self.codes: dict[tuple[Any, ...], _Code] = {}

    def __call__(self, *arguments: Any) -> Result:
        """The result. Raises ``ValueError`` for arrays with strides, ``TypeError`` for other faults."""
        given: list[Any] = []
        return self._call(_flatten(arguments, given), given)

    def bind(self, *first: Any) -> Callable[..., Result]:
        """The function of the arguments that follow these: for many calls, which then cost less."""
        first_given: list[Any] = []
        first_forms = _flatten(first, first_given)

        def call(*arguments: Any, kept_alive: tuple[Any, ...] = first) -> Any:
            given = first_given.copy()
            return self._call(first_forms + _flatten(arguments, given), given)

        return call

    def _call(self, forms: tuple[Any, ...], given: list[Any]) -> Any:
        code = self.codes.get(forms)
        if code is None:
            code = self.codes[forms] = _Code(self.python, self._kinds(forms))
        return code.call(given)

    def _kinds(self, forms: tuple[Any, ...]) -> tuple[Kind, ...]:
        declared = declared_kinds(self.python)
        if len(forms) != len(declared):
            raise TypeError(f"{self.python.__name__} takes {len(declared)} arguments, not {len(forms)}")
        return tuple(kind or _kind(form) for form, kind in zip(forms, declared, strict=True))


def _flatten(values: tuple[Any, ...], given: list[Any]) -> tuple[Any, ...]:
    """The form of every value: an array's number of axes, the forms of a tuple's parts, else its type.

    Adds the cells that they are made of to those given. Runs at every call, so it is to be fast.
    """
    forms: list[Any] = []
    for value in values:
        form: Any = type(value)
        if form is np.ndarray:
            form = value.ndim
            given.append(address_of(value))
            given.extend(value.shape)
        elif form is tuple:
            form = _flatten(value, given)
        elif issubclass(form, tuple):
            given.extend(value)
        else:
            given.append(value)
        forms.append(form)
    return tuple(forms)


def _kind(form: Any) -> Kind:
    """Kind of a value of that form. A named tuple holds numbers, as annotated."""
    match form:
        case int():
            return ArrayKind(form)
        case tuple():
            return TupleKind(tuple(map(_kind, form)))
    if issubclass(form, tuple):
        return TupleKind(tuple(map(_kind, form.__annotations__.values())), tuple(form.__annotations__))
    for known, kind in SCALAR_KINDS.items():
        if issubclass(form, known):
            return kind
    raise TypeError(f"compiled code takes numbers, arrays and tuples of these, not {form.__name__}")


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
