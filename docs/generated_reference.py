"""Generated parts of the reference: commands, scenario keys, effects, glossary.

A page marks where a part belongs by ``<!-- generated: PART -->``; ``make reference`` renews what is there.
"""

import re
from collections.abc import Callable, Iterable
from itertools import groupby
from pathlib import Path
from typing import Any

import typer
from python_reference import prose, python_names

from continuum_dyn.cli import app
from continuum_dyn.effects import EFFECTS
from continuum_dyn.scenario_files.keys import KeyTable, key_tables
from statics.outcome import Outcome
from statics.quantities import QUANTITIES

EVERY_COMMAND = "Options of every command"


def table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A table in Markdown; bars within cells are kept from being its own."""
    header = list(header)
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)


def code(text: Any) -> str:
    """The text as code, or nothing."""
    return f"`{text}`" if str(text) else ""


# Commands


def commands() -> str:
    """Every command: what it does, its arguments, its options."""
    group: Any = typer.main.get_command(app)
    parts = []
    for panel, found in groupby(group.commands.items(), lambda named: named[1].rich_help_panel):
        parts.append(f"## {panel}")
        parts += [_command(name, command) for name, command in found]
    of_every = [(_spelled(p), p.help) for p in group.params if p.rich_help_panel == EVERY_COMMAND]
    of_none = [(_spelled(p), p.help) for p in group.params if p.rich_help_panel != EVERY_COMMAND]
    parts += [f"## {EVERY_COMMAND}", "Before its name, or after it.", table(("option", "does"), of_every)]
    parts += ["## Options without a command", table(("option", "does"), of_none)]
    return "\n\n".join(parts)


def _command(name: str, command: Any) -> str:
    own = [p for p in command.params if p.rich_help_panel != EVERY_COMMAND]
    arguments = [p for p in own if p.param_type_name == "argument"]
    options = [p for p in own if p.param_type_name == "option"]
    usage = " ".join(
        [
            f"continuum-dyn {name}",
            *(p.metavar if p.required else f"[{p.metavar}]" for p in arguments),
            *(["[OPTIONS]"] if options else []),
        ]
    )
    rows = [(code(p.metavar), p.help, _default(p)) for p in arguments]
    rows += [(_spelled(p), p.help, _default(p)) for p in options]
    told = [f"### {name}", f"```text\n{usage}\n```", prose(command.help)]
    return "\n\n".join([*told, table(("given", "is", "by default"), rows)] if rows else told)


def _spelled(option: Any) -> str:
    spelled = ", ".join(code(spelling) for spelling in option.opts)
    return spelled if getattr(option, "is_flag", False) else f"{spelled} {code(option.metavar or '')}".strip()


def _default(parameter: Any) -> str:
    return "" if parameter.default in (None, False, ()) else code(parameter.default)


def exit_statuses() -> str:
    """Every outcome with the status that a run exits with."""
    rows = [(code(outcome), str(outcome.exit_status)) for outcome in Outcome]
    return table(("outcome", "exit status"), rows)


# Scenario keys


OF_EFFECTS = """\
The effects to include: `gravity = {}` includes one with its default values. Effects not listed are left
out of the equations. `cables`, `cable_friction` and `loads` are not keys here: `[[cables]]`, their
`friction`, and `[[loads]]` include them."""


OF_PROFILES = """\
Inputs of a motion: a tension, a cable's displacement, a load's factor, the base's `x`, `y` or `angle`.
A number alone is a constant; in a ramp study a list has a value for each point."""


def scenario_keys() -> str:
    """Every table of a scenario file, with its keys, their values and meanings."""
    parts, chapter = [], ""
    for found in key_tables()[:-1]:
        name, _, kind = found.heading.partition(" ")
        if name == "[effects]":
            if chapter != name:
                parts += ["## `[effects]`", OF_EFFECTS, effects()]
        elif kind and name != "the":
            if chapter != name:
                parts += ["## `[study]`"] if name == "[study]" else ["## Profiles", OF_PROFILES]
            parts += [f"### `{kind if name == '[study]' else found.heading}`", found.text, _keys(found)]
        else:
            title = "The file" if name == "the" else f"`{found.heading}`"
            parts += [f"## {title}", found.text, _keys(found)]
        chapter = name
    return "\n\n".join([*parts, materials(key_tables()[-1])])


def materials(found: KeyTable) -> str:
    """Every material: its figures, and their source."""
    rows = [(code(key.name), key.value, key.meaning) for key in found.keys]
    return "\n\n".join(["## Materials", found.text, table(("name", "figures", "source"), rows)])


def _keys(found: KeyTable) -> str:
    rows = [
        (
            code(key.name),
            key.value.replace("profile", "[profile](#profiles)"),
            key.default,
            key.meaning,
            code(key.example),
        )
        for key in found.keys
    ]
    return (
        table(("key", "value", "default", "meaning", "example"), rows)
        if rows
        else "It has no keys of its own."
    )


def effects() -> str:
    """Every effect, with its numbers of the arm, its source, and the keys of its table."""
    of_effects = {found.heading: found for found in key_tables()}
    parts = []
    for name, effect in EFFECTS.items():
        needs = ", ".join(code(quantity) for quantity in effect.arm_quantities)
        lines = [f"On each {effect.site}, {'at rest and in motion' if effect.acts_at_rest else 'in motion'}."]
        lines += [f"Needs the arm's {needs}."] if needs else []
        lines += [f"Source: {effect.source}."]
        parts += [f"### `{name}`", prose(_text(effect)), " ".join(lines)]
        found = of_effects[f"[effects] {name}"]
        parts += [f"```toml\n{found.example}\n```"] if found.example else []
        parts += [_keys(found)] if found.keys else []
    return "\n\n".join(parts)


def _text(documented: Any) -> str:
    """A docstring without its indentation; formulas and words that look like marks stay as they are."""
    lines = (documented.__doc__ or "").split("\n")
    return "\n".join([lines[0], *(line.strip() for line in lines[1:])]).strip()


# Glossary


def glossary() -> str:
    """Every quantity: its name, letter, unit and meaning."""
    rows = [
        (code(q.name), "" if q.letter == q.name else code(q.letter), q.unit, q.meaning)
        for q in QUANTITIES.values()
    ]
    return table(("name", "letter", "unit", "meaning"), rows)


PARTS: dict[str, Callable[[], str]] = {
    part.__name__: part for part in (commands, exit_statuses, scenario_keys, glossary, python_names)
}
PAGES = Path(__file__).parent / "reference"
BLOCK = re.compile(r"(<!-- generated: (\w+) -->\n).*?(<!-- end of generated text -->\n)", re.DOTALL)


def renewed(page: str) -> str:
    """The text of a page with its generated parts renewed."""
    return BLOCK.sub(lambda found: f"{found[1]}\n{PARTS[found[2]]().strip()}\n\n{found[3]}", page)


def main() -> None:
    """Write the parts into the pages, and name the pages that changed."""
    for file in sorted(PAGES.glob("*.md")):
        page = file.read_text(encoding="utf-8")
        if (new := renewed(page)) != page:
            file.write_text(new, encoding="utf-8")
            print(f"renewed: {file}")


if __name__ == "__main__":
    main()
