"""The JSON Schema (draft 2020-12) of a controller table, for editors and for readers in other languages.

A schema states shapes and ranges. What it cannot state, the reader checks beyond it: the checksum, the order of stages
and lines, coefficients that float32 can hold, and that no key is given twice.
"""

from __future__ import annotations

from typing import Final

from tuning_tables.approach import INTERLOCK, LENGTH_RANGE_M
from tuning_tables.decisions import Decisions
from tuning_tables.document import (
    APPROACH_VERSION,
    ESTIMATOR_VERSION,
    FORMAT,
    GAUGE,
    SURFACES_VERSION,
    VARIABLE,
    VERSION,
)
from tuning_tables.estimator import FARTHEST_M, LARGEST_WORK, MOST_BREAKS, MOST_READINGS
from tuning_tables.programs.observe import LARGEST_OVERPRESSURE_KPA
from tuning_tables.requirement import UTC_INSTANT
from tuning_tables.schema_parts import DIALECT, above_zero, array_of, number, object_of, pair_of, text, whole
from tuning_tables.schema_sections import (
    cut_schema,
    generator_schema,
    predicted_schema,
    retarder_schema,
    validated_schema,
)
from tuning_tables.stage import SIDES
from tuning_tables.table import HIGHEST_DEGREE, MOST_STAGES

_SLOPES: Final = [f"{side}_slope_m_s_per_kpa" for side in SIDES]


def table_schema() -> dict[str, object]:
    """A new dict with the JSON Schema of the format "retarder-table", versions 1 to 3 and 5."""
    line = {"anyOf": [{"type": "null"}, array_of({"type": "number"}, 1, HIGHEST_DEGREE + 1)]}
    stage = object_of(k=whole(0, MOST_STAGES - 1), pressure_kpa=number(0), lower=line, upper=line)
    stage["properties"] |= {key: {"type": ["number", "null"]} for key in _SLOPES}
    top = object_of(
        format={"const": FORMAT},
        version={"enum": [VERSION, ESTIMATOR_VERSION, APPROACH_VERSION, SURFACES_VERSION]},
        id=text(),
        created={"type": "string", "pattern": UTC_INSTANT},
        generator=generator_schema(),
        retarder=retarder_schema(),
        cut=cut_schema(),
        target_speed_m_s=above_zero(),
        polynomial=object_of(variable={"const": VARIABLE}, degree=whole(0, HIGHEST_DEGREE)),
        stages=array_of(stage, 2, MOST_STAGES),
        valid=object_of(s_m=pair_of(number(-1e6, 1e6)), v_m_s=pair_of(number(0, 1e6))),
        predicted=predicted_schema("p_stall", "passes"),
        validated=validated_schema(),
        crc32={"type": "string", "pattern": "^[0-9a-f]{8}$"},
    )
    top["properties"]["estimator"] = _estimator()
    top["properties"]["approach"] = object_of(
        length_m=number(*LENGTH_RANGE_M), entrance_stage=whole(0, MOST_STAGES - 1), interlock={"const": INTERLOCK}
    )
    top["properties"] |= {"decisions": {"const": Decisions.AT_ANY_TIME.value}, "pressure": {"enum": list(GAUGE)}}
    title = f"{FORMAT} {VERSION} to {APPROACH_VERSION} and {SURFACES_VERSION}"
    return {"$schema": DIALECT, "title": title, **top, "oneOf": _versions()}


def _versions() -> list[object]:
    """What must and must not be there in each version; version 3 has an estimator or none, and version 5."""
    exact: dict[str, object] = {"properties": {"passes": False}}
    measured: dict[str, object] = {"estimator": False, "predicted": exact}
    either: dict[str, object] = {"anyOf": [{"required": ["estimator"]}, {"properties": measured}]}
    lines: dict[str, object] = {"decisions": False, "pressure": False, "stages": _stages_with_slopes(False)}
    return [
        {"properties": {"version": {"const": VERSION}, "approach": False} | measured | lines},
        {
            "properties": {"version": {"const": ESTIMATOR_VERSION}, "approach": False, **lines},
            "required": ["estimator"],
        },
        {"properties": {"version": {"const": APPROACH_VERSION}, **lines}, "required": ["approach"], **either},
        *(_version_at_any_time(word, either) for word in GAUGE),
    ]


def _version_at_any_time(pressure: str, either: dict[str, object]) -> dict[str, object]:
    """Version 5 of a table whose "pressure" is so."""
    said = {"version": {"const": SURFACES_VERSION}, "pressure": {"const": pressure}}
    stages = {"stages": _stages_with_slopes(GAUGE[pressure])}
    return {"properties": said | stages, "required": ["decisions", "pressure"], **either}


def _stages_with_slopes(sloped: bool) -> dict[str, object]:
    """Every stage has the keys of both slopes, or none of them."""
    if sloped:
        return {"items": {"required": _SLOPES}}
    return {"items": {"properties": dict.fromkeys(_SLOPES, False)}}


def _estimator() -> dict[str, dict[str, object]]:
    return object_of(
        speed_noise_m_s=number(1e-4, 10.0),
        friction_cv=number(0, 1),
        resistance_std_m_s2=number(0, 1),
        path_std=number(0, 1),
        correlation_length_m=number(1e-3, 1e4),
        frozen_readings=whole(1, MOST_READINGS),
        doubted_readings=whole(1, MOST_READINGS),
        lost_speed_std_m_s=number(1e-3, 10),
        unlikely_deviation=number(0, 10),
        touch_pressure_kpa=number(0, float(LARGEST_OVERPRESSURE_KPA)),
        s_m=array_of(number(-FARTHEST_M, FARTHEST_M), 2, MOST_BREAKS),
        drive_m2_s2=array_of(number(-LARGEST_WORK, LARGEST_WORK), 2, MOST_BREAKS),
        brake_m2_s2_per_kpa=array_of(number(-LARGEST_WORK, LARGEST_WORK), 2, MOST_BREAKS),
    )
