"""The JSON Schema (draft 2020-12) of a table for point sensors, for editors and for readers in other languages.

A schema states shapes and ranges. What it cannot state, the reader checks beyond it: the checksum, the order of stages,
passages and switching speeds, that the passages are those of sensors and axles, and what float32 can hold.
"""

from __future__ import annotations

from typing import Final

from tuning_tables.approach import INTERLOCK, LENGTH_RANGE_M
from tuning_tables.document import FORMAT, PASSAGES_VERSION
from tuning_tables.line_order import LARGEST_FLOAT32
from tuning_tables.passages.document import DECISIONS
from tuning_tables.passages.passage_row import PATH_RANGE_M
from tuning_tables.passages.passage_table import MOST_PASSAGES
from tuning_tables.passages.plausible_motion import (
    ACCELERATION_RANGE_M_S2,
    PATH_TOLERANCE_RANGE_M,
    SPEED_RANGE_M_S,
    SPEED_TOLERANCE_RANGE,
)
from tuning_tables.passages.sensor_layout import (
    BASE_RANGE_M,
    DELAY_RANGE_S,
    MOST_SENSORS,
    PLACE_RANGE_M,
    SCAN_RANGE_S,
    TIMER_RANGE_S,
    TOLERANCE_RANGE,
    DecidesOn,
)
from tuning_tables.requirement import UTC_INSTANT
from tuning_tables.schema_parts import DIALECT, above_zero, array_of, number, object_of, pair_of, text, whole
from tuning_tables.schema_sections import (
    cut_schema,
    generator_schema,
    predicted_schema,
    retarder_schema,
    validated_schema,
)
from tuning_tables.table import MOST_STAGES

HIGHEST_STAGE: Final = MOST_STAGES - 1


def passage_schema() -> dict[str, object]:
    """A new dict with the JSON Schema of the format "retarder-table", version 4."""
    top = object_of(
        format={"const": FORMAT},
        version={"const": PASSAGES_VERSION},
        decisions={"const": DECISIONS},
        id=text(),
        created={"type": "string", "pattern": UTC_INSTANT},
        generator=generator_schema(),
        retarder=retarder_schema(),
        cut=cut_schema(),
        target_speed_m_s=above_zero(),
        stages=array_of(object_of(k=whole(0, HIGHEST_STAGE), pressure_kpa=number(0)), 2, MOST_STAGES),
        sensors=_sensors(),
        approach=object_of(
            length_m=number(*LENGTH_RANGE_M),
            entrance_stage=whole(0, HIGHEST_STAGE),
            initial_stage=whole(0, HIGHEST_STAGE),
            interlock={"const": INTERLOCK},
        ),
        passages=array_of(_passage(), 1, MOST_PASSAGES),
        plausible=_plausible(),
        valid=object_of(v_m_s=pair_of(number(0))),
        predicted=predicted_schema("p_stall"),
        validated=validated_schema(),
        crc32={"type": "string", "pattern": "^[0-9a-f]{8}$"},
    )
    return {"$schema": DIALECT, "title": f"{FORMAT} {PASSAGES_VERSION}", **top}


def _sensors() -> dict[str, object]:
    return object_of(
        path_m=array_of(number(*PLACE_RANGE_M), 1, MOST_SENSORS),
        base_m=number(*BASE_RANGE_M),
        base_tolerance=number(*TOLERANCE_RANGE),
        timer_noise_s=number(*TIMER_RANGE_S),
        timer_resolution_s=number(*TIMER_RANGE_S),
        computing_delay_s=number(*DELAY_RANGE_S),
        scan_period_s=number(*SCAN_RANGE_S),
        decides_on={"enum": [each.value for each in DecidesOn]},
    )


def _passage() -> dict[str, object]:
    speed = {"anyOf": [{"type": "null"}, number(0, LARGEST_FLOAT32)]}
    return object_of(
        sensor=whole(0, MOST_SENSORS - 1),
        axle=whole(0),
        path_m=number(*PATH_RANGE_M),
        switching_m_s=array_of(array_of(speed, 1, HIGHEST_STAGE), 2, MOST_STAGES),
    )


def _plausible() -> dict[str, object]:
    return object_of(
        speed_m_s=pair_of(number(*SPEED_RANGE_M_S)),
        acceleration_m_s2=number(*ACCELERATION_RANGE_M_S2),
        deceleration_m_s2=number(*ACCELERATION_RANGE_M_S2),
        speed_tolerance=number(*SPEED_TOLERANCE_RANGE),
        path_tolerance_m=number(*PATH_TOLERANCE_RANGE_M),
    )
