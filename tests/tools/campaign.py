"""Many trials in a row, each from a seed and its number: watched, counted, their failures printed."""

import argparse
import faulthandler
import resource
import signal
import time
import traceback
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

WATCHED = 100
"""Trials in a row that are given up, with a traceback, where even compiled code does not come to its end."""
MAX_SHOWN = 10
"""Largest number of failures that are printed in full."""


class TooSlowError(Exception):
    """A trial took longer than it may."""


@dataclass(frozen=True)
class Campaign:
    """Trials, each called a ``noun``.

    ``attempt(number)`` returns how one ended, in words, and raises what should not be; ``describe(number)``
    is printed above a failure. ``seconds`` bounds the processor's time of one, ``memory`` the address space
    of the whole program, bytes; how far it is, is printed every ``reported`` trials.
    """

    noun: str
    attempt: Callable[[int], list[str]]
    describe: Callable[[int], str]
    seconds: int
    memory: int
    reported: int

    def run(self, numbers: range, seed: int) -> int:
        """Try all numbers; prints what they came to, and returns the number of failures."""
        _bound(self.memory)
        found, failures, slowest, started = Counter[str](), Counter[str](), 0.0, time.monotonic()
        for number in numbers:
            if number % WATCHED == 0:
                faulthandler.dump_traceback_later(WATCHED * self.seconds, exit=True)
            before = time.process_time()
            try:
                found.update(self._attempt(number))
            except Exception:
                told = traceback.format_exc()
                kind = "\n".join(told.splitlines()[-4:])[-300:]
                failures[kind] += 1
                if failures[kind] == 1 and len(failures) <= MAX_SHOWN:
                    text = self.describe(number)
                    print(f"--- seed {seed}, {self.noun} {number}\n{text}\n{told[-2000:]}", flush=True)
                else:
                    print(f"--- seed {seed}, {self.noun} {number}: {told.splitlines()[-1][:200]}", flush=True)
            slowest = max(slowest, time.process_time() - before)
            if (done := numbers.index(number) + 1) % self.reported == 0:
                print(f"{done} {self.noun}s, up to {number}, {failures.total()} failures", flush=True)
        faulthandler.cancel_dump_traceback_later()
        seconds, peak = time.monotonic() - started, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000
        print(
            f"{len(numbers)} {self.noun}s of seed {seed}, from number {numbers.start} on, in {seconds:.0f} s,"
        )
        print(f"the slowest {slowest:.2g} s, at most {peak:.0f} MB, {failures.total()} failures")
        for outcome, times in found.most_common():
            print(f"  {outcome:28} {times}")
        return failures.total()

    def _attempt(self, number: int) -> list[str]:
        signal.setitimer(signal.ITIMER_PROF, self.seconds)
        try:
            return self.attempt(number)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)


def _bound(memory: int) -> None:
    def too_slow(_signal: int, _frame: object) -> None:
        raise TooSlowError

    signal.signal(signal.SIGPROF, too_slow)
    resource.setrlimit(resource.RLIMIT_AS, (memory, memory))


def numbers_and_seed(doc: str | None, count: int) -> tuple[range, int]:
    """The numbers and the seed that the command line asks for; ``count`` by default."""
    parser = argparse.ArgumentParser(description=doc)
    parser.add_argument("--count", type=int, default=count)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--step", type=int, default=1, help="from one number to the next")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    return range(asked.first, asked.first + asked.step * asked.count, asked.step), asked.seed
