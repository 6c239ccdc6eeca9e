"""One family of exceptions, and the "did you mean" that they share."""

from collections.abc import Iterable
from difflib import get_close_matches


class ContinuumError(Exception):
    """Anything that this program refuses or cannot do; its text is meant for the user."""


class InputError(ContinuumError):
    """An input that cannot be simulated as it was given."""


class NotFoundError(ContinuumError):
    """A number is requested from an equilibrium that was not found."""


class KernelCacheError(ContinuumError):
    """The folder of generated kernels cannot be used safely."""


class LogError(ContinuumError):
    """A log cannot be written, or is not one of ours."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """The nearest known word and the list of them all, as the end of an error message."""
    names = list(known)
    nearest = get_close_matches(word, names, n=1, cutoff=0.5)
    hint = f" Did you mean '{nearest[0]}'?" if nearest else ""
    return f"{hint} Known: {', '.join(names)}."
