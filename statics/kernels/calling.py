"""Calls of a scene's passes by address, from compiled code that knows no scene.

``run(address, n, scalars, *arrays)`` runs a pass over n segments. ``scalars`` holds what the
pass is given and what it returns, see ``slots``.
"""

import ctypes
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core.errors import TypingError
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin

NOT_CONTIGUOUS = "a pass takes contiguous arrays: it knows no strides"


def run(address: int, n: int, scalars: np.ndarray, *arrays: np.ndarray) -> None:
    """Run the pass at that address over n segments. Raises ``ValueError`` for arrays with strides."""
    if not all(array.flags.c_contiguous for array in (scalars, *arrays)):
        raise ValueError(NOT_CONTIGUOUS)
    pointers = [array.ctypes.data for array in (scalars, *arrays)]
    kind = ctypes.CFUNCTYPE(None, ctypes.c_int64, *([ctypes.c_void_p] * len(pointers)))
    kind(int(address))(n, *pointers)


@infer_global(run)  # pyright: ignore[reportOptionalCall]
class _TypeOfRun(AbstractTemplate):
    """Tells numba that ``run`` takes any arrays and returns nothing."""

    def generic(self, args: Any, kws: Any) -> Any:
        """The signature for these types; arrays with strides are refused."""
        if any(getattr(kind, "layout", "C") != "C" for kind in args[2:]):
            raise TypingError(NOT_CONTIGUOUS)
        return signature(types.none, *args)


@lower_builtin(run, types.Integer, types.Integer, types.VarArg(types.Array))
def _lower_run(context: Any, builder: Any, types_of: Any, arguments: Any) -> Any:
    """The call in compiled code: the arrays' data pointers, handed to the address."""
    address, n, *arrays = arguments
    pointer = ir.IntType(8).as_pointer()
    values = [n]
    for kind, value in zip(types_of.args[2:], arrays, strict=True):
        values.append(builder.bitcast(context.make_array(kind)(context, builder, value).data, pointer))
    function = ir.FunctionType(ir.VoidType(), [ir.IntType(64)] + [pointer] * (len(values) - 1))
    builder.call(builder.inttoptr(address, function.as_pointer()), values)
    return context.get_dummy_value()
