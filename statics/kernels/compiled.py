"""Machine code of functions that know no scene: lowered once a machine, and kept from run to run.

Every function has a file for each set of kinds of its arguments, named by all that the code depends on, all
sources of its folder among it, and sealed.
"""

import ctypes
import hashlib
import struct
from collections.abc import Callable
from functools import cache, update_wrapper
from numbers import Integral, Real
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np

from statics.kernels.calling import address_of
from statics.kernels.functions import declared_kinds, lower_function
from statics.kernels.kept_files import kernel_folder, read_sealed, write_sealed
from statics.kernels.kinds import BOOL, FLOAT, INT, SCALAR_KINDS, ArrayKind, Kind, TupleKind, cells, named
from statics.kernels.machine_code import MachineCode, compile_text, machine_name
from statics.support.stages import stage

SHARED = (Path(__file__).parent, Path(__file__).parent.parent / "passes")
"""Folders whose functions any compiled function may call."""
FORMATS = {FLOAT: "d", INT: "q", BOOL: "?", "ptr": "q"}
ACCEPTED = {FLOAT: Real, INT: Integral, BOOL: bool}
"""Types accepted by a parameter annotated as a number."""

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
        declared, name = declared_kinds(self.python), self.python.__name__
        if len(forms) != len(declared):
            raise TypeError(f"{name} takes {len(declared)} arguments, not {len(forms)}")
        for (parameter, kind), form in zip(declared.items(), forms, strict=True):
            if kind and not (isinstance(form, type) and issubclass(form, ACCEPTED[kind])):
                raise TypeError(f"{name} takes {named(kind)} as '{parameter}', not {_words(form)}")
        return tuple(kind or _kind(form) for form, kind in zip(forms, declared.values(), strict=True))


def _flatten(values: tuple[Any, ...], given: list[Any]) -> tuple[Any, ...]:
    """The form of every value: an array's number of axes, a tuple's type and forms of parts, else its type.

    Adds the cells that they are made of to those given. Runs at every call, so it is to be fast.
    """
    forms: list[Any] = []
    for value in values:
        form: Any = type(value)
        if form is np.ndarray:
            shape = value.shape
            form = len(shape)
            given.append(address_of(value))
            given.extend(shape)
        elif not issubclass(form, tuple):
            given.append(value)
        elif _number_fields(form):
            given.extend(value)
        else:
            form = (form, *_flatten(value, given))
        forms.append(form)
    return tuple(forms)


@cache
def _number_fields(form: type) -> dict[str, str]:
    """Kinds of a named tuple's fields if all are annotated as numbers: then its form is its type alone."""
    annotations = getattr(form, "__annotations__", {})
    fields = {name: SCALAR_KINDS.get(annotations.get(name), "") for name in getattr(form, "_fields", ())}
    return fields if all(fields.values()) else {}


def _kind(form: Any) -> Kind:
    """Kind of a value of that form."""
    match form:
        case int():
            return ArrayKind(form)
        case (kind, *parts):
            return TupleKind(tuple(map(_kind, parts)), getattr(kind, "_fields", ()))
    if fields := _number_fields(form):
        return TupleKind(tuple(fields.values()), tuple(fields))
    for known, kind in SCALAR_KINDS.items():
        if issubclass(form, known):
            return kind
    raise TypeError(f"compiled code takes numbers, arrays and tuples of these, not {_words(form)}")


def _words(form: Any) -> str:
    return form.__name__ if isinstance(form, type) else named(_kind(form))


class _Code:
    """Machine code of a function for arguments of some kinds."""

    def __init__(self, function: Callable[..., Any], kinds: tuple[Kind, ...]) -> None:
        file = Path(function.__code__.co_filename)
        name = f"{file.stem}.{function.__name__}"
        line = function.__code__.co_firstlineno
        shape = repr((name, line, _digest(file.parent), kinds, machine_name()))
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
        self.pack = _layout([cell for kind in kinds for cell in cells(kind)]).pack
        self.shape, *found = result.decode().split()
        self.results = _layout(found)

    def call(self, given: list[Any]) -> Any:
        """Run the code with these cells of arguments; returns the result of the function."""
        try:
            arguments = self.pack(*given)
        except struct.error as error:
            raise TypeError(f"compiled code takes numbers as annotated, within 64 bits: {error}") from None
        results = bytes(self.results.size)
        self.entry(arguments, results)
        if self.shape == "nothing":
            return None
        found = self.results.unpack(results)
        return found if self.shape == "several" else found[0]


def _layout(kinds: list[str]) -> struct.Struct:
    """The layout in memory of cells of these kinds."""
    return struct.Struct("".join(FORMATS[kind] for kind in kinds))


def _compile(function: Callable[..., Any], kinds: tuple[Kind, ...]) -> bytes:
    """A line with the kinds of the results, and machine code."""
    text, result = lower_function(function, kinds)
    shape = "nothing" if result is None else "several" if isinstance(result, TupleKind) else "one"
    head = " ".join([shape, *(cells(result) if result is not None else ())])
    return head.encode() + b"\n" + compile_text(text, multiply_loops=False)


@cache
def _digest(folder: Path) -> str:
    """Hash of all sources that a function of that folder may call."""
    whole = hashlib.sha256()
    for file in sorted(
        {file for each in (folder, folder.parent / "passes", *SHARED) for file in each.glob("*.py")}
    ):
        whole.update(file.name.encode() + file.read_bytes())
    return whole.hexdigest()
