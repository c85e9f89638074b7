"""The checker's own arithmetic and rule against numpy, zlib, the canonical form, and Python's answers to hard
readings.
"""

from __future__ import annotations

import json
import math
import zlib
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scripts.studies.in_the_loop.agreement import ask
from synth.checker.content import canonical_form, crc32, parse_json, require_right_crc32
from synth.checker.finding import DamagedError
from synth.checker.float32 import above, below, bits, decide, from_bits, horner, is_float32, rises, rounded
from synth.checker.table_reading import read_table
from tests.controller_code.sample_book import approaching_book, sample_book, surface_book
from tuning_tables import to_json
from tuning_tables.json_text import canonical_json, read_json_text
from tuning_tables.table_book import TableBook

REAL = st.floats(allow_nan=False)
SINGLE = st.floats(allow_nan=False, allow_infinity=False, width=32)
JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**53), 2**53) | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(st.characters(exclude_categories=["Cs"])),
    lambda inner: st.lists(inner, max_size=4)
    | st.dictionaries(st.text(st.characters(exclude_categories=["Cs"])), inner, max_size=4),
    max_leaves=12,
)  # fmt: skip


@given(REAL)
def test_rounding_is_that_of_numpy(x: float) -> None:
    with np.errstate(over="ignore"):
        assert bits(x) == int(np.float32(x).view(np.uint32))
        assert rounded(x) == float(np.float32(x))
        assert is_float32(x) == (math.isfinite(x) and float(np.float32(x)) == x)


@given(SINGLE)
def test_neighbours_are_those_of_numpy(x: float) -> None:
    with np.errstate(over="ignore"):
        up, down = (float(np.nextafter(np.float32(x), np.float32(end))) for end in (np.inf, -np.inf))
    assert (above(x), below(x)) == (up, down)
    assert from_bits(bits(x)) == x


@given(st.lists(SINGLE, min_size=1, max_size=10), SINGLE)
def test_horner_is_that_of_numpy(line: list[float], s: float) -> None:
    with np.errstate(all="ignore"):
        value = np.float32(line[-1])
        for coefficient in line[-2::-1]:
            value = np.float32(np.float32(value * np.float32(s)) + np.float32(coefficient))
        assert horner(line, s) == pytest.approx(float(value), abs=0.0, rel=0.0, nan_ok=True)


LINE = st.none() | st.lists(st.floats(-8, 8, width=32), min_size=3, max_size=3)
BEGIN = st.sampled_from([0.0, -3.0])
READING = st.floats(-4, 12, width=32) | st.sampled_from([0.0, -0.0, -1e-45, -1e-60]) | st.floats()


@given(st.binary(max_size=300))
def test_crc_is_that_of_zlib(content: bytes) -> None:
    assert crc32(content) == zlib.crc32(content)


def test_crc_check_value() -> None:
    assert crc32(b"123456789") == 0xCBF43926
    require_right_crc32()


def test_a_wrong_crc_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("synth.checker.content.POLYNOMIAL", 0xEDB88321)
    with pytest.raises(ArithmeticError, match="cbf43926"):
        require_right_crc32()


@given(JSON)
def test_canonical_form_is_that_of_the_tables_and_is_read_back(value: object) -> None:
    text = canonical_form(value).encode("utf-8")
    assert text == canonical_json(value)
    assert parse_json(json.dumps(value).encode("utf-8")) == parse_json(text) == value


@pytest.mark.parametrize("number", [2**53, -(2**53), 2.0**53 + 2.0, -1e17, 1e20, 123456789012345678.0])
def test_a_whole_number_is_beyond_2_53_a_double_as_the_reader_has_it(number: float) -> None:
    text = canonical_json([number])
    found, read = parse_json(text), read_json_text(text, "t.json", lambda document, source: document)[1]
    assert found == read == [number]
    assert isinstance(read, list)
    assert type(found[0]) is type(read[0]) is type(number)


@pytest.mark.parametrize(
    ("text", "reason"),
    [('{"a":1,"a":2}', "stands twice"), ("[NaN]", "no JSON number"), ("[1e999]", "double precision"),
     ("[1", "not JSON"), ("[" * 100_000, "nested"), ("[" + "9" * 5000 + "]", "double precision")],
)  # fmt: skip
def test_what_is_no_strict_json_is_refused(text: str, reason: str) -> None:
    with pytest.raises(DamagedError, match=reason):
        parse_json(text.encode())


def test_what_is_no_utf8_is_refused() -> None:
    with pytest.raises(DamagedError, match="byte 1 is not UTF-8"):
        parse_json(b'"\xff"')
    with pytest.raises(DamagedError, match="surrogate"):
        canonical_form("\ud800")


READINGS = 60_000


@pytest.mark.requirement("VERIFY-06")
@pytest.mark.parametrize("made", [sample_book, approaching_book, surface_book])
def test_hard_readings_are_decided_alike(made: Callable[[], TableBook]) -> None:
    book = made()
    tables = [read_table(to_json(table)) for table in book.tables]
    asked = ask(book, READINGS, 10, 20261124)
    found = []
    for number, stage, s, v, kpa in asked.readings.tolist():
        table = tables[number]
        added = rises(table.slopes, table.pressures_kpa, table.top_stage, stage, kpa)
        limits = table.entrance_stage, table.farthest
        found.append(decide(table.lines, table.path_m, *limits, stage, s, v, added))
    assert found == asked.decisions.tolist()
    far = asked.decisions - asked.readings["stage"]
    assert np.count_nonzero(abs(far) > 1) > 500
    assert min(np.count_nonzero(far < 0), np.count_nonzero(far == 0), np.count_nonzero(far > 0)) > 1_000
