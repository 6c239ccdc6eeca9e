"""``continuum-dyn schema``: the JSON schema of scenario files, for editors."""

import json

from continuum_dyn.commands.terminal.output import say


def schema() -> None:
    """Print the JSON schema of scenario files.

    Editors use it to complete and check scenario files. Write it beside a scenario,

        continuum-dyn schema > scenario.schema.json

    and make this the first line of the scenario, for Even Better TOML (VS Code) or taplo:

        #:schema ./scenario.schema.json
    """
    from continuum_dyn.scenario_files.schema import json_schema

    say(json.dumps(json_schema(), indent=2))
