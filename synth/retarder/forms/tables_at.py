"""All tables from whatever the user points at: a file of one, a book, or a directory."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from synth.frame.input_error import InputError
from synth.retarder.forms.table_file import (
    HDF5_SIGNATURE,
    AimFile,
    TableFile,
    book_in,
    files_of,
    holds_tables,
    read_aims,
    read_table_file,
    read_tables,
)
from tuning_tables import read_json
from tuning_tables.hdf5_file import read_any_book
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.regular_file import first_bytes

if TYPE_CHECKING:
    from tuning_tables import ControllerTable
    from tuning_tables.table_kinds import AnyTable, StageTable


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
