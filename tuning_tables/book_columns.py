"""A book of tables with lines as columns: one array per quantity, the first axis running over the tables.

Tables of one book may differ in stages, degree, zones and axles: shorter ones are filled up with NaN (float columns) or
0 (the rest). A `Layout` states every array with its axes, type, unit and meaning, as "book.h5" holds it: `PLAIN`, or
`WITH_ESTIMATORS` where a table has one; either of them `with_approaches` where a table has one, or `at_any_time`
where a table decides so.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from typing import Any, Final

import numpy as np

from tuning_tables.book_layout import FIGURES, NUMBER, ORIGIN, Column, Layout
from tuning_tables.decisions import Decisions
from tuning_tables.table import ControllerTable

AXES: Final[Mapping[str, str]] = {
    "table": "index of the table in the book",
    "stage": "pressure stage k",
    "line": "0: lower line, 1: upper line",
    "power": "power of the path in m",
    "zone": "index of the retarder along the path",
    "axle": "index of the axle from the front",
    "end": "0: beginning or smallest, 1: end or largest",
}
ESTIMATOR_AXES: Final[Mapping[str, str]] = {"break": "index of the path break of the estimator's work"}

COLUMNS: Final[tuple[Column, ...]] = (
    *ORIGIN,
    Column("degree", ("table",), "<i4", "1", "of the lines", lambda t: t.degree),
    Column("n_stages", ("table",), "<i4", "1", "number of stages", lambda t: len(t.stages)),
    Column("pressure_kpa", ("table", "stage"), "<f8", "kPa", "gauge", lambda t: [s.pressure_kpa for s in t.stages]),
    Column("coefficients", ("table", "stage", "line", "power"), "<f4", "m/s per m^power",
           "switching lines, NaN: no line", lambda t: t.coefficients),
    Column("has_line", ("table", "stage", "line"), "|u1", "1", "1: there is a line", lambda t: t.has_line),
    Column("valid_s_m", ("table", "end"), "<f8", "m", "path range of the lines", lambda t: t.valid.s_m),
    Column("valid_v_m_s", ("table", "end"), "<f8", "m/s", "speed range of the lines", lambda t: t.valid.v_m_s),
    *FIGURES,
)  # fmt: skip


def of_estimator(name: str, absent: Any) -> Callable[[ControllerTable], Any]:
    """The content of a column: an attribute of the table's estimator, `absent` without one."""
    return lambda table: absent if table.estimator is None else getattr(table.estimator, name)


ESTIMATOR_COLUMNS: Final[tuple[Column, ...]] = (
    Column("predicted_passes", ("table",), "<i8", "1", "simulated passes that the prediction comes from, 0: exact",
           lambda t: t.predicted.passes or 0),
    Column("estimator_breaks", ("table",), "<i4", "1", "path breaks of the estimator, 0: no estimator",
           lambda t: 0 if t.estimator is None else len(t.estimator.s_m)),
    Column("estimator_speed_noise_m_s", ("table",), "<f8", "m/s", "standard deviation of a measured speed",
           of_estimator("speed_noise_m_s", np.nan)),
    Column("estimator_friction_cv", ("table",), "<f8", "1", "spread of the friction factor between cuts",
           of_estimator("friction_cv", np.nan)),
    Column("estimator_resistance_std_m_s2", ("table",), "<f8", "m/s2", "spread of the deceleration by resistance",
           of_estimator("resistance_std_m_s2", np.nan)),
    Column("estimator_path_std", ("table",), "<f8", "1", "spread of the friction along the path",
           of_estimator("path_std", np.nan)),
    Column("estimator_correlation_length_m", ("table",), "<f8", "m", "its correlation length",
           of_estimator("correlation_length_m", np.nan)),
    Column("estimator_frozen_readings", ("table",), "<i4", "1", "repetitions of a reading of a frozen sensor",
           of_estimator("frozen_readings", 0)),
    Column("estimator_doubted_readings", ("table",), "<i4", "1", "doubted readings after which it begins anew",
           of_estimator("doubted_readings", 0)),
    Column("estimator_lost_speed_std_m_s", ("table",), "<f8", "m/s", "beyond it the cut is lost",
           of_estimator("lost_speed_std_m_s", np.nan)),
    Column("estimator_unlikely_deviation", ("table",), "<f8", "1", "of the friction factor, not of the category",
           of_estimator("unlikely_deviation", np.nan)),
    Column("estimator_touch_pressure_kpa", ("table",), "<f8", "kPa", "overpressure counts from here",
           of_estimator("touch_pressure_kpa", np.nan)),
    Column("estimator_s_m", ("table", "break"), "<f8", "m", "path breaks", of_estimator("s_m", ())),
    Column("estimator_drive_m2_s2", ("table", "break"), "<f8", "m2/s2", "work of grade and resistance from s = 0",
           of_estimator("drive_m2_s2", ())),
    Column("estimator_brake_m2_s2_per_kpa", ("table", "break"), "<f8", "m2/s2 per kPa", "work of the brake",
           of_estimator("brake_m2_s2_per_kpa", ())),
)  # fmt: skip


