"""Tables from whatever the user points at: a JSON table, a book, or the directory of a tune."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from synth.frame.input_error import InputError
from synth.frame.machine_fault import MACHINE_FAULTS
from synth.frame.results_directory import SUMMARY
from synth.frame.summary import FORMAT
from tuning_tables import ControllerTable, read_book, read_json
from tuning_tables.aim.aim_table import AimTable
from tuning_tables.document import FORMAT as TABLE
from tuning_tables.json_text import LARGEST_FILE_BYTES
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.regular_file import first_bytes
from tuning_tables.table_kinds import AnyTable, kind_of

HDF5_SIGNATURE = b"\x89HDF"
BOOK_SUFFIXES = (".h5", ".hdf5")
BOOK = "book.h5"
"""The book of a tune, in its directory."""


@dataclass(frozen=True)
class TableFile:
    """The tables of one file; `kind` is 'table' or 'book'. Reading them has checked their sums."""

    path: Path
    kind: str
    tables: tuple[ControllerTable, ...]


def read_tables(path: Path, directory_allowed: bool = False) -> tuple[TableFile, ...]:
    """The table files at `path`; of a directory its JSON tables, those in tables/ if it has that, else its books.

    `InputError` where there is nothing to read, `TableError` where something is damaged.
    """
    if path.is_dir():
        if not directory_allowed:
            raise InputError(f"{path}: this is a directory; give a table (.json) or a book (.h5)")
        files = table_files(path)
        if not files and read_aims(path):
            raise InputError(f"{path}: its tables are aim tables, which regulate nothing; give tables that do")
        if not files:
            raise InputError(f"{path}: there are neither tables (.json) nor books (.h5) in it; give what a tune left")
        return tuple(read_table_file(file) for file in files)
    return (read_table_file(path),)


def book_in(path: Path) -> Path:
    """The book in the directory `path` of a tune; else `path` itself, where tables may be or not."""
    return path / BOOK if (path / BOOK).is_file() else path


def table_files(directory: Path) -> list[Path]:
    """The JSON tables with lines of a directory, those in tables/ if it has that; its books where there are no tables.

    Aim tables are not meant. Beside tables for point sensors a book is theirs.
    """
    folder = directory / "tables" if (directory / "tables").is_dir() else directory
    tables = sorted(file for file in folder.glob("*.json") if file.name != SUMMARY)
    others = [file for file in tables if not is_table_of(AimTable, file)]
    with_lines = [file for file in others if not is_table_of(PassageTable, file)]
    return with_lines or ([] if others else sorted(directory.glob("*.h5")))


def files_at(path: Path) -> tuple[Path, ...]:
    """The files that may be read where `path`, a file or what a tune left, is asked for its tables."""
    if not path.is_dir():
        return (path,)
    return tuple(sorted(file for each in ("*.json", "*.h5", "tables/*.json") for file in path.glob(each)))


def holds_tables(path: Path) -> bool:
    """Whether a directory has anything to be read as tables."""
    return path.is_dir() and bool(table_files(path))


def read_table_file(path: Path) -> TableFile:
    """The tables in the file `path`, told apart by its first bytes."""
    try:
        book = first_bytes(path, len(HDF5_SIGNATURE)) == HDF5_SIGNATURE or path.suffix in BOOK_SUFFIXES
        return TableFile(path, "book", read_book(path)) if book else TableFile(path, "table", (read_json(path),))
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such file; give a table (.json) or a book (.h5)") from None
    except OSError as error:
        if error.errno in MACHINE_FAULTS:
            raise
        raise InputError(f"{path}: cannot be read ({error.strerror}); check the path and its permissions") from None


def file_stem(table: ControllerTable | AimTable | PassageTable) -> str:
    """The table's id as a file name: a file may hold any id, so no slash and no leading dot gets through."""
    return re.sub(r"[^\w.-]+", "-", table.id).lstrip(".-") or "table"


def summaries_beside(path: Path) -> Iterator[tuple[Path, dict[str, Any]]]:
    """Every summary of a command with its folder: that of `path`, of a table, book or directory, or the one above."""
    here = path if path.is_dir() else path.parent
    for folder in (here, here.parent):
        try:
            document = json.loads((folder / SUMMARY).read_bytes())
        except (OSError, ValueError):
            continue
        if isinstance(document, dict) and document.get("format") == FORMAT:
            yield folder, document


def summary_beside(path: Path) -> dict[str, object] | None:
    """summary.json of the tune that left the table, book or directory `path`; None where none can be read."""
    return next((found for _, found in summaries_beside(path) if "cases" in found.get("tables", {})), None)


def is_infeasible(table: ControllerTable | PassageTable, summary: dict[str, object] | None) -> bool:
    """Whether `summary`, of the same configuration, calls the case of `table` infeasible."""
    match summary:
        case {"generator": {"config_sha256": sha256}, "tables": {"cases": list(cases)}}:
            found = [case for case in cases if isinstance(case, dict) and case.get("id") == table.id]
            same = sha256 == table.generator.config_sha256
            return same and any(case.get("verdict") == "infeasible" for case in found)
    return False


OF_FORMAT: Final = re.compile(rb'"format"\s*:\s*"%s"' % TABLE.encode())
OF_KIND: Final = re.compile(rb'"kind"\s*:\s*"(\w+)"')
"""No text in a JSON document can hold these: its quotes would be escaped."""


def is_table_of(table: type[AnyTable], file: Path) -> bool:
    """Whether a JSON file says that it is a table of this class; what cannot be read does not."""
    try:
        content = b"" if file.suffix in BOOK_SUFFIXES else first_bytes(file, LARGEST_FILE_BYTES)
    except OSError:  # whoever reads it for its tables tells why
        return False
    return bool(OF_FORMAT.search(content)) and OF_KIND.findall(content) == [kind_of(table).encode()]


@dataclass(frozen=True)
class AimFile:
    """The aim table of one file; reading it has checked its sum."""

    path: Path
    table: AimTable


def read_aims(path: Path) -> tuple[AimFile, ...]:
    """The aim tables at `path`: a file, or those of a directory, in tables/ if it has that; empty where there is none.

    `TableError` where one is damaged.
    """
    return tuple(AimFile(file, read_json(file, AimTable)) for file in files_of(AimTable, path))


def files_of(table: type[AnyTable], path: Path) -> list[Path]:
    """The JSON files with a table of this class at `path`: a file, or those of a directory or of its tables/."""
    folder = path / "tables" if (path / "tables").is_dir() else path
    files = sorted(folder.glob("*.json")) if path.is_dir() else [path]
    return [file for file in files if is_table_of(table, file)]
