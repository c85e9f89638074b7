"""What a book consists of: arrays with one entry a table along the first axis, each with axes, type, unit and meaning.

Tables of one book may differ in the lengths of what they hold: shorter ones are filled up with NaN (float columns) or
0 (the rest).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.book_categories import OfClass, category_numbers
from tuning_tables.errors import InvalidTable

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
    content: Callable[[Any], Any]


@dataclass(frozen=True)
class Layout:
    """What a book consists of: its schema version, its columns, and the meaning of their axes."""

    version: int
    columns: tuple[Column, ...]
    axes: Mapping[str, str]

    def numbered(self) -> Layout:
        """This layout with the numbers of the categories."""
        return self.extended(self.version, (NUMBER,))

    def extended(self, version: int, columns: tuple[Column, ...]) -> Layout:
        """This layout under another schema version, with more columns of the same axes."""
        return replace(self, version=version, columns=(*self.columns, *columns))

    def length(self, axis: str, arrays: Columns) -> int:
        """The length of `axis` in the arrays of a book of this layout."""
        column = next(column for column in self.columns if axis in column.axes)
        return int(arrays[column.name].shape[column.axes.index(axis)])

    def arrays_of(self, tables: Sequence[OfClass]) -> dict[str, npt.NDArray[Any]]:
        """The arrays of a book of `tables`, by name.

        Raises `InvalidTable` for no tables at all, for an id given twice, where numbers and names of categories do not
        belong together one by one, and where a number is -0.0, which the JSON form of the same table cannot hold.
        """
        if not tables:
            raise InvalidTable("the book has no tables, but it must have at least one.")
        (name, times), *_ = Counter(table.id for table in tables).most_common(1)
        if times > 1:
            raise InvalidTable(f"{times} tables of the book have the id {name!r}, but ids must differ within a book.")
        category_numbers(tables)
        return {column.name: _stacked(column, tables) for column in self.columns}


NUMBER: Final = Column("category_number", ("table",), "<i4", "1", "number of the class in controllers, 0: not stated",
                       lambda t: t.cut.category_number or 0)  # fmt: skip
"""Only in books of which a table states the number of its category, of either version."""

ORIGIN: Final[tuple[Column, ...]] = (
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
)  # fmt: skip
"""Where a table comes from and what it is for: the first columns of every book."""

FIGURES: Final[tuple[Column, ...]] = (
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
"""What was predicted and confirmed of a table."""


def _stacked(column: Column, tables: Sequence[OfClass]) -> npt.NDArray[Any]:
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
