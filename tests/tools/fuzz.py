"""Mutants of the scenarios, loaded and run: ``python tests/tools/fuzz.py --count 1000000 --seed 0``.

Every mutant must load or be refused with an ``InputError``. Those that load, and whose kernels are those of
the scenarios named in ``WARM``, are run with a small budget, and the log of one in ``LOGGED`` is written and
read back. A mutant that ends in any other way or with a warning, or takes more than ``SECONDS`` or
``MEMORY``, is printed, and the exit status is 1. A mutant follows from the seed and its number alone, so a
long run can be split, or taken up where it was left: ``--first 500000``.
"""

import argparse
import faulthandler
import resource
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from pathlib import Path
from random import Random

from scenario_mutants import mutant, spoiled

from continuum_dyn import load_scenario, simulate
from continuum_dyn.integrators import Budget
from continuum_dyn.record import read_log, write_log
from statics import InputError
from statics.kernels import loading

SCENARIOS = Path(__file__).parents[2] / "scenarios"
TABLE = SCENARIOS / "slow_ramp.csv"
WARM = ("step_response", "tension_ramp", "unactuated", "step_response_payload")
BUDGET = Budget(steps=100, seconds=1.0)
SECONDS = 10
"""Most of the processor's time that one mutant may take."""
MEMORY = 4_000_000_000
"""Most address space of the whole program, bytes."""
LOGGED = 4
"""One of so many numbers of mutants has its log written."""
WATCHED = 100
"""Mutants in a row that are given up, with a traceback, where even compiled code does not come to its end."""
MAX_SHOWN = 10
REPORTED = 10_000
"""Mutants between two lines that tell how far it is."""


class NotCachedError(Exception):
    """The mutant's kernel would have to be made."""


class TooSlowError(Exception):
    """A mutant took longer than it may."""


def outcome_of(text: str, folder: Path, is_logged: bool) -> str:
    """How a mutant ended, in a word. Raises what it should not."""
    path = folder / "mutant.toml"
    path.write_text(text, encoding="utf-8", newline="", errors="surrogatepass")
    try:
        scenario = load_scenario(path)
    except InputError as error:
        if len(str(error).splitlines()) > 20 or max(map(len, str(error).splitlines())) > 1000:
            raise AssertionError(f"more than a screen: {str(error)[:2000]}") from error
        return "refused"
    try:
        run = simulate(scenario, budget=BUDGET)
    except NotCachedError:
        return "loaded"
    except InputError:
        return "refused when run"
    if is_logged:
        write_log(run, folder / "mutant.h5")
        read_log(folder / "mutant.h5")
    return f"run: {run.outcome}"


def warm_up() -> None:
    """Load the kernels of ``WARM``; from here on no other is made."""
    for name in WARM:
        simulate(load_scenario(SCENARIOS / f"{name}.toml"))

    def refuse(*_arguments: object) -> Path:
        raise NotCachedError

    loading._kept_text = refuse


def fuzz(first: int, count: int, seed: int) -> int:
    """Try so many mutants; prints what they came to, and returns the number of failures."""
    texts = [path.read_text() for path in sorted(SCENARIOS.glob("*.toml"))]
    table = TABLE.read_text()
    found, failures, slowest, started = Counter[str](), Counter[str](), 0.0, time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        for number in range(first, first + count):
            rng = Random(f"{seed} {number}")
            text = mutant(rng, texts)
            if TABLE.name in text:
                (Path(folder) / TABLE.name).write_text(spoiled(rng, table) if rng.random() < 0.5 else table)
            if number % WATCHED == 0:
                faulthandler.dump_traceback_later(WATCHED * SECONDS, exit=True)
            signal.setitimer(signal.ITIMER_PROF, SECONDS)
            before = time.process_time()
            try:
                found[outcome_of(text, Path(folder), number % LOGGED == 0)] += 1
            except Exception:
                told = traceback.format_exc()
                kind = "\n".join(told.splitlines()[-4:])[-300:]
                failures[kind] += 1
                if failures[kind] == 1 and len(failures) <= MAX_SHOWN:
                    print(f"--- seed {seed}, mutant {number}\n{text[:2000]}\n{told[-2000:]}", flush=True)
            finally:
                signal.setitimer(signal.ITIMER_PROF, 0)
            slowest = max(slowest, time.process_time() - before)
            if (number + 1 - first) % REPORTED == 0:
                print(f"{number + 1 - first} mutants, {failures.total()} failures", flush=True)
    faulthandler.cancel_dump_traceback_later()
    seconds, peak = time.monotonic() - started, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000
    print(f"{count} mutants of seed {seed}, from number {first} on, in {seconds:.0f} s,")
    print(f"the slowest {slowest:.2g} s, at most {peak:.0f} MB, {failures.total()} failures")
    for outcome, times in found.most_common():
        print(f"  {outcome:28} {times}")
    return failures.total()


def main() -> int:
    """Exit status: 1 if any mutant failed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()

    def too_slow(_signal: int, _frame: object) -> None:
        raise TooSlowError

    signal.signal(signal.SIGPROF, too_slow)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    warm_up()
    warnings.simplefilter("error")
    return int(fuzz(asked.first, asked.count, asked.seed) > 0)


if __name__ == "__main__":
    sys.exit(main())
