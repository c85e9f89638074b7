"""A sorting list as CSV (RFC 4180, UTF-8) or as the first sheet of a workbook, one row a cut.

    cut,cars,axles,mass_t,category,track,length_m,rolling,lead,hump_speed_m_s,marks
    1,2,8,151.5,T,17,27.84,mean,0,1.7,
    2,1,4,23,L,3,13.92,bad,0,1.7,do-not-hump long-base

The columns up to `track` must be there, but for `category`; the others may be left out, and the order is free.
`category` is the name of a weight category (Л or L, …), without it that of mass and axles; marks are words with blanks
between. Cells may be separated by semicolons or tabs, as spreadsheets do: then numbers may have a decimal comma. A
mistake is told with row and column.
"""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from plant_models.errors import PlantError, near_miss
from plant_models.library import load_weight_categories
from plant_models.library.weight_category import WeightCategories
from synth.frame.faults import MACHINE_FAULTS, InputError
from synth.frame.sheet import first_sheet_csv
from synth.hump.control.cut_record import USUAL_CAR_M, USUAL_HUMP_SPEED_M_S, CutRecord, Mark, Rolling, SortingList
from tuning_tables.errors import DamagedTable, excerpt
from tuning_tables.whole_file import read_regular_file

NEEDED = ("cut", "cars", "axles", "mass_t", "track")
COLUMNS = (
    "cut",
    "cars",
    "axles",
    "mass_t",
    "category",
    "track",
    "length_m",
    "rolling",
    "lead",
    "hump_speed_m_s",
    "marks",
)
LARGEST_BYTES = 1_000_000
WORKBOOK = ".xlsx"
"""How the name of a list ends that is the first sheet of a workbook."""

SEPARATORS = (",", ";", "\t")
"""What may stand between cells."""


def load_sorting_list(path: str | os.PathLike[str], categories: WeightCategories | None = None) -> SortingList:
    """The list in the file at `path`; `categories`: those of the yard unless told otherwise. `InputError`."""
    file = os.fspath(path)
    try:
        content = read_regular_file(path, LARGEST_BYTES)
        text = first_sheet_csv(content, file) if file.endswith(WORKBOOK) else content.decode("utf-8")
    except FileNotFoundError:
        raise InputError(f"{file}: there is no such file; give the path of a sorting list, CSV or .xlsx") from None
    except UnicodeDecodeError as fault:
        raise InputError(f"{file}: byte {fault.start} is not UTF-8 text; save the file as UTF-8") from None
    except DamagedTable:
        raise InputError(f"{file}: it has more than {LARGEST_BYTES} bytes; a sorting list has fewer") from None
    except OSError as fault:
        if fault.errno in MACHINE_FAULTS:
            raise
        raise InputError(f"{file}: cannot be read ({fault.strerror}); check the path and its permissions") from None
    return sorting_list_of_csv(text, file, load_weight_categories() if categories is None else categories)


def sorting_list_of_csv(text: str, file: str, categories: WeightCategories) -> SortingList:
    """The list in `text`; `file` is what messages call it. `InputError`: one sentence for each row at fault."""
    separator = separator_of(text)
    rows = csv_rows(text, file, separator)
    columns = header_columns(rows[0], file)
    faults: list[str] = []
    cuts: list[CutRecord] = []
    for number, cells in enumerate(rows[1:], start=2):
        try:
            cuts.append(cut_of_row(cells, columns, Reading(categories, decimal_comma=separator != ",")))
        except ValueError as fault:
            faults.append(f"{file}: row {number}: {fault}")
    if faults:
        raise InputError(*faults[:20])
    try:
        return SortingList(tuple(cuts))
    except PlantError as fault:
        raise InputError(f"{file}: {fault}") from None


def separator_of(text: str) -> str:
    """What separates the names of the first row."""
    first = text.partition("\n")[0]
    return max(SEPARATORS, key=first.count)


def csv_rows(text: str, file: str, separator: str) -> list[list[str]]:
    """The rows of `text`, empty ones left out."""
    content = io.StringIO(text.removeprefix("\ufeff"), newline="")
    try:
        rows = [row for row in csv.reader(content, delimiter=separator, strict=True) if any(row)]
    except csv.Error as fault:
        raise InputError(f"{file}: this is not valid CSV ({fault}); correct the file") from None
    if not rows:
        raise InputError(f"{file}: it is empty; its first row must name the columns {', '.join(NEEDED)}")
    return rows


