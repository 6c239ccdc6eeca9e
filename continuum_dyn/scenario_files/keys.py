"""The keys of scenario files as tables: an example, allowed values, default and meaning of each."""

import re
from collections.abc import Iterator
from typing import Any, NamedTuple

from continuum_dyn.effects import EFFECTS
from continuum_dyn.scenario_files.examples import examples
from continuum_dyn.scenario_files.schema import json_schema
from continuum_dyn.scenario_files.tables import NAMED_ELSEWHERE, OF_EFFECTS
from statics.materials import MATERIALS

_HEADED = re.compile(r"^\[\w+\]: ")


class Key(NamedTuple):
    """A key of a table; ``value`` describes its allowed values, with literal text in `ticks`.

    ``example`` is a line of a scenario file, or the header of the table that the key stands for.
    """

    name: str
    example: str
    value: str
    default: str
    meaning: str


class KeyTable(NamedTuple):
    """A table of a scenario file, or one kind of it, with its purpose and its keys.

    ``example`` is the line that an effect or a profile takes in a file, otherwise empty.
    """

    heading: str
    text: str
    keys: tuple[Key, ...]
    example: str = ""


def key_tables() -> list[KeyTable]:
    """Every table of a scenario file in the order of the file: effects, studies and profiles one by one."""
    schema = json_schema()
    definitions = schema["$defs"]
    of_file = keys_of(schema, definitions, "file")
    found = [KeyTable("the file", "Keys above all tables, and the tables.", of_file)]
    for name, key in schema["properties"].items():
        if name == "effects":
            found += list(_effects(definitions))
        elif name == "study":
            for kind, reference in key["discriminator"]["mapping"].items():
                of_kind = definitions[reference.rpartition("/")[2]]
                found.append(_table(f'[study] kind = "{kind}"', of_kind, definitions, f"study.{kind}"))
        elif reference := _reference(key):
            found.append(_table(_header(name, key), definitions[reference], definitions, name))
    return [*found, *_profiles(definitions), _materials()]


def _materials() -> KeyTable:
    """Materials as a table of keys: the figures of each, and their source."""
    rows = (
        Key(
            name,
            f'core_material = "{name}"',
            f"Young's modulus {known.youngs_modulus / 1e9:g} GPa; density {known.density:g} kg/m^3",
            "",
            known.source,
        )
        for name, known in MATERIALS.items()
    )
    text = "Names for `core_material` and `disk_material`: typical figures; measured ones are better."
    return KeyTable("materials", text, tuple(rows))


def _header(name: str, key: dict[str, Any]) -> str:
    return f"[[{name}]]" if "items" in key else f"[{name}]"


def _table(heading: str, of_table: dict[str, Any], definitions: dict[str, Any], place: str) -> KeyTable:
    text = of_table["description"].replace("``", "`").removeprefix(f"{heading}: ")
    return KeyTable(heading, text[0].upper() + text[1:], keys_of(of_table, definitions, place))


def _effects(definitions: dict[str, Any]) -> Iterator[KeyTable]:
    for name, effect in EFFECTS.items():
        of_effect = definitions.get(OF_EFFECTS[name].__name__, {})
        text = (effect.__doc__ or "").partition("\n\n")[0].replace("``", "`")
        found = KeyTable(f"[effects] {name}", text, keys_of(of_effect, definitions, f"effects.{name}"))
        yield found if name in NAMED_ELSEWHERE else found._replace(example=_inline(name, found.keys))


def _profiles(definitions: dict[str, Any]) -> Iterator[KeyTable]:
    for found in definitions.values():
        kind = found.get("properties", {}).get("profile", {}).get("const")
        if kind:
            table = _table(f'profile = "{kind}"', found, definitions, f"profile.{kind}")
            yield table._replace(example=_inline("tension", table.keys, table.heading))


def _inline(name: str, keys: tuple[Key, ...], *first: str) -> str:
    """A table on one line, with examples of the keys that it must have."""
    needed = [key.example for key in keys if key.default == "required"]
    known = ", ".join([*first, *(needed or [key.example for key in keys[:1] if not key.default])])
    return f"{name} = {{ {known} }}" if known else f"{name} = {{}}"


def keys_of(of_table: dict[str, Any], definitions: dict[str, Any], place: str) -> tuple[Key, ...]:
    """Keys of one table of the schema, without the key of its kind.

    ``place`` names the table among the examples.
    """
    given = examples().get(place, {})
    return tuple(
        Key(
            name,
            f"{name} = {given[name]}" if name in given else _header(name, key),
            _values(key, definitions),
            "required" if name in of_table.get("required", []) else _shown(key.get("default", "")),
            _HEADED.sub("", key.get("description", "").replace("``", "`").replace("\n", " ")),
        )
        for name, key in of_table.get("properties", {}).items()
        if "const" not in key
    )


def _shown(default: Any) -> str:
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    if isinstance(default, str):
        return f'`"{default}"`' if default else ""
    return f"`{default}`"


def _reference(key: dict[str, Any]) -> str:
    return (key.get("$ref") or key.get("items", {}).get("$ref", "")).rpartition("/")[2]


def _values(key: dict[str, Any], definitions: dict[str, Any]) -> str:
    """The values that a key may have, in words."""
    choices = key.get("oneOf") or key.get("anyOf")
    if choices and any(_is_profile(choice, definitions) for choice in choices):
        plain = [choice for choice in choices if not _is_profile(choice, definitions)]
        return ", or ".join([*(_values(choice, definitions) for choice in plain), "profile"])
    if choices and "discriminator" in key:
        return "table"
    if choices:
        return ", or ".join(_values(choice, definitions) for choice in choices)
    if _reference(key):
        found = definitions[_reference(key)]
        if "enum" in found:
            return ", ".join(f'`"{word}"`' for word in found["enum"])
        return "list of tables" if "items" in key else "table"
    if "enum" in key:
        return ", ".join(f'`"{word}"`' for word in key["enum"])
    return _number_or_text(key, definitions)


def _is_profile(choice: dict[str, Any], definitions: dict[str, Any]) -> bool:
    found = definitions.get(_reference(choice), {})
    return "const" in found.get("properties", {}).get("profile", {})


def _number_or_text(key: dict[str, Any], definitions: dict[str, Any]) -> str:
    if "const" in key:
        return f'`"{key["const"]}"`'
    if key["type"] == "array" and "prefixItems" in key:
        return f"list of {len(key['prefixItems'])} numbers"
    if key["type"] == "array":
        return "list of them"
    if key["type"] == "object":
        return f"table: for each name {_values(key['additionalProperties'], definitions)}"
    words = {"number": "number", "integer": "integer", "string": "text", "boolean": "`true` or `false`"}
    signs = {"exclusiveMinimum": ">", "minimum": ">=", "exclusiveMaximum": "<", "maximum": "<="}
    bounds = [f"{sign} {key[name]:g}" for name, sign in signs.items() if name in key]
    return " ".join([words[key["type"]], ", ".join(bounds)]).strip()
