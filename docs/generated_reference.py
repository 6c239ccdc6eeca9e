"""The parts of the reference that the program tells itself: commands, scenario keys, effects, glossary.

Pages ask for a part by the directive ``{generated} PART``, so what they show is what the program has.
"""

from collections.abc import Callable, Iterable
from itertools import groupby
from typing import Any

import typer
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

import continuum_dyn.effects
import continuum_dyn.modes
import continuum_dyn.passes.dynamics
import continuum_dyn.scenario.intervals
import continuum_dyn.scenario.profiles
import continuum_dyn.scenario.solver
import continuum_dyn.scenario.studies
import statics
from continuum_dyn.cli import app
from continuum_dyn.effects import EFFECTS
from continuum_dyn.scenario.profiles import PROFILES
from continuum_dyn.scenario.studies import STUDIES
from continuum_dyn.scenario_files.keys import KeyTable, key_tables
from statics.effects import STATIC_EFFECTS
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


def prose(docstring: str) -> str:
    """A docstring as Markdown."""
    return docstring.replace("``", "`")


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
The effects in play: `gravity = {}` takes one with what it has by default. What is not named is in no
equation. `cables`, `cable_friction` and `loads` are no keys here: they come with `[[cables]]`, their
`friction`, and `[[loads]]`."""


OF_PROFILES = """\
What drives a motion: a tension, a cable's displacement, a load's factor, the base's `x`, `y` or `angle`.
A number alone is constant; in a ramp study a list has a value for each point."""


def scenario_keys() -> str:
    """Every table of a scenario file: its keys, what they may be, what they mean."""
    parts, chapter = [], ""
    for found in key_tables():
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
    return "\n\n".join(parts)


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
    """Every effect: what it does, what it needs of the arm, where it is from; and the keys of its table."""
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
    return "\n".join([lines[0], *(line.strip() for line in lines[1:])]).strip().replace("*", "\\*")


# Glossary


def glossary() -> str:
    """Every quantity: its name, letter, unit and meaning."""
    rows = [
        (code(q.name), "" if q.letter == q.name else code(q.letter), q.unit, q.meaning.replace("*", "\\*"))
        for q in QUANTITIES.values()
    ]
    return table(("name", "letter", "unit", "meaning"), rows)


# Python


def python_names() -> str:
    """The public names of both packages, and of the modules that people use beside them."""
    parts = []
    for module, names in PUBLIC.items():
        parts += [f"## `{module.__name__}`", prose((module.__doc__ or "").strip())]
        parts += [_documented(f"{module.__name__}.{name}", getattr(module, name)) for name in names]
    return "\n\n".join(parts)


def _documented(path: str, value: Any) -> str:
    kind = "autoclass" if isinstance(value, type) else "autofunction" if callable(value) else "autodata"
    return f"```{{eval-rst}}\n.. {kind}:: {path}\n```"


PUBLIC: dict[Any, Iterable[str]] = {
    continuum_dyn: continuum_dyn.__all__,
    statics: statics.__all__,
    continuum_dyn.effects: [
        effect.__name__ for name, effect in EFFECTS.items() if name not in STATIC_EFFECTS
    ],
    continuum_dyn.scenario.profiles: [profile.__name__ for profile in PROFILES.values()],
    continuum_dyn.scenario.intervals: ["Interval", "cut_into_intervals"],
    continuum_dyn.scenario.studies: [study.__name__ for study in STUDIES.values()],
    continuum_dyn.scenario.solver: ["Solver", "Accuracy"],
    continuum_dyn.passes.dynamics: ["Dynamics", "Observation"],
    continuum_dyn.modes: ["modes_at_rest", "RestModes", "Mode"],
}


PARTS: dict[str, Callable[[], str]] = {
    part.__name__: part for part in (commands, exit_statuses, scenario_keys, glossary, python_names)
}


class Generated(SphinxDirective):
    """``{generated} PART``: what the program tells, as part of the page."""

    required_arguments = 1

    def run(self) -> list[Any]:
        """The part as nodes."""
        return self.parse_text_to_nodes(PARTS[self.arguments[0]](), allow_section_headings=True)


def bars_as_text(_app: Any, _what: str, _name: str, _value: Any, _options: Any, lines: list[str]) -> None:
    """In docstrings |v| is a size, and no substitution of reStructuredText."""
    for number, line in enumerate(lines):
        parts = line.split("``")
        parts[::2] = [part.replace("|", "\\|") for part in parts[::2]]
        lines[number] = "``".join(parts)


def without_factories(*given: Any) -> tuple[str, Any] | None:
    """Signatures of dataclasses without how they make their defaults."""
    signature, returns = given[-2:]
    return signature and (signature.replace("=<factory>", "=..."), returns)


def setup(application: Sphinx) -> dict[str, Any]:
    """Tell Sphinx of the directive."""
    application.connect("autodoc-process-docstring", bars_as_text)
    application.connect("autodoc-process-signature", without_factories)
    application.add_directive("generated", Generated)
    return {"parallel_read_safe": True}
