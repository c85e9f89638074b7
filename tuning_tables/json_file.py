"""Controller tables as JSON files: written for people and machines, read without mercy."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Final, NoReturn

from tuning_tables.atomic_file import write_atomically
from tuning_tables.document import from_document, to_document
from tuning_tables.errors import DamagedTable
from tuning_tables.table import ControllerTable

LARGEST_FILE_BYTES: Final = 4 * 2**20


def to_json(table: ControllerTable) -> bytes:
    """The JSON text of `table`, UTF-8: a key a line, a stage a line, floats in shortest round-trip form.

    Equal tables give equal bytes.
    """
    members = [f" {_compact(key)}: {_layout(value)}" for key, value in to_document(table).items()]
    return ("{\n" + ",\n".join(members) + "\n}\n").encode("utf-8")


def from_json(content: bytes, source: str = "table") -> ControllerTable:
    """The table in the JSON text `content`; `source` names it in messages.

    Raises `DamagedTable` for text that is too long (over 4 MiB), no UTF-8, no JSON, nested too deep, with a key given
    twice or a number that is not finite; otherwise as `document.from_document`.
    """
    if len(content) > LARGEST_FILE_BYTES:
        raise DamagedTable(f"{source}: longer than {LARGEST_FILE_BYTES} bytes, which no controller table is.")
    try:
        document = json.loads(
            content.decode("utf-8"),
            object_pairs_hook=_object,
            parse_constant=_refuse_constant,
            parse_int=_bounded_integer,
        )
        return from_document(document, source)
    except RecursionError as fault:
        raise DamagedTable(f"{source}: nested too deep, which no controller table is; export it again.") from fault
    except (UnicodeDecodeError, json.JSONDecodeError, _Unacceptable) as fault:
        raise DamagedTable(f"{source}: not a complete JSON text ({fault}); export the table again.") from fault


def write_json(table: ControllerTable, path: str | os.PathLike[str]) -> None:
    """Write `to_json(table)` to the file at `path`, complete or not at all; raises `OSError`."""
    write_atomically(path, to_json(table))


def read_json(path: str | os.PathLike[str]) -> ControllerTable:
    """The table in the file at `path`; raises as `from_json`, and `OSError` where the file cannot be read."""
    with Path(path).open("rb") as file:
        # One byte more than allowed tells a long file from a longest one, without reading the whole.
        content = file.read(LARGEST_FILE_BYTES + 1)
    return from_json(content, source=os.fspath(path))


class _Unacceptable(Exception):
    """JSON as the parser of the standard library would take it, but no JSON as RFC 8259 and I-JSON have it."""


def _object(members: list[tuple[str, object]]) -> dict[str, object]:
    document = dict(members)
    if len(document) < len(members):
        keys = [key for key, _ in members]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise _Unacceptable(f"the key {twice!r} is given twice")
    return document


def _refuse_constant(token: str) -> NoReturn:
    raise _Unacceptable(f"{token} is no JSON number")


def _bounded_integer(token: str) -> int:
    # Longer ones exceed 2^53, and int() itself refuses thousands of digits in its own words.
    if len(token) > 17:
        raise _Unacceptable(f"{token:.60} exceeds the range of whole numbers")
    return int(token)


def _layout(value: object) -> str:
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return "[\n" + ",\n".join(f"  {_compact(item)}" for item in value) + "\n ]"
    return _compact(value)


def _compact(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False)
