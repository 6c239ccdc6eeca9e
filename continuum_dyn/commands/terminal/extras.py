"""Optional dependencies, the extras of the package."""

from collections.abc import Iterator
from contextlib import contextmanager

from statics.errors import ContinuumError

EXTRAS = {"matplotlib": "plots", "rerun": "rerun"}
"""The extra that each of these packages comes with."""


class MissingExtraError(ContinuumError, ImportError):
    """A request needs a package that is not installed."""


@contextmanager
def naming_extras() -> Iterator[None]:
    """Raise ``MissingExtraError`` if an import within misses a package of an extra."""
    try:
        yield
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0].removesuffix("_bindings")  # rerun's compiled core
        if package not in EXTRAS:
            raise
        extra = EXTRAS[package]
        raise MissingExtraError(
            f"{package} is not installed: pip install 'continuum-dyn[{extra}]'"
        ) from error
