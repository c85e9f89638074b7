"""Tables for point sensors as JSON files, by the rules of all controller tables: two texts for a table, no other."""

from __future__ import annotations

import os

from tuning_tables.atomic_file import write_atomically
from tuning_tables.json_text import LARGEST_FILE_BYTES, laid_out, read_json_text, require_layout
from tuning_tables.passages.document import from_passage_document, to_passage_document
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.regular_file import read_regular_file


def to_passage_json(table: PassageTable) -> bytes:
    """The JSON text of `table`, UTF-8: a key a line, a stage or passage a line, floats in shortest round-trip form.

    Equal tables give equal bytes.
    """
    return laid_out(to_passage_document(table))


def from_passage_json(content: bytes, source: str = "table") -> PassageTable:
    """The table in the JSON text `content`; `source` names it in messages.

    Raises as `json_text.read_json_text` and `document.from_passage_document`; at last `DamagedTable` for a text that
    is, byte for byte, neither `to_passage_json` of the table nor the canonical form (RFC 8785) of the document.
    """
    document, table = read_json_text(content, source, "controller table", from_passage_document)
    require_layout(content, document, to_passage_json(table), source)
    return table


def write_passage_json(table: PassageTable, path: str | os.PathLike[str]) -> None:
    """Write `to_passage_json(table)` to the file at `path`, complete or not at all; raises `OSError`."""
    write_atomically(path, to_passage_json(table))


def read_passage_json(path: str | os.PathLike[str]) -> PassageTable:
    """The table in the file at `path`; raises as `from_passage_json`, and `OSError` for what is no regular file."""
    return from_passage_json(read_regular_file(path, LARGEST_FILE_BYTES), source=os.fspath(path))
