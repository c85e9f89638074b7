"""The other exports in the directory of a command, each against the same tables."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final, TypeAlias, TypeVar

from synth.checker.aim.exports import aim_differences, aim_sheet_differences, due_of_aims
from synth.checker.aim.table import Aim
from synth.checker.code_export import (
    AIMS,
    FOLDERS,
    LINES,
    PASSAGES,
    CodeFile,
    CodeKind,
    Due,
    ascii_comment,
    c_differences,
    code_files,
    st_differences,
)
from synth.checker.content import content_of, text_of
from synth.checker.csv_export import read_rows, sheet_differences
from synth.checker.finding import Check, DamagedError, Differences, Finding, Kind, findings_of
from synth.checker.line_exports import due_of_lines, track_differences, vector_differences
from synth.checker.passages.exports import due_of_passages, stage_differences
from synth.checker.passages.table import PassageTable
from synth.checker.plc_text import structured_text
from synth.checker.source import Source, named, without_number
from synth.checker.table_reading import Table

PLACE: Final = re.compile(r"[/(]\*\s+(\d{1,6}): ([^*]*?) \*[/)]")
"""How all forms name a table: its number in the export, and its id in ASCII, perhaps on several lines."""

AnyTable: TypeAlias = Table | PassageTable | Aim
Kept = TypeVar("Kept", Table, PassageTable, Aim)


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

    kinds = kinds_of(source)
    for code in code_files(folder):
        if code.kind in kinds:
            check(code.path, partial(code_differences, code, source))
    for place in FOLDERS:
        for file in sorted((folder / place).glob("*golden_*.csv")):
            compare = golden_check(file, source, kinds)
            if compare is not None:
                check(file, compare)
    findings += check_sheets(source, folder, check)
    return ExportReport(tuple(files), tuple(findings))


def kinds_of(source: Source) -> tuple[CodeKind, ...]:
    """The kinds whose code is compared: those of the tables that are there; where there are none, those with lines."""
    tables: Mapping[CodeKind, Sequence[AnyTable]] = {LINES: source.tables, AIMS: source.aims, PASSAGES: source.passages}
    return tuple(kind for kind in tables if tables[kind]) or (LINES,)


def code_differences(code: CodeFile, source: Source) -> Differences:
    """The controller code of an export."""
    if code.kind is not AIMS:
        yield from without_number(source.tables if code.kind is LINES else source.passages)
    if code.path.suffix == ".c":
        text = text_of(code.path)
        header = text_of(code.path.with_suffix(".h"))
        yield from c_differences(text, header, code.word, code.kind, due(code.kind, source, text))
        return
    text = "\n".join(structured_text(file) for file in code.files())
    yield from st_differences(text, code.word, code.kind, due(code.kind, source, text))


def due(kind: CodeKind, source: Source, text: str) -> Due:
    """What code of a kind must hold of the tables that are there, if it is a `text` with such comments."""
    if kind is AIMS:
        return due_of_aims(as_told(source.aims, text))
    if kind is PASSAGES:
        return due_of_passages(in_order(source.passages, source, text))
    return due_of_lines(in_order(source.tables, source, text))


def golden_check(file: Path, source: Source, kinds: Sequence[CodeKind]) -> Callable[[], Differences] | None:
    """How the answers beside code are compared, by the name of their file; None for those of other kinds."""
    checks: Mapping[str, tuple[CodeKind, Callable[[], Differences]]] = {
        "golden_vectors": (LINES, lambda: golden_differences(file, source)),
        "golden_tracks": (LINES, lambda: track_differences(content_of(file), source.tables, source.has_book)),
        "golden_aims": (AIMS, lambda: aim_differences(content_of(file), source.aims)),
        "golden_stages": (PASSAGES, lambda: stage_differences(content_of(file), source.passages)),
    }
    for ending, (kind, compare) in checks.items():
        if file.stem.endswith(ending) and kind in kinds:
            return compare
    return None


def golden_differences(file: Path, source: Source) -> Differences:
    """The golden vectors in `file`; their own ids tell the order where there is no book."""
    content = content_of(file)
    text = content.decode("utf-8", "replace")
    rows = dict.fromkeys(re.findall(r'^(\d{1,6}),"?([^",]*)"?,', text, re.MULTILINE))
    order = "".join(f"/* {number}: {ascii_comment(name)} */" for number, name in rows)
    yield from vector_differences(content, in_order(source.tables, source, order))


def check_sheets(source: Source, folder: Path, check: Check) -> list[Finding]:
    """Compare the CSV tables; what is found of tables without one, where others have one."""
    with_sheets: tuple[AnyTable, ...] = (*source.tables, *source.passages)
    tables = {each.id: each for each in (*with_sheets, *source.aims)}
    seen: set[str] = set()
    inside = folder / "tables"
    for file in sorted((inside if inside.is_dir() else folder).glob("*.csv")):
        if file.parent == inside or is_aim_csv(file):
            check(file, partial(csv_differences, file, tables, seen))
    names = {each.id for each in with_sheets}
    missing = sorted(names - seen) if names & seen else []
    return [Finding(Kind.DISAGREES, name, "other tables have a CSV file, it has none") for name in missing]


def is_aim_csv(file: Path) -> bool:
    """Whether a CSV file says that it is of an aim table."""
    try:
        return re.search(rb"^text,kind,aim,", content_of(file), re.MULTILINE) is not None
    except DamagedError:
        return False


def csv_differences(file: Path, tables: Mapping[str, AnyTable], seen: set[str]) -> Differences:
    """The CSV table in `file`, whose id is added to `seen`."""
    rows = read_rows(content_of(file))
    name = (rows.get(("text", "id")) or ("",))[0]
    table = tables.get(name)
    if table is None:
        yield "", f"it is of the table {name!r}, which no other file holds"
        return
    seen.add(name)
    found = aim_sheet_differences(rows, table) if isinstance(table, Aim) else sheet_differences(rows, table.document)
    yield from ((name, sentence) for sentence in found)


def in_order(tables: Sequence[Kept], source: Source, text: str) -> list[Kept]:
    """The tables in the order of the book; without a book, in the order that the comments of `text` tell."""
    return list(tables) if source.has_book else as_told(tables, text)


def as_told(tables: Sequence[Kept], text: str) -> list[Kept]:
    """The tables in the order that the comments of `text` tell; behind them those that it does not name."""
    by_name = {unspaced(ascii_comment(table.id)): table for table in tables}
    names = [unspaced(name) for _, name in sorted((int(number), name) for number, name in PLACE.findall(text))]
    ordered = [by_name[name] for name in dict.fromkeys(names) if name in by_name]
    return ordered + [table for table in tables if table not in ordered]


def unspaced(text: str) -> str:
    """A name without white space: a form may have broken a long one into lines."""
    return re.sub(r"\s+", "", text)
