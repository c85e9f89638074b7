"""The JSON Schema of a configuration file, for editors that check what is typed."""

from __future__ import annotations

from typing import Any, Final

from plant_models.library.written_units import unit_in_name, unit_schema
from synth.frame.settings.section import OF_LIBRARY, Section

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"


def schema_of(model: type[Section], title: str) -> dict[str, Any]:
    """The schema: keys, types, limits, units, meanings and origins, as they are declared."""
    return {"$schema": DIALECT, **with_units(model.model_json_schema()), "title": title}


def with_units(node: Any, unit: str = "") -> Any:
    """A part of a schema in which numbers may be written with a unit; `unit`: the declared one of those in it."""
    if isinstance(node, list):
        return [with_units(each, unit) for each in node]
    if not isinstance(node, dict):
        return node
    declared = node["unit"] if isinstance(node.get("unit"), str) else unit
    in_node = ((key, each, unit_in_name(key) if is_of_library(each) else declared) for key, each in node.items())
    inner = {key: with_units(each, of_it) for key, each, of_it in in_node}
    written = unit_schema(declared)
    if written is None or inner.get("type") != "number":
        return inner
    number = {key: inner.pop(key) for key in ("type", "minimum", "maximum") if key in inner}
    return {**inner, "anyOf": [number, written]}


def is_of_library(node: Any) -> bool:
    """Whether a part of a schema is that of a value of the library, whose key has its unit."""
    return isinstance(node, dict) and node.get("source") == OF_LIBRARY
