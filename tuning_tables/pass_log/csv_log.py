"""Measured passes as CSV: one long table under a header line, one row a sample.

numpy parses whole blocks of lines. Only where it gives up, each line is gone through by itself, to name the fault.
A decimal comma is read as a point in all rows, texts too. Rows of empty cells at the end, as of spreadsheets, are none.
"""

from __future__ import annotations

import codecs
import csv
import io
import os
import re
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.errors import DamagedTable, InvalidLog, excerpt
from tuning_tables.pass_log.log_columns import (
    COLUMNS,
    LARGEST_FILE_BYTES,
    LONGEST_TEXT,
    NUMBERS,
    OPTIONAL,
    TEXTS,
    BrokenRow,
    Floats,
    LogColumns,
    TextRuns,
)
from tuning_tables.pass_log.log_mapping import DELIMITERS, PATHS, LogMapping
from tuning_tables.pass_log.pass_log import ROWS, PassLog
from tuning_tables.whole_file import read_regular_file, replacing

FIRST_LINE: Final = "# retarder-synth pass log 1; path: "
BLOCK_ROWS: Final = 100_000
NUMBER: Final = re.compile(r"\s*([+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|[+-]?(nan|inf|infinity))?\s*", re.A | re.I)


def read_csv_log(path: Path, mapping: LogMapping) -> LogColumns:
    """The rows of the CSV file at `path`; `InvalidLog` names file, row and column of what is wrong; `OSError`."""
    source = os.fspath(path)
    text, is_cut_off = _text_of(path)
    *lines, end = text.split("\n")
    independent, header = _first_lines(source, lines)
    if len(lines) <= header:
        raise _no_rows(source)
    places = _places(source, lines[header], header + 1, mapping)
    if mapping.decimal == ",":
        *lines, end = text.replace(",", ".").split("\n")
    broken, blank = None, f" \t{mapping.delimiter}"
    if is_cut_off or (end.strip(blank) and not _is_whole(end, places, mapping)):
        broken = _broken_row(end, len(lines) + 1, places, mapping)
    elif end.strip(blank):  # only the last line feed is missing
        lines.append(end)
    while broken is None and len(lines) > header and not lines[-1].strip(blank):
        lines.pop()
    body = lines[header + 1 :]
    if not body:
        raise _no_rows(source)
    numbers, texts = _parsed(source, body, header + 2, places, mapping)
    for name, factor in mapping.factors.items():
        if name in places:
            numbers[name] = numbers[name] * factor
    for name in NUMBERS:
        if name not in numbers:
            value = float(mapping.constant.get(name, OPTIONAL.get(name, np.nan)))
            numbers[name] = np.full(len(body), value)
    category = texts.get("category", TextRuns((0,), (str(mapping.constant.get("category")),)))
    if mapping.path_is_independent is not None:
        independent = mapping.path_is_independent
    return LogColumns(source, header + 2, numbers, texts["cut_id"], category, independent, broken)


