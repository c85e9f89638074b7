"""The passages of a table for point sensors, and their sensors, as sections of a JSON document, and back."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from tuning_tables.errors import InvalidTable
from tuning_tables.passages.passage_row import PassageRow, Row
from tuning_tables.passages.plausible_motion import PlausibleMotion
from tuning_tables.passages.sensor_layout import DecidesOn, SensorLayout
from tuning_tables.provenance_document import floats
from tuning_tables.section import Section

SENSOR_KEYS: Final = (
    "path_m",
    "base_m",
    "base_tolerance",
    "timer_noise_s",
    "timer_resolution_s",
    "computing_delay_s",
    "scan_period_s",
    "decides_on",
)
PASSAGE_KEYS: Final = ("sensor", "axle", "path_m", "switching_m_s")
PLAUSIBLE_KEYS: Final = (
    "speed_m_s",
    "acceleration_m_s2",
    "deceleration_m_s2",
    "speed_tolerance",
    "path_tolerance_m",
)


def sensors_document(sensors: SensorLayout) -> dict[str, object]:
    """The section "sensors"."""
    return {
        "path_m": floats(sensors.path_m),
        "base_m": float(sensors.base_m),
        "base_tolerance": float(sensors.base_tolerance),
        "timer_noise_s": float(sensors.timer_noise_s),
        "timer_resolution_s": float(sensors.timer_resolution_s),
        "computing_delay_s": float(sensors.computing_delay_s),
        "scan_period_s": float(sensors.scan_period_s),
        "decides_on": sensors.decides_on.value,
    }


def passages_document(passages: Sequence[PassageRow]) -> list[object]:
    """The section "passages"; an infinity is null."""
    return [
        {
            "sensor": passage.sensor,
            "axle": passage.axle,
            "path_m": float(passage.path_m),
            "switching_m_s": [list(map(_number_or_null, row)) for row in passage.switching_m_s],
        }
        for passage in passages
    ]


def plausible_document(plausible: PlausibleMotion) -> dict[str, object]:
    """The section "plausible"."""
    return {
        "speed_m_s": floats(plausible.speed_m_s),
        "acceleration_m_s2": float(plausible.acceleration_m_s2),
        "deceleration_m_s2": float(plausible.deceleration_m_s2),
        "speed_tolerance": float(plausible.speed_tolerance),
        "path_tolerance_m": float(plausible.path_tolerance_m),
    }


def read_sensors(top: Section) -> SensorLayout:
    """The section "sensors" of the document; raises `DamagedTable` and `InvalidTable`, as the others here."""
    section = top.section("sensors", SENSOR_KEYS)
    word = section.text("decides_on")
    known = [each.value for each in DecidesOn]
    if word not in known:
        raise InvalidTable(f"sensors.decides_on is {word!r}, but it must be one of {', '.join(known)}.")
    return SensorLayout(
        section.numbers("path_m"),
        section.number("base_m"),
        section.number("base_tolerance"),
        section.number("timer_noise_s"),
        section.number("timer_resolution_s"),
        section.number("computing_delay_s"),
        section.number("scan_period_s"),
        DecidesOn(word),
    )


def read_passages(top: Section) -> tuple[PassageRow, ...]:
    """The section "passages" of the document."""
    return tuple(
        PassageRow(
            section.count("sensor"),
            section.count("axle"),
            section.number("path_m"),
            tuple(_row(stage, speeds) for stage, speeds in enumerate(section.rows_or_nulls("switching_m_s"))),
        )
        for section in top.sections("passages", PASSAGE_KEYS)
    )


def read_plausible(top: Section) -> PlausibleMotion:
    """The section "plausible" of the document."""
    section = top.section("plausible", PLAUSIBLE_KEYS)
    return PlausibleMotion(
        section.pair("speed_m_s"),
        section.number("acceleration_m_s2"),
        section.number("deceleration_m_s2"),
        section.number("speed_tolerance"),
        section.number("path_tolerance_m"),
    )


def _number_or_null(speed: float) -> float | None:
    return None if math.isinf(speed) else float(speed)


def _row(stage: int, speeds: Sequence[float | None]) -> Row:
    """The row of `stage`: a null below it is −∞, one from it on +∞."""
    return tuple(
        (-math.inf if index < stage else math.inf) if speed is None else speed for index, speed in enumerate(speeds)
    )
