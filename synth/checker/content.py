"""The content of a file: its bytes, however odd the file is; strict JSON, its canonical form (RFC 8785), and
CRC-32 bit by bit.
"""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Sequence
from decimal import Decimal
from pathlib import Path
from typing import Any, Final, NoReturn

from synth.checker.finding import DamagedError, shown

LARGEST_BYTES: Final = 64 * 2**20


def content_of(path: Path) -> bytes:
    """All of a regular file of bearable size; `DamagedError` for what is not one, or cannot be read."""
    try:
        if not path.is_file():  # a pipe or device might never end
            raise DamagedError("it is no regular file")
        with path.open("rb") as file:
            content = file.read(LARGEST_BYTES + 1)
    except OSError as fault:
        raise DamagedError(f"it cannot be read ({fault.strerror})") from None
    if len(content) > LARGEST_BYTES:
        raise DamagedError(f"it has more than {LARGEST_BYTES} bytes")
    return content


def text_of(path: Path) -> str:
    """A file of ASCII text; `DamagedError` otherwise."""
    try:
        return content_of(path).decode("ascii")
    except UnicodeDecodeError as fault:
        raise DamagedError(f"byte {fault.start} is not ASCII") from None


def rows_below(head: Sequence[str], content: bytes) -> list[list[str]]:
    """The rows of a CSV file below its first line, which must be `head`; `DamagedError` otherwise."""
    try:
        rows = list(csv.reader(io.StringIO(content.decode("utf-8"), newline=""), strict=True))
    except (UnicodeDecodeError, csv.Error) as fault:
        raise DamagedError(f"it is no CSV: {fault}") from None
    if not rows or rows[0] != list(head):
        raise DamagedError(f"its first line is not {','.join(head)}")
    return rows[1:]


LARGEST_JSON_BYTES: Final = 4 * 1024 * 1024
POLYNOMIAL: Final = 0xEDB88320
"""04C11DB7 with its bits reversed: the reflected form."""
CHECK_VALUE: Final = 0xCBF43926
"""CRC-32 of "123456789"."""
ESCAPES: Final = {'"': '\\"', "\\": "\\\\", "\b": "\\b", "\t": "\\t", "\n": "\\n", "\f": "\\f", "\r": "\\r"}


def parse_json(content: bytes, largest_bytes: int = LARGEST_JSON_BYTES) -> Any:
    """The JSON value in `content`: UTF-8, no key twice in an object, finite numbers; `DamagedError` otherwise."""
    if len(content) > largest_bytes:
        raise DamagedError(f"it has {len(content)} bytes, but at most {largest_bytes} are allowed")
    try:
        return json.loads(
            content.decode("utf-8"),
            object_pairs_hook=unique_members,
            parse_constant=refuse_constant,
            parse_float=finite_number,
            parse_int=whole_number,
        )
    except UnicodeDecodeError as fault:
        raise DamagedError(f"byte {fault.start} is not UTF-8 text") from None
    except RecursionError:
        raise DamagedError("it is nested too deeply") from None
    except json.JSONDecodeError as fault:
        raise DamagedError(f"it is not JSON: {fault}") from None


def unique_members(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """The object of these members."""
    members = dict(pairs)
    if len(members) < len(pairs):
        keys = [key for key, _ in pairs]
        raise DamagedError(f"the key {shown(next(k for k in keys if keys.count(k) > 1))} stands twice in one object")
    return members


def refuse_constant(name: str) -> NoReturn:
    """NaN and the infinities, which Python would read."""
    raise DamagedError(f"{name} is no JSON number")


def finite_number(text: str) -> float:
    """The number, which must fit into a double."""
    number = float(text)
    if not math.isfinite(number):
        raise DamagedError(f"the number {text[:40]} is beyond the range of double precision")
    return number


def whole_number(text: str) -> int | float:
    """The number; beyond 2^53 it is the double that RFC 8785 writes without a point below 10^21."""
    if len(text) <= 17 and abs(number := int(text)) <= 2**53:  # int() refuses thousands of digits
        return number
    return finite_number(text)


def canonical_form(value: object) -> str:
    """`value` by RFC 8785; `DamagedError` for what has no such form."""
    if isinstance(value, dict):
        members = sorted(value.items(), key=lambda member: member[0].encode("utf-16-be", "surrogatepass"))
        return "{" + ",".join(f"{string_form(key)}:{canonical_form(member)}" for key, member in members) + "}"
    if isinstance(value, list):
        return "[" + ",".join(map(canonical_form, value)) + "]"
    if isinstance(value, str):
        return string_form(value)
    if isinstance(value, bool) or value is None:
        return {True: "true", False: "false", None: "null"}[value]
    if isinstance(value, int):
        if abs(value) > 2**53:
            raise DamagedError(f"the integer {shown(value)} is beyond 2^53")
        return str(value)
    if isinstance(value, float):
        return number_form(value)
    raise DamagedError(f"{type(value).__name__} has no JSON form")


def string_form(text: str) -> str:
    """A string in quotes with the fewest escapes."""
    if any("\ud800" <= letter <= "\udfff" for letter in text):
        raise DamagedError("a string holds a lone surrogate")
    return '"' + "".join(ESCAPES.get(x) or (f"\\u{ord(x):04x}" if x < " " else x) for x in text) + '"'


def number_form(x: float) -> str:
    """A finite double as ECMAScript's Number::toString: the shortest digits that read back, laid out by exponent."""
    if not math.isfinite(x):
        raise DamagedError(f"{x!r} is no JSON number")
    if x == 0.0:
        return "0"
    sign, digit_tuple, exponent = Decimal(repr(x)).normalize().as_tuple()
    assert isinstance(exponent, int)  # of a finite number
    digits = "".join(map(str, digit_tuple))
    k, n = len(digits), len(digits) + exponent  # x = 0.digits · 10^n, the letters of ECMA-262
    if k <= n <= 21:
        text = digits + "0" * (n - k)
    elif 0 < n <= 21:
        text = f"{digits[:n]}.{digits[n:]}"
    elif -6 < n <= 0:
        text = "0." + "0" * -n + digits
    else:
        text = digits[0] + ("." + digits[1:] if k > 1 else "") + f"e{n - 1:+d}"
    return ("-" if sign else "") + text


def crc32(content: bytes) -> int:
    """CRC-32 of ISO 3309 / ITU-T V.42, one bit after the other, as the standard describes it."""
    register = 0xFFFFFFFF
    for byte in content:
        register ^= byte
        for _ in range(8):
            register = (register >> 1) ^ (POLYNOMIAL if register & 1 else 0)
    return register ^ 0xFFFFFFFF


def require_right_crc32() -> None:
    """Raise `ArithmeticError` unless this implementation gives the check value."""
    if crc32(b"123456789") != CHECK_VALUE:
        raise ArithmeticError("the checker's CRC-32 is wrong: 123456789 does not give cbf43926")


def without_checksum(document: dict[str, Any]) -> dict[str, Any]:
    """What the checksum of a table is taken over."""
    return {key: value for key, value in document.items() if key != "crc32"}