def write_csv_log(log: PassLog, path: Path) -> None:
    """Write `log` to the file at `path`, complete or not at all; numbers read back exactly. `OSError`.

    Columns that say nothing are left out: pressure without a gauge, target where none is known.
    """
    left_out = {"pressure_kpa"} if not log.has_gauge else set()
    if np.isnan(log.target_m_s).all():
        left_out.add("target_m_s")
    names = [name for name in COLUMNS if name not in left_out]
    word = next(word for word, independent in PATHS.items() if independent == log.path_is_independent)
    with replacing(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        file.write(f"{FIRST_LINE}{word}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        for number in range(len(log)):
            rows = log.rows(number)
            count = rows.stop - rows.start
            columns: list[list[Any]] = []
            for name in names:
                value = getattr(log, name)
                columns.append(_written(value[rows]) if name in ROWS else _written(value[number : number + 1]) * count)
            writer.writerows(zip(*columns, strict=True))


def _written(values: Any) -> list[Any]:
    """Values as the file has them: nothing for NaN, 0 and 1 for truth."""
    if isinstance(values, tuple):
        return list(values)
    if values.dtype == np.bool_:
        return [int(value) for value in values]
    return ["" if value != value else value for value in values.tolist()]  # only NaN is not itself


def _no_rows(source: str) -> InvalidLog:
    return InvalidLog(f"{source}: no rows under a header line; give a log with columns {', '.join(COLUMNS)}.")


def _text_of(path: Path) -> tuple[str, bool]:
    """The text, and whether it ends within a character or in zero bytes: both are left where the power was lost."""
    try:
        content = read_regular_file(path, LARGEST_FILE_BYTES)
    except DamagedTable as fault:
        raise InvalidLog(str(fault)) from fault
    written = content.rstrip(b"\0")
    decoder = codecs.getincrementaldecoder("utf-8-sig")()
    try:
        text = decoder.decode(written)
    except UnicodeDecodeError as fault:
        raise InvalidLog(f"{path}: byte {fault.start} is no UTF-8; save the log as UTF-8.") from fault
    is_cut_off = len(written) < len(content) or bool(decoder.getstate()[0])
    if "\0" in text:
        raise InvalidLog(f"{path}: character {text.index(chr(0))} is a zero byte; this is no CSV file.")
    return text.replace("\r\n", "\n").removesuffix("\r"), is_cut_off


def _is_whole(line: str, places: dict[str, int], mapping: LogMapping) -> bool:
    return line.count('"') % 2 == 0 and _row_fault(_cells(line, mapping), places, mapping) is None


def _broken_row(line: str, row: int, places: dict[str, int], mapping: LogMapping) -> BrokenRow:
    """The row that the file ends in, as far as it was written."""
    cells, place = _cells(line, mapping), places["cut_id"]
    found = _row_fault(cells, places, mapping)
    column = max(places, key=places.__getitem__) if found is None else found[0]
    return BrokenRow(row, column, cells[place] if place < len(cells) else "", has_whole_id=place < len(cells) - 1)


def _first_lines(source: str, lines: list[str]) -> tuple[bool, int]:
    """Whether the path is independent, and which line is the header, counted from 0."""
    independent, header = True, 0
    while header < len(lines) and lines[header].startswith("#"):
        if lines[header].startswith(FIRST_LINE.split(" 1;")[0]):
            word = lines[header].removeprefix(FIRST_LINE).strip(" ,;\t")
            if word not in PATHS:
                raise InvalidLog(
                    f"{source}: row {header + 1} is {excerpt(lines[header])!r}; it must be {FIRST_LINE!r} and one of "
                    f"{', '.join(PATHS)}."
                )
            independent = PATHS[word]
        header += 1
    return independent, header


def _places(source: str, line: str, row: int, mapping: LogMapping) -> dict[str, int]:
    """Which column of the file each of ours is."""
    found = [name.strip() for name in _cells(line, mapping)]
    places = {}
    for name in COLUMNS:
        foreign = mapping.columns.get(name, name)
        if found.count(foreign) > 1:
            raise InvalidLog(f"{source}: row {row}: the column {foreign} stands there twice; take one of them out.")
        if foreign in found and name not in mapping.constant:
            places[name] = found.index(foreign)
        elif name in mapping.columns or (name not in OPTIONAL and name not in mapping.constant):
            told = f"{source}: row {row}: there is no column {foreign}, only {excerpt(', '.join(found), 200)}"
            other = next((each for each in DELIMITERS if len(found) == 1 and each in line), None)
            remedy = f"give delimiter = {other!r} in a mapping" if other else "add it, or tell its name by a mapping"
            raise InvalidLog(f"{told}; {remedy}.")
    return places


def _cells(line: str, mapping: LogMapping) -> list[str]:
    try:
        return next(csv.reader([line], delimiter=mapping.delimiter), [])
    except csv.Error:  # a cell too long for it
        return line.split(mapping.delimiter)


def _parsed(
    source: str, body: list[str], first_number: int, places: dict[str, int], mapping: LogMapping
) -> tuple[dict[str, Floats], dict[str, TextRuns]]:
    """The columns of the lines `body`: numbers, and runs of texts."""
    texts = [name for name in TEXTS if name in places]
    dtype = np.dtype([(name, f"U{LONGEST_TEXT + 1}" if name in texts else "f8") for name in places])
    blocks, runs = [], {name: ([0], [""]) for name in texts}
    for begin in range(0, len(body), BLOCK_ROWS):
        lines = _filled(body[begin : begin + BLOCK_ROWS], mapping.delimiter)
        try:
            block = np.loadtxt(
                lines, dtype, comments=None, delimiter=mapping.delimiter, usecols=list(places.values()), ndmin=1,
                quotechar='"',
            )  # fmt: skip
        except (ValueError, OverflowError) as fault:
            _name_fault(source, body, begin, first_number, places, mapping)
            raise InvalidLog(f"{source}: not readable as CSV ({excerpt(str(fault), 200)}); write it anew.") from fault
        if len(block) != len(body[begin : begin + BLOCK_ROWS]):
            _name_fault(source, body, begin, first_number, places, mapping)
            raise InvalidLog(f"{source}: a cell goes over the end of its line; write the log anew.")
        for name in texts:
            _lengthen(runs[name], block[name], begin)
        blocks.append({name: block[name].copy() for name in places if name not in texts})
    found: dict[str, TextRuns] = {name: TextRuns(tuple(first), tuple(value)) for name, (first, value) in runs.items()}
    for text in texts:
        _require_texts(source, text, found[text], first_number)
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}, found


def _filled(lines: list[str], delimiter: str) -> list[str]:
    """The lines with `nan` in empty cells: numpy knows no empty number."""
    if any('"' in line for line in lines):
        return _filled_quoted(lines, delimiter)
    joined = "\n".join(("", *lines, ""))
    if delimiter + " " in joined or "\n " in joined:  # perhaps cells of spaces: the slow way finds them
        cell = re.escape(delimiter)
        joined = re.sub(rf"(?m)(?<={cell}) +(?={cell}|$)|^ +(?={cell})", "", joined)
    gaps = [gap for gap in (2 * delimiter, "\n" + delimiter, delimiter + "\n") if gap in joined]
    if not gaps:
        return lines
    for gap in [*gaps, *gaps]:  # twice: of three delimiters in a row, one pass sees the first two
        joined = joined.replace(gap, f"{gap[0]}nan{gap[1]}")
    return joined[1:-1].split("\n")


def _filled_quoted(lines: list[str], delimiter: str) -> list[str]:
    """The same where cells stand in quotes, which may hold a delimiter, or nothing."""
    filled = io.StringIO()
    writer = csv.writer(filled, delimiter=delimiter, lineterminator="\n")
    try:
        for cells in csv.reader(lines, delimiter=delimiter):
            writer.writerow([cell if cell.strip() else "nan" for cell in cells])
    except csv.Error:  # numpy tells that a line is none
        return lines
    return filled.getvalue()[:-1].split("\n")


def _require_texts(source: str, name: str, texts: TextRuns, first_number: int) -> None:
    for row, text in zip(texts.first_row, texts.value, strict=True):
        if text in ("", "nan"):
            raise InvalidLog(f"{source}: row {first_number + row}, column {name}: the cell is empty; fill it.")
        if not text.isprintable():
            raise InvalidLog(f"{source}: row {first_number + row}, column {name}: {text!r:.60} is no name; write one.")
        if len(text) > LONGEST_TEXT:
            raise InvalidLog(
                f"{source}: row {first_number + row}, column {name}: longer than {LONGEST_TEXT} characters; shorten it."
            )


def _lengthen(runs: tuple[list[int], list[str]], values: npt.NDArray[np.str_], begin: int) -> None:
    """Add the runs of `values`, which begin at row `begin`."""
    first, value = runs
    starts = np.flatnonzero(values[1:] != values[:-1]) + 1
    for start in chain([0], starts.tolist()):
        text = str(values[start])
        if begin + start == 0:
            value[0] = text
        elif text != value[-1]:
            first.append(begin + start)
            value.append(text)


def _name_fault(
    source: str, body: list[str], begin: int, first_number: int, places: dict[str, int], mapping: LogMapping
) -> None:
    """Raise `InvalidLog` for the first line from `begin` on that is no row."""
    for row, line in _numbered(body, begin, first_number):
        cells = _cells(line, mapping)
        if not line.strip():
            raise InvalidLog(f"{source}: row {row}: the line is empty; take it out.")
        if (found := _row_fault(cells, places, mapping)) is not None:
            column, what = found
            raise InvalidLog(f"{source}: row {row}, column {column}: {what}.")


def _row_fault(cells: list[str], places: dict[str, int], mapping: LogMapping) -> tuple[str, str] | None:
    """The first column that is at fault in a row, and what is wrong there; None where nothing is."""
    for name, place in places.items():
        if place >= len(cells):
            return name, f"the row ends after {len(cells)} of its cells; write the whole row"
        if name in TEXTS and not cells[place].strip():
            return name, "the cell is empty; fill it"
        if name not in TEXTS and NUMBER.fullmatch(cells[place]) is None:
            what = f'{excerpt(cells[place])!r} is no number; write one, with "{mapping.decimal}" before its decimals'
            return name, what
    return None


def _numbered(body: list[str], begin: int, first_number: int) -> Iterator[tuple[int, str]]:
    for place in range(begin, min(begin + BLOCK_ROWS, len(body))):
        yield first_number + place, body[place]
