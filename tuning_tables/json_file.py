"""Controller tables as JSON files: written for people and machines, read without mercy.

One table has exactly two texts: the layout of the export, and the canonical form of RFC 8785 of the whole document
(without a line feed at its end) for writers in other languages. Any other text is refused, even where it says the same:
the checksum covers what is said, this covers how, so that no byte of a file can change unnoticed.
"""

from __future__ import annotations

import json
import os
from typing import Final, NoReturn

from tuning_tables.atomic_file import write_atomically
from tuning_tables.canonical import LARGEST_EXACT_INTEGER, canonical_json
from tuning_tables.document import from_document, to_document
from tuning_tables.errors import DamagedTable
from tuning_tables.excerpt import excerpt
from tuning_tables.regular_file import read_regular_file
from tuning_tables.table import ControllerTable

LARGEST_FILE_BYTES: Final = 4 * 2**20


def to_json(table: ControllerTable) -> bytes:
    """The JSON text of `table`, UTF-8: a key a line, a stage a line, floats in shortest round-trip form.

    Equal tables give equal bytes. Raises `InvalidTable` where a number is -0.0 (see `document.to_document`).
    """
    members = [f" {_compact(key)}: {_layout(value)}" for key, value in to_document(table).items()]
    return ("{\n" + ",\n".join(members) + "\n}\n").encode("utf-8")


def from_json(content: bytes, source: str = "table") -> ControllerTable:
    """The table in the JSON text `content`; `source` names it in messages.

    Raises `DamagedTable` for text that is too long (over 4 MiB), no UTF-8, no JSON, nested too deep, with a key given
    twice or a number that is not finite; then as `document.from_document`; at last `DamagedTable` for a text that is,
    byte for byte, neither `to_json` of the table nor the canonical form (RFC 8785) of the document.
    """
    if len(content) > LARGEST_FILE_BYTES:
        raise DamagedTable(f"{source}: longer than {LARGEST_FILE_BYTES} bytes, which no controller table is.")
    try:
        document = json.loads(
            content.decode("utf-8"),
            object_pairs_hook=_object,
            parse_constant=_refuse_constant,
            parse_int=_whole_number,
        )
        table = from_document(document, source)
    except RecursionError as fault:
        raise DamagedTable(f"{source}: nested too deep, which no controller table is; export it again.") from fault
    except (UnicodeDecodeError, json.JSONDecodeError, _Unacceptable) as fault:
        raise DamagedTable(f"{source}: not a complete JSON text ({fault}); export the table again.") from fault
    if content != to_json(table) and content != canonical_json(document):
        raise DamagedTable(
            f"{source}: laid out otherwise than the export writes it, so it was changed after the export; "
            "export it again, or write it in the canonical form of RFC 8785."
        )
    return table


def write_json(table: ControllerTable, path: str | os.PathLike[str]) -> None:
    """Write `to_json(table)` to the file at `path`, complete or not at all; raises as `to_json`, and `OSError`."""
    write_atomically(path, to_json(table))


def read_json(path: str | os.PathLike[str]) -> ControllerTable:
    """The table in the file at `path`; raises as `from_json`, and `OSError` for what is no readable regular file."""
    return from_json(read_regular_file(path, LARGEST_FILE_BYTES), source=os.fspath(path))


class _Unacceptable(Exception):
    """JSON as the parser of the standard library would take it, but no JSON as RFC 8259 and I-JSON have it."""


def _object(members: list[tuple[str, object]]) -> dict[str, object]:
    document = dict(members)
    if len(document) < len(members):
        seen: set[str] = set()
        for key, _ in members:
            if key in seen:
                raise _Unacceptable(f"the key {excerpt(repr(key))} is given twice")
            seen.add(key)
    return document


def _refuse_constant(token: str) -> NoReturn:
    raise _Unacceptable(f"{token} is no JSON number")


def _whole_number(token: str) -> int | float:
    # The canonical form writes any double below 1e21 that is whole without a point: beyond 2^53 it is one of those.
    # The length first, for int() refuses thousands of digits in its own words.
    if len(token) <= 17 and abs(whole := int(token)) <= LARGEST_EXACT_INTEGER:
        return whole
    return float(token)


def _layout(value: object) -> str:
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return "[\n" + ",\n".join(f"  {_compact(item)}" for item in value) + "\n ]"
    return _compact(value)


def _compact(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False)
