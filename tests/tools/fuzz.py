"""Mutants of the scenarios, loaded and run: ``python tests/tools/fuzz.py --count 1000000 --seed 0``.

Every mutant must load or be refused with an ``InputError``. Those that load, and whose kernels are those of
the scenarios named in ``WARM``, are run with a small budget, and the log of one in ``LOGGED`` is written and
read back. A mutant that ends in any other way or with a warning, or takes more than ``SECONDS`` or
``MEMORY``, is printed, and the exit status is 1. A mutant follows from the seed and its number alone, so a
long run can be split, or taken up where it was left: ``--first 500000``.
"""

import sys
import tempfile
import warnings
from pathlib import Path
from random import Random

from campaign import Campaign, numbers_and_seed
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
REPORTED = 10_000
"""Mutants between two lines that tell how far it is."""


class NotCachedError(Exception):
    """The mutant's kernel would have to be made."""


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


def main() -> int:
    """Exit status: 1 if any mutant failed."""
    numbers, seed = numbers_and_seed(__doc__, 1000)
    texts = [path.read_text() for path in sorted(SCENARIOS.glob("*.toml"))]
    table = TABLE.read_text()
    warm_up()
    warnings.simplefilter("error")
    with tempfile.TemporaryDirectory() as folder:

        def attempt(number: int) -> list[str]:
            rng = Random(f"{seed} {number}")
            text = mutant(rng, texts)
            if TABLE.name in text:
                (Path(folder) / TABLE.name).write_text(spoiled(rng, table) if rng.random() < 0.5 else table)
            return [outcome_of(text, Path(folder), number % LOGGED == 0)]

        def describe(number: int) -> str:
            return mutant(Random(f"{seed} {number}"), texts)[:2000]

        campaign = Campaign("mutant", attempt, describe, SECONDS, MEMORY, REPORTED)
        return int(campaign.run(numbers, seed) > 0)


if __name__ == "__main__":
    sys.exit(main())
