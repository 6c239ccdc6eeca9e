"""Time at which an answer began: the first one with the program, whose loading a user waits for as well."""

import time

_begun: list[float] = []


def program_begun(at: float) -> None:
    """Note when the program was started, as of ``time.perf_counter``, s."""
    _begun[:] = [at]


def answer_begun() -> float:
    """Return when the program was started, the first time that it is asked, and the time now later on."""
    return _begun.pop() if _begun else time.perf_counter()
