"""JSON text as the files of this package hold it: the canonical form of a document, the checksum over it, strict
reading, and one of two layouts only.

The canonical form of a JSON document, and the checksum over it. Canonical form: RFC 8785 (JSON Canonicalization
Scheme). UTF-8; no white space; the keys of each object sorted by their UTF-16 code units; numbers as ECMAScript prints
a double (the shortest digits that read back exactly); strings with the fewest escapes. It has no -0.0, which is written
as 0. Most languages have a library for it.

Checksum: CRC-32 of ISO 3309 / ITU-T V.42 (reflected, polynomial 04C11DB7, initial value and final xor FFFFFFFF), that
of zlib, Ethernet and PNG, over the canonical form of the document less its key "crc32", as 8 lower-case hex digits.
Its check value, over the nine bytes "123456789", is cbf43926. Worked example: {"b": 1.0, "a": [0.5, null]} has the
canonical form {"a":[0.5,null],"b":1} and the checksum 3f95c3d3.
"""

from __future__ import annotations

import json
import math
import zlib
from collections.abc import Callable, Mapping
from typing import Final, NoReturn, TypeVar

from tuning_tables.errors import DamagedTable, excerpt

CHECKSUM_KEY: Final = "crc32"
LARGEST_EXACT_INTEGER: Final = 2**53

_quoted: Final = json.JSONEncoder(ensure_ascii=False).encode
"""A string as JSON. One encoder for all, as `json.dumps` makes a new one at every call."""


def canonical_json(document: object) -> bytes:
    """The canonical form of `document`, built from dict, list, tuple, str, int, float, bool and None.

    Raises `ValueError` for what JSON cannot hold faithfully: NaN, infinities, integers beyond 2^53, keys that are no
    strings, lone surrogates, other types.
    """
    return _text(document).encode("utf-8")


def crc32_hex(content: bytes) -> str:
    """CRC-32 of `content` as 8 lower-case hex digits; b"123456789" gives "cbf43926"."""
    return f"{zlib.crc32(content):08x}"


def document_checksum(document: Mapping[str, object]) -> str:
    """The checksum of all of `document` but its key "crc32". Raises `ValueError` as `canonical_json`."""
    return crc32_hex(canonical_json({key: value for key, value in document.items() if key != CHECKSUM_KEY}))


def _text(value: object) -> str:
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, float):
        return _number_text(float(value))
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        if abs(value) > LARGEST_EXACT_INTEGER:
            raise ValueError("an integer beyond 2^53 has no exact canonical form; write it as a string.")
        return str(int(value))
    if isinstance(value, list | tuple):
        return "[" + ",".join(map(_text, value)) + "]"
    if isinstance(value, dict):
        return "{" + ",".join([f"{_quoted(key)}:{_text(value[key])}" for key in _sorted_keys(value)]) + "}"
    raise ValueError(f"{type(value).__name__} has no JSON form; convert it to a plain number, string, list or dict.")


def _sorted_keys(members: dict[object, object]) -> list[str]:
    """The keys by their UTF-16 code units, which is Python's own order where all are ASCII."""
    keys = [key for key in members if isinstance(key, str)]
    if len(keys) < len(members):
        raise ValueError("a key is no string; JSON objects have string keys only.")
    return sorted(keys) if "".join(keys).isascii() else sorted(keys, key=lambda key: key.encode("utf-16-be"))


def _number_text(value: float) -> str:
    """`value` as ECMAScript's Number.prototype.toString prints it (ECMA-262, Number::toString)."""
    if not math.isfinite(value):
        raise ValueError(f"{value!r} has no JSON form; numbers must be finite.")
    if value == 0.0:
        return "0"  # also for -0.0
    if "e" not in (plain := repr(value)):
        return plain.removesuffix(".0")  # as ECMAScript, but for the point of a whole number
    sign = "-" if value < 0.0 else ""
    mantissa, _, exponent = plain.removeprefix("-").partition("e")
    digits = mantissa.replace(".", "")
    point = int(exponent) + 1  # value = 0.d1 d2 d3 ... * 10^point
    if len(digits) <= point <= 21:
        return sign + digits.ljust(point, "0")
    if -6 < point <= 0:
        return f"{sign}0.{'0' * -point}{digits}"
    tail = f".{digits[1:]}" if len(digits) > 1 else ""
    return f"{sign}{digits[0]}{tail}e{point - 1:+d}"


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
