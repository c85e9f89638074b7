"""JSON Schema of a hump file: the keys of `hump_cells.ELEMENTS` and the form of each value, for editors."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from plant_models.hump import GROUPS
from plant_models.library.data_file import FORMS, NUMBER, Json, number, number_or_pairs, rows_of
from plant_models.library.hump_cells import CONTROLLERS, ELEMENTS, PROFILE, Key, Schema
from plant_models.library.hump_entry import FORMAT, VERSION
from plant_models.library.hump_forms import (
    LONGEST_NAME,
    short_text,
    some_numbers,
    some_pairs,
    text,
    texts,
    triples,
    truth,
    unit_schema,
    whole,
)
from plant_models.library.sourced_value import CONFIDENCES

PRINTABLE: Final[Json] = {"type": "string", "minLength": 1}
ORIGIN: Final[Json] = {"source": PRINTABLE, "confidence": {"enum": list(CONFIDENCES)}}
CELL_FORMS: Final[Mapping[Callable[[object], Any], Json]] = {
    **FORMS,
    some_pairs: rows_of(2),
    some_numbers: {"type": "array", "items": NUMBER},
    triples: rows_of(3),
    whole: {"type": "integer"},
    truth: {"type": "boolean"},
    text: PRINTABLE,
    short_text: {**PRINTABLE, "maxLength": LONGEST_NAME},
    texts: {"type": "array", "items": PRINTABLE},
}
"""What a value of each form may be."""


def hump_schema() -> Json:
    """The schema: whatever it refuses, the reader refuses; what needs more than one element, the reader alone sees."""
    properties = {key: value for schema in ELEMENTS.values() for key, value in schema.items()}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Hump file of retarder-synth",
        "type": "object",
        "additionalProperties": False,
        "required": ["format", "version", "title", "hump"],
        "properties": {
            "format": {"const": FORMAT},
            "version": {"const": VERSION, "type": "integer"},
            "title": PRINTABLE,
            "notes": {"type": "array", "items": PRINTABLE},
            **ORIGIN,
            "for_cars": {
                "type": "object",
                "additionalProperties": False,
                "minProperties": 1,
                "properties": {
                    "categories": {"type": "array", "items": PRINTABLE, "minItems": 1},
                    "most_cars": {"type": "integer", "minimum": 1},
                },
            },
            "type": {"type": "object", "additionalProperties": type_schema(properties)},
            "hump": {
                "type": "object",
                "additionalProperties": False,
                "required": ["leads"],
                "properties": {
                    "leads": {"type": "array", "items": {"type": "integer"}, "minItems": 1},
                    "profile_from_crest": cell_schema(PROFILE),
                    **{kind: {"type": "array", "items": element_schema(kind)} for kind in ELEMENTS},
                },
            },
        },
    }


def element_schema(kind: str) -> Json:
    """A row of a kind; its number in the group of the kind."""
    schema = table_schema(ELEMENTS[kind])
    group = next(group for group in GROUPS if group.noun == kind)
    properties = {**schema["properties"], "number": {"type": "integer", "minimum": group.first, "maximum": group.last}}
    return {**schema, "properties": properties}


def type_schema(properties: Schema) -> Json:
    """A table `[type.NAME]`: keys of an element or of an edge; it names no other type itself."""
    edge = properties["left"]
    assert not isinstance(edge, Key)
    schema = table_schema({**edge, **properties})
    return {**schema, "properties": {key: value for key, value in schema["properties"].items() if key != "type"}}


def table_schema(schema: Schema) -> Json:
    """A table with some of the keys of `schema`."""
    properties = {
        key: cell_schema(value) if isinstance(value, Key) else table_schema(value) for key, value in schema.items()
    }
    found: Json = {
        "type": "object",
        "additionalProperties": False,
        "properties": {"type": PRINTABLE, **ORIGIN, **properties},
    }
    return found | {"not": {"required": list(CONTROLLERS)}} if all(key in schema for key in CONTROLLERS) else found


def cell_schema(key: Key) -> Json:
    """A value, or where it is a number, a table of it and its origin."""
    plain = CELL_FORMS[key.form]
    if key.range is not None:
        plain = {**plain, "minimum": key.range.low, "maximum": key.range.high}
    if not key.unit:
        return plain
    written = unit_schema(key.unit) if key.form in (number, number_or_pairs) else None
    if written is not None:
        plain = {"anyOf": [plain, written]}
    sourced = {
        "type": "object",
        "additionalProperties": False,
        "required": ["value"],
        "properties": {"value": plain, **ORIGIN},
    }
    return {"anyOf": [plain, sourced]}
