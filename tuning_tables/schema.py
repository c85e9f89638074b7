"""The JSON Schema (draft 2020-12) of a controller table, for editors and for readers in other languages.

A schema states shapes and ranges. What it cannot state, the reader checks beyond it: the checksum, the order of stages
and lines, coefficients that float32 can hold, and that no key is given twice.
"""

from __future__ import annotations

import json
import os
from typing import Any, Final

from tuning_tables.approach import INTERLOCK, LENGTH_RANGE_M
from tuning_tables.atomic_file import write_atomically
from tuning_tables.category_number import KNOWN_NUMBERS, LARGEST_OWN, LEAST_OWN
from tuning_tables.document import APPROACH_VERSION, ESTIMATOR_VERSION, FORMAT, VARIABLE, VERSION
from tuning_tables.estimator import FARTHEST_M, LARGEST_OVERPRESSURE_KPA, LARGEST_WORK, MOST_BREAKS
from tuning_tables.requirement import SHA256_HEX, UTC_INSTANT
from tuning_tables.table import HIGHEST_DEGREE, MOST_STAGES

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"


def table_schema() -> dict[str, object]:
    """A new dict with the JSON Schema of the format "retarder-table", versions 1 to 3."""
    line = {"anyOf": [{"type": "null"}, _array({"type": "number"}, 1, HIGHEST_DEGREE + 1)]}
    stage = _object(k=_whole(0, MOST_STAGES - 1), pressure_kpa=_number(0), lower=line, upper=line)
    validated = _object(passes=_whole(1), rms_m_s=_number(0), rms_ci95_m_s=_pair(_number(0)))
    predicted = _object(rms_m_s=_number(0), bias_m_s=_number(), p_overspeed=_number(0, 1), switchings=_number(0))
    predicted["properties"]["p_stall"] = _number(0, 1)
    predicted["properties"]["passes"] = _whole(1)
    cut = _object(category=_text(), mass_t=_above_zero(), axle_offsets_m=_array(_number(0), 1))
    cut["properties"]["category_number"] = _whole(1, LARGEST_OWN)
    top = _object(
        format={"const": FORMAT},
        version={"enum": [VERSION, ESTIMATOR_VERSION, APPROACH_VERSION]},
        id=_text(),
        created={"type": "string", "pattern": UTC_INSTANT},
        generator=_object(name=_text(), version=_text(), config_sha256={"type": "string", "pattern": SHA256_HEX}),
        retarder=_object(name=_text(), zones_m=_array(_pair(_number()), 1), exit_m=_number(), dead_band_kpa=_number(0)),
        cut={**cut, "oneOf": _numbered_cuts()},
        target_speed_m_s=_above_zero(),
        polynomial=_object(variable={"const": VARIABLE}, degree=_whole(0, HIGHEST_DEGREE)),
        stages=_array(stage, 2, MOST_STAGES),
        valid=_object(s_m=_pair(_number(-1e6, 1e6)), v_m_s=_pair(_number(0, 1e6))),
        predicted=predicted,
        validated={"anyOf": [{"type": "null"}, validated]},
        crc32={"type": "string", "pattern": "^[0-9a-f]{8}$"},
    )
    top["properties"]["estimator"] = _estimator()
    top["properties"]["approach"] = _object(
        length_m=_number(*LENGTH_RANGE_M), entrance_stage=_whole(0, MOST_STAGES - 1), interlock={"const": INTERLOCK}
    )
    title = f"{FORMAT} {VERSION} to {APPROACH_VERSION}"
    return {"$schema": DIALECT, "title": title, **top, "oneOf": _versions()}


def _versions() -> list[object]:
    """What must and must not be there in each version; version 3 has an estimator or none."""
    exact: dict[str, object] = {"properties": {"passes": False}}
    measured: dict[str, object] = {"estimator": False, "predicted": exact}
    either = {"anyOf": [{"required": ["estimator"]}, {"properties": measured}]}
    return [
        {"properties": {"version": {"const": VERSION}, "approach": False, **measured}},
        {"properties": {"version": {"const": ESTIMATOR_VERSION}, "approach": False}, "required": ["estimator"]},
        {"properties": {"version": {"const": APPROACH_VERSION}}, "required": ["approach"], **either},
    ]


def _numbered_cuts() -> list[object]:
    """No number is given, or that of the category of the yard, or one of a user's own category."""
    own = {"category": {"not": {"enum": list(KNOWN_NUMBERS)}}, "category_number": _whole(LEAST_OWN, LARGEST_OWN)}
    known = [
        {"category": {"const": name}, "category_number": {"const": number}} for name, number in KNOWN_NUMBERS.items()
    ]
    stated = [{"properties": each, "required": ["category_number"]} for each in (own, *known)]
    return [{"properties": {"category_number": False}}, *stated]


def _estimator() -> dict[str, dict[str, object]]:
    return _object(
        speed_noise_m_s=_number(1e-4, 10.0),
        friction_cv=_number(0, 1),
        path_std=_number(0, 1),
        correlation_length_m=_number(1e-3, 1e4),
        touch_pressure_kpa=_number(0, LARGEST_OVERPRESSURE_KPA),
        s_m=_array(_number(-FARTHEST_M, FARTHEST_M), 2, MOST_BREAKS),
        drive_m2_s2=_array(_number(-LARGEST_WORK, LARGEST_WORK), 2, MOST_BREAKS),
        brake_m2_s2_per_kpa=_array(_number(-LARGEST_WORK, LARGEST_WORK), 2, MOST_BREAKS),
    )


def write_schema(path: str | os.PathLike[str]) -> None:
    """Write the schema to the file at `path`, complete or not at all; raises `OSError`."""
    write_atomically(path, (json.dumps(table_schema(), indent=1) + "\n").encode("utf-8"))


def _object(**properties: object) -> dict[str, Any]:
    """All `properties` and no others; all are required."""
    return {
        "type": "object",
        "properties": dict(properties),
        "required": list(properties),
        "additionalProperties": False,
    }


def _array(items: object, fewest: int, most: int | None = None) -> dict[str, object]:
    bounds = {"minItems": fewest} if most is None else {"minItems": fewest, "maxItems": most}
    return {"type": "array", "items": items, **bounds}


def _pair(items: object) -> dict[str, object]:
    return _array(items, 2, 2)


def _number(smallest: float | None = None, largest: float | None = None) -> dict[str, object]:
    return _bounded("number", smallest, largest)


def _whole(smallest: int, largest: int | None = None) -> dict[str, object]:
    return _bounded("integer", smallest, largest)


def _bounded(kind: str, smallest: float | None, largest: float | None) -> dict[str, object]:
    bounds = {"minimum": smallest, "maximum": largest}
    return {"type": kind, **{key: bound for key, bound in bounds.items() if bound is not None}}


def _above_zero() -> dict[str, object]:
    return {"type": "number", "exclusiveMinimum": 0}


def _text() -> dict[str, object]:
    return {"type": "string", "minLength": 1}
