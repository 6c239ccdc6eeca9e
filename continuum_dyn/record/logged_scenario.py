"""The scenario of a log, from the log alone: no file beside it is read."""

from collections.abc import Sequence
from dataclasses import replace

from continuum_dyn.record import Log
from continuum_dyn.scenario.scenario import Scenario
from continuum_dyn.scenario_files.reading import parse
from statics.errors import InputError, LogError


def logged_scenario(log: Log, overrides: Sequence[str] = ()) -> Scenario:
    """The scenario of a log, from the text and the tables in it, with changes applied.

    Raises ``LogError`` if the log holds none, or one that this program refuses.
    """
    if not log.scenario:
        raise LogError(f"{log.path}: no scenario in this log: the run was made from Python.")

    def text_of_table(name: str) -> str:
        if name not in log.tables:
            raise InputError(f"the table '{name}' is not in the log.")
        return log.tables[name]

    try:
        scenario = parse(log.scenario, log.path, text_of_table, overrides)[0]
    except InputError as error:
        raise LogError(f"the scenario in {error}") from error
    return scenario if overrides else replace(scenario, title=log.title)
