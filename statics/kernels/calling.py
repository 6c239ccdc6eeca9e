"""Calls of a scene's passes by address.

``run(address, n, scalars, *arrays)`` runs a pass over n segments. ``scalars`` holds what the
pass is given and what it returns, see ``slots``. In compiled functions it is a plain call.
"""

import ctypes

import numpy as np

NOT_CONTIGUOUS = "compiled code takes contiguous arrays of floats only, without strides"

FLOAT = np.dtype(float)
addressof, from_buffer = ctypes.addressof, ctypes.c_char.from_buffer


def run(address: int, n: int, scalars: np.ndarray, *arrays: np.ndarray) -> None:
    """Run the pass at that address over n segments. Raises ``ValueError`` for arrays with strides."""
    pointers = [address_of(array) for array in (scalars, *arrays)]
    kind = ctypes.CFUNCTYPE(None, ctypes.c_int64, *([ctypes.c_void_p] * len(pointers)))
    kind(int(address))(n, *pointers)


def address_of(array: np.ndarray) -> int:
    """Address of an array's first number. Raises ``ValueError`` for one with strides, or not of floats."""
    if array.dtype is not FLOAT and array.dtype != FLOAT:
        raise ValueError(NOT_CONTIGUOUS)
    try:
        return addressof(from_buffer(array))  # pyright: ignore[reportArgumentType], a third of asking it
    except (TypeError, ValueError):  # with strides, empty, or not to be written to
        if not array.flags.c_contiguous:
            raise ValueError(NOT_CONTIGUOUS) from None
        return array.ctypes.data
