"""A controller table of any version: with lines over the path, or with switching speeds at sensor passages.

Who needs one of the two kinds reads it by `json_file` or by `passages.json_file`, which refuse the other in a sentence.
"""

from __future__ import annotations

import os
from typing import TypeAlias

from tuning_tables.atomic_file import write_atomically
from tuning_tables.document import PASSAGES_VERSION, from_document
from tuning_tables.json_file import to_json
from tuning_tables.json_text import LARGEST_FILE_BYTES, read_json_text, require_layout
from tuning_tables.passages.document import from_passage_document
from tuning_tables.passages.json_file import to_passage_json
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.regular_file import read_regular_file
from tuning_tables.table import ControllerTable

AnyTable: TypeAlias = ControllerTable | PassageTable


def to_table_json(table: AnyTable) -> bytes:
    """The JSON text of `table`, as `to_json` or `to_passage_json`."""
    return to_passage_json(table) if isinstance(table, PassageTable) else to_json(table)


def from_table_json(content: bytes, source: str = "table") -> AnyTable:
    """The table in the JSON text `content`; `source` names it in messages. Raises as `from_json`."""
    document, table = read_json_text(content, source, "controller table", _from_any_document)
    require_layout(content, document, to_table_json(table), source)
    return table


def write_table(table: AnyTable, path: str | os.PathLike[str]) -> None:
    """Write `to_table_json(table)` to the file at `path`, complete or not at all; raises as `write_json`."""
    write_atomically(path, to_table_json(table))


def read_table(path: str | os.PathLike[str]) -> AnyTable:
    """The table in the file at `path`; raises as `read_json`, but takes all versions."""
    return from_table_json(read_regular_file(path, LARGEST_FILE_BYTES), source=os.fspath(path))


def _from_any_document(document: object, source: str) -> AnyTable:
    match document:
        case {"version": int(version)} if version == PASSAGES_VERSION:
            return from_passage_document(document, source)
        case _:
            return from_document(document, source)
