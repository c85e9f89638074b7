"""Controller tables as JSON files: written for people and machines, read without mercy.

One table has exactly two texts: the layout of the export, and the canonical form of RFC 8785 of the whole document
(without a line feed at its end) for writers in other languages. Any other text is refused, even where it says the same:
the checksum covers what is said, this covers how, so that no byte of a file can change unnoticed.
"""

from __future__ import annotations

import os

from tuning_tables.atomic_file import write_atomically
from tuning_tables.document import from_document, to_document
from tuning_tables.json_text import LARGEST_FILE_BYTES, laid_out, read_json_text, require_layout
from tuning_tables.regular_file import read_regular_file
from tuning_tables.table import ControllerTable


def to_json(table: ControllerTable) -> bytes:
    """The JSON text of `table`, UTF-8: a key a line, a stage a line, floats in shortest round-trip form.

    Equal tables give equal bytes. Raises `InvalidTable` where a number is -0.0 (see `document.to_document`).
    """
    return laid_out(to_document(table))


def from_json(content: bytes, source: str = "table") -> ControllerTable:
    """The table in the JSON text `content`; `source` names it in messages.

    Raises `DamagedTable` for text that is too long (over 4 MiB), no UTF-8, no JSON, nested too deep, with a key given
    twice or a number that is not finite; then as `document.from_document`; at last `DamagedTable` for a text that is,
    byte for byte, neither `to_json` of the table nor the canonical form (RFC 8785) of the document.
    """
    document, table = read_json_text(content, source, "controller table", from_document)
    require_layout(content, document, to_json(table), source)
    return table


def write_json(table: ControllerTable, path: str | os.PathLike[str]) -> None:
    """Write `to_json(table)` to the file at `path`, complete or not at all; raises as `to_json`, and `OSError`."""
    write_atomically(path, to_json(table))


def read_json(path: str | os.PathLike[str]) -> ControllerTable:
    """The table in the file at `path`; raises as `from_json`, and `OSError` for what is no readable regular file."""
    return from_json(read_regular_file(path, LARGEST_FILE_BYTES), source=os.fspath(path))
