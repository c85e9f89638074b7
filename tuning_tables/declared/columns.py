"""What a book holds of declared tables: an array for each leaf, with one entry a table along the first axis.

The name of an array is that of the key, its dots as "_": `cut_mass_t`. Of a member that is a tuple of sections the name
of its axis stands before: `stage_pressure_kpa`, and under the name of the member how many there are. So it is of a
section that may be None: 1 or 0. A book whose tables all have None there has no array of the section but that one.

Tables of one book may differ in the lengths of what they hold: shorter ones are filled up with NaN (float columns) or
0 (the rest), and so is what is None.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from tuning_tables.declared.members import LeafMember, SectionMember, SectionsMember, members_of
from tuning_tables.errors import InvalidTable
from tuning_tables.units import unit_of

Columns = Mapping[str, npt.NDArray[Any]]
"""The arrays of a book, by name."""
Content = Callable[[Any], Any]
"""From a table, or a row of sections, to its cells; None for a table without them."""
COUNT_DTYPE = "<i4"


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
    content: Content = field(compare=False)


def columns_of(declared: type, has_section: Callable[[str], bool]) -> Iterator[Column]:
    """The columns of tables of the class `declared`; `has_section` tells of an optional section if any table has it."""
    yield from _columns(declared, "", ("table",), has_section, lambda table: table)


def row_value(declared: type, cells: Mapping[str, Any], prefix: str = "") -> Any:
    """The value of the class `declared` in one row of the columns, whose names begin with `prefix`.

    Raises `InvalidTable` for cells that make none, `UnicodeDecodeError` for text that is no UTF-8.
    """
    given: dict[str, Any] = {}
    for name, member in members_of(declared).items():
        match member:
            case LeafMember():
                cell = cells[prefix + name]
                given[name] = None if member.is_optional and _is_absent(cell) else member.leaf.of_cells(cell)
            case SectionMember():
                there = not member.is_optional or cells[prefix + name]
                given[name] = row_value(member.section, cells, f"{prefix}{name}_") if there else None
            case SectionsMember():
                given[name] = _sections(member, cells, int(cells[prefix + name]))
    return declared(**given)


def stacked(columns: Sequence[Column], tables: Sequence[Any]) -> dict[str, npt.NDArray[Any]]:
    """The arrays of a book of `tables`, by name; an axis along which there is nothing has the length 1."""
    contents = {column.name: [column.content(table) for table in tables] for column in columns}
    lengths: dict[str, int] = {}
    for column in columns:
        axes = column.axes[1:]
        for axis, length in zip(axes, _longest(contents[column.name], len(axes)), strict=True):
            lengths[axis] = max(lengths.get(axis, 1), length)
    return {column.name: _array(column, contents[column.name], lengths) for column in columns}


def _array(column: Column, contents: Sequence[Any], lengths: Mapping[str, int]) -> npt.NDArray[Any]:
    if column.dtype == "S":
        return np.array([b"" if content is None else content for content in contents])
    filler = np.nan if column.dtype in ("<f4", "<f8") else 0
    array = np.full((len(contents), *(lengths[axis] for axis in column.axes[1:])), filler, dtype=column.dtype)
    _fill(array, contents, len(column.axes))
    return array


def told_sections(declared: type, tables: Sequence[Any]) -> Callable[[str], bool]:
    """Which optional sections any of the tables has, by the column that tells of them."""
    told = {column.name: column for column in columns_of(declared, lambda _: True)}
    there = {name for name in _optional_sections(declared, "") if any(map(told[name].content, tables))}
    return there.__contains__


def stored_sections(declared: type, names: Set[str]) -> Callable[[str], bool]:
    """Which optional sections a book with columns of these names has columns of."""
    stored = {each for each in _optional_sections(declared, "") if any(name.startswith(f"{each}_") for name in names)}
    return stored.__contains__


def _optional_sections(declared: type, prefix: str) -> Iterator[str]:
    """The names of the columns that tell whether there is an optional section."""
    for name, member in members_of(declared).items():
        if isinstance(member, SectionMember):
            if member.is_optional:
                yield prefix + name
            yield from _optional_sections(member.section, f"{prefix}{name}_")


def _columns(
    declared: type, prefix: str, axes: tuple[str, ...], has_section: Callable[[str], bool], reach: Content
) -> Iterator[Column]:
    for name, member in members_of(declared).items():
        column, content = prefix + name, _member_of(reach, name)
        match member:
            case LeafMember():
                leaf = member.leaf
                unit = leaf.unit or unit_of(name)
                cells = _each(content, leaf.cells, len(axes) - 1)
                yield Column(column, (*axes, *(leaf.axes or ())), leaf.dtype, unit, leaf.meaning, cells)
            case SectionMember():
                if member.is_optional:
                    yield Column(
                        column, axes, COUNT_DTYPE, "1", "1: there are members of it, 0: it is null", _presence(content)
                    )
                if not member.is_optional or has_section(column):
                    yield from _columns(member.section, f"{column}_", axes, has_section, content)
            case SectionsMember():
                several = member.several
                yield Column(column, axes, COUNT_DTYPE, "1", f"number of {several.meaning}", _count(content))
                yield from _columns(member.section, f"{several.axis}_", (*axes, several.axis), has_section, content)


def _member_of(reach: Content, name: str) -> Content:
    """The member `name` of what `reach` finds: of each section, where it finds several."""

    def content(table: Any) -> Any:
        found = reach(table)
        if isinstance(found, tuple):
            return [getattr(each, name) for each in found]
        return None if found is None else getattr(found, name)

    return content


def _each(content: Content, cells: Content, depth: int) -> Content:
    """The cells of what `content` finds: of each of its entries, where it lies `depth` axes below the table."""

    def found(table: Any) -> Any:
        values = content(table)
        if depth == 0:
            return None if values is None else cells(values)
        return [None if value is None else cells(value) for value in values]

    return found


def _presence(content: Content) -> Content:
    return lambda table: int(content(table) is not None)


def _count(content: Content) -> Content:
    return lambda table: len(content(table))


def _longest(contents: Sequence[Any], depth: int) -> tuple[int, ...]:
    """The greatest length of each of the `depth` axes in the contents."""
    if depth == 0:
        return ()
    rows = [content for content in contents if content is not None]
    longest = max((len(row) for row in rows), default=0)
    return longest, *_longest([item for row in rows for item in row], depth - 1)


def _fill(array: npt.NDArray[Any], contents: Sequence[Any], depth: int) -> None:
    """Put the contents, in rows of rows, to the beginnings of the rows of the array."""
    for index, content in enumerate(contents):
        if content is not None:
            if depth > 1:
                _fill(array[index], content, depth - 1)
            else:
                array[index] = content


def _is_absent(cell: Any) -> bool:
    """Whether the cell, or all of its numbers, is what fills a book up."""
    if isinstance(cell, bytes):
        return cell == b""
    return bool(np.isnan(cell).all() if np.asarray(cell).dtype.kind == "f" else np.asarray(cell == 0).all())


def _sections(member: SectionsMember, cells: Mapping[str, Any], count: int) -> tuple[Any, ...]:
    prefix = f"{member.several.axis}_"
    below = {name: cell for name, cell in cells.items() if name.startswith(prefix)}
    room = min(len(cell) for cell in below.values())
    if not 0 <= count <= room:
        raise InvalidTable(f"there are {count} {member.several.meaning}, but the book has room for {room}.")
    rows = ({name: cell[index] for name, cell in below.items()} for index in range(count))
    return tuple(row_value(member.section, row, prefix) for row in rows)
