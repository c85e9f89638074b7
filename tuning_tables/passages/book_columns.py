"""A book of tables for point sensors as columns: one array per quantity, the first axis running over the tables.

Tables of one book may differ in stages, zones, axles, sensors and passages: shorter ones are filled up with NaN (float
columns) or 0 (the rest). An infinite switching speed stands as such.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from typing import Any, Final

from tuning_tables.book_layout import FIGURES, NUMBER, ORIGIN, Column, Layout
from tuning_tables.passages.passage_table import PassageTable

PASSAGES_SCHEMA: Final = 4

AXES: Final[Mapping[str, str]] = {
    "table": "index of the table in the book",
    "stage": "pressure stage k, in a row of switching speeds the one in force",
    "threshold": "j of the switching speed that parts stage j from stage j + 1",
    "passage": "index of the passage in the order of the path",
    "sensor": "index of the point sensor along the path",
    "zone": "index of the retarder along the path",
    "axle": "index of the axle from the front",
    "end": "0: beginning or smallest, 1: end or largest",
}


def _each(name: str) -> Callable[[PassageTable], Any]:
    """The content of a column: an attribute of every passage."""
    return lambda table: [getattr(row, name) for row in table.passages]


COLUMNS: Final[tuple[Column, ...]] = (
    *ORIGIN,
    Column("n_stages", ("table",), "<i4", "1", "number of stages", lambda t: len(t.pressure_kpa)),
    Column("pressure_kpa", ("table", "stage"), "<f8", "kPa", "gauge", lambda t: t.pressure_kpa),
    Column("sensor_path_m", ("table", "sensor"), "<f8", "m", "middle of the base of each sensor",
           lambda t: t.sensors.path_m),
    Column("sensor_base_m", ("table",), "<f8", "m", "distance of the coils", lambda t: t.sensors.base_m),
    Column("sensor_base_tolerance", ("table",), "<f8", "1", "standard deviation of its relative error",
           lambda t: t.sensors.base_tolerance),
    Column("sensor_timer_noise_s", ("table",), "<f8", "s", "standard deviation of a measured time",
           lambda t: t.sensors.timer_noise_s),
    Column("sensor_timer_resolution_s", ("table",), "<f8", "s", "times are whole multiples of it, 0: not rounded",
           lambda t: t.sensors.timer_resolution_s),
    Column("sensor_computing_delay_s", ("table",), "<f8", "s", "from the second pulse to the command",
           lambda t: t.sensors.computing_delay_s),
    Column("sensor_scan_period_s", ("table",), "<f8", "s", "step of the clock that changes of stage are counted in",
           lambda t: t.sensors.scan_period_s),
    Column("sensor_decides_on", ("table",), "S", "1", "first_axle or every_axle", lambda t: t.sensors.decides_on.value),
    Column("approach_length_m", ("table",), "<f8", "m", "path before the entrance with regulation",
           lambda t: t.approach.length_m),
    Column("approach_entrance_stage", ("table",), "<i4", "1", "highest stage before the entrance",
           lambda t: t.approach.entrance_stage),
    Column("approach_initial_stage", ("table",), "<i4", "1", "at rest when a cut is taken over",
           lambda t: t.initial_stage),
    Column("n_passages", ("table",), "<i4", "1", "number of passages", lambda t: len(t.passages)),
    Column("passage_sensor", ("table", "passage"), "<i4", "1", "index of its sensor", _each("sensor")),
    Column("passage_axle", ("table", "passage"), "<i4", "1", "index of its axle", _each("axle")),
    Column("passage_path_m", ("table", "passage"), "<f8", "m", "path of the first axle", _each("path_m")),
    Column("switching_m_s", ("table", "passage", "stage", "threshold"), "<f4", "m/s",
           "switching speeds, -inf: never lower so far, inf: never raise so far", lambda t: t.switching_m_s),
    Column("plausible_speed_m_s", ("table", "end"), "<f8", "m/s", "speeds that are believed",
           lambda t: t.plausible.speed_m_s),
    Column("plausible_acceleration_m_s2", ("table",), "<f8", "m/s2", "greatest of a cut",
           lambda t: t.plausible.acceleration_m_s2),
    Column("plausible_deceleration_m_s2", ("table",), "<f8", "m/s2", "greatest of a cut",
           lambda t: t.plausible.deceleration_m_s2),
    Column("plausible_speed_tolerance", ("table",), "<f8", "1", "relative error allowed of a speed",
           lambda t: t.plausible.speed_tolerance),
    Column("plausible_path_tolerance_m", ("table",), "<f8", "m", "error allowed of a path",
           lambda t: t.plausible.path_tolerance_m),
    Column("valid_v_m_s", ("table", "end"), "<f8", "m/s", "speed range of the switching speeds",
           lambda t: t.valid_v_m_s),
    *FIGURES,
)  # fmt: skip

LAYOUT: Final = Layout(PASSAGES_SCHEMA, COLUMNS, AXES)


def passage_layout_of(tables: Sequence[PassageTable]) -> Layout:
    """The layout of a book of the tables."""
    numbered = any(table.cut.category_number is not None for table in tables)
    return LAYOUT.numbered() if numbered else LAYOUT


def passage_layout_stored(names: Set[str]) -> Layout:
    """The layout of a book of this schema version that has datasets of these names."""
    return LAYOUT.numbered() if NUMBER.name in names else LAYOUT
