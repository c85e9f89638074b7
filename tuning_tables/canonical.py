"""The canonical form of a JSON document, and the checksum over it.

Canonical form: RFC 8785 (JSON Canonicalization Scheme). UTF-8; no white space; the keys of each object sorted by their
UTF-16 code units; numbers as ECMAScript prints a double (the shortest digits that read back exactly); strings with the
fewest escapes. It has no -0.0, which is written as 0. Most languages have a library for it.

Checksum: CRC-32 of ISO 3309 / ITU-T V.42 (reflected, polynomial 04C11DB7, initial value and final xor FFFFFFFF), that
of zlib, Ethernet and PNG, over the canonical form of the document less its key "crc32", as 8 lower-case hex digits.
Its check value, over the nine bytes "123456789", is cbf43926. Worked example: {"b": 1.0, "a": [0.5, null]} has the
canonical form {"a":[0.5,null],"b":1} and the checksum 3f95c3d3.
"""

from __future__ import annotations

import json
import math
import zlib
from collections.abc import Mapping
from typing import Final

CHECKSUM_KEY: Final = "crc32"
LARGEST_EXACT_INTEGER: Final = 2**53


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
    if value is None or isinstance(value, bool):
        return json.dumps(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, int):
        if abs(value) > LARGEST_EXACT_INTEGER:
            raise ValueError("an integer beyond 2^53 has no exact canonical form; write it as a string.")
        return str(int(value))
    if isinstance(value, float):
        return _number_text(float(value))
    if isinstance(value, list | tuple):
        return "[" + ",".join(map(_text, value)) + "]"
    if isinstance(value, dict):
        if not all(isinstance(key, str) for key in value):
            raise ValueError("a key is no string; JSON objects have string keys only.")
        members = sorted(value.items(), key=lambda member: member[0].encode("utf-16-be"))
        return "{" + ",".join(f"{_text(key)}:{_text(member)}" for key, member in members) + "}"
    raise ValueError(f"{type(value).__name__} has no JSON form; convert it to a plain number, string, list or dict.")


def _number_text(value: float) -> str:
    """`value` as ECMAScript's Number.prototype.toString prints it (ECMA-262, Number::toString)."""
    if not math.isfinite(value):
        raise ValueError(f"{value!r} has no JSON form; numbers must be finite.")
    if value == 0.0:
        return "0"  # also for -0.0
    sign = "-" if value < 0.0 else ""
    mantissa, _, exponent = repr(abs(value)).partition("e")
    whole, _, fraction = mantissa.partition(".")
    digits = (whole + fraction).lstrip("0")
    # value = 0.d1 d2 d3 ... * 10^point
    point = len(whole) + int(exponent or "0") - (len(whole + fraction) - len(digits))
    digits = digits.rstrip("0")
    if len(digits) <= point <= 21:
        return sign + digits.ljust(point, "0")
    if 0 < point <= 21:
        return f"{sign}{digits[:point]}.{digits[point:]}"
    if -6 < point <= 0:
        return f"{sign}0.{'0' * -point}{digits}"
    tail = f".{digits[1:]}" if len(digits) > 1 else ""
    return f"{sign}{digits[0]}{tail}e{point - 1:+d}"
