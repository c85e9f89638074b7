"""A book of tables as columns: one array per quantity, the first axis running over the tables.

Tables of one book may differ in stages, degree, zones and axles: shorter ones are filled up with NaN (float columns) or
0 (the rest). A `Layout` states every array with its axes, type, unit and meaning, as "book.h5" holds it: `PLAIN`, or
`WITH_ESTIMATORS` where a table has one; either of them `with_approaches` where a table has one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.book_categories import category_numbers
from tuning_tables.errors import InvalidTable
from tuning_tables.table import ControllerTable

Columns = Mapping[str, npt.NDArray[Any]]


@dataclass(frozen=True)
class Column:
    """One array of a book.

    `dtype`: a numpy type, "S" for UTF-8 text of the length needed. `unit`: "1" for plain numbers and text. `content`:
    the value of one table, at most as long as the axes after the first.
    """

    name: str
    axes: tuple[str, ...]
    dtype: str
    unit: str
    meaning: str
    content: Callable[[ControllerTable], Any]


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
    Column("id", ("table",), "S", "1", "name of the table", lambda t: t.id),
    Column("created", ("table",), "S", "1", "instant of creation, UTC", lambda t: t.created),
    Column("generator_name", ("table",), "S", "1", "program that made the table", lambda t: t.generator.name),
    Column("generator_version", ("table",), "S", "1", "its version", lambda t: t.generator.version),
    Column("config_sha256", ("table",), "S", "1", "its configuration", lambda t: t.generator.config_sha256),
    Column("retarder", ("table",), "S", "1", "retarder position", lambda t: t.retarder.name),
    Column("zones_m", ("table", "zone", "end"), "<f8", "m", "retarder zones", lambda t: t.retarder.zones_m),
    Column("exit_m", ("table",), "<f8", "m", "path at the end of the pass", lambda t: t.retarder.exit_m),
    Column("dead_band_kpa", ("table",), "<f8", "kPa", "of the pressure", lambda t: t.retarder.dead_band_kpa),
    Column("category", ("table",), "S", "1", "class of cuts", lambda t: t.cut.category),
    Column("mass_t", ("table",), "<f8", "t", "mass of the cut", lambda t: t.cut.mass_t),
    Column("axle_offsets_m", ("table", "axle"), "<f8", "m", "from the first axle", lambda t: t.cut.axle_offsets_m),
    Column("target_speed_m_s", ("table",), "<f8", "m/s", "exit speed aimed at", lambda t: t.target_speed_m_s),
    Column("degree", ("table",), "<i4", "1", "of the lines", lambda t: t.degree),
    Column("n_stages", ("table",), "<i4", "1", "number of stages", lambda t: len(t.stages)),
    Column("pressure_kpa", ("table", "stage"), "<f8", "kPa", "gauge", lambda t: [s.pressure_kpa for s in t.stages]),
    Column("coefficients", ("table", "stage", "line", "power"), "<f4", "m/s per m^power",
           "switching lines, NaN: no line", lambda t: t.coefficients),
    Column("has_line", ("table", "stage", "line"), "|u1", "1", "1: there is a line", lambda t: t.has_line),
    Column("valid_s_m", ("table", "end"), "<f8", "m", "path range of the lines", lambda t: t.valid.s_m),
    Column("valid_v_m_s", ("table", "end"), "<f8", "m/s", "speed range of the lines", lambda t: t.valid.v_m_s),
    Column("predicted_rms_m_s", ("table",), "<f8", "m/s", "exit speed error", lambda t: t.predicted.rms_m_s),
    Column("predicted_bias_m_s", ("table",), "<f8", "m/s", "mean of the error", lambda t: t.predicted.bias_m_s),
    Column("predicted_p_overspeed", ("table",), "<f8", "1", "probability", lambda t: t.predicted.p_overspeed),
    Column("predicted_switchings", ("table",), "<f8", "1", "per pass", lambda t: t.predicted.switchings),
    Column("predicted_p_stall", ("table",), "<f8", "1", "probability, NaN: not computed",
           lambda t: np.nan if t.predicted.p_stall is None else t.predicted.p_stall),
    Column("validated_passes", ("table",), "<i8", "1", "simulated passes, 0: not validated",
           lambda t: 0 if t.validated is None else t.validated.passes),
    Column("validated_rms_m_s", ("table",), "<f8", "m/s", "exit speed error, simulated",
           lambda t: np.nan if t.validated is None else t.validated.rms_m_s),
    Column("validated_rms_ci95_m_s", ("table", "end"), "<f8", "m/s", "95 % interval of it",
           lambda t: (np.nan, np.nan) if t.validated is None else t.validated.rms_ci95_m_s),
)  # fmt: skip


NUMBER: Final = Column("category_number", ("table",), "<i4", "1", "number of the class in controllers, 0: not stated",
                       lambda t: t.cut.category_number or 0)  # fmt: skip
"""Only in books of which a table states the number of its category, of either version."""


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
    Column("estimator_path_std", ("table",), "<f8", "1", "spread of the friction along the path",
           of_estimator("path_std", np.nan)),
    Column("estimator_correlation_length_m", ("table",), "<f8", "m", "its correlation length",
           of_estimator("correlation_length_m", np.nan)),
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

APPROACH_VERSION: Final = 3


@dataclass(frozen=True)
class Layout:
    """What a book consists of: its schema version, its columns, and the meaning of their axes."""

    version: int
    columns: tuple[Column, ...]
    axes: Mapping[str, str]

    def numbered(self) -> Layout:
        """This layout with the numbers of the categories."""
        return replace(self, columns=(*self.columns, NUMBER))

    def with_approaches(self) -> Layout:
        """This layout with approaches."""
        return replace(self, version=APPROACH_VERSION, columns=(*self.columns, *APPROACH_COLUMNS))

    def length(self, axis: str, arrays: Columns) -> int:
        """The length of `axis` in the arrays of a book of this layout."""
        column = next(column for column in self.columns if axis in column.axes)
        return int(arrays[column.name].shape[column.axes.index(axis)])


PLAIN: Final = Layout(1, COLUMNS, AXES)
WITH_ESTIMATORS: Final = Layout(2, COLUMNS + ESTIMATOR_COLUMNS, {**AXES, **ESTIMATOR_AXES})
VERSIONS: Final = (PLAIN.version, WITH_ESTIMATORS.version, APPROACH_VERSION)


def layout_of(tables: Sequence[ControllerTable]) -> Layout:
    """The oldest layout that can hold the tables."""
    layout = WITH_ESTIMATORS if any(table.estimator is not None for table in tables) else PLAIN
    layout = layout.with_approaches() if any(table.approach is not None for table in tables) else layout
    return layout.numbered() if any(table.cut.category_number is not None for table in tables) else layout


def layout_stored(version: int, names: Set[str]) -> Layout:
    """The layout of a book of this schema version, one of `VERSIONS`, that has datasets of these names.

    Only books with approaches have the columns of estimators or not; where those of numbers are, they belong to it.
    """
    estimating = version == WITH_ESTIMATORS.version
    if version == APPROACH_VERSION:
        estimating = not names.isdisjoint(column.name for column in ESTIMATOR_COLUMNS)
    layout = WITH_ESTIMATORS if estimating else PLAIN
    layout = layout.with_approaches() if version == APPROACH_VERSION else layout
    return layout.numbered() if NUMBER.name in names else layout


def columns_of(tables: Sequence[ControllerTable]) -> dict[str, npt.NDArray[Any]]:
    """The arrays of a book, by name.

    Raises `InvalidTable` for no tables at all, for an id given twice, where numbers and names of categories do not
    belong together one by one, and where a number is -0.0, which the JSON form of the same table cannot hold.
    """
    if not tables:
        raise InvalidTable("the book has no tables, but it must have at least one.")
    (name, times), *_ = Counter(table.id for table in tables).most_common(1)
    if times > 1:
        raise InvalidTable(f"{times} tables of the book have the id {name!r}, but ids must differ within a book.")
    category_numbers(tables)
    return {column.name: _stacked(column, tables) for column in layout_of(tables).columns}


def _stacked(column: Column, tables: Sequence[ControllerTable]) -> npt.NDArray[Any]:
    if column.dtype == "S":
        return np.array([column.content(table).encode("utf-8") for table in tables])
    contents = [np.asarray(column.content(table), dtype=column.dtype) for table in tables]
    longest = tuple(max(sizes) for sizes in zip(*(content.shape for content in contents), strict=True))
    filler = np.nan if column.dtype in ("<f4", "<f8") else 0
    stacked = np.full((len(tables), *longest), filler, dtype=column.dtype)
    for index, content in enumerate(contents):
        region: tuple[slice, ...] = tuple(map(slice, content.shape))
        stacked[index, ...][region] = content  # the dots keep a view even of a single number
    return stacked
