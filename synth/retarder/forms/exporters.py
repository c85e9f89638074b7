"""The programs that wrote the table files at a path, as these files say."""

from __future__ import annotations

import json
from pathlib import Path

from synth.retarder.forms.passage_file import is_book
from synth.retarder.forms.table_file import files_at
from synth.retarder.forms.table_mark import is_table_of
from tuning_tables.table_kinds import KINDS


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
