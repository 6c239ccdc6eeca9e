"""Deferred Ctrl-C: while a file is written, or while results are saved first."""

import signal
import sys
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, TypeVar

Item = TypeVar("Item")


@dataclass
class Interruption:
    """Whether Ctrl-C was pressed and not answered yet, and whether it raises at once."""

    asked: bool = False
    raises: bool = False

    def raise_if_asked(self) -> None:
        """Answer by ``KeyboardInterrupt``."""
        if self.asked:
            self.asked = False
            raise KeyboardInterrupt

    def until_asked(self, items: Iterable[Item]) -> Iterator[Item]:
        """The items, or those that come before Ctrl-C is pressed."""
        for item in items:
            if self.asked:
                return
            yield item


_deferred: Interruption | None = None


@contextmanager
def defer_interruption() -> Iterator[Interruption]:
    """Ctrl-C waits for the end of the block; pressed again, it raises at once.

    Code within may look at ``asked``, end early, and clear it once it has answered.
    """
    if _deferred is not None and threading.current_thread() is threading.main_thread():
        yield from _nested(_deferred, raises=False)
    else:
        yield from _outermost()


@contextmanager
def allowed() -> Iterator[Interruption]:
    """Within what holds it, Ctrl-C raises ``KeyboardInterrupt``, also if it was pressed before."""
    if _deferred is None or threading.current_thread() is not threading.main_thread():
        yield Interruption()
    else:
        _deferred.raise_if_asked()
        yield from _nested(_deferred, raises=True)


def _nested(interruption: Interruption, raises: bool) -> Iterator[Interruption]:
    before, interruption.raises = interruption.raises, raises
    try:
        yield interruption
    except KeyboardInterrupt:
        interruption.asked = False
        raise
    finally:
        interruption.raises = before
    if before or raises:  # what the block has swallowed, or held
        interruption.raise_if_asked()


def _outermost() -> Iterator[Interruption]:
    global _deferred
    interruption = Interruption()
    previous = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(previous):
        yield interruption
        return

    def on_interrupt(_signal: int, _frame: object) -> None:
        again, interruption.asked = interruption.asked, True
        if again or interruption.raises:
            raise KeyboardInterrupt

    def on_swallowed(unraisable: Any) -> None:
        if unraisable.exc_type is not KeyboardInterrupt:  # that one is not lost: it was noted as asked for
            told_before(unraisable)

    told_before = sys.unraisablehook
    _deferred, sys.unraisablehook = interruption, on_swallowed
    signal.signal(signal.SIGINT, on_interrupt)
    try:
        yield interruption
    finally:
        _deferred, sys.unraisablehook = None, told_before
        signal.signal(signal.SIGINT, previous)
        if interruption.asked:
            previous(signal.SIGINT, None)
