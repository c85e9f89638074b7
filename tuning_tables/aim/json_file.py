"""Aim tables as JSON files, by the rules of controller tables: two texts for a table, and no other is read."""

from __future__ import annotations

import os

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.document import from_aim_document, to_aim_document
from tuning_tables.atomic_file import write_atomically
from tuning_tables.json_text import LARGEST_FILE_BYTES, compact, read_json_text, require_layout
from tuning_tables.regular_file import read_regular_file


def to_aim_json(table: AimTable) -> bytes:
    """The JSON text of `table`, UTF-8: a key a line, a row of nodes a line, floats in shortest round-trip form.

    Equal tables give equal bytes.
    """
    return (_laid_out(to_aim_document(table), "") + "\n").encode("utf-8")


def from_aim_json(content: bytes, source: str = "aim table") -> AimTable:
    """The table in the JSON text `content`; `source` names it in messages.

    Raises as `json_text.read_json_text` and `document.from_aim_document`; at last `DamagedTable` for a text that is,
    byte for byte, neither `to_aim_json` of the table nor the canonical form (RFC 8785) of the document.
    """
    document, table = read_json_text(content, source, "aim table", from_aim_document)
    require_layout(content, document, to_aim_json(table), source)
    return table


def write_aim_json(table: AimTable, path: str | os.PathLike[str]) -> None:
    """Write `to_aim_json(table)` to the file at `path`, complete or not at all; raises `OSError`."""
    write_atomically(path, to_aim_json(table))


def read_aim_json(path: str | os.PathLike[str]) -> AimTable:
    """The table in the file at `path`; raises as `from_aim_json`, and `OSError` for what is no regular file."""
    return from_aim_json(read_regular_file(path, LARGEST_FILE_BYTES), source=os.fspath(path))


def _laid_out(value: object, indent: str) -> str:
    """`value` on one line, but what holds arrays of arrays with a line for each of its parts."""
    deeper = indent + " "
    if isinstance(value, dict) and (not indent or any(map(_is_nested, value.values()))):
        parts = [f"{deeper}{compact(key)}: {_laid_out(member, deeper)}" for key, member in value.items()]
        return "{\n" + ",\n".join(parts) + f"\n{indent}}}"
    if isinstance(value, list) and _is_nested(value):
        return "[\n" + ",\n".join(f"{deeper}{_laid_out(item, deeper)}" for item in value) + f"\n{indent}]"
    return compact(value)


def _is_nested(value: object) -> bool:
    return isinstance(value, list) and any(isinstance(item, list) for item in value)
