"""Random scenarios through the commands: ``python tests/tools/random_runs.py --count 20000 --seed 0``.

Each is run, and its log goes through info and validate; every ``LOOKED_AT``-th also through one of plot,
settle, modes and play, and every ``COMPARED``-th is held against what other equations and another integrator
make of it. A run must end in a named outcome that its log bears out, or be refused in words; nothing may
raise, warn, hold a number that is not finite, or take more than ``SECONDS``. A scenario follows from the seed
and its number alone, so a run of many can be split, or taken up where it was left: ``--first 5000``.
"""

import json
import re
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

from campaign import Campaign, numbers_and_seed
from log_claims import check, check_rest, check_same_motion
from random_structures import scenario
from typer.testing import CliRunner, Result

from continuum_dyn.cli import app
from continuum_dyn.record import Log, read_log
from continuum_dyn.record.logged_scenario import logged_scenario
from statics.outcome import Outcome

SECONDS = 60
"""Most of the processor's time that one may take, with the kernels of its structure."""
MEMORY = 16_000_000_000
REPORTED = 500
LOOKED_AT, COMPARED = 5, 10
SCREEN = 25
"""Most lines of a message, as wide as a terminal."""
OTHER_METHOD = ("--set", 'solver.method="LSODA"', "--set", "solver.rtol=1e-8", "--set", "solver.atol=1e-11")

runner = CliRunner(env={"COLUMNS": "100", "NO_COLOR": "1"})


def invoke(*arguments: Any) -> Result:
    """Run a command; raises what it raises, and ``AssertionError`` for an exit status that says it broke."""
    result = runner.invoke(app, list(map(str, arguments)))
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code in (0, 1, 2), f"{arguments[0]}: exit status {result.exit_code}\n{result.output}"
    if result.exit_code == 2:
        lines = result.stderr.splitlines()
        assert lines, f"{arguments[0]}: exit status 2 without a word\n{result.output}"
        assert lines[0].startswith("error: "), f"{arguments[0]}: no error\n{result.stderr}"
        assert len(lines) <= SCREEN, f"more than a screen: {result.stderr}"
    return result


def outcome_of(seed: int, number: int, folder: Path) -> list[str]:
    """How a scenario ended, in words. Raises what it should not."""
    drawn = scenario(seed, number)
    file = folder / "scene.toml"
    file.write_text(drawn.text)
    for name, text in drawn.tables.items():
        (folder / name).write_text(text)
    result = invoke("run", file, "--out", folder, "--json")
    if result.exit_code == 2:
        return [f"run refused: {_reason(result, file)}"]
    record = json.loads(result.stdout, parse_constant=_refuse)
    assert result.exit_code == Outcome(record["outcome"]).exit_status
    path = Path(record["log"])
    assert invoke("validate", path).exit_code == 0, invoke("validate", path).stdout
    assert invoke("info", path).exit_code == 0
    log = read_log(path)
    check(log, logged_scenario(log))
    words = [f"run: {record['outcome']}"]
    if number % LOOKED_AT == 0:
        words += look_at(number // LOOKED_AT, file, log, folder)
    if number % COMPARED == 0:
        check_rest(log, logged_scenario(log))
        words += compare_with_another_method(file, log, folder)
    return words


def look_at(part: int, file: Path, log: Log, folder: Path) -> list[str]:
    """Ask for one of the pictures and answers; says if it was refused, and why."""
    asked = (
        ("plot", log.path, "--out", folder / "plot.png"),
        ("settle", log.path, "--out", folder, "--json"),
        ("modes", file, "--out", folder),
        ("play", log.path, "--save", folder / "play.rrd"),
    )
    name, *arguments = asked[part % len(asked)]
    result = invoke(name, *arguments)
    if result.exit_code == 2:
        return [f"{name} refused: {_reason(result, log.path)}"]
    if name == "settle":
        json.loads(result.stdout, parse_constant=_refuse)
    return [name]


def compare_with_another_method(file: Path, log: Log, folder: Path) -> list[str]:
    """Hold a motion against that by a method of SciPy's; says so if there was one to compare."""
    if not (log.trajectory and log.outcome.answered) or "accuracy" in logged_scenario(log).text:
        return []
    if "rtol" not in log.attributes:  # "midpoint" has a step, and no tolerance to be held against
        return []
    result = invoke("run", file, "--out", folder / "other", *OTHER_METHOD, "--json")
    if result.exit_code != 0:
        return []
    check_same_motion(log, read_log(Path(json.loads(result.stdout)["log"])))
    return ["compared with another method"]


def _reason(result: Result, file: Path) -> str:
    """Beginning of a message, without the file's name and without numbers, so that reasons can be counted."""
    words = " ".join(result.stderr.split()).removeprefix("error: ").removeprefix(f"{file}: ")
    return re.sub(r"\d[\d.e+-]*", "#", words)[:70]


def _refuse(name: str) -> None:
    raise AssertionError(f"{name} in an answer")


def main() -> int:
    """Exit status: 1 if any failed."""
    numbers, seed = numbers_and_seed(__doc__, 100)
    warnings.simplefilter("error")

    def attempt(number: int) -> list[str]:
        with tempfile.TemporaryDirectory() as folder:
            return outcome_of(seed, number, Path(folder))

    def describe(number: int) -> str:
        return scenario(seed, number).text

    return int(Campaign("scenario", attempt, describe, SECONDS, MEMORY, REPORTED).run(numbers, seed) > 0)


if __name__ == "__main__":
    sys.exit(main())
