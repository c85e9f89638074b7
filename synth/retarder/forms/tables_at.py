"""All tables from whatever the user points at, a JSON table, a book, or the directory of a tune; and the programs that
wrote the files there, as these files say.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from synth.frame.faults import MACHINE_FAULTS, InputError
from synth.frame.results_directory import SUMMARY
from synth.frame.told import FORMAT
from tuning_tables import ControllerTable, read_book, read_json
from tuning_tables.aim.aim_tables import AimTable
from tuning_tables.document import FORMAT as TABLE
from tuning_tables.document import KINDS, AnyTable, kind_of
from tuning_tables.hdf5_file import read_any_book
from tuning_tables.json_text import LARGEST_FILE_BYTES
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.whole_file import first_bytes

if TYPE_CHECKING:
    from tuning_tables.document import StageTable

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


@dataclass(frozen=True)
class TablesAt:
    """The tables at a path by kind: those with lines, in the order of their book where there is one; the `files` that
    hold these; those for point sensors; aim tables.
    """

    path: Path
    lines: tuple[ControllerTable, ...]
    files: tuple[TableFile, ...]
    passages: tuple[PassageTable, ...]
    aims: tuple[AimFile, ...]

    @property
    def of_stages(self) -> tuple[StageTable, ...]:
        """All tables that a controller takes stages from."""
        return (*self.lines, *self.passages)

    @property
    def of_one_kind(self) -> tuple[AnyTable, ...]:
        """The tables that make an export: aim tables, without any those for point sensors, else those with lines."""
        return tuple(file.table for file in self.aims) or self.passages or self.lines

    def only_lines(self, for_what: str) -> tuple[ControllerTable, ...]:
        """The tables that have lines; `InputError` where there are others, as `for_what` has use for none of them."""
        if self.passages:
            raise InputError(f"{self.path}: its tables are for point sensors; {for_what} takes tables for a radar")
        self.only_of_stages(for_what)
        return self.lines

    def only_of_stages(self, for_what: str) -> tuple[StageTable, ...]:
        """All tables that a controller takes stages from; `InputError` where there are aim tables alone."""
        if not self.of_stages:
            raise InputError(
                f"{self.path}: its tables are aim tables, which regulate nothing; {for_what} takes tables of a tune"
            )
        return self.of_stages


def tables_at(path: Path, else_there: bool = False) -> TablesAt:
    """The tables at `path`: a table, a book, or a directory, in which they may lie in tables/.

    `InputError` where there are none, unless there is something else to be told (`else_there`); `TableError` where
    something is damaged.
    """
    aims, passages = read_aims(path), read_passages(path)
    if (else_there or aims or passages) and not holds_tables(path):
        return TablesAt(path, (), (), passages, aims)
    files = read_tables(path, directory_allowed=True)
    book = book_in(path)
    in_order = files if book == path else (read_table_file(book),)
    return TablesAt(path, tuple(table for file in in_order for table in file.tables), files, passages, aims)


def read_passages(path: Path) -> tuple[PassageTable, ...]:
    """The tables for point sensors at `path`: a file, or those of a directory, in tables/ if it has that.

    Empty where there is none. `TableError` where one is damaged.
    """
    if path.is_dir() or not is_book(path):
        return tuple(read_json(file, PassageTable) for file in files_of(PassageTable, path))
    return tuple(table for table in read_any_book(path) if isinstance(table, PassageTable))


def is_book(file: Path) -> bool:
    """Whether a file is HDF5; what cannot be read is not."""
    try:
        return first_bytes(file, len(HDF5_SIGNATURE)) == HDF5_SIGNATURE
    except OSError:  # whoever reads it for its tables tells why
        return False


def exporters_at(path: Path) -> tuple[str, ...]:
    """Each once; the files were read before, so they are sound."""
    return tuple(dict.fromkeys(name for name in map(exporter_of, files_at(path)) if name))


def exporter_of(file: Path) -> str:
    """The program that wrote a book or a JSON table; "" for another file."""
    if is_book(file):
        import h5py

        with h5py.File(file) as book:
            return str(book.attrs["exported_by"])
    if any(is_table_of(kind, file) for kind in KINDS.values()):
        return str(json.loads(file.read_bytes())["exported_by"])
    return ""
