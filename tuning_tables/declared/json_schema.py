"""The JSON Schema (draft 2020-12) of what a dataclass declares."""

from __future__ import annotations

from typing import Any, Final

from tuning_tables.declared.leaf import Json
from tuning_tables.declared.members import DeclaredMember, LeafMember, SectionMember, members_of

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"


def schema_of(declared: type) -> Json:
    """An object with exactly the declared members, all of them required.

    A class may state more of them in `SCHEMA`, a schema that must hold, too.
    """
    whole = object_of({name: _schema(member) for name, member in members_of(declared).items()})
    further = getattr(declared, "SCHEMA", None)
    return whole if further is None else {**whole, "allOf": [further]}


def object_of(properties: Json) -> Json:
    """An object with exactly these members."""
    return {
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "additionalProperties": False,
    }


def _schema(member: DeclaredMember) -> Any:
    match member:
        case LeafMember():
            return _or_null(member.leaf.schema(), member.is_optional)
        case SectionMember():
            return _or_null(schema_of(member.section), member.is_optional)
        case _:
            several = member.several
            items = schema_of(member.section)
            return {"type": "array", "items": items, "minItems": several.fewest, "maxItems": several.most}


def _or_null(schema: Json, is_optional: bool) -> Json:
    return {"anyOf": [{"type": "null"}, schema]} if is_optional else schema
