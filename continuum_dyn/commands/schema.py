"""``continuum-dyn schema``: what editors complete and check scenario files by."""

import json

from continuum_dyn.commands.terminal.output import say


def schema() -> None:
    """Print the JSON schema of scenario files.

    Editors complete and check by it. Write it beside a scenario,

        continuum-dyn schema > scenario.schema.json

    and make this the scenario's first line, for Even Better TOML in VS Code and for taplo elsewhere:

        #:schema ./scenario.schema.json
    """
    from continuum_dyn.scenario_files.schema import json_schema

    say(json.dumps(json_schema(), indent=2))
