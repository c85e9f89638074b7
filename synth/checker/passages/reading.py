"""A table for point sensors read from its JSON document, as docs/table-format.md has version 4."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from synth.checker.canonical import canonical_form, crc32, parse_json, without_checksum
from synth.checker.category_number import number_of
from synth.checker.document_shape import (
    COUNT,
    NUMBER,
    NUMBERS,
    PREDICTED,
    SHAPE,
    TEXT,
    OrNull,
    Pair,
    refuse_unless,
    require_shape,
)
from synth.checker.finding import DamagedError, shown
from synth.checker.table_reading import pair, stated_figures

MARK: Final = re.compile(rb'"decisions"\s*:\s*"at_sensor_passages"')
"""No text in a JSON document can hold this: its quotes would be escaped."""

VERSION: Final = 4
SENSOR_NUMBERS: Final = (
    "base_m", "base_tolerance", "timer_noise_s", "timer_resolution_s", "computing_delay_s", "scan_period_s",
)  # fmt: skip
SHARED: Final = (
    "format", "version", "id", "created", "generator", "retarder", "cut", "target_speed_m_s", "validated", "crc32",
)  # fmt: skip
PASSAGE_SHAPE: Final[Mapping[str, Any]] = {
    **{key: SHAPE[key] for key in SHARED},
    "decisions": TEXT,
    "stages": [{"k": COUNT, "pressure_kpa": NUMBER}],
    "sensors": {
        "path_m": NUMBERS,
        **dict.fromkeys(SENSOR_NUMBERS, NUMBER),
        "decides_on": TEXT,
    },
    "approach": {"length_m": NUMBER, "entrance_stage": COUNT, "initial_stage": COUNT, "interlock": TEXT},
    "passages": [{"sensor": COUNT, "axle": COUNT, "path_m": NUMBER, "switching_m_s": [[OrNull(NUMBER)]]}],
    "plausible": {
        "speed_m_s": Pair(),
        **dict.fromkeys(("acceleration_m_s2", "deceleration_m_s2", "speed_tolerance", "path_tolerance_m"), NUMBER),
    },
    "valid": {"v_m_s": Pair()},
    "predicted": PREDICTED,
}


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
    document = parse_json(content)
    if not isinstance(document, dict) or document.get("format") != "retarder-table":
        raise DamagedError('it is no controller table: its format is not "retarder-table"')
    version = document.get("version")
    if isinstance(version, bool) or version != VERSION or not isinstance(version, int):
        raise DamagedError(f"its version is {shown(version)}, but a table that decides at passages is of version 4")
    require_shape(document, PASSAGE_SHAPE, "")
    sum_found = f"{crc32(canonical_form(without_checksum(document)).encode('utf-8')):08x}"
    if document["crc32"] != sum_found:
        raise DamagedError(f"its crc32 is {shown(document['crc32'])}, but its content gives {sum_found}")
    return passage_table_of(without_checksum(document))


def passage_table_of(document: Mapping[str, Any]) -> PassageTable:
    """The table in a document of the right shape; `DamagedError` where its parts do not fit together."""
    stages, sensors, approach = document["stages"], document["sensors"], document["approach"]
    numbers: dict[str, Any] = {key: float(sensors[key]) for key in SENSOR_NUMBERS}
    words = {"first_axle": False, "every_axle": True}
    number_of(document["cut"])
    refuse_unless(document["decisions"] == "at_sensor_passages", document["decisions"], "decisions", "as documented")
    refuse_unless(sensors["decides_on"] in words, sensors["decides_on"], "sensors.decides_on", ", ".join(words))
    refuse_unless(2 <= len(stages) <= 32, len(stages), "the number of stages", "from 2 to 32")
    for k, stage in enumerate(stages):
        refuse_unless(stage["k"] == k, stage["k"], f"stages[{k}].k", str(k))
    refuse_unless(approach["interlock"] == "position_clear", approach["interlock"], "approach.interlock", "documented")
    return PassageTable(
        id=document["id"],
        target_m_s=float(document["target_speed_m_s"]),
        pressures_kpa=tuple(float(stage["pressure_kpa"]) for stage in stages),
        sensors_m=tuple(map(float, sensors["path_m"])),
        axle_offsets_m=tuple(map(float, document["cut"]["axle_offsets_m"])),
        exit_m=float(document["retarder"]["exit_m"]),
        every_axle=words[sensors["decides_on"]],
        entrance_stage=approach["entrance_stage"],
        passages=tuple(
            passage_of(passage, len(stages), f"passages[{index}]") for index, passage in enumerate(document["passages"])
        ),
        **numbers,
        config_sha256=document["generator"]["config_sha256"],
        zones_m=tuple(map(pair, document["retarder"]["zones_m"])),
        dead_band_kpa=float(document["retarder"]["dead_band_kpa"]),
        category=document["cut"]["category"],
        mass_t=float(document["cut"]["mass_t"]),
        approach_m=float(approach["length_m"]),
        initial_stage=approach["initial_stage"],
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
