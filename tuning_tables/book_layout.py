"""What a book of tables consists of: its kind, its columns, and the meaning of their axes; the checksum over
everything that it says, independent of how HDF5 lays it out; and its HDF5 image, made in memory. The image needs
h5py, when called.

The checksum over everything that a book says, independent of how HDF5 lays it out in the file. It is the SHA-256 of the
canonical JSON (`json_text`) of

    {"attributes": {root attributes less payload_sha256},
     "datasets": {name: {"dtype", "shape", "units", "meaning", "sha256": of the values, C order, little endian}}}

with `dtype` as numpy writes it ("<f4", "|S12").
"""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.book_classes import category_numbers
from tuning_tables.declared.columns import (
    Column,
    Columns,
    columns_of,
    row_value,
    stacked,
    stored_sections,
    told_sections,
)
from tuning_tables.document import KINDS, StageTable, kind_of
from tuning_tables.errors import InvalidTable
from tuning_tables.json_text import canonical_json

if TYPE_CHECKING:
    import h5py

AXES: Final[Mapping[str, str]] = MappingProxyType({
    "table": "index of the table in the book",
    "stage": "pressure stage k, in a row of switching speeds the one in force",
    "power": "power of the path in m",
    "threshold": "j of the switching speed that parts stage j from stage j + 1",
    "passage": "index of the passage in the order of the path",
    "sensor": "index of the point sensor along the path",
    "zone": "index of the retarder along the path",
    "axle": "index of the axle from the front",
    "break": "index of the path break of the estimator's work",
    "end": "0: beginning or smallest, 1: end or largest",
})  # fmt: skip
"""What the axes count."""


@dataclass(frozen=True)
class Layout:
    """What a book consists of: the kind of its tables, and its columns."""

    kind: str
    columns: tuple[Column, ...]

    @property
    def axes(self) -> Mapping[str, str]:
        """The axes of the columns, and what they count."""
        used = {axis for column in self.columns for axis in column.axes}
        return {axis: meaning for axis, meaning in AXES.items() if axis in used}

    def length(self, axis: str, arrays: Columns) -> int:
        """The length of `axis` in the arrays of a book of this layout."""
        column = next(column for column in self.columns if axis in column.axes)
        return int(arrays[column.name].shape[column.axes.index(axis)])

    def arrays_of(self, tables: Sequence[StageTable]) -> dict[str, npt.NDArray[Any]]:
        """The arrays of a book of `tables`, by name.

        Raises `InvalidTable` for an id given twice, and where numbers and names of categories do not belong together
        one by one.
        """
        (name, times), *_ = Counter(table.id for table in tables).most_common(1)
        if times > 1:
            raise InvalidTable(f"{times} tables of the book have the id {name!r}, but ids must differ within a book.")
        category_numbers(tables)
        return stacked(self.columns, tables)


def book_layout(tables: Sequence[StageTable]) -> Layout:
    """The layout of a book of `tables`; `InvalidTable` for none at all, and where they are of two kinds."""
    if not tables:
        raise InvalidTable("the book has no tables, but it must have at least one.")
    first = tables[0]
    for table in tables:
        if type(table) is not type(first):
            raise InvalidTable(
                f"{first.id} is of the kind {kind_of(type(first))} and {table.id} of the kind {kind_of(type(table))}, "
                "but the tables of a book are of one kind: write two books."
            )
    return Layout(kind_of(type(first)), tuple(columns_of(type(first), told_sections(type(first), tables))))


def stored_layout(kind: str, names: Set[str]) -> Layout:
    """The layout of a book of tables of this kind that has datasets of these names."""
    return Layout(kind, tuple(columns_of(KINDS[kind], stored_sections(KINDS[kind], names))))


def stored_tables(layout: Layout, arrays: Columns) -> tuple[StageTable, ...]:
    """The tables in the arrays of a book, which must have the names, types and numbers of axes of its layout.

    Raises `InvalidTable` for values that make no table, `UnicodeDecodeError` for text that is no UTF-8.
    """
    declared = KINDS[layout.kind]
    rows = range(len(arrays["id"]))
    return tuple(row_value(declared, {name: column[row] for name, column in arrays.items()}) for row in rows)


def payload_sha256(attributes: Mapping[str, str | int], arrays: Columns, layout: Layout) -> str:
    """64 hex digits over `attributes`, which must be without payload_sha256, and all arrays of `layout`."""
    datasets = {
        column.name: {
            "dtype": arrays[column.name].dtype.str,
            "shape": list(arrays[column.name].shape),
            "units": column.unit,
            "meaning": column.meaning,
            "sha256": hashlib.sha256(np.ascontiguousarray(arrays[column.name]).tobytes()).hexdigest(),
        }
        for column in layout.columns
    }
    return hashlib.sha256(canonical_json({"attributes": dict(attributes), "datasets": datasets})).hexdigest()


FORMAT: Final = "retarder-book"
VERSION: Final = 1
# The oldest file version whose metadata carry checksums, for readers that know nothing of the seal.
FILE_VERSION: Final = ("v108", "v108")
COORDINATES: Final = ("id", "cut_category", "cut_mass_t", "target_speed_m_s")
ATTRIBUTES: Final = ("complete", "config_sha256", "exported_by", "format", "kind", "payload_sha256", "version")


def image_of(attributes: Mapping[str, str | int], arrays: Columns, layout: Layout) -> bytes:
    """The HDF5 file of a book, made in memory."""
    import h5py

    # The name stands nowhere in the file, and nothing is written to the disk.
    with h5py.File("book", "w", libver=FILE_VERSION, driver="core", backing_store=False) as file:
        for axis, meaning in layout.axes.items():
            write_axis(file, axis, layout.length(axis, arrays), meaning)
        for column in layout.columns:
            write_column(file, column, arrays[column.name])
        for name in ATTRIBUTES:
            file.attrs[name] = attributes[name]
        file.flush()
        image: bytes = file.id.get_file_image()
    return image


def write_axis(file: h5py.File, axis: str, length: int, meaning: str) -> None:
    """Write an axis: a dimension scale of its own name, numbered from 0."""
    scale = file.create_dataset(axis, data=np.arange(length, dtype="<i4"), track_times=False)
    scale.make_scale(axis)
    scale.attrs["meaning"] = meaning


def write_column(file: h5py.File, column: Column, values: npt.NDArray[Any]) -> None:
    """Write a column with its unit and meaning, in one piece and with a checksum, and attach its axes."""
    import h5py

    text = values.dtype.kind == "S"
    dtype = h5py.string_dtype("utf-8", values.dtype.itemsize) if text else values.dtype
    dataset = file.create_dataset(
        column.name, data=values.astype(dtype), chunks=values.shape, fletcher32=True, track_times=False
    )
    dataset.attrs["units"] = column.unit
    dataset.attrs["meaning"] = column.meaning
    if text:
        dataset.attrs["_Encoding"] = "utf-8"
    elif column.name not in COORDINATES:
        dataset.attrs["coordinates"] = " ".join(COORDINATES)
    for position, axis in enumerate(column.axes):
        dataset.dims[position].attach_scale(file[axis])