APPROACH_COLUMNS: Final[tuple[Column, ...]] = (
    Column("approach_length_m", ("table",), "<f8", "m", "path before the entrance with regulation, NaN: no approach",
           lambda t: np.nan if t.approach is None else t.approach.length_m),
    Column("approach_entrance_stage", ("table",), "<i4", "1", "highest stage before the entrance, -1: no approach",
           lambda t: -1 if t.approach is None else t.approach.entrance_stage),
)  # fmt: skip

ANY_TIME_COLUMNS: Final[tuple[Column, ...]] = (
    Column("at_any_time", ("table",), "|u1", "1", "1: decides at every sample, 0: only when the pressure is reached",
           lambda t: t.decisions is Decisions.AT_ANY_TIME),
    Column("has_gauge", ("table",), "|u1", "1", "1: the lines depend on the pressure", lambda t: t.has_gauge),
    Column("slopes", ("table", "stage", "line"), "<f4", "m/s per kPa",
           "of the lines over the pressure less that of the stage, 0: none", lambda t: t.slopes),
)  # fmt: skip

APPROACH_VERSION: Final = 3
ANY_TIME_VERSION: Final = 5
"""Of books in which a table decides at any time; they have approaches."""


PLAIN: Final = Layout(1, COLUMNS, AXES)
WITH_ESTIMATORS: Final = Layout(2, COLUMNS + ESTIMATOR_COLUMNS, {**AXES, **ESTIMATOR_AXES})
VERSIONS: Final = (PLAIN.version, WITH_ESTIMATORS.version, APPROACH_VERSION, ANY_TIME_VERSION)


def with_approaches(layout: Layout) -> Layout:
    """The layout with approaches."""
    return layout.extended(APPROACH_VERSION, APPROACH_COLUMNS)


def at_any_time(layout: Layout) -> Layout:
    """The layout with approaches, times of decision and slopes."""
    return with_approaches(layout).extended(ANY_TIME_VERSION, ANY_TIME_COLUMNS)


def layout_of(tables: Sequence[ControllerTable]) -> Layout:
    """The oldest layout that can hold the tables."""
    layout = WITH_ESTIMATORS if any(table.estimator is not None for table in tables) else PLAIN
    if any(table.decisions is Decisions.AT_ANY_TIME for table in tables):
        layout = at_any_time(layout)
    elif any(table.approach is not None for table in tables):
        layout = with_approaches(layout)
    return layout.numbered() if any(table.cut.category_number is not None for table in tables) else layout


def layout_stored(version: int, names: Set[str]) -> Layout:
    """The layout of a book of this schema version, one of `VERSIONS`, that has datasets of these names.

    From version 3 on books have the columns of estimators or not; where those of numbers are, they belong to it.
    """
    approaching, deciding = version == APPROACH_VERSION, version == ANY_TIME_VERSION
    estimating = version == WITH_ESTIMATORS.version
    if approaching or deciding:
        estimating = not names.isdisjoint(column.name for column in ESTIMATOR_COLUMNS)
    layout = WITH_ESTIMATORS if estimating else PLAIN
    if deciding:
        layout = at_any_time(layout)
    elif approaching:
        layout = with_approaches(layout)
    return layout.numbered() if NUMBER.name in names else layout
