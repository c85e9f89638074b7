"""Tables as JSON files: written for people and machines, read without mercy.

One table has exactly two texts: the layout of the export, and the canonical form of RFC 8785 of the whole document
(without a line feed at its end) for writers in other languages. Any other text is refused, even where it says the same:
the checksum covers what is said, this covers how, so that no byte of a file can change unnoticed.
"""

from __future__ import annotations

import os
from typing import Any, TypeVar, cast, overload

from tuning_tables.atomic_file import write_atomically
from tuning_tables.document import from_document, to_document
from tuning_tables.json_text import LARGEST_FILE_BYTES, laid_out, read_json_text, require_layout
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.regular_file import read_regular_file
from tuning_tables.table import ControllerTable
from tuning_tables.table_kinds import KINDS, AnyTable, StageTable

_T = TypeVar("_T")


def to_json(table: AnyTable) -> bytes:
    """The JSON text of `table`, UTF-8, laid out for people, floats in shortest round-trip form.

    Equal tables give equal bytes. Raises `InvalidTable` where a number is -0.0 (see `document.to_document`).
    """
    return laid_out(to_document(table))


@overload
def from_json(content: bytes, *, source: str = "table") -> ControllerTable: ...
@overload
def from_json(content: bytes, *kinds: type[_T], source: str = "table") -> _T: ...
def from_json(content: bytes, *kinds: type[Any], source: str = "table") -> Any:
    """The table in the JSON text `content`, of one of `kinds`, by default with lines; `source` names it in messages.

    Raises `DamagedTable` for text that is too long (over 4 MiB), no UTF-8, no JSON, nested too deep, with a key given
    twice or a number that is not finite; then as `document.from_document`; at last `DamagedTable` for a text that is,
    byte for byte, neither `to_json` of the table nor the canonical form (RFC 8785) of the document.
    """
    wanted = kinds or (ControllerTable,)
    document, table = read_json_text(content, source, lambda found, at: from_document(found, at, wanted))
    require_layout(content, document, to_json(table), source)
    return table


def write_json(table: AnyTable, path: str | os.PathLike[str]) -> None:
    """Write `to_json(table)` to the file at `path`, complete or not at all; raises as `to_json`, and `OSError`."""
    write_atomically(path, to_json(table))


@overload
def read_json(path: str | os.PathLike[str]) -> ControllerTable: ...
@overload
def read_json(path: str | os.PathLike[str], *kinds: type[_T]) -> _T: ...
def read_json(path: str | os.PathLike[str], *kinds: type[Any]) -> Any:
    """The table in the file at `path`; raises as `from_json`, and `OSError` for what is no readable regular file."""
    content = read_regular_file(path, LARGEST_FILE_BYTES)
    return from_json(content, *(kinds or (ControllerTable,)), source=os.fspath(path))


def read_table(path: str | os.PathLike[str]) -> AnyTable:
    """The table of any kind in the file at `path`; raises as `read_json`."""
    return read_json(path, *KINDS.values())


def read_stage_table(path: str | os.PathLike[str]) -> StageTable:
    """The table with lines or for point sensors in the file at `path`; raises as `read_json`."""
    return cast(StageTable, read_json(path, ControllerTable, PassageTable))
