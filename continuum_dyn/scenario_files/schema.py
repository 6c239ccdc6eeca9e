"""The JSON schema of scenario files, from the models that check them: editors complete and check by it.

It knows tables, keys, types, ranges and words. Conditions across a file, such as an anchor within the
arm, are checked when the scenario is read.
"""

from typing import Any

from pydantic.json_schema import GenerateJsonSchema

from continuum_dyn.scenario_files.tables import UNKNOWN_PROFILE, ScenarioFile
from statics.quantities import QUANTITIES


def json_schema() -> dict[str, Any]:
    """The schema of a scenario file, JSON Schema draft 2020-12."""
    schema = ScenarioFile.model_json_schema(schema_generator=_TomlSchema)
    schema["title"] = "continuum-dyn scenario"
    definitions = schema["$defs"]
    for table in (schema, *definitions.values()):
        for name, key in table.get("properties", {}).items():
            if "const" in key and name not in table.get("required", []):
                table.setdefault("required", []).append(name)  # it tells one kind of table from the others
            table_schema = _table_schema(key, definitions) or (table if "const" in key else None)
            _describe(name, key, table_schema)
    return schema


class _TomlSchema(GenerateJsonSchema):
    """TOML knows no null: a key that may be None may be left out. A profile has one of the known names."""

    def nullable_schema(self, schema: Any) -> dict[str, Any]:
        """The schema of the value, without null."""
        return self.generate_inner(schema["schema"])

    def tagged_union_schema(self, schema: Any) -> dict[str, Any]:
        """The schemas of the known tables and numbers."""
        known: Any = {tag: choice for tag, choice in schema["choices"].items() if tag != UNKNOWN_PROFILE}
        return super().tagged_union_schema(schema | {"choices": known})

    def default_schema(self, schema: Any) -> dict[str, Any]:
        """The schema without a default of null or of a table: such keys may be left out."""
        made = super().default_schema(schema)
        if isinstance(made.get("default"), dict | None):
            made.pop("default", None)
        return made


def _table_schema(key: dict[str, Any], definitions: dict[str, Any]) -> dict[str, Any] | None:
    """The schema of the table that is a key's value, or of those in its list; None if it holds no table."""
    reference = key.get("$ref") or key.get("items", {}).get("$ref", "")
    return definitions.get(reference.rpartition("/")[2])


def _describe(name: str, key: dict[str, Any], table: dict[str, Any] | None) -> None:
    """Title and description of a key: from its model, from its table, or from the glossary."""
    key["title"] = name
    if table is not None:
        key.setdefault("description", table["description"].partition("\n\n")[0].replace("``", "`"))
    elif name in QUANTITIES:
        unit = QUANTITIES[name].unit
        key.setdefault("description", QUANTITIES[name].meaning + ("" if unit == "1" else f", {unit}"))