def header_columns(header: list[str], file: str) -> list[str]:
    """The names in the first row, each known and there once."""
    names = [name.strip() for name in header]
    for place, name in enumerate(names):
        if name not in COLUMNS:
            shown = excerpt(name)
            raise InputError(f"{file}: row 1: column {shown!r} is unknown; {near_miss(shown, COLUMNS)}")
        if name in names[:place]:
            raise InputError(f"{file}: row 1: column {name} is there twice; leave one out")
    if missing := [name for name in NEEDED if name not in names]:
        raise InputError(f"{file}: row 1: column {missing[0]} is missing; add it")
    return names


@dataclass(frozen=True)
class Reading:
    """How cells are read: names of `categories`, and whether a number may have a decimal comma."""

    categories: WeightCategories
    decimal_comma: bool


def cut_of_row(cells: list[str], columns: list[str], reading: Reading) -> CutRecord:
    """The cut in one row; `ValueError` tells the column and what is wrong there."""
    if len(cells) != len(columns):
        raise ValueError(f"{len(cells)} cells; the first row has {len(columns)} columns")
    given = dict(zip(columns, (cell.strip() for cell in cells), strict=True))
    values: dict[str, Any] = {}
    for column, cell in given.items():
        if cell or column in NEEDED:
            values[column] = READERS[column](column, cell, reading)
    cars, axles, mass_t = values["cars"], values["axles"], values["mass_t"]
    by_mass = reading.categories.of(mass_t, max(axles, 1)).number
    return CutRecord(
        serial=values["cut"],
        cars=cars,
        axles=axles,
        mass_t=mass_t,
        category=values.get("category", by_mass),
        track=values["track"],
        length_m=values.get("length_m", USUAL_CAR_M * cars),
        rolling=values.get("rolling", Rolling.MEAN),
        lead=values.get("lead", 0),
        hump_speed_m_s=values.get("hump_speed_m_s", USUAL_HUMP_SPEED_M_S),
        marks=values.get("marks", frozenset()),
    )


def whole_number(column: str, cell: str, _: Reading) -> int:
    """A whole number of at most nine digits."""
    if not (cell.isascii() and cell.isdigit() and len(cell) <= 9):
        raise ValueError(f"{column} is {excerpt(cell)!r}; it must be a whole number")
    return int(cell)


def decimal_number(column: str, cell: str, reading: Reading) -> float:
    """A number with a decimal point, or, where the file may have one, a comma."""
    pointed = cell.replace(",", ".") if reading.decimal_comma else cell
    try:
        return float(pointed if pointed.isascii() and "_" not in pointed else "none")
    except ValueError:
        sign = "point or comma" if reading.decimal_comma else "point"
        raise ValueError(f"{column} is {excerpt(cell)!r}; it must be a number, with a decimal {sign}") from None


def category_number(column: str, cell: str, reading: Reading) -> int:
    """The number of the category with this name."""
    try:
        return reading.categories.named(excerpt(cell)).number
    except PlantError as fault:
        raise ValueError(f"{column}: {fault}") from None


def rolling_code(column: str, cell: str, _: Reading) -> Rolling:
    """A name of `Rolling`."""
    names: Mapping[str, Rolling] = {code.name.lower(): code for code in Rolling}
    if cell not in names:
        raise ValueError(f"{column} is {excerpt(cell)!r}; it must be one of {', '.join(names)}")
    return names[cell]


def mark_set(column: str, cell: str, _: Reading) -> frozenset[Mark]:
    """Words of `Mark`."""
    known = {mark.value: mark for mark in Mark}
    for word in cell.split():
        if word not in known:
            raise ValueError(f"{column}: {excerpt(word)!r} is no mark; {near_miss(excerpt(word), known)}")
    return frozenset(known[word] for word in cell.split())


READERS: Mapping[str, Callable[[str, str, Reading], Any]] = {
    "cut": whole_number,
    "cars": whole_number,
    "axles": whole_number,
    "mass_t": decimal_number,
    "category": category_number,
    "track": whole_number,
    "length_m": decimal_number,
    "rolling": rolling_code,
    "lead": whole_number,
    "hump_speed_m_s": decimal_number,
    "marks": mark_set,
}
"""What reads the cells of a column."""
