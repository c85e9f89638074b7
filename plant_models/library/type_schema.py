"""JSON Schemas of the files of types, for editors: the keys that the entries declare, and the form of each value.

Whatever a schema refuses, the reader refuses. Some types have several forms, as cars by their axles or by their bogies:
then the schema has the keys of all, and asks for those of one. What a value must be beside the others, the reader alone
sees.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any, Final

from plant_models.library.car_entry import OF_A_CAR, OF_ALL, SHARED_BOGIES, STATED_AXLES, TWO_BOGIES
from plant_models.library.data_file import FORMS, Json, Quantity, number
from plant_models.library.entry_values import ENTRY, HISTOGRAM, NORMAL, UNIFORM
from plant_models.library.hump_schema import PRINTABLE
from plant_models.library.library import (
    CAR_MIXES,
    CARS,
    POSITIONS,
    RETARDERS,
    SENSORS,
    TRACKS,
    WEIGHT_CATEGORIES,
    WHEEL_SENSORS,
    Kind,
)
from plant_models.library.position_entry import (
    FRICTION,
    NOT_STATED,
    PLACES,
    REGULATOR,
    TARGETS,
    TRACK,
    ZONES_STATED,
)
from plant_models.library.retarder_entry import FORCE_LAWS, LENGTH, drive_schema
from plant_models.library.sensor_entry import SENSOR_SCHEMA, WHEEL_SENSOR_SCHEMA
from plant_models.library.sourced_value import CONFIDENCES
from plant_models.library.track_entry import BENDS, POSITION, PROFILE, STRETCH
from plant_models.library.weight_category import (
    BRAKING_STAGES,
    BY_AXLE_LOAD,
    BY_MASS,
    ENTRANCE_STAGE,
    HIGHEST_STAGE,
    LATIN,
    OWN_NUMBERS,
)

Keys = Mapping[str, Quantity]

TITLE: Final[Json] = {"title": PRINTABLE}
NOTES: Final[Json] = {"notes": {"type": "array", "items": {"type": "string"}}}


def type_schema(kind: Kind) -> Json:
    """The schema of the files of `kind`."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **table_of(kind), "title": kind.noun}


def table_of(kind: Kind) -> Json:
    """The same without its head."""
    match kind.folder:
        case CARS.folder:
            return schema_of([TWO_BOGIES, SHARED_BOGIES, STATED_AXLES], TITLE)
        case RETARDERS.folder:
            laws = [{**LENGTH, **drive_schema(law)} for law in FORCE_LAWS]
            return schema_of(laws, {**TITLE, "law": {"enum": list(FORCE_LAWS)}}, NOTES)
        case POSITIONS.folder:
            return schema_of(forms_of_position(), {**TITLE, "retarder": PRINTABLE, "sensor": PRINTABLE}, NOTES)
        case TRACKS.folder:
            without = {**PROFILE, **POSITION, **STRETCH}
            return schema_of([without, {**without, **BENDS}], {**TITLE, "park_position": PRINTABLE}, NOTES)
        case CAR_MIXES.folder:
            cars = {"type": "object", "minProperties": 1, "additionalProperties": schema_of([OF_A_CAR])}
            return schema_of([OF_ALL], {**TITLE, "cars": cars}, NOTES)
        case WEIGHT_CATEGORIES.folder:
            return categories_schema()
        case _:
            keys = {SENSORS.folder: SENSOR_SCHEMA, WHEEL_SENSORS.folder: WHEEL_SENSOR_SCHEMA}[kind.folder]
            return schema_of([keys], TITLE)


def forms_of_position() -> list[Keys]:
    """Every way to write a position: its zones or the beginnings of them, each law of entry speeds."""
    left_out = {value.key for value in NOT_STATED}
    stated = {**TRACK, **FRICTION, **REGULATOR, **TARGETS}
    found: list[Keys] = []
    for zones, law in product((PLACES, ZONES_STATED), (UNIFORM, NORMAL, HISTOGRAM)):
        entry = {ENTRY + key: quantity for key, quantity in law.items()}
        whole = {**zones, **entry, **stated}
        found += [whole, {key: quantity for key, quantity in whole.items() if key not in left_out}]
    return found


def categories_schema() -> Json:
    """A table for each category, under its second name."""
    numbered = {"name": {**PRINTABLE, "maxLength": 40}, "number": {"type": "integer", "maximum": OWN_NUMBERS[-1]}}
    forms = [
        {**keys, **more} for keys in (BY_MASS, BY_AXLE_LOAD) for more in ({}, {ENTRANCE_STAGE: Quantity("1", number)})
    ]
    return {
        "type": "object",
        "required": [*TITLE],
        "minProperties": 2,
        "properties": {**TITLE, BRAKING_STAGES: {"type": "integer", "minimum": 1, "maximum": HIGHEST_STAGE}},
        "patternProperties": {f"^(?!(title|{BRAKING_STAGES})$){LATIN.pattern}$": schema_of(forms, numbered)},
        "additionalProperties": False,
    }


def schema_of(
    forms: Sequence[Keys], words: Mapping[str, Json] | None = None, optional: Mapping[str, Json] | None = None
) -> Json:
    """A file with all `words`, `optional` ones, and the numbers of one of the `forms`; dots in a key are tables."""
    needed = set.intersection(*(set(keys) for keys in forms))
    union = {key: quantity for keys in forms for key, quantity in keys.items()}
    found = nested({key: cell_of(quantity) for key, quantity in union.items()}, needed)
    found["properties"] = {**(words or {}), **(optional or {}), **found["properties"]}
    found["required"] = [*(words or {}), *found["required"]]
    choices = [sorted(set(keys) - needed) for keys in forms]
    if all(choices):  # else a form adds nothing to what is needed
        found["anyOf"] = [has_all(keys) for keys in choices]
    return found


def nested(cells: Mapping[str, Json], needed: set[str]) -> Json:
    """The table whose dotted keys are `cells`; a table within it is needed where one of its keys is."""
    own = {key: cell for key, cell in cells.items() if "." not in key}
    tables = dict.fromkeys(key.partition(".")[0] for key in cells if "." in key)
    properties = dict(own)
    for table in tables:
        below = {key.removeprefix(f"{table}."): cell for key, cell in cells.items() if key.startswith(f"{table}.")}
        inner = {key.removeprefix(f"{table}.") for key in needed if key.startswith(f"{table}.")}
        properties[table] = nested(below, inner)
    firsts = {key.partition(".")[0] for key in needed}
    return {
        "type": "object",
        "additionalProperties": False,
        "required": [key for key in properties if key in firsts],
        "properties": properties,
    }


def has_all(keys: Sequence[str]) -> Json:
    """A table that has all of the dotted `keys`."""
    firsts = dict.fromkeys(key.partition(".")[0] for key in keys)
    below = {
        table: has_all([key.removeprefix(f"{table}.") for key in keys if key.startswith(f"{table}.")])
        for table in firsts
        if any(key.startswith(f"{table}.") for key in keys)
    }
    return {"required": [*firsts], **({"properties": below} if below else {})}


def cell_of(quantity: Quantity) -> Json:
    """A number with its origin."""
    properties: dict[str, Any] = {
        "value": FORMS[quantity.form],
        "range": {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2},
        "source": PRINTABLE,
        "confidence": {"enum": list(CONFIDENCES)},
    }
    return {
        "type": "object",
        "description": f"Unit: {quantity.unit}",
        "additionalProperties": False,
        "required": [*properties],
        "properties": properties,
    }
