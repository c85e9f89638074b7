"""Tables for point sensors from whatever the user points at: a JSON table, a book, or a directory with some."""

from __future__ import annotations

from pathlib import Path

from synth.retarder.forms.table_file import HDF5_SIGNATURE
from synth.retarder.forms.table_mark import is_table_of
from tuning_tables.hdf5_file import read_any_book
from tuning_tables.json_file import read_json
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.regular_file import first_bytes


def read_passages(path: Path) -> tuple[PassageTable, ...]:
    """The tables for point sensors at `path`: a file, or those of a directory, in tables/ if it has that.

    Empty where there is none. `TableError` where one is damaged.
    """
    if path.is_dir():
        folder = path / "tables" if (path / "tables").is_dir() else path
        files = (file for file in sorted(folder.glob("*.json")) if is_table_of(PassageTable, file))
        return tuple(read_json(file, PassageTable) for file in files)
    if is_table_of(PassageTable, path):
        return (read_json(path, PassageTable),)
    if not is_book(path):
        return ()
    return tuple(table for table in read_any_book(path) if isinstance(table, PassageTable))


def is_book(file: Path) -> bool:
    """Whether a file is HDF5; what cannot be read is not."""
    try:
        return first_bytes(file, len(HDF5_SIGNATURE)) == HDF5_SIGNATURE
    except OSError:  # whoever reads it for its tables tells why
        return False
