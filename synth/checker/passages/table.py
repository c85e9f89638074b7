"""A table for point sensors read from its JSON document, the decision at a passage by the checker's own count, and
how far a cut can have rolled between two passages.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import Any, Final

from synth.checker.document_shape import (
    APPROACH,
    CHECKSUM,
    COUNT,
    FIGURES,
    NUMBER,
    ORIGIN,
    PURPOSE,
    OneOf,
    OrNull,
    Pair,
    Row,
    checked_document,
    number_of,
    refuse_unless,
)
from synth.checker.float32 import rounded
from synth.checker.table_reading import pair, stated_figures

PASSAGES: Final = "passages"
FIRST_AXLE, EVERY_AXLE = "first_axle", "every_axle"
SENSOR_NUMBERS: Final = (
    "base_m", "base_tolerance", "timer_noise_s", "timer_resolution_s", "computing_delay_s", "scan_period_s",
)  # fmt: skip
PASSAGES_SHAPE: Final[Mapping[str, Any]] = {
    **ORIGIN,
    **PURPOSE,
    "pressure_kpa": Row("stage", NUMBER),
    "sensors": {
        "path_m": Row("sensor", NUMBER),
        **dict.fromkeys(SENSOR_NUMBERS, NUMBER),
        "decides_on": OneOf((FIRST_AXLE, EVERY_AXLE)),
    },
    "approach": APPROACH,
    "initial_stage": COUNT,
    "passages": Row(
        "passage",
        {
            "sensor": COUNT,
            "axle": COUNT,
            "path_m": NUMBER,
            "switching_m_s": Row("stage", Row("threshold", OrNull(NUMBER), single=True)),
        },
    ),
    "plausible": {
        "speed_m_s": Pair(),
        **dict.fromkeys(("acceleration_m_s2", "deceleration_m_s2", "speed_tolerance", "path_tolerance_m"), NUMBER),
    },
    "valid_v_m_s": Pair(),
    **FIGURES,
    **CHECKSUM,
}
"""Of tables for point sensors."""


@dataclass(frozen=True)
class Passage:
    """Axle over sensor, both from 0, at a path of the first axle; for each stage in force the row of its speeds.

    A null is −∞ below the stage in force and +∞ from it on.
    """

    sensor: int
    axle: int
    path_m: float
    rows: tuple[tuple[float, ...], ...]


@dataclass(frozen=True)
class PassageTable:
    """A table as the controller must understand it, and the document that it was read from (less its checksum)."""

    id: str
    target_m_s: float
    pressures_kpa: tuple[float, ...]
    sensors_m: tuple[float, ...]
    axle_offsets_m: tuple[float, ...]
    exit_m: float
    every_axle: bool
    entrance_stage: int
    passages: tuple[Passage, ...]
    base_m: float
    base_tolerance: float
    timer_noise_s: float
    timer_resolution_s: float
    computing_delay_s: float
    scan_period_s: float
    config_sha256: str
    zones_m: tuple[tuple[float, float], ...]
    dead_band_kpa: float
    category: str
    category_number: int | None
    mass_t: float
    approach_m: float
    initial_stage: int
    predicted_rms_m_s: float
    bias_m_s: float
    p_overspeed: float
    switchings: float
    p_stall: float | None
    predicted_passes: int | None
    passes: int | None
    validated_rms_m_s: float | None
    validated_ci95_m_s: tuple[float, float] | None
    document: Mapping[str, Any]


def read_passage_table(content: bytes) -> PassageTable:
    """The table in the JSON text `content`; `DamagedError` for whatever is not one, a wrong checksum among it."""
    return passage_table_of(checked_document(content, PASSAGES, PASSAGES_SHAPE))


def passage_table_of(document: Mapping[str, Any]) -> PassageTable:
    """The table in a document of the right shape; `DamagedError` where its parts do not fit together."""
    pressures, sensors, approach = document["pressure_kpa"], document["sensors"], document["approach"]
    numbers: dict[str, Any] = {key: float(sensors[key]) for key in SENSOR_NUMBERS}
    stages = len(pressures)
    refuse_unless(2 <= stages <= 32, stages, "the number of stages", "from 2 to 32")
    refuse_unless(document["predicted"]["passes"] is None, document["predicted"], "predicted.passes", "null")
    return PassageTable(
        id=document["id"],
        target_m_s=float(document["target_speed_m_s"]),
        pressures_kpa=tuple(map(float, pressures)),
        sensors_m=tuple(map(float, sensors["path_m"])),
        axle_offsets_m=tuple(map(float, document["cut"]["axle_offsets_m"])),
        exit_m=float(document["retarder"]["exit_m"]),
        every_axle=sensors["decides_on"] == EVERY_AXLE,
        entrance_stage=approach["entrance_stage"],
        passages=tuple(
            passage_of(passage, stages, f"passages[{index}]") for index, passage in enumerate(document["passages"])
        ),
        **numbers,
        config_sha256=document["generator"]["config_sha256"],
        zones_m=tuple(map(pair, document["retarder"]["zones_m"])),
        dead_band_kpa=float(document["retarder"]["dead_band_kpa"]),
        category=document["cut"]["category"],
        category_number=number_of(document["cut"]),
        mass_t=float(document["cut"]["mass_t"]),
        approach_m=float(approach["length_m"]),
        initial_stage=document["initial_stage"],
        **stated_figures(document),
        document=document,
    )


def passage_of(passage: Mapping[str, Any], stages: int, path: str) -> Passage:
    """One passage, its nulls as infinities; `DamagedError` unless it has a row of K speeds for every stage."""
    rows = passage["switching_m_s"]
    refuse_unless(len(rows) == stages, len(rows), f"the number of rows of {path}", str(stages))
    for k, row in enumerate(rows):
        refuse_unless(len(row) == stages - 1, len(row), f"the length of row {k} of {path}", str(stages - 1))
    return Passage(
        passage["sensor"],
        passage["axle"],
        float(passage["path_m"]),
        tuple(
            tuple((-math.inf if j < k else math.inf) if speed is None else float(speed) for j, speed in enumerate(row))
            for k, row in enumerate(rows)
        ),
    )


LARGEST: Final = float.fromhex("0x1.fffffep+127")


def wanted(table: PassageTable, passage: int, stage: int, v_m_s: float) -> int:
    """The stage wanted at `passage` with `stage` in force, by counting the switching speeds on either side of v."""
    highest = len(table.pressures_kpa) - 1
    if not 0 <= passage < len(table.passages) or not 0 <= stage <= highest:
        return stage
    if not (math.isfinite(v_m_s) and 0.0 <= v_m_s <= LARGEST):
        return stage
    here = table.passages[passage]
    if here.path_m < 0.0:
        highest = max(stage, min(highest, table.entrance_stage))
    v, row = rounded(v_m_s), here.rows[stage]
    raised = leading(speed < v for speed in row[stage:highest])
    if raised:
        return stage + raised
    return stage - leading(speed > v for speed in reversed(row[:stage]))


def leading(answers: Iterable[bool]) -> int:
    """How many of the answers are true before the first that is not."""
    return sum(1 for _ in takewhile(bool, answers))


def passages_heard(sensors_m: Sequence[float], axles_m: Sequence[float]) -> list[tuple[float, int, int]]:
    """(path, sensor, axle) of every axle over every sensor, in the order of the path, then of the sensors."""
    return sorted(
        (place + offset, sensor, axle) for sensor, place in enumerate(sensors_m) for axle, offset in enumerate(axles_m)
    )
