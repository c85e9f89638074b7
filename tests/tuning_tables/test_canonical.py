"""The canonical form is that of RFC 8785, the checksum that of zlib."""

import json
import re
import struct

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tuning_tables.canonical import canonical_json, crc32_hex, document_checksum


@pytest.mark.requirement("FILE-07")
def test_checksum_has_its_published_check_value() -> None:
    assert crc32_hex(b"123456789") == "cbf43926"
    assert crc32_hex(b"") == "00000000"


def test_checksum_of_the_worked_example_leaves_out_its_own_key() -> None:
    document = {"b": 1.0, "a": [0.5, None]}
    assert canonical_json(document) == b'{"a":[0.5,null],"b":1}'
    assert document_checksum(document) == document_checksum({**document, "crc32": "?"}) == "3f95c3d3"
    assert document_checksum({**document, "a": [0.5, 0]}) != "3f95c3d3"


@pytest.mark.requirement("FILE-07")
@pytest.mark.parametrize(
    ("bits", "text"),
    [  # RFC 8785, appendix B
        ("0000000000000000", "0"),
        ("8000000000000000", "0"),
        ("0000000000000001", "5e-324"),
        ("8000000000000001", "-5e-324"),
        ("7fefffffffffffff", "1.7976931348623157e+308"),
        ("ffefffffffffffff", "-1.7976931348623157e+308"),
        ("4340000000000000", "9007199254740992"),
        ("c340000000000000", "-9007199254740992"),
        ("4430000000000000", "295147905179352830000"),
        ("44b52d02c7e14af5", "9.999999999999997e+22"),
        ("44b52d02c7e14af6", "1e+23"),
        ("44b52d02c7e14af7", "1.0000000000000001e+23"),
        ("444b1ae4d6e2ef4e", "999999999999999700000"),
        ("444b1ae4d6e2ef4f", "999999999999999900000"),
        ("444b1ae4d6e2ef50", "1e+21"),
        ("3eb0c6f7a0b5ed8c", "9.999999999999997e-7"),
        ("3eb0c6f7a0b5ed8d", "0.000001"),
        ("41b3de4355555553", "333333333.3333332"),
        ("41b3de4355555557", "333333333.33333343"),
        ("becbf647612f3696", "-0.0000033333333333333333"),
        ("43143ff3c1cb0959", "1424953923781206.2"),
    ],
)
def test_numbers_are_written_as_the_standard_shows(bits: str, text: str) -> None:
    (number,) = struct.unpack(">d", bytes.fromhex(bits))
    assert canonical_json(number) == text.encode()


@pytest.mark.requirement("FILE-07")
def test_strings_and_key_order_are_written_as_the_standard_shows() -> None:
    # RFC 8785, sections 3.2.2 and 3.2.3
    assert canonical_json('\u20ac$\x0f\nA\'B"\\\\"/') == '"\u20ac$\\u000f\\nA\'B\\"\\\\\\\\\\"/"'.encode()
    keys = ["\u20ac", "\r", "\ufb33", "1", "\U0001f600", "\x80", "\u00f6"]
    written = json.loads(canonical_json(dict.fromkeys(keys, True)))
    assert list(written) == ["\r", "1", "\x80", "\u00f6", "\u20ac", "\U0001f600", "\ufb33"]


@given(st.floats(allow_nan=False, allow_infinity=False))
@settings(derandomize=True)
def test_every_number_reads_back_exactly(number: float) -> None:
    assert float(canonical_json(number)) == number


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (float("nan"), "finite"),
        (float("-inf"), "finite"),
        (2**53 + 1, "beyond 2"),
        ({1: 2}, "string keys"),
        ({"a": object()}, "object has no JSON form"),
        (b"bytes", "bytes has no JSON form"),
        ([{"a": {1.5}}], "set has no JSON form"),
        ("\ud800", "surrogates not allowed"),
    ],
    ids=lambda given: re.sub(r" at 0x\w+", "", repr(given)),
)
def test_what_json_cannot_hold_is_refused(value: object, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        canonical_json(value)
