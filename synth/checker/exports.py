"""The other exports in the directory of a tune, each against the same tables."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

from synth.checker import csv_export, golden_export, line_export, track_export
from synth.checker.aim.exports import check_aim_exports, is_aim_csv
from synth.checker.book_categories import without_number
from synth.checker.category_constants import ascii_comment
from synth.checker.code_file import CodeFile, c_files, st_files
from synth.checker.export_check import Check, Differences, findings_of
from synth.checker.finding import Finding, Kind
from synth.checker.passages.reading import PassageTable
from synth.checker.source import Source, named
from synth.checker.source_file import content_of
from synth.checker.table_reading import Table

FOLDERS: Final = ("", "c", "st")
PLACE: Final = re.compile(r"[/(]\* (\d{1,6}): (.*?) \*[/)]")
"""How C and Structured Text name a table: its number in the book, and its id in ASCII."""


@dataclass(frozen=True)
class ExportReport:
    """What was compared, and what was found."""

    files: tuple[str, ...]
    findings: tuple[Finding, ...]


def check_exports(source: Source, folder: Path) -> ExportReport:
    """Compare every export that there is in `folder`."""
    files: list[str] = []
    findings: list[Finding] = []

    def check(file: Path, compare: Callable[[], Differences]) -> None:
        files.append(named(file, folder))
        findings.extend(findings_of(files[-1], compare))

    if source.aims:
        check_aim_exports(source.aims, folder, check)
    if source.tables or not (source.aims or source.passages):
        check_code(source, folder, check)
    tables: dict[str, Table | PassageTable] = {table.id: table for table in source.tables}
    tables |= {table.id: table for table in source.passages}
    csv_files = [file for file in sorted((folder / "tables").glob("*.csv")) if not is_aim_csv(file)]
    seen: set[str] = set()
    for file in csv_files:
        check(file, partial(csv_differences, file, tables, seen))
    if csv_files:
        missing = sorted(tables.keys() - seen)
        findings += [Finding(Kind.DISAGREES, name, "other tables have a CSV file, it has none") for name in missing]
    return ExportReport(tuple(files), tuple(findings))


def check_code(source: Source, folder: Path, check: Check) -> None:
    """Compare the controller code for tables with lines, and its golden vectors and tracks."""
    for place in FOLDERS:
        for code in c_files(folder / place):
            check(code.path, partial(c_differences, code, source))
        for file in sorted((folder / place).glob("*golden_vectors.csv")):
            check(file, partial(golden_differences, file, source))
        for file in sorted((folder / place).glob("*golden_tracks.csv")):
            check(file, partial(track_differences, file, source))
        for code in st_files(folder / place):
            check(code.path, partial(st_differences, code, source))


def c_differences(code: CodeFile, source: Source) -> Differences:
    """The C export in a file, and the header beside it."""
    text, header = code.text(), code.text(code.path.with_suffix(".h"))
    yield from without_number(source.tables)
    yield from line_export.c_differences(text, header, in_order(source, text))


def st_differences(code: CodeFile, source: Source) -> Differences:
    """The Structured Text of an export."""
    text = code.units()
    yield from without_number(source.tables)
    yield from line_export.st_differences(text, in_order(source, text))


def golden_differences(file: Path, source: Source) -> Differences:
    """The golden vectors in `file`; their own ids tell the order where there is no book."""
    content = content_of(file)
    text = content.decode("utf-8", "replace")
    rows = dict.fromkeys(re.findall(r'^(\d{1,6}),"?([^",]*)"?,', text, re.MULTILINE))
    order = "".join(f"/* {number}: {ascii_comment(name)} */" for number, name in rows)
    return golden_export.differences(content, in_order(source, order))


def track_differences(file: Path, source: Source) -> Differences:
    """The golden tracks in `file`."""
    return track_export.differences(content_of(file), source.tables, source.has_book)


def csv_differences(file: Path, tables: Mapping[str, Table | PassageTable], seen: set[str]) -> Differences:
    """The CSV table in `file`, whose id is added to `seen`."""
    rows = csv_export.read_rows(content_of(file))
    name = (rows.get(("text", "id")) or ("",))[0]
    if name not in tables:
        yield "", f"it is of the table {name!r}, which no other file holds"
        return
    seen.add(name)
    yield from ((name, sentence) for sentence in csv_export.differences(rows, tables[name].document))


def in_order(source: Source, text: str) -> list[Table]:
    """The tables in the order of the book; without a book, in the order that the comments of `text` tell."""
    if source.has_book:
        return list(source.tables)
    by_name = {ascii_comment(table.id): table for table in source.tables}
    names = [name for _, name in sorted((int(number), name) for number, name in PLACE.findall(text))]
    ordered = [by_name[name] for name in dict.fromkeys(names) if name in by_name]
    return ordered + [table for table in source.tables if table not in ordered]
