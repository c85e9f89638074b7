"""JSON text as the files of this package hold it: read strictly, and in one of two layouts only."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Final, NoReturn, TypeVar

from tuning_tables.canonical import LARGEST_EXACT_INTEGER, canonical_json
from tuning_tables.errors import DamagedTable
from tuning_tables.excerpt import excerpt

LARGEST_FILE_BYTES: Final = 4 * 2**20
WIDTH: Final = 120
"""Of a line in an exported table; a row of numbers may be wider."""

_T = TypeVar("_T")


def read_json_text(content: bytes, source: str, read: Callable[[object, str], _T]) -> tuple[dict[str, object], _T]:
    """The document in `content`, and what `read(document, source)` makes of it.

    Raises `DamagedTable` for text that is too long (over 4 MiB), no UTF-8, no JSON, nested too deep, with a key given
    twice or a number that is not finite; then as `read`, which refuses what is no object.
    """
    if len(content) > LARGEST_FILE_BYTES:
        raise DamagedTable(f"{source}: longer than {LARGEST_FILE_BYTES} bytes, which no table is.")
    try:
        document = json.loads(
            content.decode("utf-8"),
            object_pairs_hook=_object,
            parse_constant=_refuse_constant,
            parse_int=_whole_number,
        )
        return document, read(document, source)
    except RecursionError as fault:
        raise DamagedTable(f"{source}: nested too deep, which no table is; export it again.") from fault
    except (UnicodeDecodeError, json.JSONDecodeError, _Unacceptable) as fault:
        raise DamagedTable(f"{source}: not a complete JSON text ({fault}); export the table again.") from fault


def require_layout(content: bytes, document: dict[str, object], exported: bytes, source: str) -> None:
    """`content` is what the export writes, or the canonical form (RFC 8785) of `document`; raises `DamagedTable`."""
    if content not in (exported, canonical_json(document)):
        raise DamagedTable(
            f"{source}: laid out otherwise than the export writes it, so it was changed after the export; "
            "export it again, or write it in the canonical form of RFC 8785."
        )


def compact(value: object) -> str:
    """`value` on one line, floats in shortest round-trip form."""
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def laid_out(document: dict[str, object]) -> bytes:
    """`document` as tables are exported, UTF-8: a key a line, and what is wider than `WIDTH` an entry a line."""
    return (_members(document, "") + "\n").encode("utf-8")


def _laid_out(value: object, indent: str, before: int) -> str:
    """`value`, which begins `before` letters behind the indent: on one line, or an entry a line."""
    line = compact(value)
    if len(indent) + before + len(line) <= WIDTH:
        return line
    if isinstance(value, dict):
        return _members(value, indent)
    if isinstance(value, list) and any(isinstance(item, dict | list) for item in value):
        deeper = indent + " "
        return "[\n" + ",\n".join(deeper + _laid_out(item, deeper, 0) for item in value) + f"\n{indent}]"
    return line


def _members(members: dict[str, object], indent: str) -> str:
    deeper = indent + " "
    keys = {f"{compact(key)}: ": value for key, value in members.items()}
    return (
        "{\n"
        + ",\n".join(f"{deeper}{key}{_laid_out(value, deeper, len(key))}" for key, value in keys.items())
        + f"\n{indent}}}"
    )


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
